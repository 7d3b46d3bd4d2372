"""Where planned cameras look: each position is given several possible views, and one of each is picked so that together they
see as much of the room's surface as often as possible.

The choice is greedy: the position and view that add most are picked, one after the other; then each position chooses again, given
the others. A surface point is worth VALUES[k] to the view that is the (k + 1)-th to see it, so unseen surface comes first, and
seen three times is what is aimed for (texture and splats want parallax). The sum is submodular, so the greedy choice reaches at
least half of the best possible (Fisher, Nemhauser and Wolsey, 1978), and choosing again only adds to it.
"""

import dataclasses
from collections.abc import Sequence

import numpy as np
from jaxtyping import Bool, Float, Int

from wm.geometry.rays.pinhole import look_rotations
from wm.geometry.rays.raycast import RayScene
from wm.geometry.rays.surface_points import SurfacePoints, in_sight

VALUES = np.array([1.0, 0.15, 0.08, 0.01])
"""What the first, second, third and any further view of a point add."""
_SWEEPS = 2
"""Times each position chooses again, once the others have chosen."""


@dataclasses.dataclass(frozen=True, eq=False)
class Aims:
    """Views to choose from, of which one is wanted."""

    eyes: np.ndarray  # [k, 3] float64
    looks: np.ndarray  # [k, 3] float64 directions, not unit


def choose_aims(
    scene: RayScene,
    points: SurfacePoints,
    options: Sequence[Aims],
    times: Int[np.ndarray, "p"],
    *,
    half_extent: tuple[float, float],
) -> list[int]:
    """For each set of options the index of the one picked.

    Args:
        points: what is to be seen.
        options: at least one view in each.
        times: how often other views already see each point.
        half_extent: tangents of half the fields of view, across and down.
    """
    masks = [_masks(scene, points, aims, half_extent) for aims in options]
    times = times.copy()
    chosen = [-1] * len(options)
    for _ in options:
        gains = [mask @ _worth(times) if pick < 0 else np.full(1, -1.0) for mask, pick in zip(masks, chosen)]
        position = int(np.argmax([gain.max() for gain in gains]))
        chosen[position] = int(np.argmax(gains[position]))
        times += masks[position][chosen[position]] > 0
    for position in [*range(len(options))] * _SWEEPS:
        times -= masks[position][chosen[position]] > 0
        chosen[position] = int(np.argmax(masks[position] @ _worth(times)))
        times += masks[position][chosen[position]] > 0
    return chosen


def _worth(times: Int[np.ndarray, "p"]) -> Float[np.ndarray, "p"]:
    return VALUES[np.minimum(times, len(VALUES) - 1)].astype(np.float32)


def _masks(scene: RayScene, points: SurfacePoints, aims: Aims, half_extent: tuple[float, float]) -> Float[np.ndarray, "k p"]:
    """1 where a view sees a point, else 0 (floats, for the sums are matrix products); views at one place share shadow rays."""
    places, place = np.unique(aims.eyes, axis=0, return_inverse=True)
    seen = np.zeros((len(aims.eyes), len(points.face)), np.float32)
    everything = np.arange(len(points.face))
    for k, eye in enumerate(places):
        clear = np.flatnonzero(in_sight(scene, points, everything, eye))
        own = np.flatnonzero(place.reshape(-1) == k)
        seen[np.ix_(own, clear)] = _framed(aims.looks[own], points.position[clear] - eye, half_extent)
    return seen


def _framed(
    looks: Float[np.ndarray, "k 3"], offsets: Float[np.ndarray, "c 3"], half_extent: tuple[float, float]
) -> Bool[np.ndarray, "k c"]:
    x, y, z = (look_rotations(looks).reshape(-1, 3) @ offsets.T).reshape(len(looks), 3, -1).transpose(1, 0, 2)
    return (np.abs(x) < half_extent[0] * z) & (np.abs(y) < half_extent[1] * z)
