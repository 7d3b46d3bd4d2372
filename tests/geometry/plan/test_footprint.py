"""The plan from above: interiors lie inside their walls."""

import numpy as np
import pytest
import shapely
from hypothesis import assume, given
from hypothesis import strategies as st

from tests.geometry.plans import checked, random_plan, rectangle
from wm.geometry import FloorPlan, Room, interior_polygon
from wm.geometry.plan.footprint import interiors
from wm.geometry.plan.walls import room_polygons, straight_ring

SEEDS = st.integers(0, 2**32 - 1)


@given(SEEDS, st.integers(1, 16))
def test_interiors_stay_half_a_wall_or_a_wall_inside(seed, rooms):
    plan = checked(random_plan(seed, rooms))
    for index, polygon in enumerate(room_polygons(plan)):
        interior = interior_polygon(plan, index)
        assert polygon.buffer(-0.15, join_style="mitre").buffer(-1e-9).within(interior)
        assert interior.within(polygon.buffer(-0.075, join_style="mitre").buffer(1e-9))
        assert interior.exterior.is_ccw


@given(SEEDS, st.integers(3, 13))
def test_interiors_of_spiky_rooms_keep_a_wall_from_every_wall(seed, corners):
    rng = np.random.default_rng(seed)
    turns = np.sort(rng.uniform(0, 2 * np.pi, corners))
    ring = rng.uniform(1, 8, corners)[:, None] * np.stack([np.cos(turns), np.sin(turns)], axis=-1)
    polygon = shapely.Polygon(ring)
    assume(polygon.is_valid and polygon.area > 1 and polygon.exterior.is_ccw)
    interior = interiors(FloorPlan((Room("star", "Star", ring, 2.5, ()),)))[0]
    assume(interior is not None)
    assert interior is not None and interior.is_valid
    assert polygon.exterior.distance(interior) > 0.15 - 1e-9
    core = polygon.buffer(-4.5 * 0.15, join_style="mitre")  # mitres end at 4 walls
    assert core.difference(interior).area < 1e-9


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
