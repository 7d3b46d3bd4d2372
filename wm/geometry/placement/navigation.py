"""Where a visitor can walk: the occupancy grid of a furnished plan and the share of it that is connected.

A cell is free if its centre lies on a room's floor or in a door or passage, and not on an object that stands on the floor. Only
centres are tested, so a wall askew to the grid closes no door of more than two cells. A body of radius r fits where its
centre is r away from every wall and object. Where it gets to is decided in the plane, without a grid: whether it passes a door
depends on the door's width and not on where the cells fall.
Between parts of a plan that no door joins (connected_parts) a visitor goes through the open air, where each has an entrance.
Source: WorldMesh, supplement, "Navigability" (0.15 m, largest 4-connected component); the body and the parts are ours.
"""

import dataclasses
from collections.abc import Iterable, Sequence

import numpy as np
import shapely
from jaxtyping import Bool, Float, Int
from shapely.geometry.base import BaseGeometry
from skimage.measure import label

from wm.geometry.placement.clearances import STEP
from wm.geometry.plan.connected import connected_parts, entrances
from wm.geometry.plan.footprint import interior_polygon
from wm.geometry.plan.openings import portals
from wm.geometry.plan.portal import Portal
from wm.geometry.plan.records import FloorPlan
from wm.schema import NavigationSettings
from wm.types import Mesh, SceneObject

_OVERLAP = 0.01
"""Metres by which a passage reaches into either room, so that floors and passages are one area."""
_FIT = 1e-4
"""Metres by which a body gives way, so that it passes a door of exactly its width."""
_DEFAULTS = NavigationSettings()


@dataclasses.dataclass(frozen=True, eq=False)
class Navigability:
    """The occupancy grid and its verdict. Cell (j, i) has its centre at origin + cell * (i + 0.5, j + 0.5)."""

    share: float  # of the free cells, in the largest 4-connected component; 0 where no cell is free
    share_body: float  # of the area in which the centre of a body of `body_radius` can be, in its largest connected piece
    free: np.ndarray  # [gy, gx] bool
    component: np.ndarray  # [gy, gx] int32: 0 where not free, else 1, 2 ... from the largest component to the smallest
    origin: np.ndarray  # [2] float64, metres
    cell: float


def navigability(plan: FloorPlan, objects: Sequence[SceneObject], settings: NavigationSettings = _DEFAULTS) -> Navigability:
    """The share of the free floor that can be reached from its largest part.

    Obstacles are objects that stand on the floor or on one another (support "floor" or "object"), by the outline of what is
    lower than `obstacle_height`; what is lower than STEP is walked over.
    """
    floor = walkable_floor(plan)
    area = floor.difference(_obstacles(objects, settings))
    low, high = np.array(floor.bounds[:2]), np.array(floor.bounds[2:])
    columns, rows = (int(n) for n in np.ceil((high - low) / settings.cell))
    free = cells_inside(area, low, settings.cell, (rows, columns))
    component = _components(free)
    doors = {portal.wall.room for portal in entrances(plan)}
    outside = [bool(doors & set(part)) for part in connected_parts(plan)]
    parts = [walkable_floor(plan, part) for part in connected_parts(plan)]
    cells = [component[free & cells_inside(part, low, settings.cell, free.shape)] for part in parts]
    share = _share([np.bincount(of_part)[1:] for of_part in cells], outside)
    body = [_fitting(part.intersection(area), settings) for part in parts]
    share_body = _share([shapely.area(shapely.get_parts(piece)) for piece in body], outside)
    return Navigability(share=share, share_body=share_body, free=free, component=component, origin=low, cell=settings.cell)


def _share(parts: Sequence[np.ndarray], outside: Sequence[bool]) -> float:
    """The share of all that the largest piece has, and the largest of every other part where both lead outside; 0 of none.

    Args:
      parts: the sizes of the pieces of each part.
      outside: whether a part has an entrance.
    """
    total = float(sum(pieces.sum() for pieces in parts))
    largest = [float(pieces.max(initial=0)) for pieces in parts]
    together = sum(size for size, leads in zip(largest, outside) if leads)
    return max(together, *largest) / total if total > 0 else 0.0


def body_area(plan: FloorPlan, objects: Sequence[SceneObject], settings: NavigationSettings = _DEFAULTS) -> BaseGeometry:
    """Where the centre of the body can be: what `Navigability.share_body` is the share of."""
    return _fitting(walkable_floor(plan).difference(_obstacles(objects, settings)), settings)


def _obstacles(objects: Sequence[SceneObject], settings: NavigationSettings) -> BaseGeometry:
    standing = (thing.vertices[thing.faces] for thing in objects if thing.support in ("floor", "object"))
    return outlines(standing, STEP, settings.obstacle_height)


def _fitting(area: BaseGeometry, settings: NavigationSettings) -> BaseGeometry:
    return area.buffer(_FIT - settings.body_radius)


def walkable_floor(plan: FloorPlan, rooms: Sequence[int] | None = None) -> BaseGeometry:
    """The floors of these rooms, or of all, and of the doors and passages between them."""
    chosen = set(range(len(plan.rooms)) if rooms is None else rooms)
    floors = [interior_polygon(plan, index) for index in sorted(chosen)]
    ways = [_passage(portal) for portal in portals(plan) if portal.is_way and chosen.issuperset(portal.rooms)]
    return shapely.union_all([*floors, *ways])


def outlines(things: Iterable[Float[np.ndarray, "_ 3 3"]], low: float, high: float) -> BaseGeometry:
    """The union, from above, of the convex outlines of the things' parts below `high`; things that end below `low` have none.

    Args:
      things: the triangles [f, corner, xyz] of each.
      low, high: metres above the floor.
    """
    hulls = []
    for corners in things:
        below = _below(corners, high)
        if len(below) and corners[..., 2].max() > low:
            hulls.append(shapely.convex_hull(shapely.multipoints(below)))
    return shapely.union_all(hulls)


def _below(corners: Float[np.ndarray, "f 3 3"], high: float) -> Float[np.ndarray, "n 2"]:
    """From above, the corners below a height and the points at which edges cross it: their hull is that of the part below."""
    start = corners.reshape(-1, 3)
    end = np.roll(corners, -1, axis=1).reshape(-1, 3)
    up = (start[:, 2] < high) & (end[:, 2] >= high)
    down = (start[:, 2] >= high) & (end[:, 2] < high)
    foot, top = np.concatenate([start[up], end[down]]), np.concatenate([end[up], start[down]])
    share = (high - foot[:, 2:]) / (top[:, 2:] - foot[:, 2:])
    crossings = foot[:, :2] + share * (top[:, :2] - foot[:, :2])
    return np.concatenate([start[start[:, 2] < high, :2], crossings])


def body_floor(plan: FloorPlan, things: Iterable[Float[np.ndarray, "_ 3 3"]], *, height: float, radius: float) -> BaseGeometry:
    """Where the centre of a body of this height and radius can be among these things, of which the triangles are given."""
    return walkable_floor(plan).difference(outlines(things, STEP, height)).buffer(-radius)


def object_corners(mesh: Mesh) -> list[Float[np.ndarray, "_ 3 3"]]:
    """The triangles [f, corner, xyz] of each object in a scene's mesh."""
    used = np.flatnonzero(mesh.face_object >= 0)
    used = used[np.argsort(mesh.face_object[used], kind="stable")]
    starts = np.flatnonzero(np.diff(mesh.face_object[used], prepend=-1))
    return [mesh.vertices[faces] for faces in np.split(mesh.faces[used], starts[1:])] if len(used) else []


def cells_inside(
    area: BaseGeometry, origin: Float[np.ndarray, "2"], cell: float, shape: tuple[int, int]
) -> Bool[np.ndarray, "gy gx"]:
    """Which cells have their centre in the area."""
    shapely.prepare(area)
    x, y = (origin[k] + cell * (np.arange(shape[1 - k]) + 0.5) for k in (0, 1))
    return shapely.intersects_xy(area, x[None, :], y[:, None])


def _passage(portal: Portal) -> shapely.Polygon:
    before, behind = (-portal.half_depths[0] - _OVERLAP) * portal.normal, (portal.half_depths[1] + _OVERLAP) * portal.normal
    start, end = portal.ends
    return shapely.Polygon([start + before, end + before, end + behind, start + behind])


def _components(free: Bool[np.ndarray, "gy gx"]) -> Int[np.ndarray, "gy gx"]:
    """4-connected components, numbered from the largest, 1, to the smallest; 0 where not free."""
    labels = np.asarray(label(free, connectivity=1), np.int32)
    count = int(labels.max(initial=0))
    sizes = np.bincount(labels.reshape(-1), minlength=count + 1)[1:]
    rank = np.zeros(count + 1, np.int32)
    rank[1 + np.argsort(-sizes, kind="stable")] = np.arange(1, count + 1)
    return rank[labels]
