"""2^y on a bounded range, in half the operations of a general exponential."""

import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

COEFFICIENTS = (1.0, 0.6931437211486147, 0.24018014288206593, 0.05529735824627968, 0.009205798175282831, 0.0009449036573117436)
"""The polynomial of degree 5 that is 1 at 0 and nearest to 2^z on [-1, 0] in relative error: 8.4e-8 (Lawson's iteration)."""


def exp2_between(y: Float[Array, "*shape"], lowest: float) -> Float[Array, "*shape"]:
    """2^y for y in [lowest, 0], lowest >= -126; anything below, or NaN, must not be used.

    2^y = (2^(y / 2^k))^(2^k) with y / 2^k in [-1, 0]: a polynomial and k squarings, no conversion to integers, which is what
    vectorises badly. Each squaring doubles the relative error: 2e-6 for lowest = log2(1 / 255).
    """
    squarings = _squarings(lowest)
    z = y * np.float32(2.0**-squarings)
    p = jnp.float32(COEFFICIENTS[-1])
    for c in COEFFICIENTS[-2::-1]:
        p = p * z + np.float32(c)
    for _ in range(squarings):
        p = p * p
    return p


def exp2_error(y: float, lowest: float) -> float:
    """The most by which `exp2_between` may be wrong at y in [lowest, 0], relatively: less near 0, where the polynomial is exact.

    A running error analysis: the polynomial's own error, and half a unit in the last place for every product and sum (a device
    may fuse the two and round once), carried through the squarings.
    """
    squarings = _squarings(lowest)
    z = np.float64(np.float32(y)) * 2.0**-squarings
    p, error = np.float64(np.float32(COEFFICIENTS[-1])), 0.0
    for c in COEFFICIENTS[-2::-1]:
        product, p = p * z, p * z + np.float64(np.float32(c))
        error = abs(z) * error + _half_unit(product) + _half_unit(p)
    relative = abs(p / 2.0 ** (y * 2.0**-squarings) - 1) + error / p
    for _ in range(squarings):
        p = p * p
        relative = (1 + relative) ** 2 - 1 + _half_unit(p) / p
    return float(relative)


def _squarings(lowest: float) -> int:
    return max(int(np.ceil(np.log2(-lowest))), 0)


def _half_unit(x: float) -> float:
    return float(np.spacing(np.float32(abs(x)))) / 2
