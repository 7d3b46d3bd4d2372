"""The room as furniture meets it: its free floor, walls, openings, and the zones that must stay clear."""

import dataclasses
import math
from collections.abc import Sequence

import numpy as np
import shapely
from shapely.geometry.base import BaseGeometry

from wm.geometry.plan.footprint import interior_polygon
from wm.geometry.plan.openings import portals
from wm.geometry.plan.records import FloorPlan
from wm.types import SceneObject

DOOR_DEPTH = 0.9
"""Metres of floor kept clear before a door or a passage."""

DOOR_SIDE = 0.05
"""Metres kept clear on either side of it."""

INTO_WALL = 0.05
"""Metres by which the zone before a door reaches into the wall, so that no sliver of floor is left between them."""


@dataclasses.dataclass(frozen=True)
class WallOpening:
    """A portal as one wall shows it: a rectangle in metres along the wall from where it starts, and above the floor.

    Furniture sees it on the walls of a `Site`, the offline world's textures on the chart of a wall.
    """

    kind: str  # door | window | passage | hatch
    low: float
    high: float
    sill: float
    head: float


def wall_opening(
    kind: str, ends: np.ndarray, sill: float, head: float, *, start: np.ndarray, direction: np.ndarray
) -> WallOpening:
    """An opening with its ends [2, 2] near a wall, on the wall that begins at `start` [2] and runs along `direction` [2]."""
    low, high = np.sort((ends - start) @ direction).tolist()
    return WallOpening(kind, low, high, sill, head)


@dataclasses.dataclass(frozen=True, eq=False)
class Taken:
    """Room that something takes up which stands before a room is furnished."""

    outline: BaseGeometry  # from above
    low: float  # metres above the floor
    high: float


@dataclasses.dataclass(frozen=True, eq=False)
class Site:
    """One room."""

    polygon: shapely.Polygon  # inner wall faces, counter-clockwise
    ceiling: float  # metres
    starts: np.ndarray  # [w, 2] float64: where each wall begins
    directions: np.ndarray  # [w, 2] unit
    normals: np.ndarray  # [w, 2] unit, into the room
    lengths: np.ndarray  # [w]
    openings: tuple[tuple[int, WallOpening], ...]  # (index of its wall, the opening), in the order of the plan
    keep: tuple[shapely.Polygon, ...]  # zones before doors and passages
    probes: np.ndarray  # [d, 2]: a standing place before each door and passage
    centre: tuple[float, float]  # the point of the floor farthest from the walls
    taken: tuple[Taken, ...] = ()  # what stands there already, of the user's own


def make_site(polygon: shapely.Polygon, ceiling: float, openings: list[tuple[str, np.ndarray, float, float]]) -> Site:
    """A room's site.

    Args:
      polygon: the inner wall faces.
      ceiling: height above the floor, metres.
      openings: (kind, ends [2, 2] near the wall's face, sill, head) of each.
    """
    polygon = shapely.orient_polygons(polygon)
    rings = [np.asarray(ring.coords, np.float64) for ring in (polygon.exterior, *polygon.interiors)]
    starts, edges = np.concatenate([ring[:-1] for ring in rings]), np.concatenate([np.diff(ring, axis=0) for ring in rings])
    lengths = np.linalg.norm(edges, axis=1)
    directions = edges / lengths[:, None]
    normals = np.stack([-directions[:, 1], directions[:, 0]], -1)
    placed, keep, probes = [], [], []
    for kind, ends, sill, head in openings:
        k = nearest_wall(ends, starts, directions, normals, lengths)
        whole = wall_opening(kind, ends, sill, head, start=starts[k], direction=directions[k])
        low, high = max(whole.low, 0.0), min(whole.high, float(lengths[k]))
        placed.append((k, dataclasses.replace(whole, low=low, high=high)))
        if kind in ("window", "hatch"):
            continue
        a, b = starts[k] + (low - DOOR_SIDE) * directions[k], starts[k] + (high + DOOR_SIDE) * directions[k]
        reach = DOOR_DEPTH * normals[k]
        keep.append(shapely.Polygon([a - INTO_WALL * normals[k], b - INTO_WALL * normals[k], b + reach, a + reach]))
        probes.append(starts[k] + 0.5 * (low + high) * directions[k] + DOOR_DEPTH / 2 * normals[k])
    pole = shapely.maximum_inscribed_circle(polygon, tolerance=0.02).coords[0]
    return Site(
        polygon=polygon, ceiling=ceiling, starts=starts, directions=directions, normals=normals, lengths=lengths,
        openings=tuple(placed), keep=tuple(keep), probes=np.array(probes).reshape(-1, 2), centre=(float(pole[0]), float(pole[1])),
    )  # fmt: skip


def room_site(plan: FloorPlan, room: int, things: Sequence[SceneObject] = ()) -> Site:
    """The site of a plan's room, its openings on the walls' inner faces.

    Args:
      things: what stands in the plan's rooms already; of flat things nothing has to keep clear.
    """
    openings = []
    for portal in portals(plan):
        if room not in portal.rooms:
            continue
        side = portal.rooms.index(room)
        inward = -portal.normal if side == 0 else portal.normal
        ends = np.asarray(portal.ends) + portal.half_depths[side] * inward
        openings.append((portal.kind, ends, portal.sill, portal.head))
    site = make_site(interior_polygon(plan, room), plan.rooms[room].ceiling_height, openings)
    mine = (thing.vertices for thing in things if thing.room == room and thing.support != "flat")
    taken = tuple(Taken(shapely.MultiPoint(v[:, :2]).convex_hull, float(v[:, 2].min()), float(v[:, 2].max())) for v in mine)
    return dataclasses.replace(site, taken=taken) if taken else site


def nearest_wall(ends: np.ndarray, starts: np.ndarray, directions: np.ndarray, normals: np.ndarray, lengths: np.ndarray) -> int:
    """The wall an opening is cut into: parallel to it, nearest to its line, and beside it."""
    middle, along = ends.mean(0), ends[1] - ends[0]
    offset = np.abs(((middle - starts) * normals).sum(-1))
    position = ((middle - starts) * directions).sum(-1)
    beyond = np.maximum(np.maximum(-position, position - lengths), 0.0)
    skew = np.abs(normals @ (along / max(math.hypot(*along.tolist()), 1e-9)))
    return int(np.argmin(offset + beyond + 10 * skew))


def wall_yaw(normal: np.ndarray) -> float:
    """Turn about z (radians) that makes a piece's front, -y, face along `normal`."""
    return math.atan2(float(normal[0]), -float(normal[1]))
