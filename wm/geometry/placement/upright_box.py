"""Boxes that stand upright: what a thing takes up of a room, whichever way it is turned about the vertical.

Overlaps are measured by the separating axes of two rectangles (Gottschalk, Lin, Manocha, "OBBTree", 1996): the least distance
by which one would have to be moved to be clear of the other.
"""

import dataclasses
import math

import numpy as np
import shapely
from jaxtyping import Float

from wm.types import SceneObject


@dataclasses.dataclass(frozen=True)
class UprightBox:
    """A box with a vertical axis."""

    x: float  # centre of the footprint, metres
    y: float
    z: float  # of the bottom
    yaw: float  # radians about z, counter-clockwise
    width: float  # along the turned x axis
    depth: float  # along the turned y axis
    height: float

    @property
    def top(self) -> float:
        return self.z + self.height

    @property
    def center(self) -> np.ndarray:
        """[2] of the footprint."""
        return np.array([self.x, self.y])

    @property
    def half(self) -> np.ndarray:
        """[2] half the footprint's width and depth."""
        return np.array([self.width, self.depth]) / 2

    @property
    def axes(self) -> np.ndarray:
        """[2, 2] rows: the directions of width and depth."""
        c, s = math.cos(self.yaw), math.sin(self.yaw)
        return np.array([[c, s], [-s, c]])

    @property
    def transform(self) -> np.ndarray:
        """[4, 4] T_world_box: from the frame at the middle of its foot."""
        c, s = math.cos(self.yaw), math.sin(self.yaw)
        return np.array([[c, -s, 0.0, self.x], [s, c, 0.0, self.y], [0.0, 0.0, 1.0, self.z], [0.0, 0.0, 0.0, 1.0]])

    @property
    def corners(self) -> np.ndarray:
        """[4, 2] of the footprint, counter-clockwise."""
        return self.center + (np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]]) * self.half) @ self.axes

    @property
    def footprint(self) -> shapely.Polygon:
        return shapely.Polygon(self.corners)

    @property
    def volume(self) -> float:
        return self.width * self.depth * self.height


def box_of(thing: SceneObject) -> UprightBox:
    """The upright box around a thing, turned as the thing's own frame is."""
    T = thing.T_world_object
    yaw = math.atan2(float(T[1, 0]), float(T[0, 0]))
    c, s = math.cos(yaw), math.sin(yaw)
    turn = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
    local = thing.vertices @ turn
    low, high = local.min(axis=0), local.max(axis=0)
    x, y, z = (turn @ np.array([*(low + high)[:2] / 2, low[2]])).tolist()
    width, depth, height = (high - low).tolist()
    return UprightBox(x, y, z, yaw, width, depth, height)


def penetration(box: UprightBox, others: list[UprightBox]) -> Float[np.ndarray, "n"]:
    """Metres by which a box reaches into each of the others, from above; negative: how far apart they are at least."""
    if not others:
        return np.zeros(0)
    centers = np.array([other.center for other in others])
    halves = np.array([other.half for other in others])
    theirs = np.array([other.axes for other in others])
    own = np.broadcast_to(box.axes, theirs.shape)
    axes = np.concatenate([own, theirs], axis=1)  # [n, 4, 2]
    between = np.abs(np.einsum("nak,nk->na", axes, centers - box.center))
    reach = np.abs(axes @ box.axes.T) @ box.half + np.einsum("nab,nb->na", np.abs(axes @ theirs.swapaxes(1, 2)), halves)
    return (reach - between).min(axis=1)


def overlap_height(box: UprightBox, others: list[UprightBox]) -> Float[np.ndarray, "n"]:
    """Metres of height that a box shares with each of the others; negative: how far one is above the other."""
    return np.array([min(box.top, other.top) - max(box.z, other.z) for other in others])


def box_iou(a: UprightBox, b: UprightBox) -> float:
    """Volume shared by two boxes over the volume of both together, 0..1."""
    height = min(a.top, b.top) - max(a.z, b.z)
    if height <= 0:
        return 0.0
    shared = a.footprint.intersection(b.footprint).area * height
    return shared / max(a.volume + b.volume - shared, 1e-12)
