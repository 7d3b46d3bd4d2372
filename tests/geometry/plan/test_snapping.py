"""Walls that nearly touch become one, and what the rules accept can be built."""

import dataclasses
import json
import warnings

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.geometry.plans import checked, l_shaped, opening, random_plan, rectangle, two_rooms
from wm.geometry import FloorPlan, PlanError, PlanWarning, build_structure, parse_plan, plan_to_json
from wm.geometry.plan.snapping import SNAP, snapped
from wm.geometry.plan.walls import plan_walls


def built(text: str) -> str:
    """Whether a plan is refused; one that is accepted must be built, and watertight."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", PlanWarning)
            plan = parse_plan(text)
    except PlanError:
        return "refused"
    assert build_structure(plan).to_trimesh().is_watertight
    return "built"


@given(st.integers(0, 2**32 - 1), st.integers(1, 12))
def test_what_touches_stays_bit_for_bit(seed, rooms):
    plan = random_plan(seed, rooms)
    same, notes = snapped(plan.rooms)
    assert not notes and all(a is b for a, b in zip(same, plan.rooms, strict=True))


@given(st.floats(-0.02, 0.02).filter(lambda gap: abs(gap) > 1e-5), st.floats(-0.3, 0.3))
def test_gaps_overlaps_and_skews_leave_one_wall(gap, degrees):
    plan = two_rooms()
    c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    corner = np.array([5.0, 2.0])
    ring = (plan.rooms[1].polygon - corner) @ np.array([[c, s], [-s, c]]) + corner + [gap / 2, 0.0]
    study = dataclasses.replace(plan.rooms[1], polygon=ring, openings=())
    with pytest.warns(PlanWarning, match="room study: corners moved by up to"):
        joined = checked(FloorPlan((plan.rooms[0], study)))
    np.testing.assert_array_equal(joined.rooms[0].polygon, plan.rooms[0].polygon)
    assert np.abs(joined.rooms[1].polygon - ring).max() <= SNAP
    (behind,) = [wall.behind[0] for wall in plan_walls(joined)[0] if wall.behind]
    assert max(abs(behind.gap_low), abs(behind.gap_high)) < 1e-9


def test_a_corner_beside_the_middle_of_a_wall_is_moved_onto_it():
    hall = rectangle("hall", 0, 0, 5, 8, opening("door", (5, 0), (5, 8), 1.5), opening("door", (5, 0), (5, 8), 5.5))
    rooms = (hall, rectangle("b", 5.006, 0, 9, 4), rectangle("c", 4.994, 4, 9, 8))
    with pytest.warns(PlanWarning):
        plan = checked(FloorPlan(rooms))
    for room, corners in ((1, (0, 3)), (2, (0, 3))):
        np.testing.assert_allclose(plan.rooms[room].polygon[list(corners), 0], 5.0, atol=1e-9)


def test_an_opening_goes_with_its_wall():
    hall, study = two_rooms().rooms
    shift = np.array([0.015, 0.0])
    shifted = dataclasses.replace(
        study,
        polygon=study.polygon + shift,
        openings=tuple(dataclasses.replace(o, segment=o.segment + shift) for o in study.openings),
    )
    listed = dataclasses.replace(shifted, openings=(*shifted.openings, opening("door", (5.015, 0), (5.015, 4), 1.5)))
    with pytest.warns(PlanWarning):
        plan = checked(FloorPlan((dataclasses.replace(hall, openings=hall.openings[1:]), listed)))
    assert plan.rooms[1].openings[-1].segment[:, 0].tolist() == [5.0, 5.0]


def test_corners_of_one_room_are_never_joined():
    angle = np.linspace(0, 2 * np.pi, 400, endpoint=False)
    ring = np.stack([1.4 * np.cos(angle), 1.4 * np.sin(angle)], axis=1) - [1.39, -2.0]  # edges of 22 mm, and a neighbour
    rooms = (rectangle("hall", 0, 0, 5, 4), dataclasses.replace(rectangle("tower", 0, 0, 1, 1), polygon=ring))
    assert len(np.unique(snapped(rooms)[0][1].polygon, axis=0)) >= 390


@given(st.data(), st.sampled_from([two_rooms, l_shaped, lambda: random_plan(4, 6)]))
def test_what_the_rules_accept_can_be_built(data, plan):
    document = json.loads(plan_to_json(plan()))
    noise = data.draw(st.sampled_from([0.001, 0.007, 0.03, 0.2]))
    for _ in range(data.draw(st.integers(1, 6))):
        room = data.draw(st.sampled_from(document["rooms"]))
        off = data.draw(st.tuples(st.floats(-noise, noise), st.floats(-noise, noise)))
        point = data.draw(st.integers(0, len(room["floor_polygon"]) - 1))
        room["floor_polygon"][point] = [x + d for x, d in zip(room["floor_polygon"][point], off)]
        for hole in room["openings"][:1]:
            hole["position"] += off[0]
            hole["height"] += off[1]
    built(json.dumps(document))


@pytest.mark.parametrize("seed", range(40))
def test_corners_drawn_by_hand_are_built(seed):
    rng = np.random.default_rng(seed)
    document = json.loads(plan_to_json(two_rooms()))
    for room in document["rooms"]:
        room["openings"] = [hole for hole in room["openings"] if hole["type"] == "door"]
        room["floor_polygon"] = (np.array(room["floor_polygon"]) + rng.uniform(-0.007, 0.007, (4, 2))).tolist()
    assert built(json.dumps(document)) == "built"
