"""Furniture that a plan lists itself: read, kept through a round trip, and refused with reasons."""

import json

import pytest

from tests.geometry.plans import two_rooms
from wm.geometry import FloorPlan, PlanError, PlanWarning, load_plan, parse_plan, plan_to_json


def listing(*rows, **metadata) -> str:
    document = json.loads(plan_to_json(two_rooms()))
    return json.dumps(document | {"objects": list(rows), "metadata": document["metadata"] | metadata})


PIANO = {"label": "grand piano", "position": [2.5, 2.0], "size": [1.5, 1.6, 1.0], "yaw": 30}


def test_an_object_is_read_and_written():
    blue = {**PIANO, "position": [7, 2, 0.5], "support": "object", "color": [0, 0, 1], "room": "study"}
    plan = parse_plan(listing(PIANO, blue))
    first, second = plan.objects
    assert (first.label, first.room, first.position, first.yaw) == ("grand piano", 0, (2.5, 2.0, 0.0), 30.0)
    assert (second.room, second.position, second.support, second.color) == (1, (7.0, 2.0, 0.5), "object", (0.0, 0.0, 1.0))
    assert parse_plan(plan_to_json(plan)).objects == plan.objects


def test_a_mesh_lies_beside_the_plan(tmp_path):
    (tmp_path / "mine.json").write_text(listing({"label": "statue", "position": [1, 1], "mesh": "statue.glb"}))
    plan = load_plan(tmp_path / "mine.json")
    assert plan.objects[0].mesh == str(tmp_path / "statue.glb") and plan.objects[0].size is None


@pytest.mark.parametrize(
    ("change", "says"),
    [
        ({"position": None}, "[x, y]"),
        ({"position": [1, True]}, "[x, y]"),
        ({"position": [50, 50]}, "in no room"),
        ({"position": [0.2, 2.0]}, "reaches out of the floor_polygon of hall"),
        ({"size": [1, 1, 3]}, "from 0 to 3 m"),
        ({"size": [1, -1, 1]}, "[width, depth, height]"),
        ({"yaw": "left"}, "degrees"),
        ({"room": "study"}, "is in room hall and not in 'study'"),
        ({"support": "sky"}, "choices: floor"),
        ({"color": [255, 0, 0]}, "from 0 to 1"),
        ({"mesh": 3}, "mesh file"),
        ({"label": ""}, "armchair"),
    ],
)
def test_a_wrong_object_is_named(change, says):
    with pytest.raises(PlanError) as caught:
        parse_plan(listing(PIANO | change))
    (violation,) = caught.value.violations
    assert violation.rule == "object" and "objects[0]" in violation.message and says in violation.message


@pytest.mark.parametrize("objects", [{}, "sofa", ["sofa"]])
def test_what_is_no_list_of_objects_is_refused(objects):
    text = plan_to_json(two_rooms()).replace('"objects": []', f'"objects": {json.dumps(objects)}')
    with pytest.raises(PlanError, match="object"):
        parse_plan(text)


def test_what_cannot_be_placed_or_read_is_named():
    with pytest.warns(PlanWarning, match=r"objects\[0\] \(bed\) has neither 'size'"):
        assert parse_plan(listing({"type": "bed", "room": "hall", "position": [1, 1, 0]})).objects == ()
    with pytest.warns(PlanWarning, match="'brand'"):
        assert len(parse_plan(listing(PIANO | {"brand": "S"})).objects) == 1


def test_plans_without_objects_have_none():
    assert FloorPlan(two_rooms().rooms).objects == ()
