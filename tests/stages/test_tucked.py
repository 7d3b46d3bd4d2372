"""Discs on the unseen side of a box stay out of sight of the cameras in front of it."""

import numpy as np
import trimesh

from wm.geometry.rays.pinhole import make_camera
from wm.geometry.rays.raycast import build_ray_scene
from wm.geometry.rays.surface_points import SurfacePoints
from wm.stages.tucked import ENDS, _in_view, tucked
from wm.types import Mesh


def test_discs_at_the_edges_of_a_back_side_are_drawn_out_of_sight():
    box = trimesh.creation.box((1.0, 1.0, 1.0))
    faces = np.asarray(box.faces, np.int32)
    none = np.full(len(faces), -1, np.int32)
    mesh = Mesh(vertices=np.asarray(box.vertices), faces=faces, face_room=none, face_object=none, face_kind=none + 1)
    scene = build_ray_scene(mesh)
    eyes = [np.array([x, -3.0, z]) for x in (-1.5, 0.0, 1.5) for z in (-1.5, 0.0, 1.5)]
    cameras = [make_camera(eye, np.zeros(3), width=64, height=64, fov_deg=60.0) for eye in eyes]
    x, z = (grid.ravel() for grid in np.meshgrid(np.linspace(-0.49, 0.49, 9), np.linspace(-0.49, 0.49, 9)))
    position = np.column_stack([x, np.full(len(x), 0.5), z])
    normal = np.tile([0.0, 1.0, 0.0], (len(x), 1))
    points = SurfacePoints(position, normal, np.zeros(len(x), int))
    wide = np.full(len(x), 0.1)

    def seen(centres, extents):
        ends = [centres + ENDS * sign * extents[:, [k]] * axis for k, axis in enumerate(np.eye(3)[[0, 2]]) for sign in (1, -1)]
        return np.any([_in_view(scene, end, cameras) for end in ends], axis=0)

    discs = tucked(scene, points, wide, cameras)
    assert seen(position, np.repeat(wide[:, None], 2, axis=1)).sum() > 20
    assert seen(discs.centres, discs.extents).sum() == 0
    inner = np.abs(position[:, [0, 2]]).max(axis=1) < 0.3
    np.testing.assert_array_equal(discs.centres[inner], position[inner])
    assert (discs.extents <= 0.1).all() and (discs.extents > 0.01).all()
