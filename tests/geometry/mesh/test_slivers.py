"""Flat triangles are flipped away; the mesh stays closed and keeps its volume."""

import itertools

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from tests.geometry.mesh.test_structure import assert_watertight
from wm.geometry.mesh.slivers import HEIGHT, flip_slivers, heights
from wm.types import Mesh


def fan(points_on_edge: int) -> tuple[np.ndarray, np.ndarray]:
    """A tetrahedron one edge of which (0 to 1) carries extra points, filled on one side with flat triangles."""
    vertices = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], float)
    along = np.linspace(0, 1, points_on_edge + 2)[1:-1]
    vertices = np.concatenate([vertices, np.column_stack([along, np.zeros((points_on_edge, 2))])])
    chain = [0, *range(4, 4 + points_on_edge), 1]
    front = [[p, q, 3] for p, q in itertools.pairwise(chain)]  # the face 0, 1, 3 as a fan
    flat = [[chain[k + 1], chain[k], 1] for k in range(points_on_edge)]  # between the chain and the straight edge 0, 1
    return vertices, np.array([[0, 2, 1], [1, 2, 3], [2, 0, 3], *front, *flat], np.int32)


def test_chains_of_flat_triangles_disappear():
    for count in (1, 2, 5):
        vertices, faces = fan(count)
        labels = np.arange(len(faces))
        assert (heights(vertices, faces) < 1e-9).sum() == count
        flipped, names = flip_slivers(vertices, faces, labels)
        assert heights(vertices, flipped).min() > 1e-3
        assert set(names) <= set(range(3 + count + 1))  # no flat triangle's label is left
        fields = {key: np.zeros(len(flipped), np.int32) for key in ("face_room", "face_kind", "face_object")}
        assert_watertight(Mesh(vertices=vertices, faces=flipped, **fields))
        a, b, c = (vertices[flipped[:, k]] for k in range(3))
        assert abs(np.sum(a * np.cross(b, c)) / 6 - 1 / 6) < 1e-12


@given(st.integers(0, 2**32 - 1), st.integers(1, 5), st.integers(0, 2))
def test_a_flip_leaves_no_flat_triangle_and_corners_that_coincide_stay(seed, count, doubled):
    """Where a chain has a point twice, the triangle between the two has no height and no flip gives it one."""
    vertices, faces = fan(count)
    rng = np.random.default_rng(seed)
    twice = rng.choice(count, min(doubled, count - 1), replace=False) + 4
    vertices[twice] = vertices[np.where(twice + 1 < len(vertices), twice + 1, 1)]
    labels = np.arange(len(faces))
    flipped, _ = flip_slivers(vertices, faces, labels)
    before, after = heights(vertices, faces) < HEIGHT, heights(vertices, flipped) < HEIGHT
    changed = (flipped != faces).any(axis=1)
    assert not after[changed].any() and not (after & ~before).any()
    assert after.sum() == before.sum() - np.count_nonzero(before & changed)
    fields = {key: np.zeros(len(flipped), np.int32) for key in ("face_room", "face_kind", "face_object")}
    assert_watertight(Mesh(vertices=vertices, faces=flipped, **fields))


def test_a_mesh_without_flat_triangles_is_returned_as_it_is():
    vertices, faces = fan(0)
    labels = np.arange(len(faces))
    flipped, names = flip_slivers(vertices, faces, labels)
    assert flipped is faces and names is labels
