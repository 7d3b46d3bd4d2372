"""Does a generated image keep the scaffold's structure? Depth-edge recall (paper, "Image Verification"), and depth itself.

recall = |E_M and dilate(E', delta)| / |E_M| with E_M the scaffold's depth edges and E' those of the depth estimated from the
image. It counts missing structure only: things the model added are allowed. The paper does not say what follows when E_M is
empty or no estimate can be had: here an empty E_M means that the test does not apply, and no estimate is no pass.

Recall is taken over the whole image, so one chair that is missing drowns in the edges of all else (experiments/verification).
Where the condition shows all that there is, the image is therefore also held to the scaffold's depth: brought to its scale and
shift, the estimate may disagree with it in a small share of the image only. A pixel without an estimate vouches for nothing: it
counts as one that disagrees, also where the image is free to add things.
"""

import dataclasses

import numpy as np
from jaxtyping import Bool, Float

from wm.schema import VerifySettings
from wm.synth.alignment import disagreement
from wm.synth.canny import depth_edges

_REFERENCE_WIDTH = 1376  # the paper's images, for which VerifySettings.dilation is given
_LEAST_RADIUS = 2  # pixels: rasterisation alone moves an edge by one


@dataclasses.dataclass(frozen=True)
class Verdict:
    """What verification says of one image."""

    passed: bool
    recall: float | None  # None where there was nothing to compare
    disagreement: float | None  # share of the image whose depth disagrees or is not there; None where it was not compared
    reason: str  # one clause for people


def verify(
    scaffold_edges: Bool[np.ndarray, "h w"],
    estimate: Float[np.ndarray, "eh ew"] | None,
    settings: VerifySettings,
    *,
    depth: Float[np.ndarray, "h w"] | None = None,
) -> Verdict:
    """Judge an image by the depth estimated from it.

    Args:
      scaffold_edges: `depth_edges` of the scaffold's depth, made once a view.
      estimate: depth up to scale and shift, NaN where there is none; None where the backend could not tell.
      settings: thresholds; `enabled` False passes every image.
      depth: the scaffold's depth, 0 where nothing is hit, to hold the image to; None where the image is free to add things.

    Raises:
      ValueError: the estimate has another size than the scaffold's edges.
    """
    if not settings.enabled:
        return Verdict(passed=True, recall=None, disagreement=None, reason="verification is off")
    if estimate is None or not np.isfinite(estimate).any():
        return Verdict(passed=False, recall=None, disagreement=None, reason="no depth could be estimated from the image")
    if estimate.shape != scaffold_edges.shape:
        raise ValueError(f"the depth estimate is {estimate.shape}; the view is {scaffold_edges.shape}")
    radius = dilation_radius(settings, scaffold_edges.shape[1])
    edges = depth_edges(estimate, np.isfinite(estimate), low=settings.low, high=settings.high)
    recall = edge_recall(scaffold_edges, edges, radius)
    apart = _apart(depth, estimate, radius, settings)
    enough = recall is None or recall >= settings.min_recall
    close = apart is None or apart <= settings.max_disagreement
    reasons = (
        ["the scaffold has no depth edges here: recall does not apply"]
        if recall is None
        else [f"recall {recall:.3f} {'>=' if enough else '<'} {settings.min_recall:g}"]
    )
    if apart is not None:
        reasons.append(
            f"{apart:.2%} of the depth disagrees or is missing, "
            f"{'at most' if close else 'more than'} {settings.max_disagreement:.2%}"
        )
    return Verdict(passed=enough and close, recall=recall, disagreement=apart, reason="; ".join(reasons))


def _apart(depth: np.ndarray | None, estimate: np.ndarray, radius: int, settings: VerifySettings) -> float | None:
    """Share of the image that disagrees; of one that is not held to a depth, the share without an estimate, None for nothing."""
    if depth is not None:
        return float(disagreement(depth, estimate, radius=radius, tolerance=settings.tolerance).mean())
    unknown = float(np.mean(~np.isfinite(estimate)))
    return unknown if unknown > 0 else None


def edge_recall(scaffold_edges: Bool[np.ndarray, "h w"], image_edges: Bool[np.ndarray, "h w"], dilation: int) -> float | None:
    """Share of the scaffold's edge pixels that have an edge of the image within `dilation` pixels; None if it has none."""
    if not scaffold_edges.any():
        return None
    return float(dilate(image_edges, dilation)[scaffold_edges].mean())


def dilation_radius(settings: VerifySettings, width: int) -> int:
    """The tolerance in pixels of an image of this width."""
    return max(_LEAST_RADIUS, round(settings.dilation * width / _REFERENCE_WIDTH))


def dilate(edges: Bool[np.ndarray, "h w"], radius: int) -> Bool[np.ndarray, "h w"]:
    """Pixels whose centre is within `radius` of an edge pixel's centre: a disk stamped on each of the (few) edge pixels.

    scikit-image's `isotropic_dilation` is the same where there is an edge at all, and sets pixels of an image without one
    (experiments/library_peers).
    """
    height, width = edges.shape
    wide = width + 2 * radius
    stamped = np.zeros((height + 2 * radius) * wide, bool)
    i, j = np.nonzero(edges)
    di, dj = np.nonzero(np.hypot(*np.mgrid[-radius : radius + 1, -radius : radius + 1]) <= radius)
    for offset in di * wide + dj:
        stamped[i * wide + j + offset] = True
    return stamped.reshape(-1, wide)[radius : radius + height, radius : radius + width]
