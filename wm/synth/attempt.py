"""Painting one view: generate an image, verify it, and try again with another seed if it fails.

If every attempt fails, the best image is kept, and its mask holds the pixels that agree with the scaffold. Images are rounded to
8 bits before anything else uses them, so that a run that reads them back from its folder computes the same result.
"""

import dataclasses

import numpy as np
from jaxtyping import Bool, Float, UInt8
from scipy.ndimage import maximum_filter

from wm.color import to_bytes
from wm.schema import VerifySettings
from wm.synth.agreement import agreement
from wm.synth.backends import Condition, DepthBackend, ImageBackend, ImageRequest
from wm.synth.canny import depth_edges
from wm.synth.checked import checked_estimate, checked_image
from wm.synth.verify import Verdict, dilation_radius, verify
from wm.types import GBuffer


@dataclasses.dataclass(frozen=True, eq=False)
class PaintedView:
    """A finished view: everything that a later run needs to continue as if it had painted the view itself."""

    rgb: np.ndarray  # [h, w, 3] uint8 sRGB
    mask: np.ndarray  # [h, w] bool: pixels that may be used
    recall: float | None  # depth-edge recall; None if the test was off, did not apply or had no depth estimate
    attempts: int  # images generated
    accepted: bool  # whether an image passed; if not, the mask holds the pixels at which the best one agrees
    reference: str | None  # name of the view that served as style reference
    condition: np.ndarray  # [h, w, 3] uint8, what the image model was shown


def attempt_seed(seed: int, view: int, attempt: int) -> int:
    """The seed of one attempt at one view, derived from (seed, view, attempt)."""
    return int(np.random.SeedSequence([seed, view, attempt]).generate_state(1)[0])


def paint_view(
    request: ImageRequest,
    shown: GBuffer,
    image: ImageBackend,
    depth: DepthBackend,
    settings: VerifySettings,
    identity: tuple[int, int],
    reference: str | None,
) -> PaintedView:
    """Generates images of a view until one passes; if none does, keeps the best one where it agrees with the scaffold.

    Args:
      request: the request to the image model; its seed is replaced in each attempt.
      shown: the G-buffer of the conditioning scaffold, against which the image is verified.
      image, depth: the image backend and the depth backend.
      settings: settings of the verification.
      identity: (seed of the scene, index of the view), from which the seed of each attempt is derived.
      reference: name of the view that served as style reference.

    Raises:
      ValueError: a backend returned something other than an image, or a depth estimate, of the view's size.
    """
    edges = binding_edges(shown, request.condition, settings)
    held = shown.depth if request.condition.objects == "textured" else None
    condition = to_bytes(request.condition.rgb)
    best: tuple[tuple[bool, float, float], PaintedView, np.ndarray | None] | None = None
    for attempt in range(max(settings.max_attempts, 1)):
        request = dataclasses.replace(request, seed=attempt_seed(*identity, attempt))
        result = image.generate(request)
        rgb = to_bytes(checked_image(result.rgb, request.view))
        result = dataclasses.replace(result, rgb=as_float(rgb))
        estimate = checked_estimate(depth.estimate(result, seed=request.seed), request.view) if settings.enabled else None
        verdict = verify(edges, estimate, settings, depth=held)
        painted = PaintedView(
            rgb=rgb,
            mask=np.ones(shown.hit.shape, bool),
            recall=verdict.recall,
            attempts=attempt + 1,
            accepted=verdict.passed,
            reference=reference,
            condition=condition,
        )
        if verdict.passed:
            return painted
        near = _nearness(estimate, verdict)
        if best is None or near > best[0]:
            best = (near, painted, estimate)
    assert best is not None
    mask = agreement(shown.depth, shown.hit, edges, best[2], settings)
    return dataclasses.replace(best[1], mask=mask, attempts=max(settings.max_attempts, 1))


def _nearness(estimate: np.ndarray | None, verdict: Verdict) -> tuple[bool, float, float]:
    """The sort key by which the best of the failed attempts is chosen.

    First, whether there is a depth estimate, since without one no pixel can be used; then the recall (1 where recall does not
    apply); then the smallest disagreement.
    """
    told = estimate is not None and bool(np.isfinite(estimate).any())
    return told, 1.0 if verdict.recall is None else verdict.recall, -(verdict.disagreement or 0.0)


def binding_edges(shown: GBuffer, condition: Condition, settings: VerifySettings) -> Bool[np.ndarray, "h w"]:
    """The depth edges of the conditioning scaffold that an image must have. Edges of boxes are left out."""
    edges = depth_edges(shown.depth, shown.hit, low=settings.low, high=settings.high)
    if condition.objects != "boxes" or condition.object is None:
        return edges
    near = np.asarray(maximum_filter(condition.object, 2 * dilation_radius(settings, edges.shape[1]) + 1)).astype(bool)
    return edges & ~near


def as_float(rgb: UInt8[np.ndarray, "h w 3"]) -> Float[np.ndarray, "h w 3"]:
    """An 8-bit image as float32 in [0, 1]."""
    return rgb.astype(np.float32) / np.float32(255)
