"""plan.repair: rooms cut apart become one building again, each change is told, and what is right stays."""

import dataclasses

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.geometry.plans import opening, random_plan, rectangle, two_rooms
from wm.geometry import FloorPlan, PlanError, build_structure, plan_to_json
from wm.geometry.plan.loading import PlanReading, decode, read_plan
from wm.geometry.plan.openings import portals
from wm.geometry.plan.records import Room
from wm.geometry.plan.walls import SHARED, plan_walls, room_polygons


def reading(plan: FloorPlan, *, repair: bool = True) -> PlanReading:
    return read_plan(decode(plan_to_json(plan), "plan"), "plan", repair=repair)


def refusal(plan: FloorPlan, *, repair: bool = False) -> str:
    with pytest.raises(PlanError) as caught:
        reading(plan, repair=repair)
    return str(caught.value)


def four_rooms(x: list[float], y: list[float], angle: float = 0.0) -> FloorPlan:
    """Two by two rooms, apart by x[0] below and x[1] above, and by y[0] on the left and y[1] on the right; doors all around."""
    a, b = (rectangle("a", 0, 0, 5 - x[0] / 2, 4), rectangle("b", 5 + x[0] / 2, 0, 9, 4 + (y[0] - y[1]) / 2))
    c, d = (rectangle("c", 0, 4 + y[0], 5 - x[1] / 2, 8), rectangle("d", 5 + x[1] / 2, 4 + (y[0] + y[1]) / 2, 9, 8))
    a = dataclasses.replace(
        a, openings=(opening("door", (5 - x[0] / 2, 0), (5 - x[0] / 2, 4), 1.5), opening("door", (5 - x[0] / 2, 4), (0, 4), 2))
    )
    d = dataclasses.replace(d, openings=(opening("door", (5 + x[1] / 2, 8), (5 + x[1] / 2, d.polygon[0, 1]), 1.2),))
    turn = np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])
    return FloorPlan(tuple(_turned(room, turn) for room in (a, b, c, d)))


def _turned(room: Room, turn: np.ndarray) -> Room:
    openings = tuple(dataclasses.replace(o, segment=o.segment @ turn) for o in room.openings)
    return dataclasses.replace(room, polygon=room.polygon @ turn, openings=openings)


@settings(max_examples=10, deadline=None)
@given(
    st.lists(st.floats(0.01, 0.5), min_size=2, max_size=2),
    st.lists(st.floats(0.01, 0.5), min_size=2, max_size=2),
    st.floats(0, 2 * np.pi),
)
def test_rooms_cut_apart_by_any_gaps_become_one_building(x, y, angle):
    mended = reading(four_rooms(x, y, angle))
    plan = mended.plan
    walls = plan_walls(plan)
    gaps = [abs(gap) for room in walls for wall in room for b in wall.behind for gap in (b.gap_low, b.gap_high)]
    assert gaps and max(gaps) < 1e-9
    outline = shapely.union_all(room_polygons(plan)).buffer(SHARED / 2, join_style="mitre")
    assert outline.geom_type == "Polygon" and not outline.interiors
    assert [portal.rooms for portal in portals(plan)] == [(0, 1), (0, 2), (2, 3)]
    assert build_structure(plan).to_trimesh().is_watertight
    assert reading(plan).notes == () and plan_to_json(reading(plan).plan) == plan_to_json(plan)


@settings(max_examples=8, deadline=None)
@given(st.integers(0, 2**32 - 1), st.integers(1, 10))
def test_repair_of_a_valid_plan_changes_nothing(seed, rooms):
    plan = random_plan(seed, rooms)
    assert plan_to_json(reading(plan).plan) == plan_to_json(plan)


@pytest.mark.parametrize("gap", [0.03, 0.15, 0.5])
def test_without_repair_the_refusal_names_it(gap):
    hall, study = two_rooms().rooms
    apart = dataclasses.replace(study, polygon=study.polygon + np.array([gap, 0.0]), openings=())
    plan = FloorPlan((hall, apart))
    assert f"plan.repair=true closes the gap of {gap:.3g} m between hall and study" in refusal(plan)
    assert f"the gap of {gap:.3g} m between hall and study is closed" in reading(plan).notes


def test_a_wall_wider_than_half_a_metre_is_no_wall():
    hall, study = two_rooms().rooms
    plan = FloorPlan((hall, dataclasses.replace(study, polygon=study.polygon + np.array([0.6, 0.0]), openings=())))
    assert reading(plan).plan.rooms[1].polygon[:, 0].min() == pytest.approx(5.6)


@pytest.mark.parametrize("skew", [-0.3, 0.3])
def test_a_skewed_room_a_gap_away_stands_straight_again(skew):
    hall, study = two_rooms().rooms
    c, s = np.cos(np.radians(skew)), np.sin(np.radians(skew))
    ring = (study.polygon - [5.0, 0.0]) @ np.array([[c, s], [-s, c]]) + [5.12, 0.0]
    plan = reading(FloorPlan((hall, dataclasses.replace(study, polygon=ring, openings=())))).plan
    (wall,) = [wall for wall in plan_walls(plan)[0] if wall.behind]
    assert abs(wall.direction[0]) < 1e-9 and wall.behind[0].gap_low == pytest.approx(0, abs=1e-9)


def test_a_room_drawn_over_another_is_cut_out_of_it():
    hall, study = two_rooms().rooms
    inside = rectangle("wc", 6.5, 1.5, 8, 3, opening("door", (6.5, 1.5), (8, 1.5), 0.3, 0.7))
    corner = rectangle("closet", 8, 3, 9, 4, opening("door", (8, 3), (9, 3), 0.2, 0.6))
    plan = FloorPlan((hall, dataclasses.replace(study, openings=()), inside, corner))
    assert "as one of its holes (plan.repair=true does)" in refusal(plan)
    mended = reading(plan)
    areas = shapely.area(room_polygons(mended.plan))
    np.testing.assert_allclose(areas, [20.0, 16 - 2.25 - 1.0, 2.25, 1.0], atol=1e-3)
    assert len(mended.plan.rooms[1].holes) == 1 and len(mended.plan.rooms[1].polygon) == 6
    assert [portal.rooms for portal in portals(mended.plan) if portal.is_way] == [(0, 1), (1, 2), (1, 3)]
    assert build_structure(mended.plan).to_trimesh().is_watertight


def test_two_storeys_on_one_outline_are_refused_with_repair_too():
    hall, study = two_rooms().rooms
    assert "a plan has one storey" in refusal(FloorPlan((hall, study, dataclasses.replace(hall, id="up"))), repair=True)


@pytest.mark.parametrize(
    ("position", "width", "moved"),
    [(3.11, 0.9, 2.95), (3.1, 0.9, 2.95), (0.0, 0.9, 0.15), (0.1, 0.9, 0.15), (1.0, 0.9, 1.0)],
)
def test_a_door_past_a_corner_is_moved_along_its_wall(position, width, moved):
    hall = rectangle("hall", 0, 0, 5, 4, opening("door", (5, 0), (5, 4), position, width))
    plan = reading(FloorPlan((hall, rectangle("study", 5, 0, 9, 4)))).plan
    (portal,) = portals(plan)
    assert portal.width == pytest.approx(width)
    assert portal.ends[:, 1].min() == pytest.approx(moved, abs=1e-6)


def test_a_door_between_two_rooms_is_moved_to_one():
    hall = rectangle("hall", 0, 0, 5, 4, opening("door", (5, 0), (5, 4), 1.4))
    plan = reading(FloorPlan((hall, rectangle("b", 5, 0, 9, 2), rectangle("c", 5, 2, 9, 4)))).plan
    (portal,) = portals(plan)
    assert portal.rooms == (0, 1) and portal.ends[:, 1].max() == pytest.approx(2 - 0.075)


def test_an_opening_above_a_ceiling_is_made_lower():
    hall = rectangle("hall", 0, 0, 5, 4, opening("door", (5, 0), (5, 4), 1.5, 0.9, 2.5))
    plan = reading(FloorPlan((hall, rectangle("study", 5, 0, 9, 4, height=2.2)))).plan
    assert portals(plan)[0].head == pytest.approx(2.2)
