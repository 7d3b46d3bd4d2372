"""Reprojection errors of the paper between frames of a trajectory that lie apart, by the depths of the scene itself.

For each pair of frames and either direction: pixels that come back to where they were when moved there and back
(`mutual_pixels`), and over them mean |z - D| / D (AbsRel) and mean |z - D|, whose mean over the pairs is divided by one scale a
method: the median of all its depths (MAE-norm). Definitions are ours; the paper gives none.
"""

import dataclasses
import itertools
from collections.abc import Sequence

import numpy as np

from wm.compare.consistency import DrawnFrame
from wm.splat.reprojection import every, mutual_pixels, reprojection_error

APART = 12
"""Frames between those that are compared: half a second."""
STRIDE = 3
"""Every so many rows and columns are moved."""


@dataclasses.dataclass(frozen=True)
class Agreement:
    """The errors of one trajectory.

    Attributes:
        absrel: mean over pairs and directions
        mae: the same of the absolute errors, in the scene's unit
        depth: median depth of its frames, in the scene's unit
        agreeing: share of the pixels with a counterpart that come back to where they were
    """

    absrel: float
    mae: float
    depth: float
    agreeing: float


def agreement(frames: Sequence[DrawnFrame]) -> Agreement | None:
    """The errors over all frames that lie a multiple of APART apart; None where no two see the same."""
    chosen = frames[::APART] if len(frames) > APART else frames[:: max(1, len(frames) - 1)]
    rows = [row for a, b in itertools.pairwise(chosen) for i, j in ((a, b), (b, a)) if (row := _one_way(i, j)) is not None]
    depths = [float(np.median(frame.depth[frame.depth > 0])) for frame in chosen if (frame.depth > 0).any()]
    if not rows:
        return None
    absrel, mae, agreeing = np.mean(rows, axis=0)
    return Agreement(absrel=float(absrel), mae=float(mae), depth=float(np.median(depths)), agreeing=float(agreeing))


def _one_way(i: DrawnFrame, j: DrawnFrame) -> tuple[float, float, float] | None:
    depth, camera = every(STRIDE, i.depth, i.camera)
    both = mutual_pixels(depth, camera, j.depth, j.camera, tolerance=2.0 / STRIDE)
    error = reprojection_error(depth, camera, j.depth, j.camera, both)
    everywhere = reprojection_error(depth, camera, j.depth, j.camera, np.ones_like(both))
    if not error.pixels:
        return None
    return error.absrel, error.mae_norm * float(np.median(j.depth[j.depth > 0])), error.pixels / everywhere.pixels
