"""Laws of the mip pyramid: constants stay, texel centres are exact, means are kept, footprints blur."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from wm.offline.world.pyramid import build_pyramid, sample_pyramid

F32 = np.float32


@given(st.integers(1, 40), st.integers(1, 40), st.floats(0.001, 5.0))
def test_a_constant_image_is_constant_everywhere(rows, columns, footprint):
    pyramid = build_pyramid([np.full((rows, columns, 3), 0.37, F32)], 0.01)
    rng = np.random.default_rng(rows)
    s, t = (rng.uniform(-0.1, 0.6, 50).astype(F32) for _ in range(2))
    colors = sample_pyramid(pyramid, np.zeros(50, np.int32), s, t, np.full(50, footprint, F32))
    np.testing.assert_allclose(colors, 0.37, atol=2e-5)


def test_texel_centres_are_exact_in_every_image():
    rng = np.random.default_rng(0)
    images = [rng.random((h, w, 3)).astype(F32) for h, w in ((5, 7), (1, 9), (16, 3))]
    pyramid = build_pyramid(images, 0.02)
    for number, image in enumerate(images):
        i, j = (k.ravel() for k in np.indices(image.shape[:2]))
        where = np.full(len(i), number, np.int32)
        s, t = ((j + 0.5) * 0.02).astype(F32), ((i + 0.5) * 0.02).astype(F32)
        colors = sample_pyramid(pyramid, where, s, t, np.full(len(i), 0.01, F32))
        np.testing.assert_allclose(colors, image[i, j], atol=1e-4)


def test_a_wide_footprint_gives_the_mean():
    image = np.random.default_rng(1).random((32, 32, 3)).astype(F32)
    pyramid = build_pyramid([image], 0.01)
    one = np.array([0.16], F32)
    color = sample_pyramid(pyramid, np.zeros(1, np.int32), one, one, np.array([0.32], F32))
    np.testing.assert_allclose(color[0], image.mean(axis=(0, 1)), atol=1e-3)
