"""Floor plan JSON: round trips, what is accepted, and that everything wrong is named at once."""

import dataclasses
import json

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.geometry.plans import (
    checked,
    l_shaped,
    one_room,
    opening,
    random_plan,
    rectangle,
    two_rooms,
    window,
)
from wm.geometry import FloorPlan, PlanError, PlanWarning, Room, build_structure, load_plan, parse_plan, plan_to_json
from wm.geometry.placement.navigation import walkable_floor
from wm.geometry.plan.rules import RULES

# In the layout of the published files: doors listed by one room or by both, doors without a sill, integers as coordinates.
PUBLISHED = """{
  "metadata": {"units": "meters", "coordinate_system": "z_up", "wall_thickness": 0.15, "default_ceiling_height": 2.8},
  "rooms": [
    {"id": "foyer", "name": "Foyer", "floor_polygon": [[0, 0], [6, 0], [6, 4], [0, 4]], "ceiling_height": 2.8,
     "openings": [
       {"type": "door", "wall_segment": [[6, 0], [6, 4]], "position": 1.55, "width": 0.9, "height": 2.1},
       {"type": "window", "wall_segment": [[0, 0], [6, 0]], "position": 2.25, "width": 1.5, "height": 1.2, "sill_height": 0.9}]},
    {"id": "parlour", "name": "Parlour", "floor_polygon": [[6, 0], [10, 0], [10, 4], [6, 4]], "ceiling_height": 2.8,
     "openings": [{"type": "door", "wall_segment": [[6, 4], [6, 0]], "position": 1.55, "width": 0.9, "height": 2.1}]}
  ],
  "objects": []
}"""


def rules_of(plan: FloorPlan) -> list[tuple[str | None, str]]:
    with pytest.raises(PlanError) as caught:
        parse_plan(plan_to_json(plan), unreachable="refuse")
    return [(violation.room, violation.rule) for violation in caught.value.violations]


def text_rules(text: str) -> list[tuple[str | None, str]]:
    with pytest.raises(PlanError) as caught:
        parse_plan(text)
    assert all(str(violation) in str(caught.value) for violation in caught.value.violations)
    assert {violation.rule for violation in caught.value.violations} <= set(RULES)
    return [(violation.room, violation.rule) for violation in caught.value.violations]


def test_the_published_layout_loads():
    plan = parse_plan(PUBLISHED)
    assert [room.id for room in plan.rooms] == ["foyer", "parlour"]
    assert plan.wall_thickness == 0.15
    assert plan.rooms[0].openings[0].sill_height == 0.0
    np.testing.assert_array_equal(plan.rooms[1].polygon, [[6, 0], [10, 0], [10, 4], [6, 4]])


def test_a_plan_file_loads(tmp_path):
    file = tmp_path / "plan.json"
    file.write_bytes(b"\xef\xbb\xbf" + PUBLISHED.encode())
    assert plan_to_json(load_plan(file)) == plan_to_json(parse_plan(PUBLISHED))


@given(st.integers(0, 2**32 - 1), st.integers(1, 20))
def test_json_round_trip(seed, rooms):
    text = plan_to_json(random_plan(seed, rooms))
    assert plan_to_json(parse_plan(text)) == text


@pytest.mark.parametrize("null", ["", ', "name": null, "ceiling_height": null, "metadata": null', ', "openings": null'])
def test_fields_with_defaults_may_be_missing_or_null(null):
    in_room, in_plan = null.replace(', "metadata": null', ""), ', "metadata": null' if "metadata" in null else ""
    window = '{"type": "window", "wall_segment": [[0, 0], [4, 0]], "position": 1, "width": 1, "height": 1, "sill_height": null}'
    openings = "" if "openings" in null else f', "openings": [{window}]'
    polygon = '"floor_polygon": [[0, 0], [4, 0], [4, 4], [0, 4]]'
    plan = parse_plan(f'{{"rooms": [{{"id": "a", {polygon}{in_room}{openings}}}]{in_plan}}}')
    if "openings" in null:
        assert plan.rooms[0].openings == ()
        return
    assert (plan.rooms[0].name, plan.rooms[0].ceiling_height, plan.rooms[0].openings[0].sill_height) == ("a", 2.8, 0.9)


def test_clockwise_and_closed_polygons_mean_the_same():
    plan = l_shaped()
    turned = FloorPlan(
        tuple(dataclasses.replace(room, polygon=np.concatenate([room.polygon, room.polygon[:1]])[::-1]) for room in plan.rooms)
    )
    mesh, other = build_structure(checked(plan)), build_structure(checked(turned))
    np.testing.assert_array_equal(mesh.vertices, other.vertices)
    np.testing.assert_array_equal(mesh.faces, other.faces)


def test_points_in_the_middle_of_a_wall_change_nothing():
    plan = two_rooms()
    ring = np.array([[0, 0], [2, 0], [5, 0], [5, 1], [5, 2.5], [5, 4], [3, 4], [0, 4]], float)
    split = FloorPlan((dataclasses.replace(plan.rooms[0], polygon=ring), plan.rooms[1]))
    mesh, other = build_structure(checked(plan)), build_structure(checked(split))
    np.testing.assert_array_equal(mesh.vertices, other.vertices)
    np.testing.assert_array_equal(mesh.faces, other.faces)


@pytest.mark.parametrize("plan", [one_room(), two_rooms(), l_shaped()])
def test_accepted(plan):
    assert len(checked(plan).rooms) == len(plan.rooms)


def test_rooms_a_centimetre_apart_still_touch():
    plan = two_rooms()
    moved = dataclasses.replace(plan.rooms[1], polygon=plan.rooms[1].polygon + np.array([0.009, 0]), openings=())
    with pytest.warns(PlanWarning, match=r"room study: corners moved by up to 9\.0 mm"):
        joined = checked(FloorPlan((plan.rooms[0], moved)))
    assert joined.rooms[1].polygon[:, 0].min() == 5.0 and build_structure(joined).to_trimesh().is_watertight


A = rectangle("a", 0, 0, 4, 4, opening("door", (4, 0), (4, 4), 1.5))
B = rectangle("b", 4, 0, 8, 4)


@pytest.mark.parametrize(
    ("rooms", "expected"),
    [
        ((A, dataclasses.replace(B, id="A")), [("A", "duplicate_id")]),
        ((A, B, rectangle("c", 20, 0, 24, 4)), [("c", "unreachable")]),
        # What a fault may be the cause of is no fault of its own: the door of a is off its wall, c has none.
        (
            (rectangle("a", 0, 0, 4, 4, opening("door", (4, 0), (4, 4), 0)), B, rectangle("c", 8, 0, 12, 4)),
            [("a", "opening_off_wall"), ("c", "unreachable")],
        ),
        ((A, B, rectangle("c", 3, 3, 5, 8)), [("a", "rooms_overlap"), ("b", "rooms_overlap")]),
        ((A, B, rectangle("c", 0, 4, 0.15, 8, window((0, 4), (0, 8), 1))), [("c", "room_too_small")]),
        ((A, B, rectangle("c", 0, 4, 0.4, 8, window((0, 4), (0, 8), 1))), [("c", "room_too_small"), ("c", "unreachable")]),
        ((Room("a", "a", np.array([[0, 0], [4, 4], [4, 0], [0, 4.0]]), 2.8, ()),), [("a", "self_intersection")]),
        ((Room("a", "a", np.array([[0, 0], [4, 0], [2, 0.0]]), 2.8, ()),), [("a", "zero_area")]),
        (
            (rectangle("a", 0, 0, 4, 4, opening("door", (4, 0), (4, 4), 1)), rectangle("b", 4.1, 0, 8, 4)),
            [("a", "door_exterior")],
        ),
        ((rectangle("a", 0, 0, 4, 4, window((0, 1), (4, 1), 1)),), [("a", "opening_off_wall")]),
        ((rectangle("a", 0, 0, 4, 4, window((0, 0), (4, 0), 2.8)),), [("a", "opening_off_wall")]),
        ((rectangle("a", 0, 0, 4, 4, window((0, 0), (4, 0), 0.1)),), [("a", "opening_off_wall")]),
        ((rectangle("a", 0, 0, 4, 4, window((0, 0), (4, 0), 1), height=2.0),), [("a", "opening_off_wall")]),
        ((rectangle("a", 0, 0, 4, 4, window((0, 0), (4, 0), 1), window((4, 0), (0, 0), 1)),), [("a", "openings_overlap")]),
        (
            (rectangle("a", 0, 0, 4, 8, window((4, 0), (4, 8), 3.5, 1.0)), B, rectangle("c", 4, 4, 8, 8)),
            [("a", "window_interior"), ("b", "unreachable"), ("c", "unreachable")],
        ),
        ((A, dataclasses.replace(B, openings=(opening("door", (4, 0), (4, 4), 2.0),))), [("b", "openings_overlap")]),
        ((A, dataclasses.replace(B, openings=(opening("passage", (4, 0), (4, 4), 1.5),))), [("b", "openings_overlap")]),
        ((A, dataclasses.replace(B, ceiling_height=2.0)), [("a", "opening_off_wall")]),
        (
            (rectangle("a", 0, 0, 4, 4, window((4, 0), (4, 4), 1)), rectangle("b", 4.1, 0, 8, 4)),
            [("a", "window_interior"), ("b", "unreachable")],
        ),
        # A door must lead into one room, not along two.
        (
            (rectangle("a", 0, 0, 4, 8, opening("door", (4, 0), (4, 8), 3.5)), B, rectangle("c", 4, 4, 8, 8)),
            [("a", "door_exterior")],
        ),
    ],
)
def test_each_rule_is_named_with_its_room(rooms, expected):
    assert rules_of(FloorPlan(rooms)) == expected


def test_every_violation_is_named_at_once():
    rooms = (
        rectangle("a", 0, 0, 4, 4, opening("passage", (0, 0), (4, 0), 1), window((0, 0), (9, 0), 7)),
        rectangle("a", 4, 0, 8, 4),
        rectangle("c", 7, 0, 12, 4, window((7, 4), (7, 0), 1)),
        Room("d", "d", np.array([[20, 0], [24, 4], [24, 0], [20, 4.0]]), 2.8, ()),
    )
    text = plan_to_json(FloorPlan(rooms)).replace('"ceiling_height": 2.8', '"ceiling_height": "high"', 1)
    found = text_rules(text)
    assert set(found) == {
        ("a", "type"),
        ("a", "duplicate_id"),
        ("d", "self_intersection"),
        ("a", "rooms_overlap"),
        ("a", "door_exterior"),
        ("a", "opening_off_wall"),
        ("c", "window_interior"),
    }


def test_doors_to_a_broken_room_are_not_blamed():
    bow = Room("b", "b", np.array([[4, 0], [8, 4], [8, 0], [4, 4.0]]), 2.8, ())
    assert rules_of(FloorPlan((A, bow))) == [("b", "self_intersection")]


SQUARE = '"floor_polygon": [[0, 0], [4, 0], [4, 4], [0, 4]]'


def square_with(fields: str, metadata: str = "{}") -> str:
    """Plan text with one square room that has these fields."""
    return f'{{"metadata": {metadata}, "rooms": [{{{fields}, {SQUARE}}}]}}'


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("", [(None, "json")]),
        (PUBLISHED[:400], [(None, "json")]),
        ("[" * 1_000_000, [(None, "json")]),
        ('{"a":' * 100_000, [(None, "json")]),
        ('{"rooms": [{"id": "a", "id": "b"}]}', [(None, "json")]),
        ('{"rooms": NaN}', [(None, "json")]),
        ('{"rooms": -Infinity}', [(None, "json")]),
        ("[" + "1" * 10_000 + "]", [(None, "json")]),
        (" " * (8 * 2**20 + 1), [(None, "json")]),
        ("null", [(None, "type")]),
        ("{}", [(None, "type")]),
        ('{"rooms": []}', [(None, "no_rooms")]),
        ('{"rooms": [' + ",".join(["{}"] * 100_000) + "]}", [(None, "too_many")]),
        ('{"rooms": [7]}', [("rooms[0]", "type")]),
        ('{"rooms": [{"id": "a"}]}', [("a", "type")]),
        (square_with('"id": 1, "name": "x"'), [("rooms[0]", "room_id")]),
        (square_with('"id": "../../etc", "name": "x"'), [("rooms[0]", "room_id")]),
        (square_with('"id": "a", "name": "\\ud800"'), [("a", "type")]),
        ('{"rooms": [{"id": "a", "floor_polygon": [[0, 0], [1e999, 0], [4, 4]]}]}', [("a", "number")]),
        ('{"rooms": [{"id": "a", "floor_polygon": [[0, 0], [1e9, 0], [1e9, 1e9]]}]}', [("a", "number")]),
        ('{"rooms": [{"id": "a", "floor_polygon": [[0, 0], [1, true], [4, 4]]}]}', [("a", "type")]),
        (square_with('"id": "a", "ceiling_height": 1e9'), [("a", "number")]),
        (square_with('"id": "a", "ceiling_height": "3"'), [("a", "type")]),
        (square_with('"id": "a", "openings": {}'), [("a", "type")]),
        (square_with('"id": "a", "openings": [{"type": ["door"]}, 3]'), [("a", "opening_type"), ("a", "type")]),
        (
            square_with('"id": "a"', '{"units": "parsecs", "wall_thickness": 9}'),
            [(None, "units"), (None, "number")],
        ),
    ],
)
def test_hostile_text_is_one_error(text, expected):
    assert text_rules(text) == expected


def test_a_heap_of_identical_rooms_is_refused_before_all_pairs_are_met():
    room = '{"id": "r%d", ' + SQUARE + "}"
    found = text_rules('{"rooms": [' + ",".join(room % k for k in range(2048)) + "]}")
    assert {rule for _, rule in found} == {"rooms_overlap"} and len(found) == 256


def test_unreadable_files_are_one_error(tmp_path):
    (tmp_path / "latin.json").write_bytes(PUBLISHED.replace("Foyer", "Foyé").encode("latin-1"))
    (tmp_path / "huge.json").write_bytes(b" " * (8 * 2**20 + 1))
    for name in ("missing.json", ".", "latin.json", "huge.json", "nul\0.json"):
        with pytest.raises(PlanError, match="file") as caught:
            load_plan(tmp_path / name)
        assert len(caught.value.violations) == 1


def test_messages_stay_short():
    with pytest.raises(PlanError) as caught:
        parse_plan(json.dumps({"rooms": [{"id": "x" * 100_000, "name": ["y"] * 100_000, "floor_polygon": "z" * 100_000}]}))
    assert len(str(caught.value)) < 1000


def test_metres_that_are_called_feet_are_one_violation():
    with pytest.raises(PlanError) as caught:
        parse_plan(PUBLISHED.replace('"meters"', '"feet"'))
    (violation,) = caught.value.violations
    assert (violation.rule, violation.room) == ("units", None)
    assert "metadata.wall_thickness is 0.15 (0.04572 m)" in violation.message and "say 'meters'" in violation.message
    with pytest.raises(PlanError) as caught:  # in metres the door would be out of range as well
        parse_plan(PUBLISHED.replace('"meters"', '"feet"').replace('"width": 0.9', '"width": 0.05'))
    assert {violation.rule for violation in caught.value.violations} == {"number"}


def test_a_plan_in_feet_is_the_plan_in_metres():
    document = json.loads(plan_to_json(two_rooms()))
    document["metadata"]["units"] = "feet"
    per_foot = {"wall_thickness", "default_ceiling_height", "ceiling_height", "position", "width", "height", "sill_height"}

    def in_feet(value, key=""):
        if isinstance(value, dict):
            return {name: in_feet(part, name) for name, part in value.items()}
        if isinstance(value, list):
            return [in_feet(part, key) for part in value]
        return value / 0.3048 if key in per_foot | {"floor_polygon", "wall_segment"} else value

    plan = parse_plan(json.dumps(in_feet(document)))
    np.testing.assert_allclose(build_structure(plan).vertices, build_structure(two_rooms()).vertices, atol=1e-9)


@pytest.mark.parametrize(
    ("change", "says"),
    [
        (lambda plan: plan.update(stairs=[]), "'stairs'"),
        (lambda plan: plan["rooms"][0].update(ceilling_height=4.0), "'ceilling_height' (is 'ceiling_height' meant?)"),
        (lambda plan: plan["metadata"].update(author="me"), "'author'"),
        (lambda plan: plan["rooms"][0]["openings"][0].update(swing="left"), "room hall, openings[0], says 'swing'"),
    ],
)
def test_a_key_that_is_not_read_is_named(change, says):
    document = json.loads(plan_to_json(two_rooms()))
    change(document)
    with pytest.warns(PlanWarning) as caught:
        parse_plan(json.dumps(document))
    assert len(caught) == 1 and says in str(caught[0].message)


@pytest.mark.parametrize(("word", "kind"), [("opening", "passage"), ("Archway", "passage"), ("double door", "door")])
def test_openings_have_other_names(word, kind):
    document = json.loads(plan_to_json(two_rooms()))
    document["rooms"][0]["openings"][0]["type"] = word
    assert parse_plan(json.dumps(document)).rooms[0].openings[0].kind == kind


def test_an_entrance_is_closed_and_no_way():
    entrance = opening("door", (0, 0), (5, 0), 0.5)
    plan = two_rooms()
    hall = dataclasses.replace(plan.rooms[0], openings=(*plan.rooms[0].openings, entrance))
    with_entrance = checked(FloorPlan((hall, plan.rooms[1])))
    mesh, bare = build_structure(with_entrance), build_structure(plan)
    solid, whole = mesh.to_trimesh(), bare.to_trimesh()
    assert solid.is_watertight
    # The recesses on both sides of a leaf a quarter of the wall thick, less the opening's inset edges.
    assert whole.volume - solid.volume == pytest.approx(0.9 * 2.1 * (0.15 - 0.15 / 4), rel=1e-6)
    assert walkable_floor(with_entrance).area == pytest.approx(walkable_floor(plan).area)


@pytest.mark.parametrize(
    ("rooms", "says"),
    [
        ((A, rectangle("b", 4, 0, 8, 4), rectangle("up", 0, 0, 4, 4)), "a plan has one storey"),
        ((A, B, rectangle("wc", 5, 1, 7, 3)), "cut wc out of b, as one of its holes (plan.repair=true does)"),
        ((A, rectangle("b", 3.8, 0, 8, 4)), "move the wall between them"),
        ((A, B, rectangle("c", 20, 0, 24, 4)), "put one on a wall that it shares"),
        ((rectangle("a", 0, 0, 4, 4, opening("door", (4, 0), (4, 4), 0.1)), B), "from 0.15 to 3.85 m of its wall_segment"),
        ((rectangle("a", 0, 0, 4, 4, opening("door", (4, 4), (4, 0), 3.0)), B), "from 0.15 to 3.85 m of its wall_segment"),
        ((rectangle("a", 0, 0, 4, 4, opening("door", (4, 0), (4, 4), 1, width=0.4)), B), "no doors or passages lead to it"),
        ((rectangle("a", 0, 0, 4, 4, opening("door", (4, 0), (4, 4), 0.1)), B), "plan.repair=true moves or narrows it"),
        (
            (rectangle("a", 0, 0, 4, 4, opening("door", (4, 0), (4, 4), 1)), rectangle("b", 4.1, 0, 8, 4)),
            "closes the gap of 0.1 m",
        ),
    ],
)
def test_a_refusal_says_what_would_be_right(rooms, says):
    with pytest.raises(PlanError) as caught:
        parse_plan(plan_to_json(FloorPlan(rooms)), unreachable="refuse")
    assert says in str(caught.value)
