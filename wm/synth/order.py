"""The order in which views are painted, and the finished view that is the style reference of each.

sim(q1, q2) = |q1 . q2| of unit quaternions: 1 for equal orientations, 0 for orientations half a turn apart (paper, "Viewpoint
Generation for Appearance Synthesis"). In each room the two bootstrap views come first. After them, the next view is always the
one that is most similar to any finished view.
"""

import dataclasses

import numpy as np
from jaxtyping import Float


@dataclasses.dataclass(frozen=True)
class PaintStep:
    """One view to paint, by its index and that of its reference."""

    view: int  # index into the room's views
    reference: int | None  # index into the done views followed by the room's views; None if no view is finished yet


def similarity(q1: Float[np.ndarray, "n 4"], q2: Float[np.ndarray, "m 4"]) -> Float[np.ndarray, "n m"]:
    """|q1 . q2| of every pair of quaternions (wxyz) after normalisation: in [0, 1] and equal for q and -q."""
    unit1, unit2 = (q / np.linalg.norm(q, axis=1, keepdims=True) for q in (q1, q2))
    return np.minimum(np.abs(unit1 @ unit2.T), 1.0)


def paint_order(
    quats: Float[np.ndarray, "n 4"], done: Float[np.ndarray, "d 4"], *, bootstraps: int = 2
) -> list[PaintStep]:
    """The painting order of one room's views, each with the finished view of the most similar orientation as its reference.

    Args:
      quats: orientations of the room's views, the two bootstrap views first.
      done: orientations of the views finished in earlier rooms; they can be references too.
      bootstraps: number of bootstrap views.

    Returns:
      n steps. The bootstrap views come first, in their order. Of equally similar views the first in `quats` is chosen, and of
      equally similar references the one painted first. Similarities are rounded to 1e-9, so that rounding errors decide nothing.
    """
    count, before = len(quats), len(done)
    to_done = np.full((count, before + count), -1.0)  # similarity of each view to each finished one, in painting order
    to_done[:, :before] = similarity(quats, done)
    among = similarity(quats, quats)
    painted = list(range(before))
    waiting = list(range(count))
    steps = []
    while waiting:
        best = np.round(to_done[waiting, : len(painted)].max(axis=1, initial=-1.0), 9)
        view = waiting[0] if len(steps) < bootstraps else waiting[int(np.argmax(best))]
        nearest = np.round(to_done[view, : len(painted)], 9)
        steps.append(PaintStep(view=view, reference=painted[int(np.argmax(nearest))] if painted else None))
        to_done[:, len(painted)] = among[:, view]
        painted.append(before + view)
        waiting.remove(view)
    return steps
