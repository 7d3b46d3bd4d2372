"""The plan from above: the free floor of each room, and the portals between rooms.

A room's interior is its polygon moved in along every wall by that wall's thickness, corners mitred. In general position the
inner faces of neighbouring walls meet where their lines do; where the lines are so nearly parallel that they would meet far
away (one half as thick as the other), the thicker wall ends in a step instead.
"""

import dataclasses
import functools

import numpy as np
import shapely
from shapely.geometry import Polygon

from wm.geometry.plan.openings import Place, place_openings
from wm.geometry.plan.records import FloorPlan, Opening, PlanError
from wm.geometry.plan.walls import Wall, plan_walls, room_polygons
from wm.types import OUTSIDE

_MITRE = 4.0  # wall thicknesses beyond a corner at which a mitre is cut off
_DUST = 1e-6  # square metres below which a part of an interior is rounding error


@dataclasses.dataclass(frozen=True, eq=False)
class Portal:
    """One opening of the building, once, whether one room lists it or both."""

    kind: str  # door | window | passage
    rooms: tuple[int, int]  # (a, b) indices into the plan's rooms, a < b; b is OUTSIDE for a window
    ends: np.ndarray  # [2, 2] float64, on the wall's centre line; room a on the left of ends[0] -> ends[1]
    normal: np.ndarray  # [2] float64 unit, from a to b
    sill: float  # metres above the floor
    head: float
    half_depths: tuple[float, float]  # metres from the centre line to the wall's face in a and in b (or outside)

    @property
    def width(self) -> float:
        return float(np.linalg.norm(self.ends[1] - self.ends[0]))


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
def walls_of(plan: FloorPlan) -> tuple[tuple[Wall, ...], ...]:
    """The walls of every room; computed once a plan (plans are read-only and compared by identity)."""
    return plan_walls(plan)


@functools.lru_cache(maxsize=4)
def interiors(plan: FloorPlan) -> tuple[Polygon | None, ...]:
    """The free floor of every room, None where the walls leave no floor in one piece; computed once a plan."""
    thin = shapely.buffer(
        room_polygons(plan),
        -plan.wall_thickness / 2,
        join_style="mitre",
        mitre_limit=_MITRE,
    )
    return tuple(_interior(polygon, walls) for polygon, walls in zip(thin, walls_of(plan)))


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


@functools.lru_cache(maxsize=4)
def portals(plan: FloorPlan) -> tuple[Portal, ...]:
    """Every opening of the plan once, in the order in which rooms list them.

    Raises:
      PlanError: an opening is not on its wall, a door leads nowhere, or a window looks into a room.
    """
    places, violations = place_openings(plan, walls_of(plan))
    if violations:
        raise PlanError(violations)
    return tuple(_portal(plan.rooms[place.room].openings[place.opening], place) for place in places)


def _portal(opening: Opening, place: Place) -> Portal:
    wall, behind = place.wall, place.behind
    if behind is None:
        rooms, centre, half_depths = (place.room, OUTSIDE), wall.thickness / 2, (wall.thickness / 2, wall.thickness / 2)
    else:
        rooms, centre = (place.room, behind.room), -place.gap / 2
        half_depths = (wall.thickness - centre, wall.thickness - centre)
    along = np.array([[place.low], [place.high]])
    ends = wall.start + centre * wall.normal + along * wall.direction
    normal = -wall.normal
    if behind is not None and rooms[0] > rooms[1]:
        rooms, ends, normal = (rooms[1], rooms[0]), ends[::-1], -normal
    return Portal(
        kind=opening.kind,
        rooms=rooms,
        ends=ends,
        normal=normal,
        sill=opening.sill_height,
        head=opening.sill_height + opening.height,
        half_depths=half_depths,
    )
