"""Laws of coverage and of the rooms a view can look into."""

import dataclasses

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.geometry.plans import l_shaped, one_room, random_plan, two_rooms
from tests.geometry.things import box
from wm.geometry.cameras.aim import VALUES, Aims, choose_aims
from wm.geometry.cameras.sightlines import visible_rooms
from wm.geometry.cameras.visibility import coverage, reachable_points
from wm.geometry.mesh.scene_mesh import assemble_scene
from wm.geometry.mesh.structure import build_structure
from wm.geometry.plan.footprint import interior_polygon
from wm.geometry.plan.openings import portals
from wm.geometry.rays.pinhole import camera_center, make_camera, unproject_depth
from wm.geometry.rays.raycast import build_ray_scene, cast
from wm.geometry.rays.surface_points import in_picture, in_sight, some_points, surface_points, times_seen
from wm.types import SurfaceKind, View


def view_of(eye, target, fov=60.0, room=0):
    camera = make_camera(np.array(eye, float), np.array(target, float), width=64, height=36, fov_deg=fov)
    return View(camera, room, "perimeter", "test")


def random_views(plan, count, seed):
    rng = np.random.default_rng(seed)
    views = []
    for index in range(len(plan.rooms)):
        x0, y0, x1, y1 = interior_polygon(plan, index).bounds
        for _ in range(count):
            eye = rng.uniform((x0, y0, 0.3), (x1, y1, 2.3))
            views.append(view_of(eye, eye + rng.normal(size=3), fov=float(rng.uniform(30, 90)), room=index))
    return views


@pytest.mark.parametrize("plan", [two_rooms(), l_shaped(), random_plan(5, 7)], ids=["two", "l", "random"])
def test_a_room_that_shows_a_face_is_never_called_invisible(plan):
    mesh = build_structure(plan)
    views = random_views(plan, 12, seed=3)
    for portal in portals(plan):  # and from the thresholds, in every direction
        if portal.kind != "window":
            middle = np.append(portal.ends.mean(axis=0), 1.4)
            for off in (-0.3, 0.0, 0.12):
                eye = middle + off * np.append(portal.normal, 0.0)
                views += [view_of(eye, eye + look) for look in np.vstack([np.eye(3), -np.eye(3)])]
    seen = visible_rooms(plan, mesh, views)
    scene = build_ray_scene(mesh)
    shown = np.zeros_like(seen)
    for row, view in zip(shown, views):
        gbuffer = cast(scene, view.camera)
        rooms = np.unique(mesh.face_room[gbuffer.face[gbuffer.hit]])
        row[rooms[rooms >= 0]] = True
    assert not (shown & ~seen).any()
    assert seen.sum() < 1.6 * shown.sum()  # and it does say "invisible" of most that are


def test_a_view_sees_its_own_room_and_not_what_lies_behind_it():
    plan = two_rooms()
    mesh = build_structure(plan)
    towards, away = view_of([2.5, 2, 1.6], [5, 1.95, 1.6]), view_of([2.5, 2, 1.6], [0, 2, 1.6])
    assert visible_rooms(plan, mesh, [towards, away]).tolist() == [[True, True], [True, False]]
    assert visible_rooms(plan, mesh, towards).tolist() == [[True, True]]
    over = view_of([3.0, 2.0, 1.6], [3.0 + 1e-3, 2.0, 2.7])  # at the ceiling: the door's head is below the picture
    assert visible_rooms(plan, mesh, over).tolist() == [[True, False]]
    lost = view_of([20.0, 20.0, 1.0], [21.0, 20.0, 1.0])
    assert visible_rooms(plan, mesh, lost).all()


def test_nothing_is_covered_without_views_and_all_by_looking_everywhere():
    plan = one_room()
    mesh = build_structure(plan)
    assert coverage(plan, mesh, []).once == 0.0
    eyes = [[x, y, z] for x in (0.6, 4.4) for y in (0.6, 3.4) for z in (0.4, 2.4)]
    looks = np.vstack([np.eye(3), -np.eye(3)])
    views = [view_of(eye, np.array(eye) + look, fov=95.0) for eye in eyes for look in looks]
    share = coverage(plan, mesh, views)
    assert share.once == 1.0 and share.three == 1.0


def test_coverage_counts_views_and_grows_with_them():
    plan = two_rooms()
    mesh = build_structure(plan)
    views = [view_of([0.6, 2, 1.6], [5, 2, 1.2]), view_of([4.4, 1, 1.6], [0, 2, 1.2]), view_of([8.4, 2, 1.6], [5, 2, 1.2])]
    shares = [coverage(plan, mesh, views[:k]) for k in (1, 3)]
    assert 0.0 < shares[0].once < shares[1].once < 1.0
    assert shares[0].three == 0.0
    thrice = coverage(plan, mesh, views[:1] * 3)
    assert thrice.three == thrice.once == shares[0].once


def test_one_view_covers_what_its_gbuffer_shows():
    plan = one_room()
    mesh = build_structure(plan)
    view = view_of([0.7, 0.7, 1.5], [4, 3, 1.0])
    scene, points = build_ray_scene(mesh), surface_points(mesh, 4000)
    seen = times_seen(scene, points, [view.camera]) > 0
    gbuffer = cast(scene, dataclasses.replace(view.camera))
    world = unproject_depth(view.camera, gbuffer.depth.astype(np.float64)).reshape(-1, 3)
    gaps = np.array([np.linalg.norm(world - p, axis=1).min() for p in points.position])
    assert gaps[seen].max() < 0.35 and gaps[seen].mean() < gaps[~seen].mean()
    inside = in_picture(view.camera, points)
    np.testing.assert_array_equal(seen[inside], in_sight(scene, points, np.flatnonzero(inside), camera_center(view.camera)))
    assert not seen[~inside].any()


def test_backs_and_insides_are_not_reachable():
    plan = one_room()
    wardrobe = box([0.15, 1.0, 0.0], [0.75, 3.0, 2.0])
    mesh = assemble_scene(build_structure(plan), [wardrobe])
    points = surface_points(mesh, 6000)
    reached = reachable_points(plan, build_ray_scene(mesh), points)
    own = mesh.face_object[points.face] == 0
    back, front, under = (own & (points.normal @ np.array(axis) > 0.9) for axis in ((-1, 0, 0), (1, 0, 0), (0, 0, -1)))
    assert back.any() and under.any() and front.any()
    assert not reached[back].any() and not reached[under].any() and reached[front].all()


@settings(max_examples=8, deadline=None)
@given(st.integers(500, 3000))
def test_surface_points_stand_for_equal_areas_and_skip_the_skin(count):
    mesh = build_structure(two_rooms())
    points = surface_points(mesh, count)
    assert len(points.face) == count
    assert (mesh.face_kind[points.face] != SurfaceKind.EXTERIOR).all()
    corners = mesh.vertices[mesh.faces]
    area = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1) / 2
    inner = mesh.face_kind != SurfaceKind.EXTERIOR
    expected = count * area * inner / area[inner].sum()
    assert np.abs(np.bincount(points.face, minlength=len(area)) - expected).max() <= 1.0 + 1e-9
    offset = np.sum((points.position - corners[points.face, 0]) * points.normal, axis=1)
    assert np.abs(offset).max() < 1e-9
    assert len(some_points(points, points.position[:, 2] == 0).face) < count


def test_views_are_chosen_for_what_they_add():
    mesh = build_structure(one_room())
    scene, points = build_ray_scene(mesh), surface_points(mesh, 1000)
    both = Aims(eyes=np.tile([[2.5, 2.0, 1.6]], (2, 1)), looks=np.array([[-1.0, 0.0, 0.0], [1.0, 0.0, 0.0]]))
    start, half_extent = np.zeros(1000, int), (64 / 36 * np.tan(np.pi / 6), np.tan(np.pi / 6))
    assert sorted(choose_aims(scene, points, [both, both], start, half_extent=half_extent)) == [0, 1]
    seen = times_seen(scene, points, [view_of([2.5, 2, 1.6], [0, 2, 1.6]).camera])
    assert choose_aims(scene, points, [both], start + 3 * seen, half_extent=half_extent) == [1]
    assert (np.diff(VALUES) < 0).all()
