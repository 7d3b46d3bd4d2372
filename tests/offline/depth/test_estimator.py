"""Laws of the offline depth model: affine in the depth drawn, noisy as configured, none without a drawing."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from wm.offline.depth.estimator import Settings as DepthSettings
from wm.synth.backends import ImageResult
from wm.synth.registry import make_backend


def drawing(rng) -> ImageResult:
    depth = np.full((48, 64), 3.0, np.float32)
    depth[:, 30:] = 1.5 + rng.random() * 0.1
    depth[:4] = 0
    return ImageResult(rgb=np.zeros((48, 64, 3), np.float32), drawn_depth=depth)


@given(st.integers(0, 1000))
def test_without_noise_it_is_affine_in_the_drawn_depth(seed):
    result = drawing(np.random.default_rng(seed))
    estimate = make_backend("depth", DepthSettings(noise=0.0, softness=0.0)).estimate(result, seed=seed)
    drawn = result.drawn_depth > 0
    x, y = result.drawn_depth[drawn], estimate[drawn]
    slope, shift = np.polyfit(x, y, 1)
    assert slope > 0
    np.testing.assert_allclose(y, slope * x + shift, rtol=1e-4)
    assert np.isnan(estimate[~drawn]).all() and np.isfinite(y).all()


def test_noise_is_relative_seeded_and_as_strong_as_configured():
    result = drawing(np.random.default_rng(0))
    clean = make_backend("depth", DepthSettings(noise=0.0)).estimate(result, seed=4)
    noisy = make_backend("depth", DepthSettings(noise=0.02))
    a, again, b = (noisy.estimate(result, seed=s) for s in (4, 4, 5))
    np.testing.assert_array_equal(a, again)
    drawn = result.drawn_depth > 0
    assert np.abs(a - b)[drawn].max() > 1e-3
    assert 0.005 < np.std(a[drawn] / clean[drawn]) < 0.04


def test_no_drawing_no_estimate():
    assert make_backend("depth", DepthSettings()).estimate(ImageResult(rgb=np.zeros((4, 4, 3), np.float32)), seed=0) is None
