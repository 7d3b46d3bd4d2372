"""An object's texture: every face finds its own texels in the packed image, and nothing else's."""

import dataclasses

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from tests.geometry.things import box
from wm.geometry.mesh.object_colors import object_colors
from wm.geometry.texture.atlas import build_atlas, texel_charts, texel_positions
from wm.geometry.texture.chart_texture import chart_texture
from wm.types import Mesh, Texture

PLAIN = (0.3, 0.6, 0.1)


def ramp(points):
    """A colour that is affine in space: bilinear reading finds it exactly, but for 8 bits."""
    return (0.1 + points * [0.2, 0.25, 0.3]).astype(np.float32)


def textured(known=(True,) * 6, texel=0.05):
    """A box whose known sides are coloured by `ramp`; the colours of its atlas elsewhere are wild."""
    thing = box([0.1, 0.2, 0], [1.3, 0.9, 0.8], PLAIN)
    zero = np.zeros(len(thing.faces), np.int32)
    mesh = Mesh(vertices=thing.vertices, faces=thing.faces, face_room=zero, face_kind=zero + 5, face_object=zero)
    atlas = build_atlas(mesh, texel, thing.face_slot)
    color = ramp(texel_positions(atlas)) * atlas.inside[:, None]
    weight = np.array(known, np.float32)[texel_charts(atlas)] * atlas.inside
    atlas = dataclasses.replace(atlas, color=color, weight=weight)
    image, corner_uv = chart_texture(atlas, thing.vertices[thing.faces], np.tile(np.float32(PLAIN), (6, 1)))
    return dataclasses.replace(thing, texture=Texture(image=image, corner_uv=corner_uv, slots=np.array([True]))), atlas


def read(thing, seed=0, count=400):
    """(colours, places, faces) at points of the object, scattered."""
    rng = np.random.default_rng(seed)
    face = rng.integers(len(thing.faces), size=count)
    share = rng.dirichlet(np.ones(3), count)
    points = np.einsum("nk,nki->ni", share, thing.vertices[thing.faces[face]])
    return object_colors([thing], np.zeros(count, np.int64), face, share[:, 1:].astype(np.float32)), points, face


def test_without_a_texture_points_have_their_slots_colour():
    colors, *_ = read(box([0, 0, 0], [1, 1, 1], PLAIN))
    np.testing.assert_array_equal(colors, np.tile(np.float32(PLAIN), (len(colors), 1)))


@given(st.integers(0, 10_000), st.floats(0.02, 0.2))
def test_a_point_of_a_face_finds_its_own_colour(seed, texel):
    """Within half a texel of a chart's edge its last texels continue: 0.3 a metre over half a texel."""
    thing, _ = textured(texel=texel)
    colors, points, _ = read(thing, seed)
    assert np.abs(colors - ramp(points)).max() < 0.5 / 255 + 0.3 * 0.75 * texel


def test_sides_of_which_nothing_is_known_are_plain_and_cost_a_pixel():
    thing, atlas = textured(known=(True, False, False, False, False, False))
    colors, points, face = read(thing)
    side = atlas.face_chart[face] == 0
    assert np.abs(colors[side] - ramp(points[side])).max() < 0.02
    np.testing.assert_allclose(colors[~side], np.tile(PLAIN, ((~side).sum(), 1)), atol=0.5 / 255 + 1e-6)
    everything, _ = textured()
    assert thing.texture.image.size < 0.4 * everything.texture.image.size


def test_objects_are_told_apart():
    first, second = textured()[0], box([3, 3, 0], [4, 4, 1], PLAIN)
    colors = object_colors([first, second], np.array([1, 0, 1]), np.array([3, 3, 5]), np.full((3, 2), 0.3, np.float32))
    np.testing.assert_array_equal(colors[[0, 2]], np.tile(np.float32(PLAIN), (2, 1)))
    assert np.abs(colors[1] - PLAIN).max() > 0.02
