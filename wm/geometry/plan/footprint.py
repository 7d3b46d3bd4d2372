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
from wm.geometry.plan.walls import Wall, plan_walls, room_polygons

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
    thin = shapely.buffer(
        room_polygons(plan),
        -plan.wall_thickness / 2,
        join_style="mitre",
        mitre_limit=_MITRE,
    )
    return tuple(_interior(polygon, walls) for polygon, walls in zip(thin, plan_walls(plan)))


def _interior(thin: Polygon, walls: tuple[Wall, ...]) -> Polygon | None:
    """A polygon already moved in by half a wall, less the full thickness of its exterior walls."""
    bands = [_band(walls, k) for k, wall in enumerate(walls) if not wall.behind]
    rest = thin.difference(shapely.union_all(shapely.polygons(bands))) if bands else thin
    parts = [part for part in shapely.get_parts(rest) if part.area > _DUST]
    if len(parts) != 1 or len(parts[0].interiors):
        return None
    clean = shapely.simplify(parts[0], 1e-7)
    return shapely.orient_polygons(clean)


def _band(walls: tuple[Wall, ...], k: int) -> np.ndarray:
    """[4, 2]: the body of wall k, from just outside to its inner face, run on to where it meets its neighbours' inner faces."""
    wall = walls[k]
    at_start = _overrun(wall, walls[k - 1], 1.0)
    at_end = _overrun(wall, walls[(k + 1) % len(walls)], -1.0)
    first = wall.start - at_start * wall.direction
    last = wall.start + (wall.length + at_end) * wall.direction
    outer, inner = -wall.thickness * wall.normal, wall.thickness * wall.normal
    return np.stack([first + outer, last + outer, last + inner, first + inner])


def _overrun(wall: Wall, other: Wall, sign: float) -> float:
    """Metres past the corner it shares with `other` at which the wall's inner face meets the other's; 0 if before it."""
    sine = sign * float(wall.direction @ other.normal)
    if abs(sine) < 1e-9:
        return 0.0
    # From (V + t n + s u) . n_other = t_other, with s along the wall away from itself.
    reach = -(other.thickness - wall.thickness * float(wall.normal @ other.normal)) / sine
    return reach if 0 < reach <= _MITRE * wall.thickness else 0.0
