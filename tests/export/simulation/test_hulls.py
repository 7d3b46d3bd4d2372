"""Hulls are closed, convex, thick enough and small enough, whatever points they are of."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from wm.export.simulation.hulls import MOST_VERTICES, THINNEST, convex_hull
from wm.export.simulation.parts import volume


def assert_is_solid(hull):
    """Every point lies behind every face, and every edge is there once in either direction."""
    corners = hull.vertices[hull.faces]
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    behind = np.einsum("fi,fvi->fv", normal, hull.vertices[None] - corners[:, :1])
    assert behind.max() < 1e-9
    edges = np.stack([hull.faces, np.roll(hull.faces, -1, axis=1)], axis=2).reshape(-1, 2).tolist()
    assert sorted(map(tuple, edges)) == sorted((b, a) for a, b in edges)
    assert len(hull.vertices) <= MOST_VERTICES


@given(st.integers(0, 10_000), st.integers(4, 400), st.floats(0.002, 20))
def test_a_hull_is_a_convex_solid_within_its_points(seed, count, size):
    points = np.random.default_rng(seed).normal(size=(count, 3)) * size
    hull = convex_hull(points)
    assert_is_solid(hull)
    assert {tuple(row) for row in hull.vertices.tolist()} <= {tuple(row) for row in points.tolist()} or size < 0.01


@pytest.mark.parametrize("flat", [1, 2])
def test_flat_things_get_a_thickness_of_a_millimetre(flat):
    points = np.random.default_rng(flat).uniform(-1, 1, (30, 3))
    points[:, -flat:] = 0.5
    hull = convex_hull(points)
    assert_is_solid(hull)
    extent = np.ptp(hull.vertices, axis=0)
    np.testing.assert_allclose(extent[-flat:], THINNEST, rtol=1e-6)
    np.testing.assert_allclose(extent[:-flat], np.ptp(points, axis=0)[:-flat], atol=1e-9)


def test_a_round_foot_keeps_its_height_and_a_rim_to_stand_on():
    turn = np.linspace(0, 2 * np.pi, 200, endpoint=False)
    rings = [np.stack([0.3 * np.cos(turn), 0.3 * np.sin(turn), np.full(200, z)], axis=1) for z in (0.0, 0.1, 0.8)]
    hull = convex_hull(np.concatenate(rings))
    rim = hull.vertices[hull.vertices[:, 2] == 0.0]
    assert len(rim) >= 8
    np.testing.assert_allclose(np.ptp(hull.vertices, axis=0), [0.6, 0.6, 0.8], atol=1e-3)
    assert volume(hull.vertices[hull.faces]) > 0.9 * np.pi * 0.09 * 0.8


def test_boxes_along_the_axes_are_told_and_others_are_not():
    corners = np.array([[x, y, z] for x in (0, 1) for y in (0, 2) for z in (0, 3)], float)
    center, size = convex_hull(corners + 5).box
    np.testing.assert_allclose([center, size], [[5.5, 6, 6.5], [1, 2, 3]])
    turned = corners @ np.array([[0.6, 0.8, 0], [-0.8, 0.6, 0], [0, 0, 1]])
    assert convex_hull(turned).box is None
    assert convex_hull(corners[:-1]).box is None


def test_one_point_has_no_hull():
    with pytest.raises(ValueError, match="one point"):
        convex_hull(np.ones((5, 3)))
