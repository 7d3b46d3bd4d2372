"""What goes wrong with a request to an image service, and what comes of it: retried, refused, or one clear error."""

import dataclasses
import logging
import socket
import time
import traceback
from collections.abc import Callable
from types import ModuleType
from typing import Any

import numpy as np
import pytest

from tests.models.image.drawing_servers import drawing, encoded, gemini_reply, openai_reply
from tests.models.image.requests import image_request
from tests.models.image.shift import shift, texture
from tests.models.loopback import Loopback, Reply, in_turn
from wm.models.image import nano_banana_pro, openai_images
from wm.models.image.drawing_model import DrawingModel
from wm.services.faults import MissingKeyError, RefusedError, ServiceError
from wm.services.ledger import Ledger
from wm.services.retries import RetryPolicy
from wm.services.services import Services
from wm.services.store import AnswerStore

pytest.importorskip("google.genai")
pytest.importorskip("openai")

KEY = "sk-a-key-that-nobody-may-see"
VIEW = texture(344, 192)
IMAGE = encoded(np.repeat(np.repeat(VIEW, 4, axis=0), 4, axis=1))
SOON = RetryPolicy(first=0.001, longest=0.001, patience=20.0)
LIMIT = 0.4  # seconds


@dataclasses.dataclass(frozen=True)
class Family:
    """One service: its backend, where its SDK looks, and what it answers."""

    module: ModuleType
    variable: str
    path: str  # after the server's address
    image: Callable[[bytes], Reply]
    error: Callable[[int, str], Any]  # the body of an error
    safety: Reply
    empty: Reply


FAMILIES = {
    "gemini": Family(
        nano_banana_pro,
        "GEMINI_API_KEY",
        "",
        gemini_reply,
        lambda status, said: {"error": {"code": status, "message": said, "status": "SOME_STATUS"}},
        Reply(body={"promptFeedback": {"blockReason": "PROHIBITED_CONTENT"}, "usageMetadata": {"promptTokenCount": 9}}),
        Reply(body={"candidates": [], "usageMetadata": {"promptTokenCount": 9}}),
    ),
    "openai": Family(
        openai_images,
        "OPENAI_API_KEY",
        "/v1",
        openai_reply,
        lambda status, said: {"error": {"message": said, "type": "some_type", "param": None, "code": None}},
        Reply(status=400, body={"error": {"message": f"rejected {KEY}", "type": "user_error", "code": "moderation_blocked"}}),
        Reply(body={"created": 1, "data": []}),
    ),
}


@pytest.fixture(params=FAMILIES)
def family(request, monkeypatch) -> Family:
    chosen = FAMILIES[request.param]
    monkeypatch.setenv(chosen.variable, KEY)
    return chosen


def backend(family: Family, address: str, *, limit: float = 20.0, **services) -> DrawingModel:
    settings = family.module.Settings(base_url=address + family.path, time_limit=limit)
    return family.module.make(settings, None).with_services(Services(**{"retries": SOON, **services}))


def status(code: int, **headers: str) -> Callable[[Family], Reply]:
    names = {name.replace("_", "-"): value for name, value in headers.items()}
    return lambda family: Reply(status=code, body=family.error(code, f"not now, {KEY}"), headers=names)


RETRIED = {
    "429": status(429),
    "429 with Retry-After": status(429, retry_after="0.01"),
    "408": status(408),
    "500": status(500),
    "502": lambda family: Reply(status=502, body=b"<html>bad gateway</html>", headers={"content-type": "text/html"}),
    "503": status(503),
    "504": status(504),
    "529": status(529),
    "no answer in time": lambda family: family.image(IMAGE)._replace(wait=3 * LIMIT),
    "cut connection": lambda family: family.image(IMAGE)._replace(cut=4000),
    "cut before the reply": lambda family: Reply(cut=0, headers={"x": "y"}, body=b"x" * 10),
    "slow drip": lambda family: family.image(IMAGE)._replace(drip=LIMIT / 10),
    "HTML with 200": lambda family: Reply(body=b"<html>busy</html>", headers={"content-type": "text/html"}),
    "empty body": lambda family: Reply(body=b"", headers={"content-type": "application/json"}),
    "other JSON": lambda family: Reply(body=[1, 2]),
    "null": lambda family: Reply(body=b"null", headers={"content-type": "application/json"}),
}


@pytest.mark.parametrize("fault", RETRIED)
def test_a_passing_fault_is_retried(family, fault):
    limit = LIMIT if fault in ("no answer in time", "slow drip") else 20.0
    said: list[str] = []
    with Loopback(in_turn(RETRIED[fault](family), family.image(IMAGE))) as server:
        model = backend(family, server.url, limit=limit, say=said.append)
        result = model.generate(image_request(VIEW))
        model.close()
    assert len(server.asked) == 2 and len(said) == 1
    assert shift(VIEW, np.round(result.rgb * 255)) <= 0.25
    assert KEY not in said[0]


REFUSED = {
    "empty candidates": (lambda family: family.empty, "the answer has no (candidate|image)"),
    "safety": (lambda family: family.safety, "blocked"),
    "truncated image": (lambda family: family.image(IMAGE[:-2000]), "cannot be read"),
    "no image at all": (lambda family: family.image(b"hello"), "cannot be read"),
    "another shape": (lambda family: family.image(encoded(VIEW[:, :192])), "192 x 192 pixels, which is another shape"),
}


@pytest.mark.parametrize("fault", REFUSED)
def test_an_answer_that_cannot_be_used_is_refused_once_and_kept(family, fault, tmp_path):
    reply, said = REFUSED[fault]
    with Loopback(in_turn(reply(family))) as server:
        model = backend(family, server.url, store=AnswerStore(tmp_path), ledger=Ledger())
        for _ in range(2):
            with pytest.raises(RefusedError, match=said):
                model.generate(image_request(VIEW))
        model.close()
    assert len(server.asked) == 1 and model.services.ledger.spent().requests == 1


HOPELESS = {
    "401": (401, "is not accepted"),
    "403": (403, "may not be used"),
    "400": (400, "the request was not accepted"),
    "404": (404, "the model or the address is not known"),
}


@pytest.mark.parametrize("fault", HOPELESS)
def test_what_no_retry_helps_is_one_clear_error(family, fault):
    code, said = HOPELESS[fault]
    with Loopback(in_turn(status(code)(family))) as server:
        model = backend(family, server.url)
        with pytest.raises(ServiceError, match=f"{said}.*status {code}") as caught:
            model.generate(image_request(VIEW))
        model.close()
    assert len(server.asked) == 1
    assert code not in (401, 403) or family.variable in str(caught.value)


def test_an_image_of_another_size_is_resampled(family):
    with Loopback(drawing(family.image, lambda w, h: (w // 2 + 7, h // 2 + 3))) as server:
        model = backend(family, server.url)
        assert shift(VIEW, np.round(model.generate(image_request(VIEW)).rgb * 255)) <= 0.25
        model.close()


def test_a_server_that_is_gone_is_waited_for_as_long_as_patience_lasts(family):
    with socket.socket() as place:
        place.bind(("127.0.0.1", 0))
        model = backend(family, f"http://127.0.0.1:{place.getsockname()[1]}", retries=RetryPolicy(first=0.01, patience=0.05))
        with pytest.raises(ServiceError, match=r"no answer after \d+ tr.*no answer: ConnectError"):
            model.generate(image_request(VIEW))
        model.close()


def test_a_wait_beyond_patience_is_not_waited(family):
    with Loopback(in_turn(status(429, retry_after="90")(family))) as server:
        model, began = backend(family, server.url), time.monotonic()
        with pytest.raises(ServiceError, match="asks to wait for 90 s"):
            model.generate(image_request(VIEW))
        model.close()
    assert len(server.asked) == 1 and time.monotonic() - began < 20


def test_a_missing_key_names_its_variable_and_nothing_is_sent(family, monkeypatch):
    monkeypatch.delenv(family.variable)
    with Loopback(in_turn(family.image(IMAGE))) as server, pytest.raises(MissingKeyError, match=family.variable):
        backend(family, server.url).generate(image_request(VIEW))
    assert server.asked == []


@pytest.mark.parametrize("fault", ["401", "400", "429", "safety", "truncated image", "none"])
def test_the_key_is_sent_and_seen_nowhere_else(family, fault, tmp_path, caplog):
    caplog.set_level(logging.DEBUG)
    reply = {
        "401": status(401)(family), "400": status(400)(family), "429": status(429, retry_after="90")(family),
        "safety": family.safety, "truncated image": family.image(IMAGE[:-2000]), "none": family.image(IMAGE),
    }[fault]  # fmt: skip
    said = []
    with Loopback(in_turn(reply)) as server:
        model = backend(family, server.url, store=AnswerStore(tmp_path), ledger=Ledger(tmp_path / "requests.jsonl"))
        try:
            said.append(repr(model.generate(image_request(VIEW)).record))
        except (ServiceError, RefusedError) as error:
            said += traceback.format_exception(error)
        said.append(repr(model))
        model.close()
    assert any(KEY in value for value in server.asked[0].headers.values())
    assert KEY.encode() not in server.asked[0].body
    for text in (*said, caplog.text, *(record.getMessage() for record in caplog.records)):
        assert KEY not in text
    for file in tmp_path.rglob("*"):
        assert file.is_dir() or KEY.encode() not in file.read_bytes()
