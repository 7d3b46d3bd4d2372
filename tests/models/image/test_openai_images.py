"""OpenAI's image models as they are asked, and what is read of their answers."""

import numpy as np
import pytest

from tests.models.image.drawing_servers import drawing, encoded, openai_reply, sent_fields, sent_images
from tests.models.image.requests import image_request
from tests.models.image.shift import shift, texture
from tests.models.loopback import Loopback, Reply, in_turn
from wm.models.image.openai_images import Settings, make
from wm.services.faults import RefusedError, ServiceError
from wm.services.services import Services

pytest.importorskip("openai")

VIEW = texture(344, 192)


@pytest.fixture(autouse=True)
def key(monkeypatch):
    monkeypatch.setenv("OPENAI_API_KEY", "a-key")


def asked_of(server: Loopback, request=None, **settings):
    model = make(Settings(base_url=server.url + "/v1", **settings), None).with_services(Services())
    try:
        return model.generate(request or image_request(VIEW))
    finally:
        model.close()


def told(server: Loopback) -> dict[str, str]:
    fields = [part for part in sent_fields(server.asked[0]) if not part.get_filename()]
    return {part.get_param("name", header="content-disposition"): part.get_content().strip() for part in fields}


def test_the_request_has_prompt_guide_reference_size_and_quality():
    with Loopback(drawing(openai_reply)) as server:
        asked_of(server, image_request(VIEW, reference=VIEW[:100]), quality="medium")
    assert server.asked[0].path == "/v1/images/edits"
    sent = told(server)
    assert "lighthouse keeper's cottage" in sent.pop("prompt")
    assert sent == {
        "model": "gpt-image-2.6-sunburst", "size": "1376x768", "quality": "medium", "output_format": "png",
        "background": "opaque", "n": "1",
    }  # fmt: skip
    guide, reference = sent_images(server.asked[0])
    assert guide.shape == (768, 1376, 3) and np.array_equal(reference, VIEW[:100])


def test_older_models_are_asked_for_a_size_that_they_know():
    with Loopback(drawing(openai_reply)) as server:
        result = asked_of(server, model="gpt-image-1.5")
    sent = told(server)
    assert sent["size"] == "1536x1024" and sent["input_fidelity"] == "high"
    assert shift(VIEW, np.round(result.rgb * 255)) <= 0.25


def test_the_record_says_what_the_answer_used():
    with Loopback(drawing(openai_reply)) as server:
        record = asked_of(server).record
    assert record["response_id"] == "answer-1" and record["size"] == "1376x768" and record["quality"] == "high"
    assert record["usage"] == {
        "requests": 1, "images": 1, "input_tokens": 2700, "output_tokens": 0, "image_tokens": 1756
    }  # fmt: skip


@pytest.mark.parametrize("size", [(344, 192), (333, 517), (400, 400), (500, 160), (301, 199)], ids=str)
def test_views_of_any_shape_register(size):
    view = texture(*size)
    with Loopback(drawing(openai_reply)) as server:
        assert shift(view, np.round(asked_of(server, image_request(view)).rgb * 255)) <= 0.25


@pytest.mark.parametrize(
    ("reply", "fault", "said"),
    [
        (Reply(body={"data": [{"url": "http://127.0.0.1/x.png"}]}), RefusedError, "the answer has no image"),
        (Reply(body={"data": [{"b64_json": "@@@"}]}), RefusedError, "its image cannot be read"),
        (
            Reply(status=429, body={"error": {"message": "pay", "code": "insufficient_quota"}}),
            ServiceError,
            "the account has no credit left",
        ),
        (
            Reply(status=400, body={"error": {"message": "unknown model x", "code": "invalid_value"}}),
            ServiceError,
            "status 400: unknown model x",
        ),
        (
            Reply(body={"error": {"message": "no such model", "type": "not_found_error"}}),
            ServiceError,
            "the model or the address is not known",
        ),
    ],
)
def test_what_cannot_be_used_is_told_apart(reply, fault, said):
    with Loopback(in_turn(reply)) as server, pytest.raises(fault, match=said):
        asked_of(server)
    assert len(server.asked) == 1


def test_an_image_is_read_whatever_its_format():
    with Loopback(in_turn(openai_reply(encoded(VIEW, "JPEG")))) as server:
        assert shift(VIEW, np.round(asked_of(server).rgb * 255)) <= 0.25
