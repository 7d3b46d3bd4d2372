"""Meshes with more faces than wanted, decimated by the package of the extra `sam3d`."""

import numpy as np
import pytest

from tests.models.reconstruction.test_model_mesh import colors_at, painted_sphere, shown
from wm.models.reconstruction.model_mesh import model_mesh

pytest.importorskip("fast_simplification")


def test_a_mesh_of_too_many_faces_is_decimated():
    content = painted_sphere(5).export(file_type="glb")
    thing = model_mesh(content, label="stool", room=1, most_faces=500, texels=40_000)
    points, colors = shown(thing)
    assert len(thing.faces) <= 500
    off = np.abs(np.linalg.norm(points, axis=1) - 0.25)
    assert off.mean() < 0.003 and off.max() < 0.015  # a face of 6 cm lies up to a few millimetres inside the sphere
    upright = points @ np.array([[1, 0, 0], [0, 0, -1], [0, 1, 0]])
    assert np.median(np.abs(colors - colors_at(upright))) < 0.02
    again = model_mesh(content, label="stool", room=1, most_faces=500, texels=40_000)
    assert again.vertices.tobytes() == thing.vertices.tobytes() and again.texture.image.tobytes() == thing.texture.image.tobytes()
