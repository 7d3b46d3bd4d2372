"""The schema of floor plans against the reader that it is for."""

import json

import pytest
from hypothesis import HealthCheck, given, settings

from tests.geometry.plans import l_shaped, one_room, random_plan, two_rooms
from tests.json_schemas import conforming, faults
from wm.geometry import plan_to_json
from wm.geometry.plan.layout_json import Reader, decode
from wm.geometry.plan.layout_schema import layout_schema


@given(conforming(layout_schema()))
@settings(max_examples=50, suppress_health_check=[HealthCheck.too_slow], deadline=None)
def test_whatever_conforms_is_read_without_a_fault_in_any_single_value(document):
    reader = Reader()
    plan = reader.plan(decode(json.dumps(document), "test"))
    assert not [violation for violation in reader.violations if violation.rule != "opening_off_wall"]  # a segment without length
    assert reader.notes == []
    assert plan is not None and len(plan.rooms) == len(document["rooms"])


@pytest.mark.parametrize("plan", [one_room(), two_rooms(), l_shaped(), random_plan(1, 9)], ids=["one", "two", "l", "random"])
def test_plans_as_we_write_them_conform(plan):
    document = json.loads(plan_to_json(plan))
    assert document.pop("objects") == []
    assert faults(layout_schema(), document) == []


@pytest.mark.parametrize(
    "path, value",
    [
        (("metadata", "wall_thickness"), 2),
        (("metadata", "units"), "feet"),
        (("rooms",), []),
        (("rooms", 0, "id"), "a room"),
        (("rooms", 0, "floor_polygon"), [[0, 0], [1, 1]]),
        (("rooms", 0, "ceiling_height"), 1.2),
        (("rooms", 0, "openings", 0, "width"), 0.3),
        (("rooms", 0, "openings", 0, "sill_height"), 0.4),
        (("rooms", 0, "openings", 0, "type"), "hatch"),
        (("rooms", 0, "openings", 0, "wall_segment"), [[0, 0], [1, 0], [2, 0]]),
        (("rooms", 0, "openings", 0, "position"), None),
        (("rooms", 0, "furniture"), []),
    ],
)
def test_what_the_reader_refuses_does_not_conform(path, value):
    document = json.loads(plan_to_json(two_rooms()))
    del document["objects"]
    *way, last = path
    holder = document
    for step in way:
        holder = holder[step]
    holder[last] = value
    assert faults(layout_schema(), document)
