"""Laws of the exposed surface: whatever a camera sees, wherever it stands, is part of it; backs are not."""

import numpy as np
import pytest
from scipy.spatial import KDTree

from tests.geometry.plans import l_shaped, two_rooms
from tests.geometry.things import box
from wm.geometry.cameras.air import free
from wm.geometry.cameras.exposed_surface import exposed, room_eyes, room_surface
from wm.geometry.mesh.scene_mesh import assemble_scene
from wm.geometry.mesh.structure import build_structure
from wm.geometry.plan.footprint import interior_polygon
from wm.geometry.rays.pinhole import make_camera, unproject_depth
from wm.geometry.rays.raycast import build_ray_scene, cast
from wm.geometry.rays.surface_points import some_points
from wm.schema import CameraSettings

EDGE = 0.15


def furnished(plan):
    wardrobe = box([0.15, 1.0, 0.0], [0.75, 2.2, 2.0])
    return build_ray_scene(assemble_scene(build_structure(plan), [wardrobe]))


@pytest.mark.parametrize("plan", [two_rooms(), l_shaped()], ids=["two", "l"])
def test_what_any_camera_sees_is_exposed(plan):
    scene = furnished(plan)
    trees = []
    for room in range(len(plan.rooms)):
        surface = room_surface(scene.mesh, room, spacing=EDGE, detail_spacing=EDGE)
        eyes = room_eyes(plan, scene, room, CameraSettings())
        trees.append(KDTree(some_points(surface, exposed(scene, surface, eyes)).position))
    rng = np.random.default_rng(0)
    far = []
    for index in range(len(plan.rooms)):
        x0, y0, x1, y1 = interior_polygon(plan, index).bounds
        eyes = rng.uniform((x0, y0, 0.9), (x1, y1, 2.2), (30, 3))
        for eye in eyes[free(scene, eyes, 0.1)]:
            camera = make_camera(eye, eye + rng.normal(size=3), width=32, height=18, fov_deg=60.0)
            gbuffer = cast(scene, camera)
            points, room = unproject_depth(camera, gbuffer.depth), scene.mesh.face_room[gbuffer.face]
            far += [trees[k].query(points[gbuffer.hit & (room == k)])[0] for k in range(len(trees))]
    assert np.quantile(np.concatenate(far), 0.995) < EDGE


def test_backs_are_not_exposed_and_fronts_are():
    plan = two_rooms()
    scene = furnished(plan)
    surface = room_surface(scene.mesh, 0, spacing=EDGE, detail_spacing=EDGE / 2)
    seen = exposed(scene, surface, room_eyes(plan, scene, 0, CameraSettings()))
    own = scene.mesh.face_object[surface.face] == 0
    back, front, under = (own & (surface.normal @ np.array(axis) > 0.9) for axis in ((-1, 0, 0), (1, 0, 0), (0, 0, -1)))
    assert back.any() and not seen[back].any() and under.any() and not seen[under].any()
    assert front.any() and seen[front].all()


def test_the_surface_of_a_room_is_its_own_and_as_dense_as_asked():
    plan = two_rooms()
    scene = furnished(plan)
    surface = room_surface(scene.mesh, 0, spacing=EDGE, detail_spacing=EDGE / 2)
    assert (scene.mesh.face_room[surface.face] == 0).all()
    own = scene.mesh.face_object[surface.face] == 0
    top = own & (surface.normal[:, 2] > 0.9)
    assert 2.5 < top.sum() * (EDGE / 2) ** 2 / (0.6 * 1.2) < 3.5
    floor = surface.position[~own & (surface.normal[:, 2] > 0.9) & (surface.position[:, 2] < 0.01), :2]
    grid = np.stack(np.meshgrid(np.arange(1.0, 4.0, 0.05), np.arange(1.0, 3.0, 0.05)), -1).reshape(-1, 2)
    assert KDTree(floor).query(grid)[0].max() < EDGE
