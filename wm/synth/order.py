"""The order in which views are painted, and the finished view that is the style reference of each.

sim(q1, q2) = |q1 . q2| of unit quaternions: 1 for equal orientations, 0 for orientations half a turn apart (paper, "Viewpoint
Generation for Appearance Synthesis"). In each room the two bootstrap views come first. After them, the next view is always the
one that is most similar to any finished view.

The bootstrap views of the first room are the anchors of the scene: they are painted before everything else. After them each room
looks only at the anchors and at itself, so that rooms can be painted side by side and the order within a room does not depend on
the others.
"""

import dataclasses
from collections.abc import Sequence

import numpy as np
from jaxtyping import Float

from wm.geometry.rays.pinhole import camera_quat
from wm.types import View


@dataclasses.dataclass(frozen=True)
class PaintStep:
    """One view to paint, by its index and that of its reference."""

    view: int  # `paint_order`: index into the room's views; `scene_order`: into the scene's views
    reference: int | None  # likewise, where `paint_order` counts the done views first; None if no view is finished yet


@dataclasses.dataclass(frozen=True)
class RoomSteps:
    """Views of one room, in painting order."""

    room: int
    steps: tuple[PaintStep, ...]


@dataclasses.dataclass(frozen=True)
class SceneOrder:
    """The views of a scene: the anchors in painting order, then the other views of each room, which wait for no other room."""

    anchors: RoomSteps
    rooms: tuple[RoomSteps, ...]  # the first room, whose rest may be empty, then the others

    @property
    def views(self) -> tuple[int, ...]:
        """All views by index, in the order in which they are painted if one room is painted after the other."""
        return tuple(step.view for part in (self.anchors, *self.rooms) for step in part.steps)

    @property
    def referred(self) -> frozenset[int]:
        """The views that are the reference of another one."""
        steps = (step for part in (self.anchors, *self.rooms) for step in part.steps)
        return frozenset(step.reference for step in steps if step.reference is not None)

    def after(self, part: RoomSteps) -> tuple[int, ...]:
        """The views, of those in `views`, that come after the views of a part."""
        parts = (self.anchors, *self.rooms)
        later = parts[parts.index(part) + 1 :]
        return tuple(step.view for one in later for step in one.steps)


def similarity(q1: Float[np.ndarray, "n 4"], q2: Float[np.ndarray, "m 4"]) -> Float[np.ndarray, "n m"]:
    """|q1 . q2| of every pair of quaternions (wxyz) after normalisation: in [0, 1] and equal for q and -q."""
    unit1, unit2 = (q / np.linalg.norm(q, axis=1, keepdims=True) for q in (q1, q2))
    return np.minimum(np.abs(unit1 @ unit2.T), 1.0)


def paint_order(quats: Float[np.ndarray, "n 4"], done: Float[np.ndarray, "d 4"], *, bootstraps: int = 2) -> list[PaintStep]:
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


def scene_order(views: Sequence[View]) -> SceneOrder:
    """The painting order of a scene's views. The first room is the one with the lowest index.

    Raises:
      ValueError: there is no view.
    """
    if not views:
        raise ValueError("a scene without views has no painting order")
    first, *others = sorted({view.room for view in views})
    steps = _room_steps(views, first, ())
    count = _bootstraps(views, first)
    anchors = RoomSteps(first, steps[:count])
    done = [step.view for step in anchors.steps]
    rest = [RoomSteps(room, _room_steps(views, room, done)) for room in others]
    return SceneOrder(anchors=anchors, rooms=(RoomSteps(first, steps[count:]), *rest))


def _room_steps(views: Sequence[View], room: int, done: Sequence[int]) -> tuple[PaintStep, ...]:
    members = [i for i, view in enumerate(views) if view.room == room]
    members.sort(key=lambda i: views[i].kind != "bootstrap")
    known = [*done, *members]
    steps = paint_order(_quats(views, members), _quats(views, done), bootstraps=_bootstraps(views, room))
    return tuple(PaintStep(members[s.view], None if s.reference is None else known[s.reference]) for s in steps)


def _bootstraps(views: Sequence[View], room: int) -> int:
    return sum(view.room == room and view.kind == "bootstrap" for view in views)


def _quats(views: Sequence[View], indices: Sequence[int]) -> np.ndarray:
    return np.array([camera_quat(views[i].camera) for i in indices]).reshape(-1, 4)
