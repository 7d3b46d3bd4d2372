"""A model's mesh file as an object: its colours survive decimation, and what cannot be used is refused."""

import dataclasses
import sys

import numpy as np
import pytest
import trimesh
from hypothesis import given, settings
from hypothesis import strategies as st

from wm.geometry.mesh.object_colors import object_colors
from wm.models.reconstruction.baking import baked
from wm.models.reconstruction.model_mesh import model_mesh
from wm.models.reconstruction.surface_distance import surface_distance
from wm.services.faults import MissingExtraError, RefusedError
from wm.types import SceneObject

WIDE = {"label": "stool", "room": 1, "most_faces": 10_000, "texels": 50_000}


def painted_sphere(levels: int) -> trimesh.Trimesh:
    """A sphere of half a metre whose colours vary smoothly with the place."""
    mesh = trimesh.creation.icosphere(levels, 0.25)
    mesh.visual.vertex_colors = np.round(colors_at(mesh.vertices) * 255).astype(np.uint8)
    return mesh


def colors_at(points: np.ndarray) -> np.ndarray:
    return 0.5 + 0.4 * np.sin(6 * points + [0.0, 1.0, 2.0])


def shown(thing: SceneObject, count: int = 2000) -> tuple[np.ndarray, np.ndarray]:
    """(points [n, 3] of a thing's surface, their colours [n, 3])."""
    rng = np.random.default_rng(0)
    face = rng.integers(len(thing.faces), size=count)
    u, v = np.sort(rng.random((2, count)), axis=0)
    barycentric = np.stack([u, v - u], axis=1)
    corners = thing.vertices[thing.faces[face]]
    points = corners[:, 0] + u[:, None] * (corners[:, 1] - corners[:, 0]) + (v - u)[:, None] * (corners[:, 2] - corners[:, 0])
    return points, object_colors([thing], np.zeros(count, np.intp), face, barycentric)


def test_a_small_mesh_is_read_as_it_is():
    thing = model_mesh(painted_sphere(2).export(file_type="glb"), **WIDE)
    points, colors = shown(thing)
    assert (thing.label, thing.room, len(thing.faces)) == ("stool", 1, 320)
    upright = points @ np.array([[1, 0, 0], [0, 0, -1], [0, 1, 0]])  # z up to y up
    np.testing.assert_allclose(colors, colors_at(upright), atol=0.06)


@pytest.mark.parametrize("texels", [10_000, pytest.param(90_000, marks=pytest.mark.slow)])
def test_the_colours_of_a_fine_mesh_are_baked_into_a_coarse_one(texels):
    fine = model_mesh(painted_sphere(4).export(file_type="glb"), **WIDE)
    coarse = trimesh.creation.icosphere(2, 0.25)
    thing = baked(fine, np.asarray(coarse.vertices), np.asarray(coarse.faces, np.int32), texels=texels)
    points, colors = shown(thing)
    upright = (0.25 * points / np.linalg.norm(points, axis=1, keepdims=True)) @ np.array([[1, 0, 0], [0, 0, -1], [0, 1, 0]])
    assert np.median(np.abs(colors - colors_at(upright))) < 0.02
    assert np.abs(colors - colors_at(upright)).max() < 0.12
    assert thing.texture is not None and 0.3 < np.prod(thing.texture.image.shape[:2]) / texels < 1.4
    np.testing.assert_allclose(thing.slot_colors[0], colors.mean(axis=0), atol=0.03)


def test_slots_and_the_two_sides_of_a_sheet_keep_their_colours():
    """A board of 4 mm, red above and blue below, whose lower side glows."""
    board = trimesh.creation.box(extents=[1, 1, 0.004]).subdivide().subdivide()
    below = board.face_normals[:, 2] < -0.5
    fine = SceneObject(
        label="board", room=0, support="floor", vertices=np.asarray(board.vertices), faces=np.asarray(board.faces, np.int32),
        face_slot=below.astype(np.int32), slots=("top", "bottom"),
        slot_colors=np.array([[0.8, 0.1, 0.1], [0.1, 0.1, 0.8]], np.float32),
        T_world_object=np.eye(4), size=np.array([1, 1, 0.004]), emission=np.array([0, 1.5], np.float32),
    )  # fmt: skip
    coarse = trimesh.creation.box(extents=[1, 1, 0.004])
    thing = baked(fine, np.asarray(coarse.vertices), np.asarray(coarse.faces, np.int32), texels=3000)
    level = np.abs(coarse.face_normals[:, 2]) > 0.5
    np.testing.assert_array_equal(thing.face_slot[level], (coarse.face_normals[level, 2] < 0).astype(int))
    flat = dataclasses.replace(thing, faces=thing.faces[level], face_slot=thing.face_slot[level], texture=dataclasses.replace(
        thing.texture, corner_uv=thing.texture.corner_uv[level]))  # fmt: skip
    points, colors = shown(flat)
    np.testing.assert_allclose(colors, fine.slot_colors[(points[:, 2] < 0).astype(int)], atol=0.01)
    np.testing.assert_array_equal(thing.emission, fine.emission)


def test_without_the_package_that_decimates_its_extra_is_named(monkeypatch):
    monkeypatch.setitem(sys.modules, "fast_simplification", None)
    with pytest.raises(MissingExtraError, match=r"fast_simplification is not installed: pip install 'wm\[sam3d\]'"):
        model_mesh(painted_sphere(2).export(file_type="glb"), label="stool", room=0, most_faces=100, texels=1000)


def triangle(corners) -> bytes:
    return trimesh.Trimesh(np.array(corners), [[0, 1, 2]], process=False).export(file_type="glb")


GLB = painted_sphere(1).export(file_type="glb")
BROKEN = {
    "empty": b"", "text": b"<html>502</html>", "cut": GLB[: len(GLB) // 2], "header only": GLB[:20],
    "no triangles": trimesh.PointCloud(np.eye(3)).export(file_type="glb"),
    "not finite": triangle([[np.nan, 0, 0], [1, 0, 0], [0, 1, 0]]), "no area": triangle(np.zeros((3, 3))),
}  # fmt: skip


@pytest.mark.parametrize("fault", BROKEN)
def test_a_broken_file_is_a_refusal(fault):
    with pytest.raises(RefusedError, match=r"its mesh cannot be used: mesh\.glb"):
        model_mesh(BROKEN[fault], **WIDE)


@settings(max_examples=8)
@given(st.integers(0, 10_000), st.floats(0.001, 0.4))
def test_distances_from_a_box_are_exact(seed, away):
    rng = np.random.default_rng(seed)
    mesh = trimesh.creation.box(extents=[0.6, 0.5, 0.4])
    axis, sign = rng.integers(3), rng.choice([-1.0, 1.0])
    points = rng.uniform(-0.5, 0.5, (20, 3)) * [0.6, 0.5, 0.4]
    points[:, axis] = sign * ([0.6, 0.5, 0.4][axis] / 2 + away)
    np.testing.assert_allclose(surface_distance(points, np.asarray(mesh.vertices), np.asarray(mesh.faces)), away, atol=1e-9)
