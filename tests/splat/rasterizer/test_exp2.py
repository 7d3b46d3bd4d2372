"""The rasterizer's power of two against float64, over the range that each alpha cut allows."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from wm.splat.rasterizer._exp2 import exp2_between


@pytest.mark.parametrize("lowest", [-0.5, -1.0, np.log2(1 / 255), -30.0, -126.0])
def test_it_is_the_power_of_two(lowest):
    y = np.linspace(lowest, 0, 100_001, dtype=np.float32)
    error = np.abs(np.asarray(jax.jit(exp2_between, static_argnums=1)(y, float(lowest)), np.float64) / np.exp2(np.float64(y)) - 1)
    # every squaring doubles the polynomial's error, and float32 rounds once more
    assert error.max() <= 2.5e-7 * max(1, -lowest)


def test_it_is_one_at_zero():
    assert float(exp2_between(jnp.float32(0), -8.0)) == 1.0
