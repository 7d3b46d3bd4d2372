"""Verifies that an image keeps the scaffold's structure, by depth-edge recall (paper, "Image Verification") and by depth.

recall = |E_M and dilate(E', delta)| / |E_M|, where E_M are the scaffold's depth edges and E' those of the depth estimated from
the image. Recall measures missing structure only: things that the model added do not lower it. The paper leaves two cases open:
if E_M is empty, recall does not apply here, and an image without a depth estimate fails.

Recall is computed over the whole image, so that one missing chair hardly changes it (experiments/verification). The image is
therefore also compared with the scaffold's depth: the aligned estimate may disagree with it in only a small share of the image.
Where the condition leaves the furniture to the model (boxes, none), what it adds stands in front of the scaffold, so only what
lies behind it disagrees: a wall that is gone, or front and back confused, whose edges are all in their places. A pixel without an
estimate counts as one that disagrees.

Window panes and mirrors are left out (`glass`): an estimate may tell their own depth or that of what is seen through or in them.
"""

import dataclasses

import numpy as np
from jaxtyping import Bool, Float

from wm.schema import VerifySettings
from wm.synth.alignment import disagreement
from wm.synth.canny import depth_edges

_REFERENCE_WIDTH = 1376  # width of the paper's images, for which VerifySettings.dilation is given
_LEAST_RADIUS = 2  # pixels: rasterisation alone moves an edge by one


@dataclasses.dataclass(frozen=True)
class Verdict:
    """The result of the verification of one image."""

    passed: bool
    recall: float | None  # None if the scaffold has no depth edges in this view
    disagreement: float | None  # share of the image whose depth disagrees or is missing; None if it was not compared
    reason: str  # the result in words


def verify(
    scaffold_edges: Bool[np.ndarray, "h w"],
    estimate: Float[np.ndarray, "eh ew"] | None,
    settings: VerifySettings,
    *,
    depth: Float[np.ndarray, "h w"] | None = None,
    adds: bool = False,
    glass: Bool[np.ndarray, "h w"] | None = None,
) -> Verdict:
    """Verifies an image by the depth estimated from it.

    Args:
      scaffold_edges: `depth_edges` of the scaffold's depth.
      estimate: depth up to scale and shift, NaN where there is no estimate; None if the backend gave no estimate at all.
      settings: thresholds; if `enabled` is False, every image passes.
      depth: the scaffold's depth, 0 where nothing is hit or nothing is compared; None for the paper's test, by edges alone.
      adds: whether the image may add things in front of the scaffold.
      glass: pixels of which an estimate may say anything or nothing; `scaffold_edges` and `depth` leave them out already.

    Raises:
      ValueError: the estimate and the scaffold's edges differ in size.
    """
    if not settings.enabled:
        return Verdict(passed=True, recall=None, disagreement=None, reason="verification is off")
    if estimate is None or not np.isfinite(estimate).any():
        return Verdict(passed=False, recall=None, disagreement=None, reason="no depth could be estimated from the image")
    if estimate.shape != scaffold_edges.shape:
        raise ValueError(f"the depth estimate is {estimate.shape}; the view is {scaffold_edges.shape}")
    radius = dilation_radius(settings, scaffold_edges.shape[1])
    edges = image_edges(estimate, glass, settings)
    recall = edge_recall(scaffold_edges, edges, radius)
    unknown = ~np.isfinite(estimate) if glass is None else ~np.isfinite(estimate) & ~glass
    apart = _apart(depth, estimate, unknown, radius, settings, adds)
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


def image_edges(
    estimate: Float[np.ndarray, "h w"], glass: Bool[np.ndarray, "h w"] | None, settings: VerifySettings
) -> Bool[np.ndarray, "h w"]:
    """The depth edges of an image. Its depth range is that of what is not glass, or else a far sight would flatten the room."""
    finite = np.isfinite(estimate)
    if glass is not None and (finite & ~glass).any():
        ranged = estimate[finite & ~glass]
        estimate = np.clip(estimate, ranged.min(), ranged.max())
    return depth_edges(estimate, finite, low=settings.low, high=settings.high)


def _apart(
    depth: np.ndarray | None, estimate: np.ndarray, unknown: np.ndarray, radius: int, settings: VerifySettings, adds: bool
) -> float | None:
    """Share of the image that disagrees with `depth` or is unknown. If `depth` is None: the latter, or None if that is 0."""
    if depth is None:
        return float(unknown.mean()) if unknown.any() else None
    apart = disagreement(depth, estimate, radius=radius, tolerance=settings.tolerance, adds=adds, field=settings.field)
    return float((apart | unknown).mean() if adds else apart.mean())


def edge_recall(scaffold_edges: Bool[np.ndarray, "h w"], image_edges: Bool[np.ndarray, "h w"], dilation: int) -> float | None:
    """Share of the scaffold's edge pixels with an image edge within `dilation` pixels; None if the scaffold has no edges."""
    if not scaffold_edges.any():
        return None
    return float(dilate(image_edges, dilation)[scaffold_edges].mean())


def dilation_radius(settings: VerifySettings, width: int) -> int:
    """The radius of the dilation, in pixels, for an image of this width."""
    return max(_LEAST_RADIUS, round(settings.dilation * width / _REFERENCE_WIDTH))


def dilate(edges: Bool[np.ndarray, "h w"], radius: int) -> Bool[np.ndarray, "h w"]:
    """Pixels whose centre is within `radius` of the centre of an edge pixel. A disk is stamped on each of the (few) edge pixels.

    scikit-image's `isotropic_dilation` gives the same result for an image with edges, but sets pixels of an image without edges
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
