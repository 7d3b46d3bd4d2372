"""What real plans have beyond rooms with doors: it is built as the plan says, or told in which form."""

import dataclasses
import json

import numpy as np
import pytest

from tests.geometry.plans import opening, rectangle, two_rooms, window
from wm.geometry import FloorPlan, PlanError, PlanWarning, build_structure, interior_polygon, load_plan, parse_plan, plan_to_json
from wm.geometry.plan.connected import connected_parts, entrances
from wm.geometry.plan.loading import PlanReading, decode, read_plan
from wm.geometry.plan.openings import portals
from wm.geometry.plan.records import ThickWall

HOLE = np.array([[6.5, 1.5], [6.5, 3], [8, 3], [8, 1.5]])  # clockwise
DOOR = opening("door", (5, 0), (5, 4), 1.5)
A, B = rectangle("a", 0, 0, 5, 4, DOOR), rectangle("b", 5, 0, 9, 4)
WC = rectangle("wc", 6.5, 1.5, 8, 3, opening("door", (6.5, 1.5), (8, 1.5), 0.3, 0.7))


def reading(plan: FloorPlan, **options) -> PlanReading:
    return read_plan(decode(plan_to_json(plan), "plan"), "plan", **options)


def built(plan: FloorPlan) -> FloorPlan:
    """The plan as it is read, which is built watertight and read again as the same, without a word."""
    read = reading(plan)
    assert build_structure(read.plan).to_trimesh().is_watertight
    again = read_plan(decode(plan_to_json(read.plan), "plan"), "plan")
    assert plan_to_json(again.plan) == plan_to_json(read.plan)
    return read.plan


def test_a_room_in_a_room_is_a_hole_however_it_is_written():
    hole = built(FloorPlan((A, dataclasses.replace(B, holes=(HOLE,)), WC)))
    document = json.loads(plan_to_json(FloorPlan((A, B, WC))))
    for polygon in (
        [B.polygon.tolist(), HOLE.tolist()],
        [*B.polygon.tolist(), B.polygon[0].tolist(), *HOLE.tolist(), HOLE[0].tolist()],  # along a slit and back
    ):
        document["rooms"][1]["floor_polygon"] = polygon
        written = parse_plan(json.dumps(document))
        assert interior_polygon(written, 1).symmetric_difference(interior_polygon(hole, 1)).area < 1e-9
        assert connected_parts(written) == ((0, 1, 2),)


def test_a_column_stands_in_the_room_and_takes_no_more_than_itself():
    column = np.array([[2, 2], [2.3, 2], [2.3, 2.3], [2, 2.3]])
    free, with_column = (
        interior_polygon(built(FloorPlan((room, B))), 0) for room in (A, dataclasses.replace(A, columns=(column,)))
    )
    assert free.area - with_column.area == pytest.approx(0.09)
    small = read = reading(FloorPlan((dataclasses.replace(A, holes=(column[::-1],)), B)))
    assert interior_polygon(small.plan, 0).area == pytest.approx(with_column.area)
    assert "a hole of 0.09 m^2 with no room in it is a column" in read.notes[0]


def test_a_shaft_that_nothing_opens_into_is_solid():
    notched = dataclasses.replace(B, polygon=np.array([[5, 0], [9, 0], [9, 3.6], [8.6, 3.6], [8.6, 4], [5, 4.0]]))
    plan = built(FloorPlan((A, notched, rectangle("shaft", 8.6, 3.6, 9, 4))))
    assert [room.id for room in plan.rooms] == ["a", "b"] and len(plan.solids) == 1
    whole, bare = (build_structure(one).to_trimesh() for one in (plan, dataclasses.replace(plan, solids=())))
    assert whole.volume - bare.volume == pytest.approx(0.16 * (2.8 + 0.3), rel=1e-6)


@pytest.mark.parametrize("kind", ["hatch", "window", "door"])
def test_a_hole_above_the_floor_between_rooms_is_open_and_no_way(kind):
    hatch = opening(kind, (5, 0), (5, 4), 2.8, 0.9, 1.0, sill=1.0)
    plan = built(FloorPlan((dataclasses.replace(A, openings=(DOOR, hatch)), B)))
    way, hole = portals(plan)
    assert way.is_way and (hole.kind, hole.is_open, hole.is_way) == ("hatch", True, False)


def test_a_passage_to_the_outside_is_a_closed_door():
    plan = built(FloorPlan((dataclasses.replace(A, openings=(DOOR, opening("passage", (0, 0), (5, 0), 1, 1.5))), B)))
    assert [portal.wall.room for portal in entrances(plan)] == [0]


@pytest.mark.parametrize(
    ("kind", "position", "width", "wide"), [("passage", 0, 4, 3.7), ("door", 0, 4, 3.7), ("passage", 2.5, 1.5, 1.35)]
)
def test_an_opening_drawn_to_a_corner_ends_at_the_wall_beside_it(kind, position, width, wide):
    hall = rectangle("a", 0, 0, 5, 4, opening(kind, (5, 0), (5, 4), position, width))
    assert portals(built(FloorPlan((hall, B))))[0].width == pytest.approx(wide)


def test_windows_around_a_corner():
    hall = dataclasses.replace(A, openings=(DOOR, window((0, 0), (5, 0), 0), window((0, 4), (0, 0), 2.5)))
    assert [portal.width for portal in portals(built(FloorPlan((hall, B))))[1:]] == pytest.approx([1.35, 1.35])


def test_a_wall_is_as_thick_as_the_thicker_of_its_rooms_says():
    thick = (ThickWall(np.array([[5, 0], [5, 4.0]]), 0.4), ThickWall(np.array([[0, 0], [2, 0.0]]), 0.5))
    plan = built(FloorPlan((dataclasses.replace(A, walls=thick), B)))
    a, b = interior_polygon(plan, 0), interior_polygon(plan, 1)
    assert a.bounds == pytest.approx((0.15, 0.15, 4.8, 3.85)) and b.bounds[0] == pytest.approx(5.2)
    assert a.area == pytest.approx(4.65 * 3.7 - (2 - 0.15) * 0.35)
    assert portals(plan)[0].half_depths == pytest.approx((0.2, 0.2))


@pytest.mark.parametrize("given", [0.3, [0.3, 0.3, 0.3, 0.3]])
def test_a_room_says_how_thick_its_walls_are_in_one_number_or_by_edge(given):
    document = json.loads(plan_to_json(FloorPlan((A, B))))
    document["rooms"][1]["wall_thickness"] = given
    plan = parse_plan(json.dumps(document))
    assert interior_polygon(plan, 1).bounds == pytest.approx((5.15, 0.3, 8.7, 3.7))
    assert interior_polygon(plan, 0).bounds == pytest.approx((0.15, 0.15, 4.85, 3.85))


@pytest.mark.parametrize(
    ("size", "way", "note"), [((0.45, 2.0), False, "nobody gets through"), ((0.8, 1.6), True, "people stoop")]
)
def test_small_doors_are_built_and_told_of(size, way, note):
    hall = rectangle("a", 0, 0, 5, 4, opening("door", (5, 0), (5, 4), 1.5, *size))
    assert portals(built(FloorPlan((hall, B))))[0].is_way == way
    assert any(note in told for told in reading(FloorPlan((hall, B))).notes)


def test_attics_are_built():
    low = [rectangle(name, x, 0, x + 4, 4, *doors, height=1.2) for name, x, doors in (("a", 0, ()), ("b", 4, ()))]
    door = opening("door", (4, 0), (4, 4), 1.5, 0.9, 1.2)
    plan = built(FloorPlan((dataclasses.replace(low[0], openings=(door,)), low[1])))
    assert connected_parts(plan) == ((0, 1),)


def test_rooms_that_no_way_leads_to_are_named_or_refused():
    garage = rectangle("garage", 9, 0, 12, 4)
    plan = FloorPlan((A, B, garage))
    assert connected_parts(reading(plan).plan) == ((0, 1), (2,))
    (note,) = reading(plan).notes
    assert note.startswith("room garage: no doors or passages lead there from a; nobody gets in")
    with pytest.raises(PlanError, match="room garage: unreachable"):
        reading(plan, unreachable="refuse")
    entered = FloorPlan((A, B, dataclasses.replace(garage, openings=(opening("door", (9, 0), (12, 0), 1),))))
    assert reading(entered, unreachable="refuse").notes[0].endswith("it has an entrance of its own")
    assert [portal.wall.room for portal in entrances(reading(entered).plan)] == [2]


def test_a_file_is_loaded_with_the_same_choices(tmp_path):
    path = tmp_path / "plan.json"
    apart = dataclasses.replace(two_rooms().rooms[1], polygon=two_rooms().rooms[1].polygon + np.array([0.2, 0.0]), openings=())
    path.write_text(plan_to_json(FloorPlan((two_rooms().rooms[0], apart))))
    with pytest.warns(PlanWarning, match="the gap of 0.2 m between hall and study is closed"):
        assert len(connected_parts(load_plan(path, repair=True))) == 1
    with pytest.raises(PlanError):
        load_plan(path)
