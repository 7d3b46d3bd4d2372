"""SSIM against scikit-image's, an independent implementation of the same definition."""

import jax.numpy as jnp
import numpy as np
import pytest
from skimage.metrics import structural_similarity

from wm.splat.similarity import ssim_map

RADIUS = 5  # of the 11-tap window: nearer the border the two pad differently


@pytest.mark.parametrize("noise", [0.02, 0.3])
def test_the_map_is_scikit_images_away_from_the_border(noise):
    rng = np.random.default_rng(3)
    x = rng.random((40, 56, 3)).astype(np.float32)
    y = np.clip(x + noise * rng.normal(size=x.shape), 0, 1).astype(np.float32)
    options = {"gaussian_weights": True, "sigma": 1.5, "use_sample_covariance": False, "data_range": 1.0, "full": True}
    _, peer = structural_similarity(x.astype(np.float64), y.astype(np.float64), channel_axis=2, truncate=RADIUS / 1.5, **options)
    inner = (slice(RADIUS, -RADIUS), slice(RADIUS, -RADIUS))
    assert np.abs(np.asarray(ssim_map(jnp.asarray(x), jnp.asarray(y)))[inner] - peer[inner]).max() < 2e-4
