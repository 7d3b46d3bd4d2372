"""Where planned cameras look: each position is given several possible views, and one of each is picked so that together they
see as much of the room's surface as often as possible.

Greedy: again and again the position and view that add most. A surface point is worth VALUES[k] to the view that is the
(k + 1)-th to see it, so unseen surface comes first, and seen three times is what is aimed for (texture and splats want parallax).
The sum is submodular, so the greedy choice reaches at least half of the best possible (Fisher, Nemhauser and Wolsey, 1978).
"""

from collections.abc import Sequence

import numpy as np
from jaxtyping import Bool, Int

from wm.geometry.camera import camera_center
from wm.geometry.raycast import RayScene
from wm.geometry.surface_points import SurfacePoints, framed, in_sight
from wm.types import Camera

VALUES = np.array([1.0, 0.3, 0.15, 0.02])
"""Of the first, second, third and any further view of a point."""


def choose_views(
    scene: RayScene, points: SurfacePoints, options: Sequence[Sequence[Camera]], times: Int[np.ndarray, "p"]
) -> list[Camera]:
    """One camera for each position, in the positions' order.

    Args:
        points: what is to be seen.
        options: for each position the cameras to choose from, at least one.
        times: how often other views already see each point.
    """
    masks = [_masks(scene, points, cameras) for cameras in options]
    times = times.copy()
    chosen = np.full(len(options), -1)
    for _ in options:
        worth = VALUES[np.minimum(times, len(VALUES) - 1)]
        gains = [float(np.max(mask @ worth)) if pick < 0 else -1.0 for mask, pick in zip(masks, chosen)]
        position = int(np.argmax(gains))
        chosen[position] = np.argmax(masks[position] @ worth)
        times += masks[position][chosen[position]]
    return [cameras[pick] for cameras, pick in zip(options, chosen)]


def _masks(scene: RayScene, points: SurfacePoints, cameras: Sequence[Camera]) -> Bool[np.ndarray, "cameras p"]:
    """Which camera sees which point; cameras at one place share their shadow rays."""
    inside = np.stack([framed(camera, points) for camera in cameras])
    centres = np.stack([camera_center(camera) for camera in cameras])
    _, place = np.unique(np.round(centres, 9), axis=0, return_inverse=True)
    for k in range(place.max() + 1):
        own = np.flatnonzero(place.reshape(-1) == k)
        which = np.flatnonzero(inside[own].any(axis=0))
        clear = np.zeros(len(points.face), bool)
        clear[which] = in_sight(scene, points, which, centres[own[0]])
        inside[own] &= clear
    return inside
