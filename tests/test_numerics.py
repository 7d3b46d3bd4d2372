"""Laws of the guards, in value and in gradient, over the whole float32 line; and the traps that style.md lists."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from wm.numerics import masked_mean, safe_div, safe_sqrt

FLOATS = st.floats(-(2.0**100), 2.0**100, width=32, allow_subnormal=False)
COTANGENT = 2.5  # not 1: a forgotten factor shows

vjp_div = jax.jit(lambda a, b, g: jax.vjp(safe_div, a, b)[1](g))
vjp_sqrt = jax.jit(lambda x, g: jax.vjp(safe_sqrt, x)[1](g)[0])


def f32(*values):
    return jnp.asarray(values, jnp.float32)


@given(FLOATS, FLOATS)
@settings(max_examples=60, deadline=None)
def test_safe_div_is_the_quotient_where_there_is_one(a, b):
    value, (by_a, by_b) = safe_div(f32(a), f32(b))[0], vjp_div(f32(a), f32(b), f32(COTANGENT))
    if b == 0:
        assert value == 0 and by_a[0] == 0 and by_b[0] == 0
    else:
        with np.errstate(over="ignore", under="ignore"):
            np.testing.assert_allclose(value, np.float32(np.float64(a) / b), rtol=1e-6, atol=1e-37)
            np.testing.assert_allclose(by_a[0], np.float32(COTANGENT / np.float64(b)), rtol=1e-5, atol=1e-37)


@given(FLOATS)
@settings(max_examples=60, deadline=None)
def test_safe_sqrt_is_the_root_of_what_is_positive(x):
    value, gradient = safe_sqrt(f32(x))[0], vjp_sqrt(f32(x), f32(COTANGENT))[0]
    if x <= 0:
        assert value == 0 and gradient == 0
    else:
        np.testing.assert_allclose(value, np.sqrt(np.float64(x)), rtol=1e-6)
        np.testing.assert_allclose(gradient, COTANGENT / (2 * np.sqrt(np.float64(x))), rtol=1e-5)


def test_guards_do_not_hide_nan():
    nan = jnp.array([jnp.nan, 1.0, 2.0])
    assert np.isnan(safe_sqrt(nan)[0]) and np.isnan(safe_div(nan, jnp.ones(3))[0]) and np.isnan(safe_div(jnp.ones(3), nan)[0])


def unit(x):
    """The direction of each row: how the guards are used together (wm/splat/rasterizer/projection.py)."""
    return safe_div(x, safe_sqrt(jnp.sum(x * x, axis=-1, keepdims=True)))


def test_one_zero_row_does_not_touch_the_others():
    rows = jnp.array([[0.0, 0, 0], [3.0, 4, 0], [1e-12, 0, 0]])
    value, pull = jax.vjp(unit, rows)
    np.testing.assert_allclose(value, [[0, 0, 0], [0.6, 0.8, 0], [1, 0, 0]], atol=1e-6)
    gradient = np.asarray(pull(jnp.full((3, 3), COTANGENT))[0])
    assert not gradient[0].any()
    along = np.array([0.6, 0.8, 0])  # the gradient is what of the cotangent is across the direction, over the length
    np.testing.assert_allclose(gradient[1], COTANGENT * (np.ones(3) - along.sum() * along) / 5, atol=1e-6)


@given(hnp.arrays(np.float32, (7,), elements=st.floats(-1e6, 1e6, width=32, allow_subnormal=False)), hnp.arrays(bool, (7,)))
@settings(max_examples=60, deadline=None)
def test_masked_mean_sees_only_what_the_mask_holds(x, mask):
    spoiled = np.where(mask, x, np.resize([np.nan, np.inf, -np.inf], 7)).astype(np.float32)
    value, gradient = jax.value_and_grad(lambda x: COTANGENT * masked_mean(x, jnp.asarray(mask)))(jnp.asarray(spoiled))
    expected = x[mask].astype(np.float64).mean() if mask.any() else 0.0
    np.testing.assert_allclose(value, COTANGENT * expected, rtol=1e-5, atol=0.5)
    np.testing.assert_allclose(gradient, COTANGENT * mask / max(mask.sum(), 1), rtol=1e-6)


TRAPS = {
    "x / where(norm == 0, 1, norm)": (lambda x: x / jnp.where(jnp.linalg.norm(x) == 0, 1.0, jnp.linalg.norm(x)), unit),
    "where(d > 0, 1 / d, 0)": (lambda d: jnp.where(d > 0, 1 / d, 0.0), lambda d: safe_div(jnp.ones_like(d), d)),
    "sqrt and then mask": (lambda x: jnp.where(x > 0, jnp.sqrt(x), 0.0), safe_sqrt),
    "norm at 0": (lambda x: jnp.sqrt(jnp.sum(x * x)), lambda x: safe_sqrt(jnp.sum(x * x))),
}


@pytest.mark.parametrize("form", TRAPS)
def test_the_form_that_traps_is_nan_at_zero_and_the_guard_is_zero(form):
    trap, guard = TRAPS[form]
    assert np.isnan(jax.grad(lambda x: trap(x).sum())(jnp.zeros(3))).any()
    np.testing.assert_array_equal(jax.grad(lambda x: guard(x).sum())(jnp.zeros(3)), 0)
