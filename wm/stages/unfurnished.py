"""Rooms that stay empty although their furniture should come out of images, and why: a line for whoever started the run."""

import pathlib
from collections.abc import Sequence

from wm.geometry import FloorPlan
from wm.synth.lifting.drawings import kept_drawings
from wm.types import SceneObject


def unfurnished(folder: pathlib.Path, plan: FloorPlan, objects: Sequence[SceneObject]) -> list[str]:
    """A line for each reason that leaves rooms without any object; none if all have some.

    Args:
      folder: the run folder, which keeps the drawings that could be measured.
      plan: the floor plan.
      objects: all objects of the scene.
    """
    furnished = {thing.room for thing in objects}
    empty = [room for index, room in enumerate(plan.rooms) if index not in furnished]
    measured = {drawing.name.rpartition("/")[0] for drawing in kept_drawings(folder)}
    reasons = {
        "the depth of none of its drawings fits the empty room": [room.name for room in empty if room.id not in measured],
        "nothing was found in its drawings that can stand there": [room.name for room in empty if room.id in measured],
    }
    return [f"{', '.join(names)} without furniture: {reason}" for reason, names in reasons.items() if names]
