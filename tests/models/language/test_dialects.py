"""What the two SDKs put on the wire, and a plan proposed through them, by loopback servers."""

import json

import numpy as np
import pytest

from tests.geometry.plans import two_rooms
from tests.models.language.wire import backend, good_reply, openai_reply
from tests.models.loopback import Loopback, in_turn
from wm.errors import InputError
from wm.geometry import plan_to_json
from wm.geometry.plan.layout_schema import layout_schema
from wm.models.language import openai_compatible
from wm.synth.proposing import propose_plan

pytest.importorskip("anthropic")
pytest.importorskip("openai")

DIALECTS = ("claude", "openai")
STRICT = {"name": "floor_plan", "strict": True, "schema": layout_schema()}
RGB = np.zeros((2, 3, 3), np.float32)


@pytest.fixture(autouse=True)
def keys(monkeypatch):
    monkeypatch.setenv("ANTHROPIC_API_KEY", "a-key")
    monkeypatch.setenv("OPENAI_API_KEY", "a-key")


def closed() -> str:
    """A plan whose rooms cannot be reached."""
    document = json.loads(plan_to_json(two_rooms()))
    for room in document["rooms"]:
        room["openings"] = []
    return json.dumps(document)


def asked_for(dialect, **settings):
    """The body of a request for a plan."""
    with Loopback(in_turn(good_reply(dialect, "{}"))) as server:
        model = backend(dialect, server.url, **settings)
        model.propose("a mill", ["hall"], seed=7, violations=[], previous=None)
        model.close()
    return server.asked[0].json


@pytest.mark.parametrize("dialect", DIALECTS)
@pytest.mark.parametrize("before, behind", [("", ""), ("Sure!\n```json\n", "\n```\nEnjoy."), ("<think>no</think>", "")])
def test_a_plan_is_corrected_until_it_is_valid(dialect, before, behind):
    good = before + plan_to_json(two_rooms()) + behind
    with Loopback(in_turn(good_reply(dialect, closed()), good_reply(dialect, good))) as server:
        model = backend(dialect, server.url)
        proposal = propose_plan(model, "a mill", ["hall", "study"], seed=0, max_iterations=3)
        model.close()
    assert proposal.iterations == 2 and len(proposal.plan.rooms) == 2
    turns = [turn for turn in server.asked[1].json["messages"] if turn["role"] != "system"]
    assert [turn["role"] for turn in turns] == ["user", "assistant", "user"]
    assert json.dumps(closed())[1:-1] in json.dumps(turns[1]) and "unreachable" in json.dumps(turns[2])
    assert proposal.transcript[1].record["usage"] == {"requests": 1.0, "input_tokens": 100.0, "output_tokens": 50.0}


@pytest.mark.parametrize("dialect", DIALECTS)
def test_a_seeing_model_gets_the_image_as_a_png(dialect):
    with Loopback(in_turn(good_reply(dialect, '{"things": ["sofa"]}'))) as server:
        model = backend(dialect, server.url)
        assert model.name_things("a mill", "hall", RGB, seed=0) == ["sofa"]
        model.close()
    (picture, text) = next(turn for turn in server.asked[0].json["messages"] if turn["role"] == "user")["content"]
    assert "iVBOR" in json.dumps(picture) and text["type"] == "text"


def test_claude_is_asked_with_a_schema_and_streamed():
    body = asked_for("claude", effort="low", max_tokens=4000)
    assert body["stream"] is True and body["max_tokens"] == 4000 and "thinking" not in body and "temperature" not in body
    assert body["output_config"]["effort"] == "low"
    schema = body["output_config"]["format"]["schema"]
    assert schema["additionalProperties"] is False and set(schema["properties"]) == {"metadata", "rooms"}
    assert "minimum" not in schema["properties"]["metadata"]["properties"]["wall_thickness"]  # the service takes no ranges
    assert "output_config" not in asked_for("claude", constrained=False)
    assert asked_for("claude", thinking="disabled")["thinking"] == {"type": "disabled"}


@pytest.mark.parametrize(
    "constraint, field",
    [
        ("none", {}),
        ("json_object", {"response_format": {"type": "json_object"}}),
        ("json_schema", {"response_format": {"type": "json_schema", "json_schema": STRICT}}),
        ("structured_outputs", {"structured_outputs": {"json": layout_schema()}}),
        ("guided_json", {"guided_json": layout_schema()}),
    ],
)
def test_servers_are_told_of_the_schema_in_their_own_words(constraint, field):
    body = asked_for("openai", constraint=constraint)
    assert {name: body[name] for name in body if name not in ("model", "messages")} == field


def test_what_is_set_is_sent():
    body = asked_for("openai", effort="low", temperature=0.5, seeded=True, max_tokens=500, max_tokens_field="max_tokens")
    wanted = {"reasoning_effort": "low", "temperature": 0.5, "seed": 7, "max_tokens": 500}
    assert {name: body.get(name) for name in wanted} == wanted


def test_a_server_without_keys_gets_none_and_is_not_paid(monkeypatch):
    monkeypatch.delenv("OPENAI_API_KEY")
    with Loopback(in_turn(openai_reply("{}"))) as server:
        model = backend("openai", server.url, key="", paid=False)
        model.propose("a mill", ["hall"], seed=0, violations=[], previous=None)
        model.close()
        model.close()
    assert server.asked[0].headers["authorization"] == "Bearer none"
    assert model.services.ledger.spent().requests == 0 and model.quote().usd == 0


def test_a_key_in_place_of_its_name_is_refused_and_not_shown():
    with pytest.raises(InputError, match="name of an environment variable") as caught:
        openai_compatible.make(openai_compatible.Settings(key="sk-proj-1234"))
    assert "1234" not in str(caught.value)
