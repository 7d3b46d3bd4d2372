"""The plan from above: interiors and portals fit the walls between them."""

import numpy as np
import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st

from tests.geometry.plans import checked, l_shaped, random_plan, rectangle, two_rooms
from wm.geometry import FloorPlan, interior_polygon, portals
from wm.geometry.plan.walls import room_polygons, straight_ring
from wm.types import OUTSIDE

SEEDS = st.integers(0, 2**32 - 1)


@given(SEEDS, st.integers(1, 16))
def test_interiors_stay_half_a_wall_or_a_wall_inside(seed, rooms):
    plan = checked(random_plan(seed, rooms))
    for index, polygon in enumerate(room_polygons(plan)):
        interior = interior_polygon(plan, index)
        assert polygon.buffer(-0.15, join_style="mitre").buffer(-1e-9).within(interior)
        assert interior.within(polygon.buffer(-0.075, join_style="mitre").buffer(1e-9))
        assert interior.exterior.is_ccw


@given(SEEDS, st.integers(2, 16))
def test_portals_join_the_faces_of_their_rooms(seed, rooms):
    plan = checked(random_plan(seed, rooms))
    for portal in portals(plan):
        a, b = portal.rooms
        along = (portal.ends[1] - portal.ends[0]) / portal.width
        assert along[0] * portal.normal[1] - along[1] * portal.normal[0] == pytest.approx(-1)  # normal on the right
        assert 0 <= portal.sill < portal.head <= plan.rooms[a].ceiling_height
        threshold = shapely.LineString(portal.ends)
        assert threshold.distance(interior_polygon(plan, a)) == pytest.approx(portal.half_depths[0])
        before = shapely.Point(portal.ends.mean(axis=0) - (portal.half_depths[0] + 0.01) * portal.normal)
        behind = shapely.Point(portal.ends.mean(axis=0) + (portal.half_depths[1] + 0.01) * portal.normal)
        assert before.within(interior_polygon(plan, a))
        if portal.kind == "window":
            assert b == OUTSIDE and behind.disjoint(shapely.union_all(room_polygons(plan)))
        else:
            assert a < b and behind.within(interior_polygon(plan, b))
            assert threshold.distance(interior_polygon(plan, b)) == pytest.approx(portal.half_depths[1])


def test_a_door_listed_by_both_rooms_is_one_portal():
    plan = checked(random_plan(7, 12))
    doors = [portal for portal in portals(plan) if portal.kind != "window"]
    middles = np.array([portal.ends.mean(axis=0) for portal in doors])
    apart = np.linalg.norm(middles[:, None] - middles, axis=2) + np.eye(len(doors))
    assert apart.min() > 0.5
    assert sum(hole.kind != "window" for room in plan.rooms for hole in room.openings) > len(doors)


def test_portals_keep_the_order_of_the_plan():
    assert [(portal.kind, portal.rooms) for portal in portals(checked(two_rooms()))] == [
        ("door", (0, 1)),
        ("window", (0, OUTSIDE)),
        ("window", (1, OUTSIDE)),
    ]
    assert {portal.rooms for portal in portals(checked(l_shaped())) if portal.kind != "window"} == {(0, 1), (0, 2), (1, 2)}


def test_a_room_without_a_floor_is_named():
    with pytest.raises(ValueError, match="room slot"):
        interior_polygon(FloorPlan((rectangle("slot", 0, 0, 4, 0.2),)), 0)


@given(SEEDS, st.integers(0, 30))
def test_corners_are_what_is_left_of_a_ring_with_points_on_its_sides(seed, extra):
    rng = np.random.default_rng(seed)
    square = np.array([[0, 0], [4, 0], [4, 3], [0, 3]], float)
    points = [*square]
    for _ in range(extra):
        k = int(rng.integers(len(points)))
        points.insert(k + 1, points[k] + rng.uniform(0.1, 0.9) * (points[(k + 1) % len(points)] - points[k]))
    np.testing.assert_allclose(straight_ring(np.array(points)), square)
