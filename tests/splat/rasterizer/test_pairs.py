"""The arithmetic of one gaussian at one pixel: what is clamped has no slope, whatever the constants, and what is not has one."""

import functools

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from wm.schema import RasterSettings
from wm.splat.rasterizer._pairs import alpha_at, clamp_tolerance, slope

RNG = np.random.default_rng(0)
SWEEP = [
    (alpha_min, float(alpha_max))
    for alpha_min in (1e-30, 1e-9, 1e-5, 1 / 255, 0.03)
    for alpha_max in (0.1, 0.99, 0.9955245, 0.9999, *RNG.uniform(0.05, 1, 4), *(1 - RNG.uniform(0, 0.02, 4)))
]


def slopes(log2_opacity, settings):
    """Alphas at the centre of gaussians, and their slopes where everything behind them counts."""
    one, zero = jnp.ones_like(log2_opacity), jnp.zeros_like(log2_opacity)
    alpha = alpha_at(zero, zero, one, zero, one, log2_opacity, settings)
    return alpha, slope(one, alpha, alpha, zero, settings)


@pytest.mark.parametrize("compiled", [False, True], ids=["operation by operation", "compiled"])
def test_clamped_alphas_have_no_slope(compiled):
    over = np.array([0.0, -1e-6, -0.01, -1.0])  # log2 of opacities, where those that reach the clamp are kept
    for alpha_min, alpha_max in SWEEP:
        settings = RasterSettings(alpha_min=alpha_min, alpha_max=alpha_max)
        clamped = jnp.asarray(np.maximum(over, np.log2(alpha_max)) * (1 - 1e-6), jnp.float32)
        run = functools.partial(slopes, settings=settings)
        alpha, found = (jax.jit(run) if compiled else run)(clamped)
        assert not np.asarray(found).any(), (alpha_min, alpha_max, found)
        np.testing.assert_allclose(alpha, alpha_max, rtol=clamp_tolerance(settings))


def test_alphas_below_the_clamp_have_one():
    for alpha_min, alpha_max in SWEEP:
        settings = RasterSettings(alpha_min=alpha_min, alpha_max=alpha_max)
        assert clamp_tolerance(settings) < 2e-5
        below = jnp.asarray(np.log2(alpha_max * (1 - np.array([5e-5, 1e-3]))), jnp.float32)
        assert (np.asarray(slopes(below, settings)[1]) < 0).all()


def test_the_tolerance_of_the_defaults_is_the_least():
    assert clamp_tolerance(RasterSettings()) == 1e-6
