"""Every fault of a language service, by the real SDKs against a loopback server: retried, a refusal, or one clear error."""

import json
import socket
import traceback
from typing import NamedTuple

import pytest

from tests.models.language.wire import SECRET, STREAM, backend, claude_reply, events, good_reply, openai_reply
from tests.models.loopback import Loopback, Reply, in_turn
from wm.services.budget import Budget
from wm.services.faults import RefusedError, ServiceError
from wm.services.retries import RetryPolicy
from wm.services.services import Services
from wm.services.store import AnswerStore

pytest.importorskip("anthropic")
pytest.importorskip("openai")

DIALECTS = ("claude", "openai")
HTML = Reply(body=b"<html>Bad gateway of a proxy</html>", headers={"content-type": "text/html"})


def error(kind: str, message: str = "said") -> dict:
    return {"type": "error", "error": {"type": kind, "message": message, "code": kind}}


class Fault(NamedTuple):
    claude: Reply
    openai: Reply
    says: str = ""


def both(reply: Reply, says: str = "") -> Fault:
    return Fault(reply, reply, says)


RETRIED = {
    "429 without Retry-After": both(Reply(status=429, body=error("rate_limit_error"))),
    "429 with Retry-After": both(Reply(status=429, body=error("rate_limit_error"), headers={"retry-after-ms": "20"})),
    "408": both(Reply(status=408, body=b"")),
    "409": both(Reply(status=409, body=b"")),
    "500": both(Reply(status=500, body=error("api_error"))),
    "502 with HTML": both(HTML._replace(status=502)),
    "503": both(Reply(status=503, body=b"")),
    "529": both(Reply(status=529, body=error("overloaded_error"))),
    "silence": both(Reply(body=b"x", wait=2.0)),
    "slow drip": Fault(claude_reply("x" * 500, drip=0.1), openai_reply("x" * 500, drip=0.1)),
    "cut connection": Fault(claude_reply("x", cut=700), openai_reply("x", cut=50)),
    "HTML with 200": both(HTML),
    "error with 200": both(Reply(body=error("overloaded_error"))),
    "empty reply": both(Reply(body=b"", headers=STREAM)),
    "half of JSON": both(Reply(body=b'event: message_start\ndata: {"type": \n\n', headers=STREAM)),
    "another JSON": both(Reply(body=[1, 2])),
    "no message": Fault(Reply(body=events({"type": "message_stop"}), headers=STREAM), Reply(body={"choices": []})),
    "error in a stream": both(Reply(body=events(error("overloaded_error")), headers=STREAM)),
    "stream without an end": Fault(claude_reply("x", stop=None), Reply(body={"choices": None})),
}
REFUSED = {
    "refusal": Fault(claude_reply("no", "refusal"), openai_reply(None, message={"refusal": "not allowed"}), "not allowed"),
    "cut by max_tokens": Fault(claude_reply("{", "max_tokens"), openai_reply("{", "length"), "max_tokens"),
    "empty content": Fault(claude_reply(""), openai_reply(""), "no text"),
    "content missing": Fault(claude_reply("  "), openai_reply(None, message={"reasoning": "hm"}), "no text"),
    "stopped elsewhere": Fault(claude_reply("{}", "pause_turn"), openai_reply("{}", "tool_calls"), "another reason"),
    "filtered or full": Fault(
        claude_reply("{", "model_context_window_exceeded"), openai_reply("", "content_filter"), "cut|filter"
    ),
}
HOPELESS = {
    "401": both(Reply(status=401, body=error("authentication_error", f"wrong key {SECRET}")), r"_API_KEY is not accepted"),
    "403": both(Reply(status=403, body=error("permission_error")), r"_API_KEY may not be used"),
    "402": both(Reply(status=402, body=error("billing_error")), "no credit"),
    "404 model": both(Reply(status=404, body=error("not_found_error", "model: x")), "check the settings model and base_url"),
    "400": both(Reply(status=400, body=error("invalid_request_error", "schema too large")), "schema too large"),
    "429 without credit": both(Reply(status=429, body=error("insufficient_quota")), "no credit"),
    "wrong key with 200": both(Reply(body=error("authentication_error", SECRET)), r"_API_KEY is not accepted"),
}


@pytest.fixture(autouse=True)
def keys(monkeypatch):
    monkeypatch.setenv("ANTHROPIC_API_KEY", SECRET)
    monkeypatch.setenv("OPENAI_API_KEY", SECRET)


@pytest.fixture
def services(tmp_path):
    """Services that keep answers and hardly wait; the budget is never reached."""
    return Services(
        store=AnswerStore(tmp_path / "answers"),
        budget=Budget(requests=3),
        retries=RetryPolicy(first=0.001, longest=0.001, patience=60.0),
    )


def ask(dialect, services, url, time_limit=30.0):
    """The answer to one request, or the exception; with what a user may see of it."""
    model = backend(dialect, url, time_limit=time_limit).with_services(services)
    try:
        return model.propose("a house", ["hall"], seed=0, violations=[], previous=None), ""
    except Exception as raised:
        return raised, "".join(traceback.format_exception(raised))
    finally:
        model.close()


@pytest.mark.parametrize("name", RETRIED)
@pytest.mark.parametrize("dialect", DIALECTS)
def test_what_may_pass_is_asked_again(dialect, name, services):
    waited = []
    services.say = waited.append
    with Loopback(in_turn(getattr(RETRIED[name], dialect), good_reply(dialect, '{"rooms": 1}'))) as server:
        result, _ = ask(dialect, services, server.url, time_limit=0.7 if name in ("silence", "slow drip") else 30.0)
    assert not isinstance(result, Exception), result
    assert result.text == '{"rooms": 1}'
    assert len(server.asked) == 2 and len(waited) == 1 and "next try" in waited[0]
    assert services.ledger.spent().requests == 1


@pytest.mark.parametrize("name", REFUSED)
@pytest.mark.parametrize("dialect", DIALECTS)
def test_an_answer_of_no_use_is_kept_and_never_asked_for_again(dialect, name, services):
    fault = REFUSED[name]
    with Loopback(in_turn(getattr(fault, dialect))) as server:
        for _ in range(2):
            with pytest.raises(RefusedError, match=fault.says):
                raise ask(dialect, services, server.url)[0]
    assert len(server.asked) == 1
    assert services.ledger.spent().requests == 1


@pytest.mark.parametrize("name", HOPELESS)
@pytest.mark.parametrize("dialect", DIALECTS)
def test_what_no_retry_helps_is_one_error_without_the_key(dialect, name, services, tmp_path):
    fault = HOPELESS[name]
    with Loopback(in_turn(getattr(fault, dialect))) as server:
        raised, shown = ask(dialect, services, server.url)
    assert isinstance(raised, ServiceError)
    with pytest.raises(ServiceError, match=fault.says):
        raise raised
    assert len(server.asked) == 1 and SECRET in server.asked[0].headers["authorization"]
    assert SECRET not in shown
    assert services.ledger.rows == []


@pytest.mark.parametrize("dialect", DIALECTS)
def test_a_wait_that_the_service_asks_for_reaches_the_user_when_it_is_too_long(dialect, services):
    busy = Reply(status=429, body=error("rate_limit_error"), headers={"Retry-After": "90"})
    with Loopback(in_turn(busy)) as server:
        raised, _ = ask(dialect, services, server.url)
    assert isinstance(raised, ServiceError) and "asks to wait for 90 s" in str(raised)
    assert len(server.asked) == 1


@pytest.mark.parametrize("dialect", DIALECTS)
def test_a_server_that_is_not_there_is_waited_for_and_then_named(dialect, services):
    with socket.socket() as reserved:
        reserved.bind(("127.0.0.1", 0))  # bound and not listening: connections are refused
        services.retries = RetryPolicy(first=0.001, longest=0.001, patience=1.0)
        raised, shown = ask(dialect, services, f"http://127.0.0.1:{reserved.getsockname()[1]}")
    assert isinstance(raised, ServiceError) and "refused" in str(raised) and "tries" in str(raised)
    assert SECRET not in shown


@pytest.mark.parametrize("dialect", DIALECTS)
@pytest.mark.parametrize("address", ["localhost:8000", "ftp://localhost", "http://[::1"])
def test_an_address_that_is_none_is_told_at_once(dialect, address, services):
    raised, _ = ask(dialect, services, address)
    assert isinstance(raised, ServiceError) and "base_url" in str(raised)


@pytest.mark.parametrize("dialect", DIALECTS)
def test_what_is_kept_and_written_down_holds_no_key_and_no_address(dialect, services, tmp_path):
    with Loopback(in_turn(good_reply(dialect, "{}"))) as server:
        result, _ = ask(dialect, services, server.url)
    (kept,) = (tmp_path / "answers").rglob("*.zip")
    written = kept.read_bytes() + json.dumps([services.ledger.rows, dict(result.record)]).encode()
    assert SECRET.encode() not in written and server.url.encode() not in written


@pytest.mark.parametrize("dialect", DIALECTS)
def test_a_missing_key_is_named_and_nothing_is_sent(dialect, services, monkeypatch):
    monkeypatch.delenv("ANTHROPIC_API_KEY")
    monkeypatch.delenv("OPENAI_API_KEY")
    with Loopback(in_turn(good_reply(dialect, "{}"))) as server:
        raised, _ = ask(dialect, services, server.url)
    assert f"{'ANTHROPIC' if dialect == 'claude' else 'OPENAI'}_API_KEY is not set" in str(raised)
    assert server.asked == []
