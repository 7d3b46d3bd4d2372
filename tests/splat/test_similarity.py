"""Laws of SSIM: its value against a dense float64 definition, its gradient against differences of that."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from wm.splat.similarity import C1, C2, RADIUS, TAPS, ssim, ssim_map

jitted_map = jax.jit(ssim_map)


def dense_map(x, y):
    """SSIM by its definition in float64, one window at a time."""
    window = np.outer(TAPS, TAPS)[..., None]
    h, w, _ = x.shape
    x, y = (np.pad(z.astype(np.float64), ((RADIUS, RADIUS), (RADIUS, RADIUS), (0, 0))) for z in (x, y))
    out = np.zeros((h, w, x.shape[2]))
    for i in range(h):
        for j in range(w):
            a, b = (z[i : i + 2 * RADIUS + 1, j : j + 2 * RADIUS + 1] for z in (x, y))
            ma, mb, aa, bb, ab = ((window * z).sum((0, 1)) for z in (a, b, a * a, b * b, a * b))
            numerator = (2 * ma * mb + C1) * (2 * (ab - ma * mb) + C2)
            out[i, j] = numerator / ((ma**2 + mb**2 + C1) * (aa - ma**2 + bb - mb**2 + C2))
    return out


def pair(seed, shape):
    rng = np.random.default_rng(seed)
    return rng.random(shape).astype(np.float32), rng.random(shape).astype(np.float32)


@pytest.mark.parametrize("shape", [(1, 1, 1), (2, 13, 3), (9, 4, 3)])
def test_map_is_the_definition(shape):
    x, y = pair(0, shape)
    np.testing.assert_allclose(jitted_map(x, y), dense_map(x, y), atol=3e-6)


@given(st.integers(0, 99))
def test_symmetric_and_at_most_one_and_one_for_itself(seed):
    x, y = pair(seed, (9, 4, 3))
    np.testing.assert_allclose(jitted_map(x, y), jitted_map(y, x), rtol=0, atol=1e-6)
    assert float(jitted_map(x, y).max()) <= 1 + 1e-6
    np.testing.assert_allclose(jitted_map(x, x), 1, atol=1e-6)


@pytest.mark.parametrize("argument", [0, 1])
def test_gradient_against_float64_differences_under_a_cotangent_map(argument):
    images, weight = pair(3, (7, 6, 3)), pair(4, (7, 6, 3))[0]
    gradient = jax.jit(jax.grad(lambda *z: jnp.sum(weight * ssim_map(*z)), argument))(*images)
    step = 1e-5
    for index in [(0, 0, 0), (3, 2, 1), (6, 5, 2), (2, 5, 0)]:
        moved = [z.astype(np.float64) for z in images]
        values = []
        for sign in (1, -1):
            moved[argument] = images[argument].astype(np.float64)
            moved[argument][index] += sign * step
            values.append((weight * dense_map(*moved)).sum())
        np.testing.assert_allclose(gradient[index], (values[0] - values[1]) / (2 * step), rtol=2e-4, atol=1e-5)


def test_the_passes_are_not_fused_when_compiled():
    x = jnp.zeros((8, 8, 3))
    assert jitted_map.lower(x, x).compile().as_text().count(" conditional(") == 8  # two passes of four images


def test_constant_images_have_finite_gradients():
    value_and_grad = jax.jit(jax.value_and_grad(ssim))
    for value in (0.0, 0.5, 1.0):
        x = jnp.full((8, 8, 3), value)
        similarity, gradient = value_and_grad(x, x)
        np.testing.assert_allclose(similarity, 1, atol=1e-6)
        np.testing.assert_allclose(gradient, 0, atol=1e-5)
