"""What a language model is told and what is made of its answer, with a dialect that answers from a script."""

import dataclasses
import json
import re

import numpy as np
import pytest

from tests.json_schemas import faults
from wm.geometry.plan.layout_json import WALL
from wm.geometry.plan.layout_schema import OPENING_SIZES, STANDING, layout_schema
from wm.models.language.conversation import plan_conversation, things_conversation
from wm.models.language.speaking_model import SpeakingModel
from wm.models.language.spoken_text import spoken_text
from wm.models.language.thing_names import MOST_THINGS, ThingNamesError, thing_names
from wm.models.prompt_files import Prompts
from wm.services.faults import RefusedError
from wm.services.records import ServiceAnswer
from wm.services.services import Services
from wm.services.store import AnswerStore
from wm.synth.proposing import propose_plan

FAMILIES = ("language/claude", "language/openai_compatible")


def example_plan() -> str:
    """The plan in the prompt of open models."""
    return re.search(r"^\{$.*?^\}$", Prompts(FAMILIES[1]).write("plan_system"), re.DOTALL | re.MULTILINE)[0]


class Scripted:
    """A dialect that answers in turn, the last answer for ever."""

    deciding = {"effort": "low"}  # noqa: RUF012 - nobody changes it

    def __init__(self, *texts):
        self.texts, self.told = texts, []

    def send(self, conversation, *, seed):
        self.told.append(conversation)
        text = self.texts[min(len(self.told), len(self.texts)) - 1]
        return ServiceAnswer(files={"text.txt": text.encode()}, finish_reason="stop") if text else ServiceAnswer(refusal="no")

    def text(self, answer):
        return answer.files["text.txt"].decode()

    def close(self):
        pass


def model(dialect, folder=None, prompts=None, sees=True):
    store = None if folder is None else AnswerStore(folder)
    made = SpeakingModel("here", "some-model", dialect, Prompts(FAMILIES[0], prompts), paid=True, sees=sees, at_once=3)
    return made.with_services(Services(store=store))


def propose(speaker, **changes):
    asked = {"theme": "a mill", "rooms": ["hall"], "seed": 0, "violations": [], "previous": None} | changes
    return speaker.propose(asked.pop("theme"), asked.pop("rooms"), **asked)


@pytest.mark.parametrize("family", FAMILIES)
def test_a_plan_is_asked_for_by_theme_rooms_and_the_rules_of_the_reader(family):
    asked = plan_conversation(Prompts(family), "a mill by the <sea>", ["hall", "attic", "attic"], [], None)
    assert "a mill by the <sea>" in asked.turns[0].text and asked.turns[0].text.count("- attic\n") == 2
    (door_width, door_height), (window, _) = OPENING_SIZES["door"], OPENING_SIZES["window"]
    for said in (
        f"at least {door_width:g} m wide and {door_height:g} m high",
        f"at least {window:g} m wide and high",
        f"between {WALL[0]:g} and {WALL[1]:g}, usually",
        f"between {STANDING[0]:g} and {STANDING[1]:g}, usually",
    ):
        assert said in asked.system
    assert asked.schema == layout_schema()


def test_a_correction_is_a_conversation_with_the_last_plan_and_its_violations():
    asked = plan_conversation(Prompts(FAMILIES[0]), "a mill", ["hall"], ["room hall: x: y"], '{"rooms": []}')
    assert [turn.role for turn in asked.turns] == ["user", "assistant", "user"]
    assert asked.turns[1].text == '{"rooms": []}' and "- room hall: x: y" in asked.turns[2].text
    assert asked.turns[0] == plan_conversation(Prompts(FAMILIES[0]), "a mill", ["hall"], [], None).turns[0]


def test_the_example_in_the_prompt_is_a_valid_plan():
    assert faults(layout_schema(), json.loads(example_plan())) == []
    assert propose_plan(model(Scripted(example_plan())), "a", ["hall", "study"], seed=0, max_iterations=1).iterations == 1


def test_an_answer_is_paid_once_and_told_by_everything_that_decides_it(tmp_path):
    (tmp_path / "mine").mkdir()
    (tmp_path / "mine" / "plan.md").write_text("Draw {{ theme }} with {{ rooms | join }}.")
    dialect = Scripted("{}")
    speaker = model(dialect, tmp_path / "answers")
    for _ in range(2):
        result = propose(speaker)
    assert len(dialect.told) == 1
    assert result.text == "{}" and result.record["model"] == "some-model" and result.record["finish_reason"] == "stop"
    for number, change in enumerate(({"seed": 1}, {"theme": "b"}, {"previous": "{}", "violations": ["v"]}), start=2):
        propose(speaker, **change)
        assert len(dialect.told) == number
    propose(model(dialect, tmp_path / "answers", prompts=str(tmp_path / "mine")))
    assert len(dialect.told) == 5 and dialect.told[-1].turns[0].text == "Draw a mill with hall."
    other = dataclasses.replace(speaker, model="other")
    propose(other)
    assert len(dialect.told) == 6


def test_a_refusal_costs_a_round_and_the_next_one_is_another_request(tmp_path):
    dialect = Scripted("", example_plan())
    proposal = propose_plan(model(dialect, tmp_path), "a", ["hall", "study"], seed=5, max_iterations=3)
    assert proposal.iterations == 2 and "answer: some-model: no" in proposal.transcript[0].violations[0]


def test_names_are_asked_with_the_image_where_the_model_sees():
    rgb = np.linspace(0, 1, 24, dtype=np.float32).reshape(2, 4, 3)
    asked = things_conversation(Prompts(FAMILIES[0]), "a mill", "hall", rgb)
    assert asked.image is not None and asked.image.dtype == np.uint8 and asked.image.max() == 255
    assert "picture shows" in asked.turns[0].text and str(MOST_THINGS) in asked.system
    for sees in (True, False):
        dialect = Scripted('{"things": ["Arm_chair", "arm chair", "rug"]}')
        assert model(dialect, sees=sees).name_things("a mill", "hall", rgb, seed=0) == ["arm chair", "rug"]
        assert (dialect.told[0].image is not None) == sees == ("picture shows" in dialect.told[0].turns[0].text)


def test_an_answer_without_names_is_a_refusal():
    with pytest.raises(RefusedError, match="no list of names"):
        model(Scripted("A chair, I think.")).name_things("a mill", "hall", None, seed=0)


@pytest.mark.parametrize(
    "text, names",
    [
        ('{"things": ["sofa"]}', ["sofa"]),
        ('Here:\n```json\n["sofa", "Floor  Lamp", "sofa"]\n```', ["sofa", "floor lamp"]),
        ('[not JSON] then {"things": ["bed"]}', ["bed"]),
        (json.dumps({"things": [f"thing {k}" for k in range(99)]}), [f"thing {k}" for k in range(MOST_THINGS)]),
        (json.dumps({"things": ["x" * 41, "a b c d e f", "", " ", "\x00", "- rug", 5, None, "mug"]}), ["mug"]),
        ('{"things": []}', []),
    ],
)
def test_names_are_short_and_there_once(text, names):
    assert thing_names(text) == names


@pytest.mark.parametrize("text", ["", "no", '{"other": 1}', "[" * 50])
def test_an_answer_without_a_list_of_names_is_told(text):
    with pytest.raises(ThingNamesError):
        thing_names(text)


@pytest.mark.parametrize(
    "text, spoken",
    [
        (' {"a": 1}\n', '{"a": 1}'),
        ('<think>{"rooms": []} no</think>\n{"a": 1}', '{"a": 1}'),
        ('{"rooms": []} no</thinking>{"a": 1}', '{"a": 1}'),
        ('<|channel|>analysis<|message|>{"x"}<|end|><|start|>assistant<|channel|>final<|message|>{"a": 1}<|return|>', '{"a": 1}'),
    ],
)
def test_reasoning_before_an_answer_is_left_out(text, spoken):
    assert spoken_text(text) == spoken
