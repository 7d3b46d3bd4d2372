"""The offline segmentation: the objects that the offline image model drew, with the errors of a segmentation model.

It knows the object of every pixel. Its segments have ragged borders, some touching objects with the same label become one
segment, and some small objects are missing; its Settings say how strong these errors are.
"""

import dataclasses

import numpy as np
from scipy import ndimage

from wm.bounds import number, setting
from wm.schema import BackendSettings
from wm.synth.backends import ImageResult, SceneContext, Segment, Surroundings
from wm.synth.registry import DRAWN

VERSION = "1"
REQUIRES = (DRAWN,)
_GRAIN = 3.0
"""Distance, in pixels, over which the error of a border is correlated."""
_SMALL = 2e-3
"""Share of the image below which an object is small."""


@dataclasses.dataclass(kw_only=True, unsafe_hash=True)
class Settings(BackendSettings):
    """The errors of the segments."""

    backend: str = setting(__name__, "The offline segmentation.")
    ragged: float = number(1.0, 0, 100, "Distance by which borders stray.", unit="px")
    merged: float = number(0.1, 0, 1, "Share of touching neighbours of one kind that are taken for one thing.")
    missed: float = number(0.25, 0, 1, "Share of small things that are missed.")


@dataclasses.dataclass(frozen=True)
class DrawnSegmentation:
    """The backend."""

    config: Settings

    def segment(self, result: ImageResult, *, where: Surroundings | None = None, seed: int) -> list[Segment]:
        """The segments of an image.

        Raises:
          ValueError: the image has no object numbers, so that it does not come from the offline image model.
        """
        if result.drawn_object is None:
            raise ValueError(
                "the offline segmentation goes by what an offline image model tells that it drew; this image tells nothing: "
                "a model of images needs one that segments them"
            )
        rng = np.random.default_rng(np.random.SeedSequence([seed, 0x5E6]))
        ids = _joined(result.drawn_object, result.drawn_labels, self.config.merged, rng)
        segments = []
        for k in np.unique(ids[ids >= 0]):
            mask = ids == k
            lost = rng.random() < self.config.missed
            if lost and mask.sum() < _SMALL * mask.size:
                continue
            segments.append(Segment(result.drawn_labels[int(k)], _ragged(mask, self.config.ragged, rng)))
        return [segment for segment in segments if segment.mask.any()]


def make(config: Settings, context: SceneContext | None = None) -> DrawnSegmentation:
    """The offline segmentation. It does not use the scene."""
    return DrawnSegmentation(config)


def _joined(ids: np.ndarray, labels: tuple[str, ...], share: float, rng: np.random.Generator) -> np.ndarray:
    """Object numbers in which a share of the touching pairs with the same label have one number."""
    pairs = set()
    for a, b in ((ids[1:], ids[:-1]), (ids[:, 1:], ids[:, :-1])):
        border = (a != b) & (a >= 0) & (b >= 0)
        pairs |= {(min(p), max(p)) for p in zip(a[border].tolist(), b[border].tolist())}
    home = np.arange(len(labels))
    for a, b in sorted(pairs):
        if labels[a] == labels[b] and rng.random() < share:
            home[home == home[b]] = home[a]
    return np.where(ids >= 0, home[ids] if len(home) else ids, ids)


def _ragged(mask: np.ndarray, amount: float, rng: np.random.Generator) -> np.ndarray:
    """The mask with its border displaced at random by about `amount` pixels."""
    if amount == 0:
        return mask
    rows, columns = (np.flatnonzero(mask.any(axis=axis)) for axis in (1, 0))
    margin = int(4 * amount) + 2
    window = tuple(slice(max(int(k[0]) - margin, 0), int(k[-1]) + margin + 1) for k in (rows, columns))
    part = np.pad(mask[window], 1)
    inside = np.asarray(ndimage.distance_transform_edt(part)) - np.asarray(ndimage.distance_transform_edt(~part))
    noise = ndimage.gaussian_filter(rng.normal(size=part.shape), _GRAIN)
    strayed = inside + np.where(inside > 0, -0.5, 0.5) + amount * noise / max(float(noise.std()), 1e-9) > 0
    out = np.zeros_like(mask)
    out[window] = strayed[1:-1, 1:-1]
    return out
