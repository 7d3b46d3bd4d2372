"""Masks as SAM 3 gives them, at its own resolution, turned into masks of the image; and what of several is one thing.

A mask of the model is a grid of values over the whole image, stretched to a square. Its value between the middles of its cells is
interpolated linearly, and constant beyond the outer ones, as in torch's `interpolate(mode="bilinear", align_corners=False)`.
"""

import dataclasses
import io
import json
from collections.abc import Sequence

import numpy as np
from jaxtyping import Bool, Float, Float16

from wm.services.faults import RefusedError
from wm.synth.backends import Segment

MASKS, FOUND = "masks.npy", "found.json"
"""Names of the files of an answer."""


@dataclasses.dataclass(frozen=True, eq=False)
class FoundMasks:
    """What a model found in an image."""

    logits: Float16[np.ndarray, "n a b"]  # above 0 inside
    labels: tuple[str, ...]
    scores: tuple[float, ...]  # 0..1


def encode(found: FoundMasks) -> dict[str, bytes]:
    """The files of an answer."""
    buffer = io.BytesIO()
    np.save(buffer, found.logits, allow_pickle=False)
    told = [{"label": label, "score": score} for label, score in zip(found.labels, found.scores, strict=True)]
    return {MASKS: buffer.getvalue(), FOUND: json.dumps(told).encode()}


def decode(files: dict[str, bytes]) -> FoundMasks:
    """What was found, out of the files of an answer.

    Raises:
      RefusedError: they are not those of `encode`.
    """
    try:
        logits = np.load(io.BytesIO(files[MASKS]), allow_pickle=False)
        told = json.loads(files[FOUND])
        labels, scores = tuple(str(item["label"]) for item in told), tuple(float(item["score"]) for item in told)
    except (KeyError, ValueError, TypeError, OSError, EOFError) as error:
        raise RefusedError(f"the kept masks cannot be read ({type(error).__name__}: {error})") from error
    if logits.ndim != 3 or len(logits) != len(labels):
        raise RefusedError(f"the kept masks have shape {logits.shape}, and there are {len(labels)} labels")
    return FoundMasks(logits, labels, scores)


def halves(logits: Float[np.ndarray, "..."]) -> Float16[np.ndarray, "..."]:
    """Logits with the half of their digits; beyond 100 a mask is certain."""
    return np.clip(logits, -100, 100).astype(np.float16)


def resized(grid: Float[np.ndarray, "a b"], shape: tuple[int, int]) -> Float[np.ndarray, "h w"]:
    """Values of the model's grid at the middles of the image's pixels."""
    return _weights(grid.shape[0], shape[0]) @ grid.astype(np.float32) @ _weights(grid.shape[1], shape[1]).T


def unlike(masks: Sequence[Bool[np.ndarray, "h w"]], scores: Sequence[float], *, most: float) -> list[int]:
    """Which of the masks remain when, of two that share more than `most` of their union, only the surer one may.

    Returns:
      Indices, the surest first; of equal scores the first.
    """
    kept: list[int] = []
    for k in sorted(range(len(masks)), key=lambda k: (-scores[k], k)):
        if all(iou(masks[k], masks[other]) <= most for other in kept):
            kept.append(k)
    return kept


def iou(a: Bool[np.ndarray, "h w"], b: Bool[np.ndarray, "h w"]) -> float:
    """Pixels that two masks share, over those that at least one has; 0 for two empty masks."""
    union = int((a | b).sum())
    return int((a & b).sum()) / union if union else 0.0


def segments(found: FoundMasks, shape: tuple[int, int], *, inside: float = 0.5, most: float = 1.0) -> list[Segment]:
    """What was found as segments of an image, the surest first, without empty ones and without duplicates across labels.

    Args:
      shape: height and width of the image.
      inside: probability from which a pixel is of the thing.
      most: share of their union that two different things may have in common.
    """
    with np.errstate(over="ignore"):
        masks = [resized(1 / (1 + np.exp(-logits.astype(np.float32))), shape) > inside for logits in found.logits]
    full = [k for k, mask in enumerate(masks) if mask.any()]
    kept = [full[k] for k in unlike([masks[k] for k in full], [found.scores[k] for k in full], most=most)]
    return [Segment(found.labels[k], masks[k], found.scores[k]) for k in kept]


def _weights(cells: int, pixels: int) -> Float[np.ndarray, "pixels cells"]:
    """How much each cell of a row of the grid counts at each pixel."""
    at = np.clip((np.arange(pixels) + 0.5) * cells / pixels - 0.5, 0, cells - 1)
    low = np.minimum(at.astype(int), max(cells - 2, 0))
    weights = np.zeros((pixels, cells), np.float32)
    rows = np.arange(pixels)
    weights[rows, low] = 1 - (at - low)
    weights[rows, np.minimum(low + 1, cells - 1)] += at - low
    return weights
