"""Putting one thing on another: which top is below it, whether that carries it, and where on it there is room.

A top carries where the upper faces near the height of the box's top cover at least half of what is to stand there: a table
does, the back of an armchair does not.
"""

import dataclasses

import numpy as np
import shapely
from jaxtyping import Float
from shapely.geometry.base import BaseGeometry

from wm.geometry.mesh.scene_mesh import face_crosses
from wm.geometry.placement.occupancy import Occupancy
from wm.geometry.placement.upright_box import UprightBox, box_of
from wm.types import SceneObject

_BELOW = 0.3
"""Metres above or below its seen foot within which a thing finds the top it stands on."""
_BESIDE = 0.3
"""Metres beside a top from which a thing is still brought onto it."""
_LEVEL = 0.02
"""Metres below the highest point within which a face belongs to the top."""
_CARRIED = 0.5
"""Share of its footprint that must be carried."""
_STEP = 0.03


def stacked(box: UprightBox, things: list[SceneObject], taken: Occupancy, *, lift: float) -> UprightBox | None:
    """The box on the best top below it, moved as little as it takes; None where no top takes it."""
    for below in _supporters(box, things, lift):
        area = top_area(below)
        shapely.prepare(area)
        raised = dataclasses.replace(box, z=box_of(below).top + lift)
        if _carried(raised, area) and taken.allows(raised, exactly=True):
            return raised
        for place in _places(raised, box_of(below)):
            if _carried(place, area) and taken.allows(place):
                return place
    return None


def top_area(thing: SceneObject) -> BaseGeometry:
    """From above, the faces of a thing that look up and lie at its highest level."""
    corners = thing.vertices[thing.faces]
    normal = face_crosses(corners)
    level = corners[:, :, 2].min(axis=1) > thing.vertices[:, 2].max() - _LEVEL
    up = level & (normal[:, 2] > 0.9 * np.linalg.norm(normal, axis=1)) & (normal[:, 2] > 1e-12)
    return shapely.union_all(shapely.polygons(corners[up][:, :, :2]))


def _supporters(box: UprightBox, things: list[SceneObject], lift: float) -> list[SceneObject]:
    """Things whose top is near a box's foot, the nearest first."""
    found = []
    for k, thing in enumerate(things):
        below = box_of(thing)
        height = abs(below.top + lift - box.z)
        aside = float(np.linalg.norm(_outside(box.center, below)))
        if thing.support in ("floor", "object", "wall") and height < _BELOW and aside < _BESIDE:
            found.append((height + 2 * aside, below.x, below.y, k))
    return [things[k] for *_, k in sorted(found)]


def _outside(point: Float[np.ndarray, "2"], box: UprightBox) -> Float[np.ndarray, "2"]:
    """How far a point is beyond a box's sides, in the box's axes."""
    local = box.axes @ (point - box.center)
    return np.maximum(np.abs(local) - box.half, 0.0)


def _carried(box: UprightBox, area: BaseGeometry) -> bool:
    footprint = box.footprint
    return bool(area.intersects(shapely.Point(box.x, box.y))) and area.intersection(footprint).area >= _CARRIED * footprint.area


def _places(box: UprightBox, below: UprightBox) -> list[UprightBox]:
    """The box at points of a grid on a top, the nearest first."""
    counts = np.maximum((2 * below.half / _STEP).astype(int), 1)
    grid = np.stack(np.meshgrid(*[np.linspace(-h, h, n + 1) for h, n in zip(below.half, counts)]), axis=-1).reshape(-1, 2)
    points = below.center + grid @ below.axes
    order = np.argsort(np.linalg.norm(points - box.center, axis=1), kind="stable")
    return [dataclasses.replace(box, x=float(x), y=float(y)) for x, y in points[order]]
