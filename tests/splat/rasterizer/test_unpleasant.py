"""Scenes of unpleasant gaussians under the default cuts: every pixel that differs from the twin is explained by a threshold.

The twin says how close each pixel came to a threshold. Where rounding cannot have decided, values and gradients must agree as
in the smooth interior; a scene where rounding could explain most pixels would prove nothing, so that share is bounded as well.
"""

import jax
import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.splat.scenes import KINDS, camera, cloud, gradients, images, troubled, undecided
from wm.schema import RasterSettings

DEFAULT = RasterSettings()
BACKGROUND = np.array([0.2, 0.5, 0.9])
SEEDS = st.integers(0, 10**6)
TROUBLES = st.lists(st.integers(0, len(KINDS) - 1), min_size=1, max_size=4, unique=True)

ALPHA, TRANSMITTANCE = 2e-5, 1e-3
"""Relative rounding of an alpha (2e-6 of its exponential; its exponent, up to ln 255, some times 1e-7), and
of a transmittance, which is a product of differences 1 - alpha as small as 0.01."""


@given(SEEDS)
@settings(max_examples=10)
def test_each_flipped_pixel_is_within_rounding_of_a_threshold(seed):
    gaussians, view = cloud(seed=seed, degree=3, opaque=9.0), camera(seed=seed)
    found, exact = images(gaussians, view, BACKGROUND, DEFAULT)
    error = np.abs(found.rgb - exact.rgb).max(-1)
    near = undecided(gaussians, view, DEFAULT, alpha=ALPHA, transmittance=TRANSMITTANCE)
    assert (error[~near] < 1e-5).all() and near.mean() < 0.02


@given(SEEDS, TROUBLES)
@settings(max_examples=20)
def test_values_of_troubled_scenes(seed, kinds):
    gaussians, view = troubled(seed, kinds), camera(seed=None)
    found, exact = images(gaussians, view, BACKGROUND, DEFAULT)
    decided = ~undecided(gaussians, view, DEFAULT, alpha=ALPHA, transmittance=TRANSMITTANCE)
    assert decided.mean() > 0.9
    scale = max(np.abs(exact.rgb).max(), 1.0)
    assert np.abs(found.rgb - exact.rgb)[decided].max() < 1e-5 * scale
    assert np.abs(found.alpha - exact.alpha)[decided].max() < 1e-5
    assert np.abs(found.depth * found.alpha - exact.depth * exact.alpha)[decided].max() < 3e-5


@given(SEEDS, TROUBLES)
@settings(max_examples=20)
def test_gradients_of_troubled_scenes(seed, kinds):
    gaussians, view = troubled(seed, kinds), camera(seed=None)
    decided = ~undecided(gaussians, view, DEFAULT, alpha=ALPHA, transmittance=TRANSMITTANCE)
    found, exact = gradients(gaussians, view, BACKGROUND, DEFAULT, seed=seed, kept=decided)
    for a, b in zip(jax.tree.leaves(found), jax.tree.leaves(exact)):
        assert np.isfinite(a).all()
        # by the camera the gaussians' shares may cancel: then rounding is relative to them and not to their sum
        assert np.abs(a - b).max() <= 1e-3 * max(np.abs(b).max(), 1e-2)
