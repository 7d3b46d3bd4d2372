"""The carved building: closed, as large as the plan says, labelled, and passable exactly where there are openings."""

import dataclasses

import numpy as np
import pytest
import shapely
from hypothesis import assume, example, given, settings
from hypothesis import strategies as st

from tests.geometry.plans import checked, l_shaped, one_room, opening, random_plan, rectangle, slanted_plan, two_rooms, window
from wm.geometry import (
    FloorPlan,
    PlanError,
    Room,
    build_ray_scene,
    build_structure,
    cast_rays,
    face_normals,
    interior_polygon,
    portals,
)
from wm.geometry.mesh.slivers import heights
from wm.geometry.mesh.structure import PANE, SLAB
from wm.types import OUTSIDE, Mesh, SurfaceKind

SEEDS = st.integers(0, 2**32 - 1)


def volume(mesh: Mesh) -> float:
    a, b, c = (mesh.vertices[mesh.faces[:, k]] for k in range(3))
    return float(np.sum(a * np.cross(b, c))) / 6


def areas(mesh: Mesh) -> np.ndarray:
    a, b, c = (mesh.vertices[mesh.faces[:, k]] for k in range(3))
    return np.linalg.norm(np.cross(b - a, c - a), axis=1) / 2


def area_of(mesh: Mesh, kind: SurfaceKind, room: int | None = None) -> float:
    chosen = mesh.face_kind == kind
    if room is not None:
        chosen &= mesh.face_room == room
    return float(areas(mesh)[chosen].sum())


def assert_watertight(mesh: Mesh) -> None:
    """Every directed edge occurs once, and once the other way round."""
    edges = mesh.faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2).astype(np.int64)
    forward = np.sort(edges[:, 0] * len(mesh.vertices) + edges[:, 1])
    backward = np.sort(edges[:, 1] * len(mesh.vertices) + edges[:, 0])
    assert (np.diff(forward) > 0).all()
    np.testing.assert_array_equal(forward, backward)


def transformed(plan: FloorPlan, angle: float, shift: tuple[float, float]) -> FloorPlan:
    turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])

    def move(points: np.ndarray) -> np.ndarray:
        return points @ turn.T + shift

    return dataclasses.replace(
        plan,
        rooms=tuple(
            dataclasses.replace(
                room,
                polygon=move(room.polygon),
                openings=tuple(dataclasses.replace(hole, segment=move(hole.segment)) for hole in room.openings),
            )
            for room in plan.rooms
        ),
    )


def check_laws(plan: FloorPlan, mesh: Mesh) -> None:
    """What holds of every structure."""
    assert_watertight(mesh)
    assert volume(mesh) > 0  # so normals point out of the solid, into free air
    assert heights(mesh.vertices, mesh.faces).min() > 1e-9
    assert mesh.faces.min() == 0 and mesh.faces.max() == len(mesh.vertices) - 1
    np.testing.assert_array_equal(mesh.face_room == OUTSIDE, mesh.face_kind == SurfaceKind.EXTERIOR)
    np.testing.assert_array_equal(mesh.face_object, OUTSIDE)
    normals = face_normals(mesh)
    expected = {SurfaceKind.FLOOR: 1.0, SurfaceKind.CEILING: -1.0, SurfaceKind.WALL: 0.0, SurfaceKind.PANE: 0.0}
    for kind, z in expected.items():
        np.testing.assert_allclose(normals[mesh.face_kind == kind, 2], z, atol=1e-6)
    doors = [portal for portal in portals(plan) if portal.is_way]
    windows = [portal for portal in portals(plan) if portal.kind == "window"]
    for index, room in enumerate(plan.rooms):
        interior = interior_polygon(plan, index)
        thresholds = sum(door.width * sum(door.half_depths) for door in doors if door.rooms[0] == index)
        np.testing.assert_allclose(area_of(mesh, SurfaceKind.FLOOR, index), interior.area + thresholds, rtol=1e-6)
        np.testing.assert_allclose(area_of(mesh, SurfaceKind.CEILING, index), interior.area, rtol=1e-6)
        holes = [portal for portal in portals(plan) if index in portal.rooms]
        wall = interior.length * room.ceiling_height - sum(hole.width * (hole.head - hole.sill) for hole in holes)
        np.testing.assert_allclose(area_of(mesh, SurfaceKind.WALL, index), wall, rtol=1e-6)
        panes = sum(portal.width * (portal.head - portal.sill) for portal in windows if portal.rooms[0] == index)
        np.testing.assert_allclose(area_of(mesh, SurfaceKind.PANE, index), panes, rtol=1e-6, atol=1e-9)


@given(SEEDS, st.integers(1, 24))
@settings(max_examples=30)
def test_laws_of_random_plans(seed, rooms):
    plan = checked(random_plan(seed, rooms))
    check_laws(plan, build_structure(plan))


@pytest.mark.filterwarnings("ignore::wm.geometry.PlanWarning")  # walls that nearly touch are joined
@given(SEEDS, st.integers(2, 12))
@example(268, 12)  # the two sides of a wall with a door run askew
@example(156, 12)  # a wall of a millimetre beside one with a door
@example(107, 12)  # two corners of one room come to one place
@example(192, 8)  # a short thick wall almost in line with a thin one
@settings(max_examples=20)
def test_laws_of_slanted_and_concave_plans(seed, rooms):
    try:
        plan = checked(slanted_plan(seed, rooms))
    except PlanError:
        assume(False)
    check_laws(plan, build_structure(plan))


@pytest.mark.parametrize("plan", [one_room(), two_rooms(), l_shaped()])
def test_laws_of_small_plans(plan):
    plan = checked(plan)
    check_laws(plan, build_structure(plan))


def test_volume_of_one_room_is_analytic():
    expected = 5 * 4 * (2.8 + 2 * SLAB) - 4.7 * 3.7 * 2.8
    assert volume(build_structure(one_room())) == pytest.approx(expected, abs=1e-9)


def test_volume_of_two_rooms_is_analytic():
    solid = 9 * 4 * (2.8 + 2 * SLAB) - (4.775 + 3.775) * 3.7 * 2.8
    door, glazing = 0.9 * 2.1 * 0.15, 2 * 1.5 * 1.2 * (0.15 - PANE)
    assert volume(build_structure(two_rooms())) == pytest.approx(solid - door - glazing, abs=1e-9)


def test_walls_are_half_as_thick_where_they_are_shared():
    plan = checked(l_shaped())
    # The library's upper wall is shared in part (with the closet), its right one not at all.
    assert interior_polygon(plan, 1).bounds == pytest.approx((3.075, 3.075, 7.85, 6.925))
    # The hall is concave; its upper wall is shared with the closet, its inner corner mitred.
    hall = shapely.Polygon([(0.15, 0.15), (7.85, 0.15), (7.85, 2.925), (2.925, 2.925), (2.925, 6.925), (0.15, 6.925)])
    assert interior_polygon(plan, 0).symmetric_difference(hall).area < 1e-9


def test_mitred_corners_of_a_slanted_room():
    ring = np.array([[0, 0], [6, 0], [4, 3], [1, 4]], float)
    plan = checked(FloorPlan((Room("a", "a", ring, 2.5, (window((0, 0), (6, 0), 2),)),)))
    interior = interior_polygon(plan, 0)
    assert interior.symmetric_difference(shapely.Polygon(ring).buffer(-0.15, join_style="mitre")).area < 1e-8
    check_laws(plan, build_structure(plan))


def test_a_plan_may_have_a_courtyard():
    rooms = (
        rectangle("south", 0, 0, 9, 3, opening("door", (9, 3), (6, 3), 1), window((3, 3), (6, 3), 1)),
        rectangle("east", 6, 3, 9, 6, opening("door", (9, 6), (6, 6), 1)),
        rectangle("north", 0, 6, 9, 9, opening("door", (0, 6), (3, 6), 1)),
        rectangle("west", 0, 3, 3, 6),
    )
    plan = checked(FloorPlan(rooms))
    mesh = build_structure(plan)
    check_laws(plan, mesh)
    interiors = sum(interior_polygon(plan, index).area for index in range(4))
    holes = 3 * 0.9 * 2.1 * 0.15 + 1.5 * 1.2 * (0.075 - 0.075 / 4)
    assert volume(mesh) == pytest.approx((81 - 9) * (2.8 + 2 * SLAB) - interiors * 2.8 - holes, abs=1e-6)


def test_a_passage_may_reach_the_ceiling_and_the_corners():
    rooms = (rectangle("a", 0, 0, 4, 4, opening("passage", (4, 0), (4, 4), 0.15, 3.7, 2.8)), rectangle("b", 4, 0, 8, 4))
    plan = checked(FloorPlan(rooms))
    mesh = build_structure(plan)
    assert_watertight(mesh)
    assert volume(mesh) == pytest.approx(8 * 4 * (2.8 + 2 * SLAB) - 7.7 * 3.7 * 2.8, abs=1e-6)


@given(SEEDS, st.floats(-3, 3), st.floats(-9e3, 9e3), st.floats(-9e3, 9e3))
@settings(max_examples=15)
def test_rigid_motions_change_nothing_but_the_place(seed, angle, x, y):
    plan = random_plan(seed, 6)
    moved = checked(transformed(plan, angle, (x, y)))
    mesh, other = build_structure(plan), build_structure(moved)
    check_laws(moved, other)
    assert volume(other) == pytest.approx(volume(mesh), rel=1e-6)
    for kind in SurfaceKind:
        assert area_of(other, kind) == pytest.approx(area_of(mesh, kind), rel=1e-6)


@pytest.mark.filterwarnings("ignore::wm.geometry.PlanWarning")  # walls that nearly touch are joined
def test_walls_within_a_centimetre_are_one():
    plan = two_rooms()
    apart = dataclasses.replace(plan.rooms[1], polygon=plan.rooms[1].polygon + np.array([0.008, 0.0]), openings=())
    tilted = np.array([[5, 0], [9, 0], [9, 4], [5.009, 4]])
    for room in (apart, dataclasses.replace(apart, polygon=tilted)):
        moved = checked(FloorPlan((plan.rooms[0], room)))
        mesh = build_structure(moved)
        assert_watertight(mesh)
        assert portals(moved)[0].rooms == (0, 1)


def test_the_same_plan_gives_the_same_bytes():
    first, second = build_structure(random_plan(3, 12)), build_structure(random_plan(3, 12))
    assert first.vertices.tobytes() == second.vertices.tobytes()
    assert first.faces.tobytes() == second.faces.tobytes()
    assert first.face_room.tobytes() + first.face_kind.tobytes() == second.face_room.tobytes() + second.face_kind.tobytes()


def test_it_does_not_matter_which_room_lists_a_door():
    plan = two_rooms()
    door = plan.rooms[0].openings[0]
    other = dataclasses.replace(door, segment=door.segment[::-1].copy(), position=4 - 1.5 - 0.9)
    swapped = FloorPlan(
        (
            dataclasses.replace(plan.rooms[0], openings=plan.rooms[0].openings[1:]),
            dataclasses.replace(plan.rooms[1], openings=(*plan.rooms[1].openings, other)),
        )
    )
    both = FloorPlan((plan.rooms[0], swapped.rooms[1]))
    reference = build_structure(plan)
    for same in (swapped, both):
        mesh = build_structure(checked(same))
        np.testing.assert_array_equal(mesh.vertices, reference.vertices)
        np.testing.assert_array_equal(mesh.faces, reference.faces)
        assert sorted(p.rooms for p in portals(same)) == sorted(p.rooms for p in portals(plan))


def leaks(plan: FloorPlan, rays: int, seed: int) -> int:
    """How many rays from inside the rooms end on the building's skin, or nowhere."""
    mesh = build_structure(plan)
    scene = build_ray_scene(mesh)
    rng = np.random.default_rng(seed)
    lost = 0
    for part in np.array_split(np.arange(rays), max(1, rays // 1_000_000)):
        directions = rng.normal(size=(len(part), 3)).astype(np.float32)
        room = rng.integers(len(plan.rooms), size=len(part))
        centres = np.array([_centre(plan, k) for k in range(len(plan.rooms))])
        origins = (centres[room] + rng.uniform(-0.15, 0.15, (len(part), 3))).astype(np.float32)
        hits = cast_rays(scene, origins, directions)
        lost += int((~hits.hit).sum()) + int((mesh.face_kind[hits.face[hits.hit]] == SurfaceKind.EXTERIOR).sum())
    return lost


def _centre(plan: FloorPlan, room: int) -> np.ndarray:
    interior = interior_polygon(plan, room)
    point = shapely.centroid(shapely.maximum_inscribed_circle(interior, tolerance=0.05))
    return np.array([point.x, point.y, 1.2])


@pytest.mark.parametrize("plan", [one_room(), two_rooms(), l_shaped(), random_plan(1, 9)])
def test_rooms_leak_no_ray(plan):
    assert leaks(checked(plan), 50_000, 0) == 0


@pytest.mark.slow
@pytest.mark.parametrize("plan", [l_shaped(), random_plan(5, 12)])
def test_rooms_leak_no_ray_in_ten_million(plan):
    assert leaks(checked(plan), 10_000_000, 1) == 0


@given(SEEDS)
@settings(max_examples=8)
def test_every_door_passes_rays_and_no_window_does(seed):
    plan = checked(random_plan(seed, 8))
    mesh = build_structure(plan)
    scene = build_ray_scene(mesh)
    for portal in portals(plan):
        across, up = np.meshgrid(np.linspace(0.003, 0.997, 12), np.linspace(0.003, 0.997, 12))
        feet = portal.ends[0] + across.reshape(-1, 1) * (portal.ends[1] - portal.ends[0])
        height = portal.sill + up.reshape(-1, 1) * (portal.head - portal.sill)
        back = portal.half_depths[0] + 0.3
        origins = np.concatenate([feet - back * portal.normal, height], axis=1).astype(np.float32)
        directions = np.tile(np.append(portal.normal, 0.0), (len(feet), 1)).astype(np.float32)
        hits = cast_rays(scene, origins, directions)
        if portal.kind == "window":
            assert (mesh.face_kind[hits.face] == SurfaceKind.PANE).all()
        else:
            assert (hits.t > back + portal.half_depths[1] + 0.1).all()
            assert (mesh.face_room[hits.face] != OUTSIDE).all()


def test_a_large_plan_is_carved_in_one_piece():
    plan = random_plan(0, 300)
    mesh = build_structure(plan)
    assert_watertight(mesh)
    assert len(mesh.faces) < 60 * len(plan.rooms)
