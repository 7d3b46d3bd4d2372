"""The smooth field by which the scale of a depth estimate drifts over an image, fitted robustly.

Depth estimators keep the shape of what is near in the image and lose its scale over larger distances. An aligned estimate E and
the scaffold's depth D then differ by a smooth factor, whose logarithm is modelled as a polynomial in the image's coordinates:

    log(E / D) = sum of c_ab P_a(x) P_b(y) over a + b <= degree,  x and y in [-1, 1],  P the Legendre polynomials

The coefficients minimise the sum of absolute differences, so that a thing that is missing, moved or added has little influence on
the field and remains as a difference. The field is bounded by `REACH`, because a polynomial that might take any value could turn
one room into another.
"""

import numpy as np
from jaxtyping import Bool, Float
from numpy.polynomial.legendre import leggrid2d, legvander2d

REACH = 0.3
"""Largest logarithm of the field: an estimate's scale may drift by a third. Of drifts of 5 % some exceed a fifth in a corner,
where it would reject good images (experiments/verification)."""
POINTS = 4000
"""Size of the subsample of pixels to which the field is fitted."""
ROUNDS = 12
"""Rounds of reweighting."""
_LEAST = 0.02  # differences of logarithms below this one weigh alike
_NEAREST = 0.2  # as a share of the scaffold's depth; an estimate below it says nothing about scale


def scale_field(
    aligned: Float[np.ndarray, "h w"],
    depth: Float[np.ndarray, "h w"],
    valid: Bool[np.ndarray, "h w"],
    *,
    degree: int,
    quantile: float = 0.5,
) -> Float[np.ndarray, "h w"]:
    """The factor by which an aligned estimate exceeds the scaffold's depth, as a smooth field; 1 if `degree` is 0.

    Args:
      aligned: the estimate at the scaffold's scale and shift, metres.
      depth: the scaffold's z-depth, metres.
      valid: pixels at which both are known.
      degree: of the polynomial; 4 follows a field that varies over a sixth of the image's width.
      quantile: of the differences, which the field brings to 0, as in `wm.synth.alignment.align_depth`.
    """
    height, width = depth.shape
    known = np.flatnonzero(valid & (depth > 0) & (aligned > _NEAREST * depth))
    some = known[:: max(len(known) // POINTS, 1)]
    powers = np.add.outer(np.arange(degree + 1), np.arange(degree + 1)) <= degree
    if degree == 0 or len(some) < powers.sum():
        return np.ones(depth.shape)
    x, y = np.linspace(-1, 1, width), np.linspace(-1, 1, height)
    basis = legvander2d(y[some // width], x[some % width], [degree, degree])[:, powers.ravel()]
    logs = np.log(aligned.ravel()[some].astype(np.float64) / depth.ravel()[some])
    coefficients = np.zeros(powers.shape)
    coefficients[powers] = _least_absolute(basis, logs, quantile)
    return np.exp(np.clip(leggrid2d(y, x, coefficients), -REACH, REACH))


def _least_absolute(basis: Float[np.ndarray, "n k"], values: Float[np.ndarray, "n"], quantile: float) -> Float[np.ndarray, "k"]:
    """The coefficients of a quantile regression, by iteratively reweighted least squares."""
    weight = np.ones_like(values)
    coefficients = np.zeros(basis.shape[1])
    for _ in range(ROUNDS):
        weighted = weight[:, None] * basis
        coefficients = np.linalg.lstsq(weighted.T @ basis, weighted.T @ values, rcond=None)[0]  # of k equations; may be singular
        behind = values - basis @ coefficients
        weight = np.where(behind > 0, quantile, 1 - quantile) / np.maximum(np.abs(behind), _LEAST)
    return coefficients
