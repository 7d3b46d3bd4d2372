"""A camera's walk through every room, for the video.

    route    the free floor of a body (walls and objects moved out by its radius) as a grid; shortest paths on it (Dijkstra)
             from room to nearest unvisited room, pulled straight where nothing is in the way
    walk     one position per frame at walking speed, smoothed in time; looking LOOK_AHEAD metres ahead along the route
    glance   in each room the walker stops at its most open spot and turns, the long way, to where it goes on

Smoothing cuts corners by less than the body's radius or is weakened until it does, so the walk stays in free air.
"""

import dataclasses

import numpy as np
import scipy.ndimage
import scipy.sparse
import scipy.sparse.csgraph
import shapely
from jaxtyping import Float
from shapely.geometry.base import BaseGeometry

from wm.errors import InputError
from wm.geometry.placement.clearances import BODY
from wm.geometry.placement.navigation import body_floor, cells_inside, object_corners, walkable_floor
from wm.geometry.plan.footprint import interior_polygon
from wm.geometry.plan.openings import portals
from wm.geometry.plan.records import FloorPlan
from wm.geometry.rays.pinhole import make_camera
from wm.schema import CameraSettings
from wm.types import Camera, Mesh

LOOK_AHEAD = 0.9  # metres
TURNING = 75.0  # degrees per second while the walker looks around
_AIR = 0.25  # metres of free air above and below the eye
_CELL = 0.1  # metres of the route's grid: finer than navigation's, because positions are read from it and not only counted
_SMOOTHING = 0.35  # seconds: standard deviation of the filter over positions and headings
_PITCH = -4.0  # degrees: a walker looks a little down
_DEFAULTS = CameraSettings()


@dataclasses.dataclass(frozen=True, eq=False)
class _Floor:
    """Where the walker's centre may be, as an area and as a graph of grid cells."""

    area: BaseGeometry
    cells: np.ndarray  # [n, 2] centres, metres
    graph: scipy.sparse.csr_matrix  # [n, n] distances between neighbouring cells
    stops: np.ndarray  # [rooms] the cell in which the walker stops in each room
    radius: float


def walkthrough(plan: FloorPlan, mesh: Mesh, settings: CameraSettings = _DEFAULTS, *, fps: int, speed: float) -> list[Camera]:
    """One camera per frame, from the first room through the doors into every other, with a look around in each.

    Args:
        plan, mesh: as for `place_cameras`.
        fps: frames a second.
        speed: walking speed, metres a second.

    Raises: InputError if a room cannot be walked into, naming it: its doors are blocked or it has no free floor.
    """
    if not (fps > 0 and speed > 0):
        raise ValueError(f"a walk needs frames and a speed above 0, not fps {fps}, speed {speed}")
    doors = [portal.head for portal in portals(plan) if portal.is_way]
    height = min(settings.eye_height, *(room.ceiling_height - _AIR for room in plan.rooms), *(h - _AIR for h in doors))
    floor = _walkable(plan, mesh, height)
    legs = _route(floor)
    positions, headings = _walk(legs, fps, speed)
    positions = _smooth_positions(positions, floor, _SMOOTHING * fps)
    headings = scipy.ndimage.gaussian_filter1d(headings, _SMOOTHING * fps, mode="nearest")
    drop = np.tan(np.radians(_PITCH))
    eyes = np.column_stack([positions, np.full(len(positions), height)])
    targets = eyes + np.column_stack([np.cos(headings), np.sin(headings), np.full(len(headings), drop)])
    size = {"width": settings.width, "height": settings.height, "fov_deg": settings.fov}
    return [make_camera(eye, target, **size) for eye, target in zip(eyes, targets)]


def _walkable(plan: FloorPlan, mesh: Mesh, height: float) -> _Floor:
    """The floor of the widest walker who gets into all rooms: around all furniture, else slimmer, else over low furniture too."""
    things = object_corners(mesh)
    tall = [corners for corners in things if corners[..., 2].max() > height - _AIR]
    unreached = []
    for radius, obstacles in ((BODY, things), (0.6 * BODY, things), (BODY, tall), (0.4 * BODY, tall)):
        area = body_floor(plan, obstacles, height=height + _AIR, radius=radius)
        floor = _grid(plan, area, radius)
        if floor is None:
            continue
        reached = scipy.sparse.csgraph.dijkstra(floor.graph, indices=int(floor.stops[0]))[floor.stops]
        unreached = [room.id for room, distance in zip(plan.rooms, reached) if not np.isfinite(distance)]
        if not unreached:
            return floor
    names = ", ".join(unreached) or "any room"
    raise InputError(f"no walk into {names}: a walker {0.8 * BODY:.2f} m wide finds doors blocked or no free floor")


def _grid(plan: FloorPlan, area: BaseGeometry, radius: float) -> _Floor | None:
    """The area as a graph of its cells, 8-connected; None where a room has no cell."""
    low, high = np.array(walkable_floor(plan).bounds).reshape(2, 2)
    columns, rows = (int(n) for n in np.ceil((high - low) / _CELL))
    inside = cells_inside(area, low, _CELL, (rows, columns))
    number = np.full((rows + 2, columns + 2), -1)
    number[1:-1, 1:-1][inside] = np.arange(inside.sum())
    here = np.argwhere(number >= 0)
    cells = low + _CELL * (here[:, ::-1] - 0.5)
    pairs = []
    for step in ((0, 1), (1, 0), (1, 1), (1, -1)):
        other = number[here[:, 0] + step[0], here[:, 1] + step[1]]
        pairs.append(np.column_stack([np.flatnonzero(other >= 0), other[other >= 0]]))
    a, b = np.concatenate(pairs).T
    crosses = ~shapely.covers(area, shapely.linestrings(np.stack([cells[a], cells[b]], axis=1)))
    a, b = a[~crosses], b[~crosses]
    lengths = np.linalg.norm(cells[a] - cells[b], axis=1)
    graph = scipy.sparse.coo_matrix((lengths, (a, b)), shape=(len(cells), len(cells))).tocsr()
    stops = _stops(plan, area, cells)
    return None if stops is None else _Floor(area=area, cells=cells, graph=graph + graph.T, stops=stops, radius=radius)


def _stops(plan: FloorPlan, area: BaseGeometry, cells: np.ndarray) -> np.ndarray | None:
    """In each room the cell farthest from everything."""
    edge = area.boundary
    stops = []
    for index in range(len(plan.rooms)):
        own = np.flatnonzero(shapely.contains_xy(interior_polygon(plan, index), *cells.T))
        if not len(own):
            return None
        stops.append(own[np.argmax(shapely.distance(edge, shapely.points(cells[own])))])
    return np.array(stops)


def _route(floor: _Floor) -> list[np.ndarray]:
    """Polylines [k, 2] from stop to stop, always to the nearest room not yet visited."""
    left, here, legs = set(range(1, len(floor.stops))), 0, []
    while left:
        distance, previous = scipy.sparse.csgraph.dijkstra(floor.graph, indices=int(floor.stops[here]), return_predecessors=True)
        there = min(left, key=lambda room: (distance[floor.stops[room]], room))
        path = [int(floor.stops[there])]
        while path[-1] != floor.stops[here]:
            path.append(int(previous[path[-1]]))
        legs.append(_straighten(floor.area, floor.cells[path[::-1]]))
        left.remove(there)
        here = there
    return legs or [floor.cells[floor.stops[:1]]]


def _straighten(area: BaseGeometry, path: np.ndarray) -> np.ndarray:
    """The path with its detours replaced by straight lines wherever those stay within the area."""
    kept, k = [0], 0
    while k < len(path) - 1:
        ahead = np.arange(len(path) - 1, k, -1)
        lines = np.stack([np.broadcast_to(path[k], (len(ahead), 2)), path[ahead]], axis=1)
        k = int(ahead[np.argmax(shapely.covers(area, shapely.linestrings(lines)))])
        kept.append(k)
    return path[kept]


def _walk(legs: list[np.ndarray], fps: int, speed: float) -> tuple[np.ndarray, np.ndarray]:
    """Positions [n, 2] and continuous headings [n] of every frame, before smoothing."""
    positions, headings = [], []
    for leg in legs:
        points, courses = _stride(leg, fps, speed)
        turn = _glance(headings[-1] if headings else courses[0] - np.pi, courses[0], fps)
        positions += [np.broadcast_to(leg[0], (len(turn), 2)), points]
        headings += [*turn, *(courses + turn[-1] - courses[0])]
    around = _glance(headings[-1], headings[-1] + np.pi, fps)
    positions.append(np.broadcast_to(legs[-1][-1], (len(around), 2)))
    return np.concatenate(positions), np.array([*headings, *around])


def _stride(leg: np.ndarray, fps: int, speed: float) -> tuple[np.ndarray, np.ndarray]:
    """One leg at constant speed: positions and, without jumps, the headings towards a point ahead on it."""
    if len(leg) < 2:
        return leg, np.zeros(1)
    line = shapely.LineString(leg)
    along = np.linspace(0.0, line.length, max(2, round(line.length / speed * fps)))
    points = shapely.get_coordinates(shapely.line_interpolate_point(line, along))
    ahead = shapely.get_coordinates(shapely.line_interpolate_point(line, np.minimum(along + LOOK_AHEAD, line.length)))
    last = np.searchsorted(along, max(line.length - LOOK_AHEAD / 2, along[-1] / 2))
    look = (ahead - points)[: last + 1]
    courses = np.unwrap(np.arctan2(look[:, 1], look[:, 0]))
    return points, np.concatenate([courses, np.full(len(points) - len(courses), courses[-1])])


def _glance(start: float, end: float, fps: int) -> np.ndarray:
    """Headings from `start` to `end` (up to full turns) the long way round, at an even pace that starts and stops gently."""
    turn = np.mod(end - start, 2 * np.pi)
    turn = turn if turn >= np.pi else turn - 2 * np.pi
    frames = max(2, round(abs(np.degrees(turn)) / TURNING * fps))
    pace = np.linspace(0.0, 1.0, frames)
    return start + turn * (pace - np.sin(2 * np.pi * pace) / (4 * np.pi))


def _smooth_positions(positions: Float[np.ndarray, "n 2"], floor: _Floor, frames: float) -> Float[np.ndarray, "n 2"]:
    """Positions filtered over time, as strongly as keeps them within half the walker's radius of its floor."""
    near = floor.area.buffer(floor.radius / 2)
    shapely.prepare(near)
    for weaker in (1.0, 0.5, 0.25):
        smooth = scipy.ndimage.gaussian_filter1d(positions, weaker * frames, axis=0, mode="nearest")
        if shapely.covers(near, shapely.points(smooth)).all():
            return smooth
    return positions
