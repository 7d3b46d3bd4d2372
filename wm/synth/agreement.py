"""Where an image that failed verification may still be used: the pixels at which it agrees with the scaffold.

A pixel agrees if the depth estimated from the image, brought to the scaffold's scale and shift, is within the tolerance of the
scaffold's depth there, and no scaffold edge that the image misses is near. The paper drops such views; a view that is wrong
about one chair still shows the rest of the room.
"""

import numpy as np
from jaxtyping import Bool, Float

from wm.schema import VerifySettings
from wm.synth.alignment import aligned_depth
from wm.synth.canny import depth_edges
from wm.synth.verify import dilate, dilation_radius


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
    aligned = aligned_depth(depth, valid, estimate)
    agrees = valid & (np.abs(aligned - depth) <= settings.tolerance * depth)
    radius = dilation_radius(settings, hit.shape[1])
    found = dilate(depth_edges(estimate, finite, low=settings.low, high=settings.high), radius)
    return agrees & ~dilate(scaffold_edges & ~found, radius)
