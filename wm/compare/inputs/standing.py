"""Where in a room there is most air round a viewer's head."""

import numpy as np
from jaxtyping import Float

from wm.finished import FinishedRun
from wm.geometry.cameras.air import free, room_air

_WIDEST = (1.2, 0.9, 0.7, 0.5, 0.4)  # metres of free air that are asked for, one after the other


def standing_place(run: FinishedRun, room: int) -> Float[np.ndarray, "3"]:
    """A free place at eye height with as much air round it as the room has, the one nearest to the room's middle.

    Raises: InputError where the room has no free place at all, naming it.
    """
    air = room_air(run.plan, room, run.rays, run.cameras)
    spots = air.spots[air.eye_height]
    for clearance in _WIDEST:
        roomy = spots[free(air.scene, spots, clearance)]
        if len(roomy):
            spots = roomy
            break
    middle = air.samples.mean(axis=0)
    return spots[np.argmin(np.linalg.norm(spots[:, :2] - middle, axis=1))]
