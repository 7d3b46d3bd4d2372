"""The look of objects: of one with a texture it is the texture's colours, in the gloss of its material."""

import dataclasses

import numpy as np

from tests.offline.world.boxes import box
from wm.color import to_linear
from wm.offline.style.theme import style_of
from wm.offline.world.pieces import build_pieces, look
from wm.types import Texture

STYLE = style_of("gothic library")


def test_textured_faces_have_the_textures_colours_and_others_stay_as_they_are():
    table, sofa = box("table", (0, 0, 0), (1, 1, 1), "dark_wood"), box("sofa", (2, 0, 0), (3, 1, 1), "velvet")
    rng = np.random.default_rng(0)
    image = rng.integers(40, 200, (1, 12, 3), dtype=np.uint8)
    corner_uv = np.tile(((np.arange(12) + 0.5) / 12)[:, None, None], (1, 3, 2)).astype(np.float32)  # a pixel a face
    texture = Texture(image=image, corner_uv=corner_uv, slots=np.array([True]))
    face, places = np.arange(24), rng.dirichlet(np.ones(3), 24)[:, 1:].astype(np.float32)
    footprint = np.full(24, 0.01, np.float32)
    plain = look(build_pieces([table, sofa], STYLE, seed=0), face, places, footprint)
    painted = look(build_pieces([table, dataclasses.replace(sofa, texture=texture)], STYLE, seed=0), face, places, footprint)
    np.testing.assert_allclose(painted.albedo[12:], to_linear(image[0].astype(np.float32) / 255), atol=1e-5)
    np.testing.assert_array_equal(painted.albedo[:12], plain.albedo[:12])
    np.testing.assert_array_equal(painted.mirror, plain.mirror)
    np.testing.assert_array_equal(painted.emission, plain.emission)
