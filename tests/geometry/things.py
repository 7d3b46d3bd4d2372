"""Objects for tests: boxes of one colour, standing or hung anywhere."""

import numpy as np

from wm.types import SceneObject

_CORNERS = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)], float)
_SIDES = ((0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3))  # outward, counter-clockwise
_FACES = np.array([t for a, b, c, d in _SIDES for t in ((a, b, c), (a, c, d))], np.int32)


def box(low, high, color=(0.8, 0.2, 0.1), room: int = 0, label: str = "box") -> SceneObject:
    """An axis-aligned box from corner `low` to corner `high`."""
    low, high = np.array(low, float), np.array(high, float)
    foot = np.eye(4)
    foot[:3, 3] = [*(low + high)[:2] / 2, low[2]]
    return SceneObject(
        label=label,
        room=room,
        support="floor",
        vertices=low + _CORNERS * (high - low),
        faces=_FACES.copy(),
        face_slot=np.zeros(len(_FACES), np.int32),
        slots=("paint",),
        slot_colors=np.array([color], np.float32),
        T_world_object=foot,
        size=high - low,
        emission=np.zeros(1, np.float32),
    )
