"""The offline segmentation: what the offline image model drew, as a segmenter would return it.

It knows every pixel's object; what it returns has ragged borders, takes some touching neighbours of one kind for one thing, and
misses some of the small things, at the strengths of its Settings.
"""

import dataclasses

import numpy as np
from scipy import ndimage

from wm.bounds import number, setting
from wm.schema import BackendSettings
from wm.synth.backends import ImageResult, SceneContext, Segment
from wm.synth.registry import DRAWN

VERSION = "1"
REQUIRES = (DRAWN,)
_GRAIN = 3.0
"""Pixels over which a border strays alike."""
_SMALL = 2e-3
"""Share of the image below which a thing is small."""


@dataclasses.dataclass(kw_only=True, unsafe_hash=True)
class Settings(BackendSettings):
    """How wrong the segments are."""

    backend: str = setting(__name__, "The offline segmentation.")
    ragged: float = number(1.0, 0, 100, "Distance by which borders stray.", unit="px")
    merged: float = number(0.1, 0, 1, "Share of touching neighbours of one kind that are taken for one thing.")
    missed: float = number(0.25, 0, 1, "Share of small things that are missed.")


@dataclasses.dataclass(frozen=True)
class DrawnSegmentation:
    """The backend."""

    config: Settings

    def segment(self, result: ImageResult, *, seed: int) -> list[Segment]:
        """The things of an image.

        Raises:
          ValueError: the image carries no object numbers: it is not the offline model's.
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
    """The offline segmentation; it needs nothing of the scene."""
    return DrawnSegmentation(config)


def _joined(ids: np.ndarray, labels: tuple[str, ...], share: float, rng: np.random.Generator) -> np.ndarray:
    """Object numbers with a share of the touching pairs of one label under one number."""
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
    """A mask whose border strays by about `amount` pixels."""
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
