"""Painting one view: generate an image, verify it, and try again with another seed if it fails.

If every attempt fails, the best image is kept, and its mask holds the pixels that agree with the scaffold. Images are rounded to
8 bits before anything else uses them, so that a run that reads them back from its folder computes the same result.
"""

import dataclasses
from collections.abc import Mapping
from typing import Any

import numpy as np
from jaxtyping import Bool, Float, UInt8
from scipy.ndimage import maximum_filter

from wm import console
from wm.color import to_bytes
from wm.schema import VerifySettings
from wm.services.faults import RefusedError
from wm.synth.agreement import agreement
from wm.synth.backends import Condition, DepthBackend, ImageBackend, ImageRequest, ImageResult
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
    made_by: Mapping[str, Any] = dataclasses.field(default_factory=dict)
    """What made the image: seed and prompt of the attempt, and what the backend tells of itself (`ImageResult.record`)."""


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
    held, adds = compared_depth(shown, request.condition, settings), request.condition.objects != "textured"
    glass = near_glass(request.condition, settings)
    condition = to_bytes(request.condition.rgb)
    refusals: list[str] = []
    best: tuple[tuple[bool, float, float], PaintedView, np.ndarray | None] | None = None
    for attempt in range(max(settings.max_attempts, 1)):
        request = dataclasses.replace(request, seed=attempt_seed(*identity, attempt))
        try:
            result = image.generate(request)
        except RefusedError as refusal:
            refusals.append(str(refusal))
            continue
        rgb = to_bytes(checked_image(result.rgb, request.view))
        result = dataclasses.replace(result, rgb=as_float(rgb))
        estimate = _estimate(depth, result, request) if settings.enabled else None
        verdict = verify(edges, estimate, settings, depth=held, adds=adds, glass=glass)
        painted = PaintedView(
            rgb=rgb,
            mask=np.ones(shown.hit.shape, bool),
            recall=verdict.recall,
            attempts=attempt + 1,
            accepted=verdict.passed,
            reference=reference,
            condition=condition,
            made_by={"seed": request.seed, "prompt": request.prompt, **result.record},
        )
        if verdict.passed:
            return painted
        near = _nearness(estimate, verdict)
        if best is None or near > best[0]:
            best = (near, painted, estimate)
    if best is None:
        return _refused(request, condition, reference, refusals)
    mask = agreement(shown.depth, shown.hit, edges, best[2], settings, glass)
    return dataclasses.replace(best[1], mask=mask, attempts=max(settings.max_attempts, 1))


def _estimate(depth: DepthBackend, result: ImageResult, request: ImageRequest) -> np.ndarray | None:
    return checked_estimate(depth.estimate(result, camera=request.view.camera, seed=request.seed), request.view)


def _refused(request: ImageRequest, condition: np.ndarray, reference: str | None, refusals: list[str]) -> PaintedView:
    """A view of which the model gave no image: what it was shown, none of which may be used. The run goes on without it."""
    times = f"{len(refusals)} attempts" if len(refusals) > 1 else "the one attempt"
    console.say(f"view {request.view.name}: the image model refused {times}; the view is left out. The last time: {refusals[-1]}")
    return PaintedView(
        rgb=condition,
        mask=np.zeros(condition.shape[:2], bool),
        recall=None,
        attempts=len(refusals),
        accepted=False,
        reference=reference,
        condition=condition,
    )


def _nearness(estimate: np.ndarray | None, verdict: Verdict) -> tuple[bool, float, float]:
    """The sort key by which the best of the failed attempts is chosen.

    First, whether there is a depth estimate, since without one no pixel can be used; then the recall (1 where recall does not
    apply); then the smallest disagreement.
    """
    told = estimate is not None and bool(np.isfinite(estimate).any())
    return told, 1.0 if verdict.recall is None else verdict.recall, -(verdict.disagreement or 0.0)


def binding_edges(shown: GBuffer, condition: Condition, settings: VerifySettings) -> Bool[np.ndarray, "h w"]:
    """The depth edges of the conditioning scaffold that an image must have. Those of boxes and of glass are left out."""
    return depth_edges(shown.depth, shown.hit, low=settings.low, high=settings.high) & ~_open(shown, condition, settings)


def compared_depth(shown: GBuffer, condition: Condition, settings: VerifySettings) -> Float[np.ndarray, "h w"]:
    """The depth that an image is held to: that of the conditioning scaffold; 0 near glass, and near boxes, since furniture does
    not fill them."""
    return np.where(_open(shown, condition, settings), np.float32(0), shown.depth)


def near_glass(condition: Condition, settings: VerifySettings) -> Bool[np.ndarray, "h w"] | None:
    """Pixels at or beside a window pane or a mirror, by the reach of an edge; None if the condition tells of none."""
    return None if condition.glass is None else _near(condition.glass, settings)


def _open(shown: GBuffer, condition: Condition, settings: VerifySettings) -> np.ndarray:
    """[h, w] bool: pixels at which the scaffold does not say what depth an estimate should have."""
    glass = near_glass(condition, settings)
    left = np.zeros(shown.hit.shape, bool) if glass is None else glass
    if condition.objects == "boxes" and condition.object is not None:
        left = left | _near(condition.object, settings)
    return left


def _near(mask: np.ndarray, settings: VerifySettings) -> np.ndarray:
    radius = dilation_radius(settings, mask.shape[1])
    return np.asarray(maximum_filter(mask, 2 * radius + 1)).astype(bool)


def as_float(rgb: UInt8[np.ndarray, "h w 3"]) -> Float[np.ndarray, "h w 3"]:
    """An 8-bit image as float32 in [0, 1]."""
    return rgb.astype(np.float32) / np.float32(255)
