"""Records that a user makes by hand, and what `help` says of them."""

import dataclasses
import inspect

import numpy as np
import pytest

from wm import splat, types
from wm.geometry import atlas_nodes, build_atlas, build_ray_scene, cast, make_camera
from wm.types import OUTSIDE, Mesh, SurfaceKind

SQUARE = np.array([[0.0, 0, 0], [2, 0, 0], [2, 2, 0], [0, 2, 0]])
HALVES = [[0, 1, 2], [0, 2, 3]]


def test_a_mesh_of_triangles_alone_is_cast_textured_and_exported():
    mesh = Mesh.from_triangles(SQUARE, HALVES)
    assert (mesh.face_room == 0).all() and (mesh.face_kind == SurfaceKind.WALL).all() and (mesh.face_object == OUTSIDE).all()
    camera = make_camera(np.array([1.0, 1.0, 2.0]), np.array([1.0, 1.01, 0.0]), width=8, height=6, fov_deg=30.0)
    seen = cast(build_ray_scene(mesh), camera)
    assert seen.hit.all()
    np.testing.assert_allclose(seen.depth, 2, atol=0.02)
    assert [node.name for node in atlas_nodes(build_atlas(mesh, 0.1), mesh)] == ["room 0"]
    assert len(mesh.to_trimesh().faces) == 2


def test_labels_are_one_for_all_or_one_a_face():
    mesh = Mesh.from_triangles(SQUARE.tolist(), HALVES, face_room=3, face_kind=[SurfaceKind.FLOOR, SurfaceKind.WALL])
    assert mesh.face_room.tolist() == [3, 3] and mesh.face_kind.tolist() == [1, 0] and mesh.face_kind.dtype == np.int32


@pytest.mark.parametrize(
    ("vertices", "faces", "says"),
    [
        (SQUARE[:, :2], HALVES, r"vertices has shape \(4, 2\)"),
        (SQUARE, [[0, 1, 2, 3]], r"faces has shape \(1, 4\)"),
        (SQUARE, [[0, 1, 4]], "from 0 to 3"),
        (SQUARE, [[0, 1, -1]], "from 0 to 3"),
        (SQUARE, [[0, 1, 2.5]], "whole numbers"),
        (SQUARE * np.nan, HALVES, "not finite"),
    ],
)
def test_triangles_that_are_none_are_named(vertices, faces, says):
    with pytest.raises(ValueError, match=says):
        Mesh.from_triangles(vertices, faces)


RECORDS = [
    *(types.Atlas, types.Camera, types.GBuffer, types.Gaussians, types.Mesh, types.Render, types.SceneObject, types.Texture),
    *(types.View, splat.DepthError, splat.Fit, splat.FitPoint, splat.NormalError, splat.Projected, splat.ReprojectionError),
    *(splat.SceneFit, splat.TilePlan, splat.TracedPlan, splat.TrainingView),
]


@pytest.mark.parametrize("record", RECORDS, ids=lambda record: record.__name__)
def test_help_explains_every_field(record):
    explained = {name.strip() for line in inspect.getdoc(record).splitlines() for name in line.split(":")[0].split(",")}
    assert {field.name for field in dataclasses.fields(record)} <= explained
