"""Where an image that failed verification may still be used: the pixels at which it agrees with the scaffold.

A pixel agrees if the depth estimated from the image, brought to the scaffold's scale and shift, is within a tenth of the
scaffold's depth there, and no scaffold edge that the image misses is near. The paper drops such views; a view that is wrong
about one chair still shows the rest of the room.
"""

import numpy as np
from jaxtyping import Bool, Float

from wm.schema import VerifySettings
from wm.synth.canny import depth_edges
from wm.synth.verify import dilate, dilation_radius

_TOLERANCE = 0.1  # of the scaffold's depth
_ROUNDS = 20  # of reweighting: the alignment moves by less than 1e-3 after ten


def agreement(
    depth: Float[np.ndarray, "h w"],
    hit: Bool[np.ndarray, "h w"],
    scaffold_edges: Bool[np.ndarray, "h w"],
    estimate: Float[np.ndarray, "h w"] | None,
    settings: VerifySettings,
) -> Bool[np.ndarray, "h w"]:
    """Pixels at which an image agrees with the scaffold; none where there is no estimate to tell by.

    Args:
      depth, hit: the scaffold's z-depth, metres, and where it is hit.
      scaffold_edges: its depth edges.
      estimate: depth of the image up to scale and shift, None for no estimate.
      settings: Canny thresholds and the reach of an edge, as in verification.
    """
    if estimate is None:
        return np.zeros(hit.shape, bool)
    finite = np.isfinite(estimate)
    valid = hit & finite
    if not valid.any():
        return valid
    scale, shift = align_depth(estimate[valid], depth[valid])
    aligned = scale * np.where(finite, estimate, 0) + shift
    agrees = valid & (np.abs(aligned - depth) <= _TOLERANCE * depth)
    radius = dilation_radius(settings, hit.shape[1])
    found = dilate(depth_edges(estimate, finite, low=settings.low, high=settings.high), radius)
    return agrees & ~dilate(scaffold_edges & ~found, radius)


def align_depth(estimate: Float[np.ndarray, "n"], depth: Float[np.ndarray, "n"]) -> tuple[float, float]:
    """(scale, shift) that brings an estimate to the depth with the least sum of absolute differences.

    By iteratively reweighted least squares, so that a wrong part of the image does not bend the rest. A constant estimate has
    scale 0.
    """
    x, y = estimate.astype(np.float64), depth.astype(np.float64)
    floor = 1e-3 * max(float(np.abs(y).max()), np.finfo(np.float64).tiny)
    weight = np.ones_like(x)
    scale = shift = 0.0
    for _ in range(_ROUNDS):
        mean_x, mean_y = np.average(x, weights=weight), np.average(y, weights=weight)
        variance = np.average((x - mean_x) ** 2, weights=weight)
        covariance = np.average((x - mean_x) * (y - mean_y), weights=weight)
        scale = float(covariance / variance) if variance > 0 else 0.0
        shift = float(mean_y - scale * mean_x)
        weight = 1 / np.maximum(np.abs(scale * x + shift - y), floor)
    return scale, shift
