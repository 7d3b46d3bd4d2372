"""Standing places to begin at: for the house, for each room and for each part that cannot be reached from the others."""

import dataclasses
import math
from collections.abc import Sequence

import numpy as np
import shapely
from jaxtyping import Float

from wm.geometry.placement.navmesh import Navmesh
from wm.geometry.plan.footprint import interior_polygon
from wm.geometry.plan.openings import portals
from wm.geometry.plan.portal import Portal
from wm.geometry.plan.records import FloorPlan
from wm.types import OUTSIDE

_TOLERANCE = 0.02  # metres, of the point farthest from walls
_DIRECTIONS = 16  # in which the view from a place is measured


@dataclasses.dataclass(frozen=True)
class Spawn:
    """A place on the navmesh where a body stands free.

    Attributes:
        position: x, y, z of its foot, metres
        yaw: degrees counter-clockwise from above; at 0 it looks along +x
        room: index into FloorPlan.rooms
        part: of the navmesh
        clearance: metres beyond the body's own radius to the nearest wall or obstacle
    """

    position: tuple[float, float, float]
    yaw: float
    room: int
    part: int
    clearance: float


def room_spawns(plan: FloorPlan, navmesh: Navmesh) -> tuple[Spawn | None, ...]:
    """For each room the place of its floor with the most free air around it, None where no body can stand."""
    return tuple(_room_spawn(plan, navmesh, room) for room in range(len(plan.rooms)))


def part_spawns(plan: FloorPlan, navmesh: Navmesh, rooms: Sequence[Spawn | None]) -> tuple[Spawn, ...]:
    """For each part of the navmesh one place: behind an entrance if it has one, else in the room with the most free floor."""
    count = int(navmesh.part.max(initial=-1)) + 1
    return tuple(_part_spawn(plan, navmesh, rooms, part) for part in range(count))


def _room_spawn(plan: FloorPlan, navmesh: Navmesh, room: int) -> Spawn | None:
    best = None
    for part in np.unique(navmesh.part[navmesh.room == room]):
        area = _area(navmesh, (navmesh.room == room) & (navmesh.part == part))
        circle = max((_widest(piece) for piece in shapely.get_parts(area)), key=lambda one: one[1])
        if best is None or circle[1] > best[1]:
            best = (*circle, int(part))
    if best is None:
        return None
    point, clearance, part = best
    return Spawn((*point, 0.0), _longest_view(point, interior_polygon(plan, room)), room, part, clearance)


def _part_spawn(plan: FloorPlan, navmesh: Navmesh, rooms: Sequence[Spawn | None], part: int) -> Spawn:
    mine = [spawn for spawn in rooms if spawn is not None and spawn.part == part]
    for portal in portals(plan):
        if portal.kind == "door" and portal.rooms[1] == OUTSIDE:
            entered = _behind(portal, navmesh, part)
            if entered is not None:
                return entered
    if mine:
        return max(mine, key=lambda spawn: float(navmesh.areas[(navmesh.room == spawn.room) & (navmesh.part == part)].sum()))
    room = int(navmesh.room[navmesh.part == part].max())
    point, clearance = _widest(max(shapely.get_parts(_area(navmesh, navmesh.part == part)), key=lambda piece: piece.area))
    return Spawn((*point, 0.0), 0.0, room, part, clearance)


def _behind(portal: Portal, navmesh: Navmesh, part: int) -> Spawn | None:
    """The place just inside an entrance, looking into the house; None where its room has no floor of this part."""
    room = portal.rooms[0]
    mine = (navmesh.room == room) & (navmesh.part == part)
    if not mine.any():
        return None
    area = _area(navmesh, mine)
    middle = portal.ends.mean(axis=0) - (portal.half_depths[0] + 2 * navmesh.radius) * portal.normal
    inner = area.buffer(-navmesh.radius / 2)  # not in the last gap that a body just fits
    target = inner if not inner.is_empty else area.buffer(-1e-3)
    if target.is_empty:
        return None
    nearest = shapely.get_coordinates(shapely.shortest_line(target, shapely.Point(middle)))[0]
    yaw = math.degrees(math.atan2(-portal.normal[1], -portal.normal[0]))
    clearance = float(shapely.Point(nearest).distance(area.boundary))
    return Spawn((round(float(nearest[0]), 4), round(float(nearest[1]), 4), 0.0), round(yaw, 1), room, part, clearance)


def _area(navmesh: Navmesh, mine: np.ndarray) -> shapely.Geometry:
    """The union of some triangles."""
    return shapely.union_all(shapely.polygons(navmesh.vertices[navmesh.triangles[mine], :2]))


def _widest(piece: shapely.Polygon) -> tuple[tuple[float, float], float]:
    """The point of a polygon farthest from its edge, to a tenth of a millimetre, and that distance."""
    circle = shapely.maximum_inscribed_circle(piece, tolerance=_TOLERANCE)
    x, y = circle.coords[0]
    return (round(x, 4), round(y, 4)), float(circle.length)


def _longest_view(point: tuple[float, float], floor: shapely.Polygon) -> float:
    """The direction, in degrees, in which the room's walls are farthest."""
    angles = 2 * np.pi * np.arange(_DIRECTIONS) / _DIRECTIONS
    low_x, low_y, high_x, high_y = floor.bounds
    reach = math.hypot(high_x - low_x, high_y - low_y)
    ends: Float[np.ndarray, "d 2"] = np.asarray(point) + reach * np.stack([np.cos(angles), np.sin(angles)], axis=1)
    rays = shapely.linestrings(np.stack([np.broadcast_to(point, ends.shape), ends], axis=1))
    hits = shapely.distance(shapely.intersection(rays, floor.exterior), shapely.Point(point))
    return float(np.degrees(angles[int(np.nanargmax(np.round(hits, 6)))]))
