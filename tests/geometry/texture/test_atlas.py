"""The atlas covers exactly the surface, in charts that are planar and of one room and one kind."""

import dataclasses

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from wm.geometry.texture.atlas import build_atlas, chart_image, texel_charts, texel_positions
from wm.types import OUTSIDE, Mesh, SurfaceKind


def quads(*parts):
    """A mesh of unwelded parallelograms (corner, u, v, room, kind): normals along u x v."""
    vertices = np.concatenate([np.add(o, [[0, 0, 0], u, np.add(u, v), v]).astype(float) for o, u, v, _, _ in parts])
    faces = np.concatenate([4 * k + np.array([[0, 1, 2], [0, 2, 3]]) for k in range(len(parts))]).astype(np.int32)
    labels = np.repeat(np.array([[room, kind] for *_, room, kind in parts], np.int32), 2, axis=0)
    return Mesh(
        vertices=vertices,
        faces=faces,
        face_room=labels[:, 0],
        face_kind=labels[:, 1],
        face_object=np.full(len(faces), OUTSIDE, np.int32),
    )


def moved(mesh, angle, shift):
    turn = np.array([[np.cos(angle), -np.sin(angle), 0], [np.sin(angle), np.cos(angle), 0], [0, 0, 1]])
    return dataclasses.replace(mesh, vertices=mesh.vertices @ turn.T + shift)


WALL, FLOOR, CEILING, PANE, EXTERIOR = (int(getattr(SurfaceKind, k)) for k in ("WALL", "FLOOR", "CEILING", "PANE", "EXTERIOR"))


def wall_with_window(room=0):
    """A 3 x 2 m wall in the plane y = 0 facing +y, as a frame of four quads around a 1 x 0.8 m hole."""
    right, up = [-1, 0, 0], [0, 0, 1]
    return quads(
        ([3, 0, 0], np.multiply(right, 3), np.multiply(up, 0.7), room, WALL),
        ([3, 0, 1.5], np.multiply(right, 3), np.multiply(up, 0.5), room, WALL),
        ([3, 0, 0.7], np.multiply(right, 1), np.multiply(up, 0.8), room, WALL),
        ([1, 0, 0.7], np.multiply(right, 1), np.multiply(up, 0.8), room, WALL),
    )


@settings(max_examples=20, deadline=None)
@given(
    st.floats(0, 2 * np.pi),
    st.tuples(*[st.floats(-50, 50)] * 3),
    st.sampled_from([0.02, 0.031, 0.05]),
)
def test_charts_follow_the_surface_wherever_it_stands(angle, shift, texel):
    mesh = moved(wall_with_window(), angle, np.array(shift))
    atlas = build_atlas(mesh, texel)
    assert atlas.chart_start.shape == (1,)
    assert set(atlas.face_chart) == {0}
    frame = np.stack([atlas.chart_u[0], atlas.chart_v[0], atlas.chart_normal[0]])
    np.testing.assert_allclose(frame @ frame.T, np.eye(3), atol=1e-9)
    assert np.linalg.det(frame) == pytest.approx(1)
    np.testing.assert_allclose(atlas.chart_v[0], [0, 0, 1], atol=1e-9)  # walls have v upwards
    local = moved(Mesh(**{**vars(mesh), "vertices": texel_positions(atlas) - shift}), -angle, 0).vertices
    np.testing.assert_allclose(local[:, 1], 0, atol=1e-8)
    x, z = local[:, 0], local[:, 2]
    slack = 1e-5
    within = (x > slack) & (x < 3 - slack) & (z > slack) & (z < 2 - slack)
    in_hole = (x > 1 + slack) & (x < 2 - slack) & (z > 0.7 + slack) & (z < 1.5 - slack)
    near_hole = (x > 1 - slack) & (x < 2 + slack) & (z > 0.7 - slack) & (z < 1.5 + slack)
    assert atlas.inside[within & ~near_hole].all()
    assert not atlas.inside[in_hole].any()


@pytest.mark.parametrize("texel", [0.3, 0.1, 0.03, 0.01])
def test_inside_area_converges_to_the_surface(texel):
    atlas = build_atlas(moved(wall_with_window(), 0.3, 0), texel)
    error = abs(atlas.inside.sum() * texel**2 - (6 - 0.8))
    assert error <= 4 * texel  # a row or column of texels along every edge, at worst


@settings(max_examples=40, deadline=None)
@given(st.lists(st.tuples(st.floats(0, 3), st.floats(0, 3)), min_size=3, max_size=3))
def test_a_triangle_is_rasterised_exactly(points):
    corners = np.array([(*p, 0.0) for p in points])
    area = 0.5 * np.cross(corners[1] - corners[0], corners[2] - corners[0])[2]
    if abs(area) < 1e-3:
        return
    corners = corners if area > 0 else corners[::-1]
    mesh = Mesh(
        vertices=corners,
        faces=np.array([[0, 1, 2]], np.int32),
        face_room=np.zeros(1, np.int32),
        face_kind=np.full(1, FLOOR, np.int32),
        face_object=np.full(1, OUTSIDE, np.int32),
    )
    atlas = build_atlas(mesh, 0.05)
    p = texel_positions(atlas)[:, :2]
    edges = [(corners[k, :2], corners[(k + 1) % 3, :2]) for k in range(3)]
    distance = np.stack([((b - a)[0] * (p - a)[:, 1] - (b - a)[1] * (p - a)[:, 0]) / np.linalg.norm(b - a) for a, b in edges])
    deepest = distance.min(axis=0)
    assert atlas.inside[deepest > 1e-6].all()
    assert not atlas.inside[deepest < -1e-6].any()


def test_room_kind_plane_and_gap_each_part_charts():
    mesh = quads(
        ([0, 0, 0], [1, 0, 0], [0, 1, 0], 0, FLOOR),
        ([1, 0, 0], [1, 0, 0], [0, 1, 0], 0, FLOOR),  # touches the first: one chart
        ([2, 0, 0], [1, 0, 0], [0, 1, 0], 1, FLOOR),  # another room
        ([0, 1, 0], [1, 0, 0], [0, 1, 0], 0, PANE),  # another kind
        ([1, 1, 0.01], [1, 0, 0], [0, 1, 0], 0, FLOOR),  # a step of 1 cm
        ([0, 5, 0], [1, 0, 0], [0, 1, 0], 0, FLOOR),  # the first plane again, far away
        ([0, 0, 0], [0, 1, 0], [1, 0, 0], 0, FLOOR),  # the first from below
        ([0, 9, 0], [1, 0, 0], [0, 1, 0], OUTSIDE, EXTERIOR),
    )
    atlas = build_atlas(mesh, 0.1)
    np.testing.assert_array_equal(atlas.face_chart, np.repeat([0, 0, 1, 2, 3, 4, 5, -1], 2))
    np.testing.assert_array_equal(atlas.chart_room, [0, 1, 0, 0, 0, 0])
    np.testing.assert_array_equal(atlas.chart_kind, [FLOOR, FLOOR, PANE, FLOOR, FLOOR, FLOOR])
    np.testing.assert_array_equal(atlas.chart_shape[0], [10, 20])
    np.testing.assert_array_equal(atlas.chart_normal[5], [0, 0, -1])


def test_objects_and_empty_faces_have_no_chart():
    mesh = wall_with_window()
    objects = mesh.face_object.copy()
    objects[:2] = 0
    collapsed = mesh.faces.copy()
    collapsed[2] = collapsed[2, 0]
    atlas = build_atlas(dataclasses.replace(mesh, face_object=objects, faces=collapsed), 0.1)
    np.testing.assert_array_equal(atlas.face_chart < 0, [True, True, True] + [False] * 5)


def test_a_mesh_without_structure_has_an_empty_atlas():
    mesh = wall_with_window()
    atlas = build_atlas(dataclasses.replace(mesh, face_object=np.zeros(8, np.int32)), 0.1)
    assert atlas.inside.shape == (0,)
    assert texel_positions(atlas).shape == (0, 3)


@pytest.mark.parametrize("width", [0.001, 0.009, 0.0201])
def test_a_strip_narrower_than_a_texel_still_has_texels(width):
    atlas = build_atlas(quads(([0, 0, 0], [1, 0, 0], [0, width, 0], 0, FLOOR)), 0.02)
    assert atlas.inside.all()
    assert (np.abs(texel_positions(atlas)[:, 1] - width / 2) <= 0.0101).all()


def test_texels_of_some_charts_are_those_texels():
    mesh = quads(([0, 0, 0], [1, 0, 0], [0, 1, 0], 0, FLOOR), ([0, 0, 3], [0, 1, 0], [1, 0, 0], 0, CEILING))
    atlas = build_atlas(mesh, 0.1)
    every, chart = texel_positions(atlas), texel_charts(atlas)
    np.testing.assert_array_equal(texel_positions(atlas, np.array([1])), every[chart == 1])
    np.testing.assert_array_equal(chart_image(atlas, 1, every).reshape(-1, 3), every[chart == 1])
    assert chart_image(atlas, 0, every).shape == (10, 10, 3)


@pytest.mark.parametrize("texel", [0.0, -1.0, np.nan, np.inf])
def test_an_impossible_texel_size_is_refused(texel):
    with pytest.raises(ValueError, match="texel_size"):
        build_atlas(wall_with_window(), texel)
