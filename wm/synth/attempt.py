"""Painting one view: generate, verify, try again, and at the limit keep what agrees with the scaffold.

Images are rounded to 8 bits before they are used for anything, so that what is stored is exactly what went on.
"""

import dataclasses

import numpy as np
from jaxtyping import Bool, Float, UInt8
from scipy.ndimage import maximum_filter

from wm.schema import VerifySettings
from wm.synth.agreement import agreement
from wm.synth.backends import Condition, DepthBackend, ImageBackend, ImageRequest
from wm.synth.canny import depth_edges
from wm.synth.checked import checked_estimate, checked_image
from wm.synth.verify import Verdict, dilation_radius, verify
from wm.types import GBuffer


@dataclasses.dataclass(frozen=True, eq=False)
class PaintedView:
    """A finished view: all that a later run needs to go on as if it had painted it itself."""

    rgb: np.ndarray  # [h, w, 3] uint8 sRGB
    mask: np.ndarray  # [h, w] bool: pixels that may be used
    recall: float | None  # depth-edge recall; None where the test was off, did not apply or had no estimate
    attempts: int  # images generated
    accepted: bool  # whether one passed; otherwise the mask says where the best one agrees
    reference: str | None  # name of the view its style came from
    condition: np.ndarray  # [h, w, 3] uint8, what the image model was shown


def attempt_seed(seed: int, view: int, attempt: int) -> int:
    """The seed of one attempt at one view: stable, and different for every (seed, view, attempt)."""
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
    """One finished view: generated until an image passes; at the limit the one that comes nearest, where it agrees.

    Args:
      request: what the image model is asked; its seed is set for each attempt.
      shown: the G-buffer of the conditioning scaffold, to which the image is held.
      image, depth: the backends.
      settings: verification.
      identity: (the scene's seed, the view's index), from which the attempts' seeds derive.
      reference: name of the view that the request's style came from.

    Raises:
      ValueError: a backend returned something that is no image, or no estimate of depth, of the view's size.
    """
    edges = binding_edges(shown, request.condition, settings)
    held = shown.depth if request.condition.objects == "textured" else None
    condition = as_bytes(request.condition.rgb)
    best: tuple[tuple[bool, float, float], PaintedView, np.ndarray | None] | None = None
    for attempt in range(max(settings.max_attempts, 1)):
        request = dataclasses.replace(request, seed=attempt_seed(*identity, attempt))
        result = image.generate(request)
        rgb = as_bytes(checked_image(result.rgb, request.view))
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
    """By what of the attempts that failed one is kept: that its depth can be told, without which none of it can be used, then
    its recall (where that does not apply nothing is missing), then the least disagreement."""
    told = estimate is not None and bool(np.isfinite(estimate).any())
    return told, 1.0 if verdict.recall is None else verdict.recall, -(verdict.disagreement or 0.0)


def binding_edges(shown: GBuffer, condition: Condition, settings: VerifySettings) -> Bool[np.ndarray, "h w"]:
    """The conditioning scaffold's depth edges that an image must have: of a box, whose filling is open, none."""
    edges = depth_edges(shown.depth, shown.hit, low=settings.low, high=settings.high)
    if condition.objects != "boxes" or condition.object is None:
        return edges
    near = np.asarray(maximum_filter(condition.object, 2 * dilation_radius(settings, edges.shape[1]) + 1)).astype(bool)
    return edges & ~near


def as_bytes(rgb: Float[np.ndarray, "h w 3"]) -> UInt8[np.ndarray, "h w 3"]:
    """[0, 1] to 8 bits, rounded."""
    return np.round(np.clip(rgb, 0, 1) * 255).astype(np.uint8)


def as_float(rgb: UInt8[np.ndarray, "h w 3"]) -> Float[np.ndarray, "h w 3"]:
    """8 bits to float32 in [0, 1]."""
    return rgb.astype(np.float32) / np.float32(255)
