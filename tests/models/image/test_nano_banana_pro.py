"""Gemini's image models as they are asked, and what is read of their answers."""

import concurrent.futures

import numpy as np
import pytest

from tests.models.image.drawing_servers import drawing, encoded, gemini_reply, sent_images
from tests.models.image.requests import image_request
from tests.models.image.shift import shift, texture
from tests.models.loopback import Loopback, Reply, in_turn
from wm.models.image.nano_banana_pro import Settings, canvases, make
from wm.services.faults import RefusedError, ServiceError
from wm.services.ledger import Ledger
from wm.services.prices import Price, Prices
from wm.services.retries import RetryPolicy
from wm.services.services import Services

pytest.importorskip("google.genai")

VIEW = texture(344, 192)
IMAGE = encoded(np.zeros((768, 1376, 3), np.uint8))


@pytest.fixture(autouse=True)
def key(monkeypatch):
    monkeypatch.setenv("GEMINI_API_KEY", "a-key")


def asked_of(server: Loopback, request=None, services=None, **settings):
    model = make(Settings(base_url=server.url, **settings), None).with_services(services or Services())
    try:
        return model.generate(request or image_request(VIEW))
    finally:
        model.close()


def candidate(*parts, reason="STOP") -> Reply:
    return Reply(body={"candidates": [{"content": {"parts": list(parts)}, "finishReason": reason}]})


def test_the_request_has_prompt_guide_reference_seed_shape_and_size():
    with Loopback(drawing(gemini_reply)) as server:
        asked_of(server, image_request(VIEW, seed=2**32 - 1, reference=VIEW[:100]), image_size="2K")
    asked = server.asked[0]
    assert asked.path.endswith("/models/gemini-3-pro-image:generateContent")
    parts, config = asked.json["contents"][0]["parts"], asked.json["generationConfig"]
    assert "lighthouse keeper's cottage" in parts[0]["text"] and len(parts) == 3
    assert config["imageConfig"] == {"aspectRatio": "16:9", "imageSize": "2K"}
    assert config["seed"] == 2**31 - 1 and config["responseModalities"] == ["IMAGE"]
    guide, reference = sent_images(asked)
    assert guide.shape == (768, 1376, 3) and np.array_equal(reference, VIEW[:100])


def test_the_record_and_the_ledger_say_what_the_answer_cost():
    prices = Prices(models={"gemini-3-pro-image": Price(input=2.0, output=12.0, image_tokens=120.0)})
    services = Services(prices=prices, ledger=Ledger())
    with Loopback(drawing(gemini_reply)) as server:
        record = asked_of(server, services=services).record
    assert record["model_version"] == "gemini-3-pro-image" and record["response_id"] == "answer-1"
    assert record["finish_reason"] == "STOP" and record["shape"] == "16:9"
    assert record["usage"] == {
        "requests": 1, "images": 1, "input_tokens": 2500, "output_tokens": 300, "image_tokens": 1120
    }  # fmt: skip
    assert services.ledger.spent().usd == pytest.approx((2500 * 2 + 300 * 12 + 1120 * 120) / 1e6)


@pytest.mark.parametrize(
    ("reply", "said"),
    [
        (candidate({"text": "I cannot\ndraw this."}), "a text in place of an image .finish reason STOP.: I cannot draw this"),
        (candidate(reason="IMAGE_SAFETY"), "no image .finish reason IMAGE_SAFETY"),
        (candidate(reason="MAX_TOKENS"), "no image .finish reason MAX_TOKENS"),
        (candidate({"inlineData": {"mimeType": "image/png", "data": "AAAA"}, "thought": True}, reason="NO_IMAGE"), "NO_IMAGE"),
        (candidate({"inlineData": {"mimeType": "image/png", "data": ""}}), "no image"),
        (Reply(body={"candidates": [{"finishReason": "RECITATION"}]}), "no image .finish reason RECITATION"),
        (Reply(body={"promptFeedback": {"blockReason": "SAFETY"}}), "the prompt was blocked .SAFETY"),
        (Reply(body={"candidates": []}), "the answer has no candidate"),
    ],
)
def test_an_answer_without_an_image_is_refused_with_its_reason(reply, said):
    with Loopback(in_turn(reply)) as server, pytest.raises(RefusedError, match=f"gemini-3-pro-image: .*{said}"):
        asked_of(server)
    assert len(server.asked) == 1


def test_the_last_image_that_is_no_thought_is_taken():
    drawn, images = np.full((768, 1376, 3), 90, np.uint8), gemini_reply(IMAGE).body["candidates"][0]["content"]["parts"]
    last = gemini_reply(encoded(drawn)).body["candidates"][0]["content"]["parts"]
    with Loopback(in_turn(candidate(*images, *last, last[0]))) as server:
        assert np.unique(np.round(asked_of(server).rgb * 255)) == [90]


def test_jpeg_is_read_like_png():
    with Loopback(drawing(lambda content: gemini_reply(encoded(np.asarray(VIEW), "JPEG"), "image/jpeg"))) as server:
        assert shift(VIEW, np.round(asked_of(server).rgb * 255)) <= 0.25


def test_the_wait_that_the_service_asks_for_in_the_body_is_heard():
    info = [{"@type": "type.googleapis.com/google.rpc.RetryInfo", "retryDelay": "47s"}]
    busy = Reply(status=429, body={"error": {"code": 429, "message": "quota", "status": "RESOURCE_EXHAUSTED", "details": info}})
    with Loopback(in_turn(busy)) as server, pytest.raises(ServiceError, match="asks to wait for 47 s"):
        asked_of(server, services=Services(retries=RetryPolicy(patience=1.0)))


def test_eight_threads_share_one_backend():
    with Loopback(drawing(gemini_reply)) as server:
        model = make(Settings(base_url=server.url), None)
        with concurrent.futures.ThreadPoolExecutor(8) as pool:
            requests = [image_request(np.roll(VIEW, 9 * k, axis=1)) for k in range(8)]
            results = list(pool.map(model.generate, requests))
        model.close()
    for request, result in zip(requests, results):
        assert np.abs(result.rgb - request.condition.rgb).mean() < 0.02


@pytest.mark.slow
@pytest.mark.parametrize("size", ["2K", "4K"])
@pytest.mark.parametrize("ratio", [canvas.ratio for canvas in canvases("1K")])
def test_every_shape_registers_at_the_larger_sizes(size, ratio):
    canvas = next(canvas for canvas in canvases("1K") if canvas.ratio == ratio)
    view, times = texture(canvas.width // 4, canvas.height // 4), {"2K": 2, "4K": 4}[size]
    with Loopback(drawing(gemini_reply, lambda w, h: (times * w, times * h))) as server:
        result = asked_of(server, image_request(view), image_size=size)
    assert shift(view, np.round(result.rgb * 255)) <= 0.25


@pytest.mark.parametrize("ratio", [canvas.ratio for canvas in canvases("1K")])
def test_every_shape_registers_through_the_service(ratio):
    canvas = next(canvas for canvas in canvases("1K") if canvas.ratio == ratio)
    view = texture(canvas.width // 4 + 1, canvas.height // 4)
    with Loopback(drawing(gemini_reply)) as server:
        result = asked_of(server, image_request(view))
    assert server.asked[0].json["generationConfig"]["imageConfig"]["aspectRatio"] == ratio
    assert shift(view, np.round(result.rgb * 255)) <= 0.25
