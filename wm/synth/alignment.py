"""Depth estimates are given up to scale and shift: bringing one to the scaffold's, and where the two then differ.

Differences that a shift of the picture by a few pixels explains do not count: at a silhouette, an estimate between the depths on
either side of it is right.
"""

import numpy as np
from jaxtyping import Bool, Float
from scipy.ndimage import maximum_filter, minimum_filter

ROUNDS = 20
"""Of reweighting: the alignment moves by less than 1e-3 after ten."""
POINTS = 20_000
"""Pixels from which an alignment is taken; two numbers need no more."""


def align_depth(estimate: Float[np.ndarray, "n"], depth: Float[np.ndarray, "n"]) -> tuple[float, float]:
    """(scale, shift) that brings an estimate to the depth with the least sum of absolute differences.

    By iteratively reweighted least squares, so that a wrong part of the image does not bend the rest. The scale is never
    negative: what is nearer in the estimate is nearer. An estimate that falls where the depth rises (disparity, or front and back
    confused) tells no more than a constant one: its scale is 0, its shift the median of the depth.
    """
    x, y = estimate.astype(np.float64), depth.astype(np.float64)
    floor = 1e-3 * max(float(np.abs(y).max()), np.finfo(np.float64).tiny)
    weight = np.ones_like(x)
    scale = shift = 0.0
    for _ in range(ROUNDS):
        mean_x, mean_y = np.average(x, weights=weight), np.average(y, weights=weight)
        variance = np.average((x - mean_x) ** 2, weights=weight)
        covariance = np.average((x - mean_x) * (y - mean_y), weights=weight)
        rising = covariance > 0 and variance > 0
        scale = float(covariance / variance) if rising else 0.0
        shift = float(mean_y - scale * mean_x) if rising else float(np.median(y))
        weight = 1 / np.maximum(np.abs(scale * x + shift - y), floor)
    return scale, shift


def aligned_depth(
    depth: Float[np.ndarray, "h w"], valid: Bool[np.ndarray, "h w"], estimate: Float[np.ndarray, "h w"]
) -> Float[np.ndarray, "h w"]:
    """The estimate at the scale and shift of the depth where both are valid; 0 where it is not finite."""
    finite = np.isfinite(estimate)
    both = np.flatnonzero(valid & finite)
    some = both[:: max(len(both) // POINTS, 1)]
    scale, shift = align_depth(estimate.ravel()[some], depth.ravel()[some])
    return np.where(finite, scale * np.where(finite, estimate, 0) + shift, 0)


def disagreement(
    depth: Float[np.ndarray, "h w"], estimate: Float[np.ndarray, "h w"], *, radius: int, tolerance: float
) -> Bool[np.ndarray, "h w"]:
    """Pixels at which an estimate lies outside of all that the scaffold's depth is nearby.

    Args:
      depth: the scaffold's z-depth, metres, 0 where nothing is hit: there nothing disagrees.
      estimate: depth up to scale and shift; pixels that are not finite disagree.
      radius: pixels, along rows and columns, that a picture may be off.
      tolerance: as a share of depth.
    """
    hit = depth > 0
    if not (hit & np.isfinite(estimate)).any():
        return hit
    aligned = aligned_depth(depth, hit, estimate)
    near = minimum_filter(np.where(hit, depth, np.inf), 2 * radius + 1)
    far = maximum_filter(depth, 2 * radius + 1)
    outside = (aligned < near * (1 - tolerance)) | (aligned > far * (1 + tolerance))
    return hit & (outside | ~np.isfinite(estimate))
