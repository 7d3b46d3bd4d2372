"""In which order views are painted, and which finished view each takes its style from.

sim(q1, q2) = |q1 . q2| of unit quaternions: 1 for one orientation, 0 for a half turn (paper, "Viewpoint Generation for Appearance
Synthesis"). Per room the two bootstrap views come first; then, one at a time, the view most similar to any finished one.
"""

import dataclasses

import numpy as np
from jaxtyping import Float


@dataclasses.dataclass(frozen=True)
class PaintStep:
    """One view to paint. Indices count the done views first, then the room's views in the order they were given."""

    view: int  # index into the room's views
    reference: int | None  # index into (done views, then the room's views); None where nothing is finished yet


def similarity(q1: Float[np.ndarray, "n 4"], q2: Float[np.ndarray, "m 4"]) -> Float[np.ndarray, "n m"]:
    """|q1 . q2| of every pair of normalised quaternions (wxyz): in [0, 1], the same for q and -q."""
    unit1, unit2 = (q / np.linalg.norm(q, axis=1, keepdims=True) for q in (q1, q2))
    return np.minimum(np.abs(unit1 @ unit2.T), 1.0)


def paint_order(
    quats: Float[np.ndarray, "n 4"], done: Float[np.ndarray, "d 4"], *, bootstraps: int = 2
) -> list[PaintStep]:
    """The order of one room's views, each with the finished view of the most similar orientation.

    Args:
      quats: orientations of the room's views, the two bootstrap views first.
      done: orientations of the views finished before, in earlier rooms; they are candidates for reference and for similarity.
      bootstraps: how many of the room's first views come first, in their order.

    Returns:
      n steps. The bootstrap views come first, in their order. Of equally similar views the first given is taken, and of equally
      similar references the one painted first. Similarities are compared to 1e-9, so that rounding breaks no tie.
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
