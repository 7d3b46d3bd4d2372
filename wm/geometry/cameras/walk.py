"""A visitor's walk through every room, for the video.

    route    the free floor of a body (walls and objects moved out by its radius) as a grid; shortest paths on it (Dijkstra)
             from room to room, where floor nearer than WISH to a wall, a jamb or an object counts as longer;
             pulled straight and rounded where that brings the walker nearer to nothing
    stop     in each room, the spot with most to see; the visitor looks at each thing worth it, and goes on
    walk     one position per frame along the route, at walking speed and no faster than TURNING; looking at what there is to
             see about the course (wm.geometry.cameras.gaze)

Smoothing in time moves the walker along the route and never off it.
"""

import dataclasses
import itertools
from collections.abc import Sequence
from typing import Any

import numpy as np
import scipy.ndimage
import scipy.sparse
import scipy.sparse.csgraph
import shapely
from jaxtyping import Float
from shapely.geometry.base import BaseGeometry

from wm.errors import InputError
from wm.geometry.cameras.gaze import Panorama, gaze, looks, panorama, turns
from wm.geometry.placement.clearances import BODY
from wm.geometry.placement.navigation import body_floor, cells_inside, object_corners, walkable_floor
from wm.geometry.plan.connected import connected_parts
from wm.geometry.plan.footprint import ENTERED, interior_polygon
from wm.geometry.plan.openings import portals
from wm.geometry.plan.records import FloorPlan
from wm.geometry.rays.pinhole import make_camera
from wm.geometry.rays.raycast import RayScene, ray_scene
from wm.schema import CameraSettings
from wm.types import Camera, Mesh

WISH = 0.5
"""Metres that the walker keeps from walls, jambs and objects wherever the room allows."""
TURNING = 70.0
"""Degrees per second at most."""
GLANCE, PER_WORTH, LONGEST = 0.5, 3.0, 1.2
"""Seconds that a look takes at least, seconds for each unit of worth in it, and its seconds at most."""

_AIR = 0.25  # metres of free air above and below the eye
_CELL = 0.1  # metres of the route's grid: finer than navigation's, because positions are read from it and not only counted
_SHY = 20.0  # times its length that a step counts for in addition where it touches something
_SAME = 0.03  # metres by which a straightened or rounded path may come nearer to something: less than a cell
_ROUNDING = 0.3  # metres: standard deviation of the filter that rounds a path's corners
_ALONG = 0.05  # metres between points of a rounded path
_PACE = 0.3  # metres between places at which the gaze is decided
_AHEAD = 1.0  # metres to the point on the route that gives the course
_SPOTS = 12  # places tried for the stop in a room
_SMOOTHING = 0.3  # seconds: standard deviation of the filter over progress and headings
_PITCH = -5.0  # degrees: a walker looks a little down
_DEFAULTS = CameraSettings()


@dataclasses.dataclass(frozen=True, eq=False)
class _Floor:
    """Where the walker's centre may be, as an area and as a graph of grid cells."""

    area: BaseGeometry
    cells: np.ndarray  # [n, 2] centres, metres
    clear: np.ndarray  # [n] metres from a cell's centre to the nearest wall or object
    room: np.ndarray  # [n] index of the room of each cell, -1 in a door
    graph: scipy.sparse.csr_matrix  # [n, n] distances between neighbouring cells, longer near walls and objects
    radius: float

    def clearance(self, shapes: Any) -> np.ndarray:
        """Metres from each shapely geometry of an array, within the area, to the nearest wall or object."""
        return self.radius + np.asarray(shapely.distance(self.area.boundary, shapes))


@dataclasses.dataclass(frozen=True, eq=False)
class _Eyes:
    """What the walker sees from where."""

    scene: RayScene
    height: float
    fov: float  # width of the picture, radians

    def look(self, place: np.ndarray, room: int) -> Panorama:
        return panorama(self.scene, np.append(place, self.height), room, fov=self.fov)


@dataclasses.dataclass(frozen=True, eq=False)
class _Progress:
    """The walk as knots in time: metres along the route and the heading, both continuous."""

    times: list[float]
    along: list[float]
    headings: list[float]

    def add(self, along: float, turning: float, speed: float, *, pause: float = 0.0) -> None:
        """Goes on to a place, turning by an angle on the way, as fast as speed and TURNING allow; then pauses."""
        heading = self.headings[-1] + turning
        for seconds in (max((along - self.along[-1]) / speed, abs(turning) / np.radians(TURNING)), pause):
            if seconds > 0:
                self.times.append(self.times[-1] + seconds)
                self.along.append(along)
                self.headings.append(heading)


def walkthrough(
    plan: FloorPlan, mesh: Mesh | RayScene, settings: CameraSettings = _DEFAULTS, *, fps: int, speed: float
) -> list[Camera]:
    """One camera per frame, from the first room through the doors into every other, looking at what each has to show.

    Separate parts of the plan (`connected_parts`) are walked one after the other, that of the first room first, with a cut
    between. Rooms too small to be entered are left out.

    Args:
        plan, mesh: as for `place_cameras`.
        fps: frames a second.
        speed: walking speed, metres a second.

    Raises: InputError if a room cannot be walked into, naming it: its doors are blocked or it has no free floor.
    """
    if not (fps > 0 and speed > 0):
        raise ValueError(f"a walk needs frames and a speed above 0, not fps {fps}, speed {speed}")
    scene = ray_scene(mesh)
    parts = [[room for room in part if _is_entered(plan, room)] for part in connected_parts(plan)]
    parts = sorted(filter(None, parts), key=min) or [[0]]
    return [camera for part in parts for camera in _walk(plan, scene, part, settings, fps=fps, speed=speed)]


def _is_entered(plan: FloorPlan, room: int) -> bool:
    return not interior_polygon(plan, room).buffer(-ENTERED).is_empty


def _walk(
    plan: FloorPlan, scene: RayScene, rooms: Sequence[int], settings: CameraSettings, *, fps: int, speed: float
) -> list[Camera]:
    """The walk through some rooms that doors join."""
    doors = [portal.head for portal in portals(plan) if portal.is_way and set(rooms) >= set(portal.rooms)]
    ceilings = [plan.rooms[room].ceiling_height for room in rooms]
    height = min(settings.eye_height, *(h - _AIR for h in (*ceilings, *doors)))
    floor = _walkable(plan, scene.mesh, height, rooms)
    fov = 2 * np.arctan(np.tan(np.radians(settings.fov) / 2) * settings.width / settings.height)
    eyes = _Eyes(scene=scene, height=height, fov=float(fov))
    stops = np.array([_stop(floor, eyes, room) for room in rooms])
    order, legs = _route(floor, stops)
    progress = _visit(plan, eyes, [rooms[k] for k in order], legs, speed)
    route = np.concatenate(legs)
    along = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(route, axis=0), axis=1))])
    times = np.arange(0.0, progress.times[-1] + 0.5 / fps, 1 / fps)
    reached, headings = (
        scipy.ndimage.gaussian_filter1d(np.interp(times, progress.times, values), _SMOOTHING * fps, mode="nearest")
        for values in (progress.along, progress.headings)
    )
    positions = np.column_stack([np.interp(reached, along, route[:, axis]) for axis in (0, 1)])
    return _cameras(positions, headings, height, settings)


def _cameras(
    positions: Float[np.ndarray, "n 2"], headings: Float[np.ndarray, "n"], height: float, settings: CameraSettings
) -> list[Camera]:
    drop = np.tan(np.radians(_PITCH))
    eyes = np.column_stack([positions, np.full(len(positions), height)])
    targets = eyes + np.column_stack([np.cos(headings), np.sin(headings), np.full(len(headings), drop)])
    size = {"width": settings.width, "height": settings.height, "fov_deg": settings.fov}
    return [make_camera(eye, target, **size) for eye, target in zip(eyes, targets)]


def _walkable(plan: FloorPlan, mesh: Mesh, height: float, rooms: Sequence[int]) -> _Floor:
    """The floor of the widest walker who gets into these rooms: around furniture, else slimmer, else over low furniture too."""
    things = object_corners(mesh)
    tall = [corners for corners in things if corners[..., 2].max() > height - _AIR]
    unreached = []
    for radius, obstacles in ((BODY, things), (0.6 * BODY, things), (BODY, tall), (0.4 * BODY, tall)):
        floor = _grid(plan, body_floor(plan, obstacles, height=height + _AIR, radius=radius), radius)
        roomy = [_open_cell(floor, room) for room in rooms]
        if None in roomy:
            continue
        reached = scipy.sparse.csgraph.dijkstra(floor.graph, indices=roomy[0])[roomy]
        unreached = [plan.rooms[room].id for room, distance in zip(rooms, reached) if not np.isfinite(distance)]
        if not unreached:
            return floor
    names = ", ".join(unreached) or "any room"
    raise InputError(f"no walk into {names}: a walker {0.8 * BODY:.2f} m wide finds doors blocked or no free floor")


def _grid(plan: FloorPlan, area: BaseGeometry, radius: float) -> _Floor:
    """The area as a graph of its cells, 8-connected."""
    low, high = np.array(walkable_floor(plan).bounds).reshape(2, 2)
    columns, rows = (int(n) for n in np.ceil((high - low) / _CELL))
    inside = cells_inside(area, low, _CELL, (rows, columns))
    number = np.full((rows + 2, columns + 2), -1)
    number[1:-1, 1:-1][inside] = np.arange(inside.sum())
    here = np.argwhere(number >= 0)
    cells = low + _CELL * (here[:, ::-1] - 0.5)
    clear = radius + np.asarray(shapely.distance(area.boundary, shapely.points(cells)))
    pairs = []
    for step in ((0, 1), (1, 0), (1, 1), (1, -1)):
        other = number[here[:, 0] + step[0], here[:, 1] + step[1]]
        pairs.append(np.column_stack([np.flatnonzero(other >= 0), other[other >= 0]]))
    a, b = np.concatenate(pairs).T
    crosses = ~shapely.covers(area, shapely.linestrings(np.stack([cells[a], cells[b]], axis=1)))
    a, b = a[~crosses], b[~crosses]
    missing = 1 - np.minimum(np.minimum(clear[a], clear[b]) / WISH, 1)
    lengths = np.linalg.norm(cells[a] - cells[b], axis=1) * (1 + _SHY * missing**2)
    graph = scipy.sparse.coo_matrix((lengths, (a, b)), shape=(len(cells), len(cells))).tocsr()
    room = np.full(len(cells), -1)
    for index in range(len(plan.rooms)):
        room[shapely.contains_xy(interior_polygon(plan, index), *cells.T)] = index
    return _Floor(area=area, cells=cells, clear=clear, room=room, graph=graph + graph.T, radius=radius)


def _open_cell(floor: _Floor, room: int) -> int | None:
    """The cell of a room farthest from everything; None where it has none."""
    own = np.flatnonzero(floor.room == room)
    return int(own[np.argmax(floor.clear[own])]) if len(own) else None


def _stop(floor: _Floor, eyes: _Eyes, room: int) -> int:
    """The cell of a room from which most is to be seen, of a few that lie apart and keep WISH from everything where any does."""
    first = _open_cell(floor, room)
    assert first is not None  # the floor is one that the walker gets into every room on
    reached = np.isfinite(scipy.sparse.csgraph.dijkstra(floor.graph, indices=first))
    own = np.flatnonzero((floor.room == room) & reached & (floor.clear >= min(WISH, 0.9 * floor.clear[first])))
    spots = [first]
    gap = np.full(len(own), np.inf)
    while len(spots) < min(_SPOTS, len(own)):
        gap = np.minimum(gap, np.linalg.norm(floor.cells[own] - floor.cells[spots[-1]], axis=1))
        spots.append(int(own[np.argmax(gap)]))
    return max(spots, key=lambda spot: sum(worth for _, worth in looks(eyes.look(floor.cells[spot], room))))


def _route(floor: _Floor, stops: np.ndarray) -> tuple[list[int], list[np.ndarray]]:
    """The rooms in the order of their visit, and the paths [k, 2] between their stops. A single room has its stop, twice."""
    distance, previous = scipy.sparse.csgraph.dijkstra(floor.graph, indices=stops, return_predecessors=True)
    order = _order(distance[:, stops])
    legs = []
    for start, end in itertools.pairwise(order):
        path = [int(stops[end])]
        while path[-1] != stops[start]:
            path.append(int(previous[start, path[-1]]))
        legs.append(_rounded(floor, _straighten(floor, np.array(path[::-1]))))
    return order, legs or [floor.cells[stops[[0, 0]]]]


def _order(distance: Float[np.ndarray, "r r"]) -> list[int]:
    """The rooms from the first on, always the nearest not yet visited, and then any part turned round that shortens the way."""

    def length(order: list[int]) -> float:
        return float(distance[order[:-1], order[1:]].sum())

    order = [0]
    while left := [room for room in range(len(distance)) if room not in order]:
        order.append(min(left, key=lambda room: (distance[order[-1], room], room)))
    ends = list(itertools.combinations(range(1, len(order) + 1), 2))
    while True:
        turned = [order[:a] + order[a:b][::-1] + order[b:] for a, b in ends]
        best = min(turned, key=length, default=order)
        if length(best) > length(order) - 1e-6:
            return order
        order = best


def _straighten(floor: _Floor, path: np.ndarray) -> Float[np.ndarray, "k 2"]:
    """The cells of a path without detours: straight wherever that comes no nearer to anything than the path or than WISH."""
    kept, k, cells = [0], 0, floor.cells[path]
    while k < len(path) - 1:
        ahead = np.arange(len(path) - 1, k, -1)
        lines = shapely.linestrings(np.stack([np.broadcast_to(cells[k], (len(ahead), 2)), cells[ahead]], axis=1))
        allowed = np.minimum(WISH, np.minimum.accumulate(floor.clear[path[k:]])[ahead - k]) - _SAME
        fits = shapely.covers(floor.area, lines) & (floor.clearance(lines) >= allowed)
        k = int(ahead[np.argmax(fits)]) if fits.any() else k + 1
        kept.append(k)
    return cells[kept]


def _rounded(floor: _Floor, path: Float[np.ndarray, "k 2"]) -> Float[np.ndarray, "n 2"]:
    """A path in small steps, its corners rounded as far as that comes no nearer to anything than the path or than WISH."""
    if len(path) < 2:
        return np.repeat(path, 2, axis=0)
    line = shapely.LineString(path)
    count = max(2, round(line.length / _ALONG))
    points = shapely.get_coordinates(shapely.line_interpolate_point(line, np.linspace(0.0, line.length, count)))
    allowed = np.minimum(WISH, floor.clearance(shapely.points(points))) - _SAME
    for weaker in (1.0, 0.5, 0.25):
        smooth = scipy.ndimage.gaussian_filter1d(points, weaker * _ROUNDING / _ALONG, axis=0, mode="nearest")
        smooth[[0, -1]] = points[[0, -1]]
        shapes = shapely.points(smooth)
        if (shapely.covers(floor.area, shapes) & (floor.clearance(shapes) >= allowed)).all():
            return smooth
    return points


def _visit(plan: FloorPlan, eyes: _Eyes, order: list[int], legs: list[np.ndarray], speed: float) -> _Progress:
    """The walk in time: at each stop its looks, between them the way with the gaze about its course."""
    strides = [_stride(plan, eyes, leg, room) for leg, room in zip(legs, order)] if len(order) > 1 else []
    progress, walked = _Progress(times=[0.0], along=[0.0], headings=[]), 0.0
    for number, room in enumerate(order):
        place = legs[number][0] if number < len(legs) else legs[-1][-1]
        onward = float(strides[number][1][0]) if number < len(strides) else None
        view = eyes.look(place, room)
        found = looks(view)
        if not progress.headings:
            progress.headings.append(found[0][0])
        for turning, worth in turns(view, progress.headings[-1], found, onward):
            progress.add(walked, turning, speed, pause=0.0 if worth is None else min(GLANCE + PER_WORTH * worth, LONGEST))
        if number < len(strides):
            along, headings = strides[number]
            for step, turning in zip(along[1:], np.diff(headings)):
                progress.add(walked + step, float(turning), speed)
            walked = progress.along[-1]
    return progress


def _stride(plan: FloorPlan, eyes: _Eyes, leg: np.ndarray, start: int) -> tuple[np.ndarray, np.ndarray]:
    """Along one leg, every _PACE metres: how far, [n], and the heading there, [n]."""
    line = shapely.LineString(leg)
    along = np.linspace(0.0, line.length, max(2, round(line.length / _PACE)))
    places = shapely.get_coordinates(shapely.line_interpolate_point(line, along))
    ahead = np.minimum(along + _AHEAD, line.length)
    behind = np.minimum(along, line.length - min(_AHEAD, line.length))  # near its end the leg's last course is kept
    course = shapely.get_coordinates(shapely.line_interpolate_point(line, ahead))
    course = course - shapely.get_coordinates(shapely.line_interpolate_point(line, behind))
    rooms = np.full(len(places), start)
    for index in range(len(plan.rooms)):
        rooms[shapely.contains_xy(interior_polygon(plan, index), *places.T)] = index
    views = [eyes.look(place, int(room)) for place, room in zip(places, rooms)]
    return along, gaze(views, np.arctan2(course[:, 1], course[:, 0]))
