"""The exported texture: every face is there, and looks up its own texels."""

import dataclasses

import numpy as np
import pytest

from tests.geometry.plans import two_rooms
from wm.geometry.mesh.glb import save_glb
from wm.geometry.mesh.structure import build_structure
from wm.geometry.texture import atlas_export
from wm.geometry.texture.atlas import build_atlas, texel_positions
from wm.geometry.texture.atlas_export import atlas_nodes, coarse_rooms


def ramp(points):
    """A colour that is affine in space: bilinear filtering finds it exactly."""
    return (0.1 + points * [0.08, 0.1, 0.2]).astype(np.float32)


def painted(known=1.0):
    mesh = build_structure(two_rooms())
    atlas = build_atlas(mesh, 0.05)
    weight = (np.random.default_rng(0).uniform(size=atlas.inside.shape) < known) * atlas.inside
    return mesh, dataclasses.replace(atlas, color=ramp(texel_positions(atlas)), weight=weight.astype(np.float32))


def areas(vertices, faces):
    a, b, c = (vertices[faces[:, k]] for k in range(3))
    return np.linalg.norm(np.cross(b - a, c - a), axis=1) / 2


def test_every_face_is_exported_once():
    mesh, atlas = painted()
    nodes = atlas_nodes(atlas, mesh)
    assert [node.name for node in nodes] == ["room 0", "room 1", "exterior"]
    assert sum(len(node.faces) for node in nodes) == len(mesh.faces)
    total = sum(areas(node.vertices, node.faces).sum() for node in nodes)
    assert total == pytest.approx(areas(mesh.vertices, mesh.faces).sum())


@pytest.mark.parametrize(("known", "tolerance"), [(1.0, 0.025), (0.7, 0.06)])
def test_a_point_of_a_face_finds_its_own_colour(known, tolerance):
    mesh, atlas = painted(known)
    rng = np.random.default_rng(1)
    for node in atlas_nodes(atlas, mesh)[:2]:
        assert node.texture is not None
        assert node.uv is not None
        assert node.uv.min() >= 0
        assert node.uv.max() <= 1
        share = rng.dirichlet(np.ones(3), len(node.faces))
        points = np.einsum("fk,fki->fi", share, node.vertices[node.faces])
        uv = np.einsum("fk,fki->fi", share, node.uv[node.faces])
        height, width, _ = node.texture.shape
        found = node.texture[(uv[:, 1] * height).astype(int), (uv[:, 0] * width).astype(int)] / 255
        assert np.abs(found - ramp(points)).max() < tolerance  # nearest texel of 5 cm: 0.2 / m * 3.5 cm, and holes between


def test_a_face_never_reaches_into_another_chart():
    """Texels are squares in the texture: each chart's part is its surface over the texel area."""
    mesh, atlas = painted()
    for node in atlas_nodes(atlas, mesh)[:2]:
        assert node.texture is not None
        assert node.uv is not None
        height, width, _ = node.texture.shape
        flat = np.concatenate([node.uv * [width, height], np.zeros((len(node.uv), 1))], axis=1)
        np.testing.assert_allclose(areas(flat, node.faces) * 0.05**2, areas(node.vertices, node.faces), rtol=1e-6, atol=1e-9)


def test_unpainted_charts_are_grey_and_the_file_is_written(tmp_path):
    mesh, atlas = painted()
    nodes = atlas_nodes(dataclasses.replace(atlas, weight=np.zeros_like(atlas.weight)), mesh)
    assert nodes[0].texture is not None
    assert set(np.unique(nodes[0].texture)) <= {0, 128}
    save_glb(tmp_path / "scaffold.glb", nodes)
    assert (tmp_path / "scaffold.glb").stat().st_size > 1000


def test_a_mesh_that_is_not_the_atlas_s_is_refused():
    mesh, atlas = painted()
    with pytest.raises(ValueError, match="faces"):
        atlas_nodes(dataclasses.replace(atlas, face_chart=atlas.face_chart[:-1]), mesh)


@pytest.mark.parametrize(("largest", "coarse"), [(110, False), (60, True)])
def test_no_image_is_larger_than_viewers_show_and_points_find_their_colours(monkeypatch, largest, coarse):
    monkeypatch.setattr(atlas_export, "LARGEST_SIDE", largest)
    mesh, atlas = painted()
    *rooms, exterior = atlas_nodes(atlas, mesh)
    assert max(max(node.texture.shape[:2]) for node in rooms) <= largest
    assert len(rooms) > 2 and len({node.name for node in rooms}) == len(rooms)
    assert {node.name.split(" part ")[0] for node in rooms} == {"room 0", "room 1"}
    assert sum(len(node.faces) for node in [*rooms, exterior]) == len(mesh.faces)
    assert bool(coarse_rooms(atlas)) == coarse
    for node in rooms:
        middle = node.vertices[node.faces].mean(1)
        column, row = (node.uv[node.faces].mean(1) * node.texture.shape[1::-1]).astype(int).T
        assert np.abs(node.texture[row, column] / 255 - ramp(middle)).max() < (0.07 if coarse else 0.025)
