"""Portals: where the openings of a plan lie in the building, and how furniture meets them on the walls of one room."""

import dataclasses

import numpy as np
import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st

from tests.geometry.plans import checked, l_shaped, opening, random_plan, two_rooms
from wm.geometry import interior_polygon, portals
from wm.geometry.plan.site import room_site
from wm.geometry.plan.walls import room_polygons
from wm.types import OUTSIDE

SEEDS = st.integers(0, 2**32 - 1)


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


@given(st.floats(-0.009, 0.009), st.floats(-0.009, 0.009), st.booleans())
def test_a_door_in_a_wall_askew_ends_at_both_faces(low, high, turned):
    plan = two_rooms()
    ring = plan.rooms[1].polygon.copy()
    ring[0, 0] += low  # walls within a centimetre are one; these are not snapped
    ring[3, 0] += high
    rooms = (plan.rooms[0], dataclasses.replace(plan.rooms[1], polygon=ring))
    plan = dataclasses.replace(plan, rooms=rooms[::-1] if turned else rooms)
    door = next(portal for portal in portals(plan) if portal.is_way)
    for side, room in enumerate(door.rooms):
        face = interior_polygon(plan, room).exterior
        for end, depth in zip(door.ends, door.depths[side]):
            away = door.normal if side else -door.normal
            assert face.distance(shapely.Point(end + depth * away)) < 1e-12
        assert door.depths[side].mean() == pytest.approx(door.half_depths[side], abs=1e-6)


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


def test_a_portal_is_the_same_whichever_room_lists_the_door():
    plan = two_rooms()
    hall, study = plan.rooms
    door = opening("door", (5, 4), (5, 0), 1.6)
    assert hall.openings[0].kind == "door"
    swapped = dataclasses.replace(
        plan,
        rooms=(
            dataclasses.replace(hall, openings=hall.openings[1:]),
            dataclasses.replace(study, openings=(door, *study.openings)),
        ),
    )
    mine, theirs = (next(p for p in portals(checked(each)) if p.kind == "door") for each in (plan, swapped))
    assert (mine.wall.room, theirs.wall.room) == (0, 1)
    assert mine.rooms == theirs.rooms and mine.half_depths == pytest.approx(theirs.half_depths)
    np.testing.assert_allclose(mine.ends, theirs.ends, atol=1e-12)
    np.testing.assert_allclose(mine.normal, theirs.normal, atol=1e-12)


@given(SEEDS, st.integers(1, 12))
def test_a_site_shows_the_portals_of_its_room_on_its_walls(seed, rooms):
    plan = checked(random_plan(seed, rooms))
    for room in range(rooms):
        site = room_site(plan, room)
        mine = [portal for portal in portals(plan) if room in portal.rooms]
        assert len(site.openings) == len(mine)
        for (wall, seen), portal in zip(site.openings, mine):
            assert (seen.kind, seen.sill, seen.head) == (portal.kind, portal.sill, portal.head)
            ends = site.starts[wall] + np.array([[seen.low], [seen.high]]) * site.directions[wall]
            across = np.abs((portal.ends - site.starts[wall]) @ site.normals[wall])
            np.testing.assert_allclose(across, portal.half_depths[portal.rooms.index(room)], atol=1e-9)
            assert shapely.LineString(ends).length == pytest.approx(portal.width)
            np.testing.assert_allclose(ends.mean(0) - portal.ends.mean(0), site.normals[wall] * across[0], atol=1e-9)
