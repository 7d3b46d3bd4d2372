"""Answers of language models: the plan in them is read, and what is wrong with others is said to the model."""

import json

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.geometry.plans import two_rooms
from wm.geometry import PlanError, plan_to_json
from wm.geometry.plan.loading import read_plan
from wm.synth.plan_text import plan_document

TEXT = plan_to_json(two_rooms())
PLAN = json.loads(TEXT)


def points_as_objects(value, key=""):
    if isinstance(value, dict):
        return {name: points_as_objects(part, name) for name, part in value.items()}
    if isinstance(value, list) and key in ("floor_polygon", "wall_segment"):
        return [{"x": x, "y": y} for x, y in value]
    return [points_as_objects(part) for part in value] if isinstance(value, list) else value


def numbers_as_text(value, unit=""):
    if isinstance(value, dict):
        return {name: numbers_as_text(part, unit) for name, part in value.items()}
    if isinstance(value, list):
        return [numbers_as_text(part, unit) for part in value]
    return f"{value!r}{unit}" if isinstance(value, float) else value


@pytest.mark.parametrize(
    "answer",
    [
        TEXT,
        f"```json\n{TEXT}```",
        f"```\n{TEXT}\n```\nLet me know if you want changes!",
        f"Here's the plan {{two rooms, as asked}}:\n\n{TEXT}\n\nThe hall [5 x 4 m] leads to the study.",
        f"<think>Room sizes: [5, 4]. It's tight.</think>{TEXT}",
        repr(PLAN),
        TEXT.replace("}", ",}").replace("]", ", ]"),
        TEXT.replace('"rooms": [', '// the rooms\n"rooms": [ /* two */').replace('"objects"', '# none\n "objects"'),
        TEXT.replace('"objects": []', '"objects": None'),
        TEXT.replace('"rooms"', "rooms").replace('"id"', "id"),
        json.dumps(numbers_as_text(PLAN)),
        json.dumps(numbers_as_text(PLAN, " m")),
        json.dumps(points_as_objects(PLAN)),
        json.dumps({"floor_plan": PLAN}),
        json.dumps(PLAN["rooms"]),
        TEXT.replace(" 5.0", " +5.").replace(" 0.9", " .9"),
    ],
)
def test_the_plan_in_an_answer_is_read(answer):
    plan = read_plan(plan_document(answer), "proposal").plan
    assert [room.id for room in plan.rooms] == ["hall", "study"]
    for room, expected in zip(plan.rooms, two_rooms().rooms, strict=True):
        assert room.polygon.tolist() == expected.polygon.tolist()
        for hole, wanted in zip(room.openings, expected.openings, strict=True):
            assert (hole.kind, hole.position, hole.width) == (wanted.kind, wanted.position, wanted.width)


def test_a_single_quote_within_a_name_stays():
    document = plan_document("{'rooms': [{'id': 'a', 'name': 'children\\'s \"den\"'}, {'id': 'b', 'name': \"it's\"}]}")
    assert [room["name"] for room in document["rooms"]] == ['children\'s "den"', "it's"]


@pytest.mark.parametrize(
    ("answer", "says"),
    [
        ("", "no JSON object"),
        ("I cannot draw floor plans.", "no JSON object"),
        (TEXT[:400], "breaks off"),
        (f"```json\n{TEXT[:400]}\n```", "breaks off"),
        (TEXT.replace('"position": 1.5', '"position" 1.5'), "not JSON"),
        (TEXT.replace('"id": "hall"', '"id": "hall", "id": "b"'), "appears twice"),
    ],
)
def test_what_is_wrong_is_said_to_the_model(answer, says):
    with pytest.raises(PlanError, match=says) as caught:
        plan_document(answer)
    assert [violation.rule for violation in caught.value.violations] == ["json"]


@given(st.text(alphabet="{}[]\",:'/*#ab1. \n\\", max_size=200))
def test_any_text_is_a_document_or_one_error(text):
    try:
        plan_document(text)
    except PlanError as error:
        assert len(error.violations) == 1
