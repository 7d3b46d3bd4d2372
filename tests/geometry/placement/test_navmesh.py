"""Laws of the navmesh and of spawn points: exactly the area in which a body fits, in conforming triangles, through every door."""

import collections

import numpy as np
import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st

from tests.geometry.plans import l_shaped, one_room, opening, random_plan, rectangle, two_rooms
from tests.geometry.things import box
from wm.geometry.placement.navigation import body_area
from wm.geometry.placement.navmesh import build_navmesh
from wm.geometry.placement.spawn import part_spawns, room_spawns
from wm.geometry.plan.footprint import interior_polygon
from wm.geometry.plan.records import FloorPlan
from wm.schema import NavigationSettings
from wm.types import OUTSIDE


def outline(mesh):
    return shapely.union_all(shapely.polygons(mesh.vertices[mesh.triangles, :2]))


def pieces(triangles) -> int:
    """Connected pieces over shared edges, by joining sets."""
    parent = list(range(len(triangles)))

    def root(k):
        while parent[k] != k:
            k = parent[k]
        return k

    owner = {}
    for k, triangle in enumerate(triangles.tolist()):
        for a, b in zip(triangle, triangle[1:] + triangle[:1]):
            other = owner.setdefault((min(a, b), max(a, b)), k)
            parent[root(k)] = root(other)
    return len({root(k) for k in range(len(triangles))})


@pytest.mark.parametrize("plan", [one_room(), two_rooms(), l_shaped(), random_plan(4, 8)], ids=["one", "two", "l", "random"])
def test_it_is_the_area_of_a_body_in_one_conforming_piece(plan):
    things = [box((1.4, 1.3, 0), (1.9, 1.7, 0.8))]
    mesh, area = build_navmesh(plan, things), body_area(plan, things)
    assert outline(mesh).symmetric_difference(area).area < 1e-4 * area.area
    assert mesh.areas.sum() == pytest.approx(area.area, rel=1e-4)  # no two triangles overlap
    assert mesh.areas.min() >= 0 and (mesh.vertices[:, 2] == 0).all()
    edges = collections.Counter(tuple(sorted(pair)) for t in mesh.triangles.tolist() for pair in zip(t, t[1:] + t[:1]))
    assert max(edges.values()) <= 2
    assert pieces(mesh.triangles) == 1 and set(mesh.part.tolist()) == {0}


@pytest.mark.parametrize("plan", [two_rooms(), random_plan(4, 8)], ids=["two", "random"])
def test_every_triangle_lies_in_its_room(plan):
    mesh = build_navmesh(plan, [])
    middles = mesh.vertices[mesh.triangles, :2].mean(axis=1)
    for room in range(len(plan.rooms)):
        inside = shapely.contains_xy(interior_polygon(plan, room).buffer(1e-6), middles)
        np.testing.assert_array_equal(inside, mesh.room == room)
    assert OUTSIDE in mesh.room


@given(st.floats(0.3, 0.8))
def test_it_leads_through_a_door_exactly_where_the_body_fits(width):
    rooms = (rectangle("hall", 0, 0, 3, 4, opening("door", (3, 0), (3, 4), 1.5, width)), rectangle("store", 3, 0, 6, 4))
    mesh = build_navmesh(FloorPlan(rooms), [])
    assert pieces(mesh.triangles) == (1 if width >= 0.5 else 2) == mesh.part.max() + 1


def test_what_a_body_cannot_leave_is_left_out():
    walls = [box((1, 1, 0), (3, 1.1, 1)), box((1, 2.9, 0), (3, 3, 1))]
    sides = [box((1, 1, 0), (1.1, 3, 1)), box((2.9, 1, 0), (3, 3, 1))]
    plan = FloorPlan((rectangle("hall", 0, 0, 8, 6),))
    mesh = build_navmesh(plan, [*walls, *sides])
    assert not outline(mesh).contains(shapely.Point(2, 2)) and pieces(mesh.triangles) == 1
    assert len(shapely.get_parts(body_area(plan, [*walls, *sides]))) == 2


def test_a_house_that_no_body_enters_has_none():
    mesh = build_navmesh(one_room(), [], NavigationSettings(body_radius=2.0))
    assert len(mesh.triangles) == 0 and room_spawns(one_room(), mesh) == (None,) and part_spawns(one_room(), mesh, [None]) == ()


@pytest.mark.parametrize("plan", [one_room(), two_rooms(), l_shaped(), random_plan(4, 8)], ids=["one", "two", "l", "random"])
def test_spawn_points_stand_free_in_their_rooms(plan):
    things = [box((1.4, 1.3, 0), (1.9, 1.7, 0.8))]
    mesh = build_navmesh(plan, things)
    rooms = room_spawns(plan, mesh)
    for room, spawn in enumerate(rooms):
        assert spawn is not None and spawn.room == room
        place = shapely.Point(spawn.position[:2])
        assert interior_polygon(plan, room).contains(place)
        assert body_area(plan, things).buffer(1e-6).contains(place.buffer(spawn.clearance * 0.98))
    (house,) = part_spawns(plan, mesh, rooms)
    assert outline(mesh).contains(shapely.Point(house.position[:2]))


def test_an_entrance_is_where_one_begins_and_looks_inside():
    plan = FloorPlan((rectangle("hall", 0, 0, 6, 4, opening("door", (0, 0), (6, 0), 4.0, 0.9)),))
    mesh = build_navmesh(plan, [])
    (house,) = part_spawns(plan, mesh, room_spawns(plan, mesh))
    assert abs(house.position[0] - 4.45) < 0.01 and house.position[1] < 1.0 and house.yaw == 90.0


def test_rooms_without_a_way_are_parts_of_their_own_the_largest_first():
    plan = FloorPlan((rectangle("store", 0, 0, 3, 4), rectangle("hall", 3, 0, 9, 4)))
    mesh = build_navmesh(plan, [])
    rooms = room_spawns(plan, mesh)
    assert [spawn.part for spawn in rooms if spawn is not None] == [1, 0]
    assert [spawn.room for spawn in part_spawns(plan, mesh, rooms)] == [1, 0]
