"""The plan from above: the free floor of each room, inside its walls.

A room's interior is its polygon moved in along every wall by that wall's thickness, corners mitred. In general position the
inner faces of neighbouring walls meet where their lines do; where the lines are so nearly parallel that they would meet far
away (one half as thick as the other), the thicker wall ends in a step instead.
"""

import functools

import numpy as np
import shapely
from shapely.geometry import Polygon

from wm.geometry.plan.records import FloorPlan
from wm.geometry.plan.walls import SHARED, Wall, plan_walls, room_polygons

ENTERED = 0.3  # metres: the radius of a disk that fits into every room that is entered, a little more than a body
_MITRE = 4.0  # wall thicknesses beyond a corner at which a mitre is cut off
_DUST = 1e-6  # square metres below which a part of an interior is rounding error


def interior_polygon(plan: FloorPlan, room_index: int) -> Polygon:
    """The free floor of a room: the polygon of its inner wall faces, counter-clockwise.

    Raises:
      ValueError: the walls leave no floor, or more than one piece of it (`parse_plan` refuses such plans).
    """
    interior = interiors(plan)[room_index]
    if interior is None:
        raise ValueError(f"room {plan.rooms[room_index].id}: its walls leave no floor in one piece")
    return interior


@functools.lru_cache(maxsize=4)
def interiors(plan: FloorPlan) -> tuple[Polygon | None, ...]:
    """The free floor of every room, None where the walls leave no floor in one piece; computed once per plan."""
    return tuple(
        _interior(polygon, walls, room.columns) for room, polygon, walls in zip(plan.rooms, room_polygons(plan), plan_walls(plan))
    )


def _interior(polygon: Polygon, walls: tuple[Wall, ...], columns: tuple[np.ndarray, ...]) -> Polygon | None:
    """A polygon less the bodies of its walls and its columns.

    shapely's buffer would do where all walls are equally thick, but it moves shallow corners by up to a hundredth of its
    distance, and openings are carved to within rounding error of a wall's face.
    """
    bodies = [Polygon(column) for column in columns]
    for ring in range(walls[-1].ring + 1):
        around = [wall for wall in walls if wall.ring == ring]
        for before, after in zip(around, (*around[1:], around[0])):
            bodies += [_band(before, after.start), *_corner(before, after)]
    rest = polygon.difference(shapely.union_all(bodies))
    parts = [part for part in shapely.get_parts(rest) if part.area > _DUST]
    if len(parts) != 1:
        return None
    clean = shapely.simplify(parts[0], 1e-7)
    return shapely.orient_polygons(clean)


def _band(wall: Wall, end: np.ndarray) -> Polygon:
    """The body of a wall between its two corners, from just outside to its inner face.

    It has the corners themselves as points, so that it and what fills them (`_corner`) have whole edges in common.
    """
    out, into = -SHARED * wall.normal, wall.thickness * wall.normal
    return Polygon([wall.start, wall.start + out, end + out, end, end + into, wall.start + into])


def _corner(before: Wall, after: Wall) -> list[Polygon]:
    """What the bodies of two walls leave open at the corner they share, up to where their inner faces meet."""
    corner, limit = after.start, _MITRE * max(before.thickness, after.thickness)
    near, far = corner + before.thickness * before.normal, corner + after.thickness * after.normal
    past, short = _reach(before, after, before.direction), _reach(after, before, -after.direction)
    meet = near + past * before.direction
    filled = [Polygon([corner, face, meet]) for face, reach in ((near, past), (far, short)) if 0 < reach <= limit]
    if filled:
        return filled
    if float(before.direction @ after.normal) <= 0:  # the corner does not point into the room
        return []
    on = limit / 2 if float(before.direction @ after.direction) < 0 else 0.0  # a sharp corner is cut off straight, not short
    return [Polygon([corner, near, near + on * before.direction, far - on * after.direction, far])]


def _reach(wall: Wall, other: Wall, onward: np.ndarray) -> float:
    """Metres past the corner it shares with `other`, `onward`, at which the wall's inner face meets the other's; 0 if nowhere."""
    sine = float(onward @ other.normal)
    if abs(sine) < 1e-9:
        return 0.0
    # From (V + t n + s u) . n_other = t_other, with s along the wall away from itself.
    return (other.thickness - wall.thickness * float(wall.normal @ other.normal)) / sine
