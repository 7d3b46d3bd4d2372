"""Laws of view planning: free air, the own room, numbers, names, what the views see; held-out views besides."""

import dataclasses
import functools

import numpy as np
import pytest
import shapely

from tests.geometry.plans import l_shaped, one_room, random_plan, rectangle, two_rooms
from tests.geometry.things import box
from wm.geometry.cameras.heldout import place_heldout
from wm.geometry.cameras.views import LOWER, place_cameras
from wm.geometry.cameras.visibility import coverage
from wm.geometry.mesh.scene_mesh import assemble_scene
from wm.geometry.mesh.structure import build_structure
from wm.geometry.plan.footprint import interior_polygon
from wm.geometry.plan.openings import portals
from wm.geometry.plan.records import FloorPlan
from wm.geometry.rays.pinhole import camera_center, camera_rotation
from wm.geometry.rays.raycast import build_ray_scene, cast_rays
from wm.geometry.rays.surface_points import surface_points
from wm.schema import CameraSettings

SMALL = CameraSettings(width=86, height=48)
WARDROBES = ([0.3, 0.3, 0.0], [0.9, 2.0, 2.2]), ([4.2, 0.3, 0.0], [4.8, 1.1, 1.9]), ([1.8, 3.2, 0.0], [3.2, 3.8, 2.0])


def furnished():
    """The two rooms with wardrobes where cameras would stand, a table and a lamp under the ceiling."""
    objects = [box(low, high) for low, high in WARDROBES]
    objects += [box([2.0, 1.4, 0.0], [3.2, 2.2, 0.75], label="table"), box([2.3, 1.6, 2.1], [2.7, 2.0, 2.8], label="lamp")]
    objects += [box([8.2, 1.5, 0.0], [8.8, 2.6, 1.8], room=1), box([5.5, 3.2, 0.0], [7.0, 3.8, 0.8], room=1)]
    plan = two_rooms()
    return plan, assemble_scene(build_structure(plan), objects), objects


CASES = {
    "one": lambda: (one_room(), build_structure(one_room())),
    "concave": lambda: (l_shaped(), build_structure(l_shaped())),
    "random": lambda: (random_plan(3, 3), build_structure(random_plan(3, 3))),
    "furnished": lambda: furnished()[:2],
}


@functools.cache
def case(name):
    plan, mesh = CASES[name]()
    views = place_cameras(plan, mesh, SMALL)
    return plan, mesh, views, place_heldout(plan, mesh, views, SMALL)


@pytest.fixture(params=CASES)
def planned(request):
    return case(request.param)


def centers(views):
    return np.array([camera_center(view.camera) for view in views])


def assert_free(mesh, points, clearance):
    """No surface within `clearance`, and no point inside a solid, by means other than `air.free`: by distance to samples of the
    surface, and by the nearest face on the way up."""
    samples = surface_points(mesh, 40_000).position
    for point in points:
        assert np.linalg.norm(samples - point, axis=1).min() > clearance
    up = np.tile([[0.013, 0.017, 1.0]], (len(points), 1))
    hits = cast_rays(build_ray_scene(mesh), points, up)
    assert hits.hit.all()
    corners = mesh.vertices[mesh.faces[hits.face]]
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    assert (np.sum(normal * up, axis=1) < 0).all()


def test_every_room_gets_its_kinds_of_views(planned):
    plan, _, views, _ = planned
    assert len({view.name for view in views}) == len(views)
    doors = [portal for portal in portals(plan) if portal.kind != "window"]
    for index, room in enumerate(plan.rooms):
        kinds = [view.kind for view in views if view.room == index]
        assert kinds.count("bootstrap") == 2 and kinds[:2] == ["bootstrap"] * 2
        assert kinds.count("overhead") == 8
        assert kinds.count("perimeter") >= 12 and len(kinds) >= 22
        assert kinds.count("doorway") == sum(index in portal.rooms for portal in doors)
        names = [view.name for view in views if view.room == index and view.kind == "perimeter"]
        assert names == [f"{room.id}/perimeter{k}" for k in range(len(names))]


def test_cameras_stand_in_free_air_inside_their_room(planned):
    plan, mesh, views, _ = planned
    assert_free(mesh, centers(views), 0.2)
    for view in views:
        if view.kind != "doorway":
            assert shapely.contains_xy(interior_polygon(plan, view.room), *camera_center(view.camera)[:2])


def test_no_view_stares_at_something_near(planned):
    _, mesh, views, _ = planned
    scene = build_ray_scene(mesh)
    looks = np.array([camera_rotation(view.camera)[2] for view in views])
    hits = cast_rays(scene, centers(views), looks)
    assert hits.t.min() > 0.5


def test_perimeter_views_differ_from_bootstrap_views(planned):
    _, _, views, _ = planned
    for view in views:
        if view.kind == "perimeter":
            near = [b for b in views if b.kind == "bootstrap" and b.room == view.room]
            cosines = [camera_rotation(b.camera)[2] @ camera_rotation(view.camera)[2] for b in near]
            assert max(cosines) < np.cos(np.radians(SMALL.prune_angle))


def test_overhead_views_are_higher_and_look_down(planned):
    _, _, views, _ = planned
    for view in views:
        if view.kind == "overhead":
            assert camera_center(view.camera)[2] > SMALL.eye_height and camera_rotation(view.camera)[2, 2] < -0.1
        height = camera_center(view.camera)[2]
        if view.kind == "bootstrap":
            assert height == pytest.approx(SMALL.eye_height)
        if view.kind == "perimeter":
            assert min(abs(height - SMALL.eye_height), abs(height - SMALL.eye_height + LOWER)) < 1e-9


def test_the_views_cover_the_reachable_surface(planned):
    plan, mesh, views, _ = planned
    share = coverage(plan, mesh, views)
    assert share.once > 0.97 and share.three > 0.9


def test_bootstrap_views_face_each_other_from_the_short_sides():
    first, second = (view.camera for view in case("one")[2][:2])
    np.testing.assert_allclose(np.sort([camera_center(first)[0], camera_center(second)[0]]), [0.55, 4.45], atol=1e-6)
    np.testing.assert_allclose(camera_rotation(first)[2], -camera_rotation(second)[2], atol=1e-6)
    np.testing.assert_allclose([camera_center(first)[1], camera_center(second)[1]], 2.0, atol=1e-6)


def test_the_same_scene_gives_the_same_views():
    plan, mesh, one, _ = case("furnished")
    two = place_cameras(plan, mesh, SMALL)
    assert [view.name for view in one] == [view.name for view in two]
    for a, b in zip(one, two):
        assert a.camera.T_cam_world.tobytes() == b.camera.T_cam_world.tobytes()


def test_settings_say_how_many():
    plan = one_room()
    settings = dataclasses.replace(SMALL, perimeter=3, overhead=0, doorway=False)
    kinds = [view.kind for view in place_cameras(plan, build_structure(plan), settings)]
    assert kinds == ["bootstrap"] * 2 + ["perimeter"] * 3


@pytest.mark.parametrize(("size", "height"), [((1.2, 7.0), 2.4), ((1.3, 1.6), 2.1), ((14.0, 12.0), 5.0)])
def test_corridors_closets_and_halls_have_their_views(size, height):
    plan = FloorPlan((rectangle("odd", 0, 0, *size, height=height),))
    mesh = build_structure(plan)
    views = place_cameras(plan, mesh, SMALL)
    assert len(views) >= 22
    assert_free(mesh, centers(views), 0.1)
    assert coverage(plan, mesh, views).once > 0.97


def test_a_room_without_a_free_spot_is_named():
    plan = two_rooms()
    block = box([5.2, 0.2, 0.0], [8.8, 3.8, 2.7], room=1)
    with pytest.raises(ValueError, match=r"room study: no free spot for a camera.*1 objects"):
        place_cameras(plan, assemble_scene(build_structure(plan), [block]), SMALL)


def test_heldout_views_are_free_and_apart_from_training(planned):
    plan, mesh, views, heldout = planned
    assert_free(mesh, centers(heldout), 0.15)
    gaps = np.linalg.norm(centers(heldout)[:, None] - centers(views), axis=-1)
    assert gaps.min() > 0.1
    assert len({view.name for view in heldout}) == len(heldout)
    assert all(view.kind == "heldout" for view in heldout)
    for index in range(len(plan.rooms)):
        assert sum(view.room == index for view in heldout) == SMALL.heldout_per_room


def test_heldout_views_look_at_objects_from_near():
    objects, near = furnished()[2], 0
    for view in case("furnished")[3]:
        eye, look = camera_center(view.camera), camera_rotation(view.camera)[2]
        for thing in objects:
            low, high = thing.vertices.min(axis=0), thing.vertices.max(axis=0)
            gap = np.linalg.norm(np.clip(eye, low, high) - eye)
            towards = (low + high) / 2 - eye
            near += thing.room == view.room and 0.6 <= gap <= 1.2 and look @ towards > 0.999 * np.linalg.norm(towards)
    assert near >= 4


def test_no_heldout_views_when_none_are_wanted():
    plan = one_room()
    assert place_heldout(plan, build_structure(plan), [], dataclasses.replace(SMALL, heldout_per_room=0)) == []
