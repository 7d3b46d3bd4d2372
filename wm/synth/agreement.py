"""Where an image that failed verification may still be used: the pixels at which it agrees with the scaffold.

A pixel agrees if the depth estimated from the image, brought to the scaffold's scale and shift, is within the tolerance of the
scaffold's depth at that pixel, and if no edge of the scaffold that the image misses is near it. The paper drops images that
failed; we keep their pixels that agree, since an image that is wrong about one chair still shows the rest of the room.
"""

import numpy as np
from jaxtyping import Bool, Float

from wm.schema import VerifySettings
from wm.synth.alignment import aligned_depth
from wm.synth.verify import dilate, dilation_radius, image_edges


def agreement(
    depth: Float[np.ndarray, "h w"],
    hit: Bool[np.ndarray, "h w"],
    scaffold_edges: Bool[np.ndarray, "h w"],
    estimate: Float[np.ndarray, "h w"] | None,
    settings: VerifySettings,
    glass: Bool[np.ndarray, "h w"] | None = None,
) -> Bool[np.ndarray, "h w"]:
    """Pixels at which an image agrees with the scaffold; no pixel if there is no depth estimate.

    Args:
      depth, hit: the scaffold's z-depth in metres, and the pixels that hit the scaffold.
      scaffold_edges: the depth edges of the scaffold.
      estimate: depth of the image up to scale and shift; None if there is no estimate.
      settings: Canny thresholds and the reach of an edge, as in verification.
      glass: pixels that scale, shift and depth range do not follow. They agree only if their own depth does.
    """
    if estimate is None:
        return np.zeros(hit.shape, bool)
    valid = hit & np.isfinite(estimate)
    fitted = valid if glass is None else valid & ~glass
    if not fitted.any():
        return np.zeros(hit.shape, bool)
    aligned = aligned_depth(depth, fitted, estimate, field=settings.field)
    agrees = valid & (np.abs(aligned - depth) <= settings.tolerance * depth)
    radius = dilation_radius(settings, hit.shape[1])
    found = dilate(image_edges(estimate, glass, settings), radius)
    return agrees & ~dilate(scaffold_edges & ~found, radius)
