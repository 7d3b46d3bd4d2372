"""Trajectories through a run of ours: in the free air of its rooms, so that no frame lies in a wall or in furniture.

around  a circle round an object's middle; of several radii the one with the longest arc of free places
close   from the middle of that arc straight at the object, as near as a camera gets
along   the longest straight line between free places of a room on which everything between is free too
door    a straight line through a door, as far as it is free on either side
"""

import functools
import math

import numpy as np
import shapely

from wm.compare.errors import CompareError
from wm.compare.trajectories import Picture, Trajectory, kind_of, path_of
from wm.errors import InputError
from wm.finished import FinishedRun
from wm.geometry import cast_rays, portals
from wm.geometry.cameras.air import RoomAir, free, room_air
from wm.types import SceneObject

BEARINGS = 72  # places tried on a circle
RADII = (0.8, 1.1, 1.4, 1.8)  # metres from an object's corners
LEAST_ARC = math.radians(30)  # a shorter arc shows no object from several sides
CLEARANCE = 0.2  # metres of free air around a camera of a path
NEAREST = 0.25  # the same before an object that is looked at closely
PACE = 0.05  # metres between places of a straight path that are tried
SMALL = 0.3  # metres: smaller objects are not walked round
BACK, REACH = 1.2, 1.4  # metres from which an object is approached, and that are walked on either side of a door
AHEAD = 1.0  # metres before what a way along a room ends at
SPOTS = 60  # free places of a room between which the longest way is looked for


class RunPaths:
    """The trajectories of one run; rooms and objects are surveyed when they are first needed."""

    def __init__(self, run: FinishedRun, picture: Picture) -> None:
        self._run, self._picture = run, picture

    def path(self, name: str) -> Trajectory:
        """The trajectory of a name. Raises: CompareError where the scene has no such path."""
        kind, number = kind_of(name)
        eyes, targets = {"around": self._around, "close": self._close, "along": self._along, "door": self._door}[kind](number)
        return path_of(name, self._picture, eyes, targets)

    @functools.cache  # noqa: B019 - one object a scene
    def _air(self, room: int) -> RoomAir | None:
        try:
            return room_air(self._run.plan, room, self._run.rays, self._run.cameras)
        except InputError:
            return None  # a room too full for a camera

    @functools.cached_property
    def _arcs(self) -> list[tuple[SceneObject, np.ndarray]]:
        """Objects with the free places [n, 3] round each, objects of different rooms first, the largest of each."""
        seen: dict[int, int] = {}
        order = []
        for thing in sorted(self._run.objects, key=lambda thing: -float(np.prod(thing.size))):
            if thing.support in ("floor", "flat") and max(thing.size[:2]) > SMALL and thing.size[2] > SMALL:
                order.append((seen.setdefault(thing.room, 0), thing))
                seen[thing.room] += 1
        found = []
        for _, thing in sorted(order, key=lambda pair: pair[0]):
            arc = self._arc(thing)
            if arc is not None:
                found.append((thing, arc))
        return found

    def _arc(self, thing: SceneObject) -> np.ndarray | None:
        air = self._air(thing.room)
        if air is None:
            return None
        low, high = thing.vertices.min(axis=0), thing.vertices.max(axis=0)
        height = float(np.clip(high[2] + 0.4, min(1.0, air.eye_height), air.eye_height))
        arcs = [self._free_arc(air, (low + high)[:2] / 2, np.hypot(*(high - low)[:2]) / 2 + r, height) for r in RADII]
        best = max(arcs, key=len)
        return best if len(best) * 2 * math.pi / BEARINGS >= LEAST_ARC else None

    def _free_arc(self, air: RoomAir, middle: np.ndarray, radius: float, height: float) -> np.ndarray:
        """[n, 3]: the longest run of neighbouring free places on a circle."""
        angles = np.arange(BEARINGS) * 2 * math.pi / BEARINGS
        places = np.column_stack([middle + radius * np.column_stack([np.cos(angles), np.sin(angles)]), np.full(BEARINGS, height)])
        usable = np.asarray(shapely.contains_xy(air.floor, *places[:, :2].T))
        if usable.any():
            usable[usable] = free(air.scene, places[usable], min(air.clearance, CLEARANCE))
        return places[longest_run(usable)]

    def _around(self, number: int) -> tuple[np.ndarray, np.ndarray]:
        thing, arc = self._object(number)
        return arc, np.broadcast_to((thing.vertices.min(axis=0) + thing.vertices.max(axis=0)) / 2, arc.shape)

    def _object(self, number: int) -> tuple[SceneObject, np.ndarray]:
        if number >= len(self._arcs):
            raise CompareError(f"{self._run.folder}: {len(self._arcs)} objects can be walked round; number {number + 1} is none")
        return self._arcs[number]

    def _close(self, number: int) -> tuple[np.ndarray, np.ndarray]:
        thing, arc = self._object(number)
        low, high = thing.vertices.min(axis=0), thing.vertices.max(axis=0)
        start, target = arc[len(arc) // 2], (low + high) / 2
        target = np.array([*target[:2], min(target[2] + 0.2 * (high - low)[2], start[2])])
        flat = (target - start) * [1, 1, 0]
        ahead = flat / np.linalg.norm(flat)
        inwards = self._reach(start, ahead, float(np.linalg.norm(flat)), NEAREST)
        back = self._reach(start, -ahead, BACK, CLEARANCE)
        eyes = np.concatenate([back[::-1], inwards[1:]])
        if len(eyes) < 2:
            raise CompareError(f"{self._run.folder}: no way towards {thing.id or thing.label} is free")
        return eyes, np.broadcast_to(target, eyes.shape)

    def _reach(self, start: np.ndarray, direction: np.ndarray, most: float, clearance: float) -> np.ndarray:
        """[n, 3]: places from the start on as far as they are free, at least the start."""
        places = start + np.arange(0.0, most + 1e-9, PACE)[:, None] * direction
        usable = free(self._run.rays, places, clearance)
        return places[: max(1, int(np.argmin(usable)) if not usable.all() else len(usable))]

    def _along(self, number: int) -> tuple[np.ndarray, np.ndarray]:
        ways = self._ways
        if number >= len(ways):
            raise CompareError(f"{self._run.folder}: {len(ways)} rooms have a way along; number {number + 1} is none")
        start, end = ways[number]
        ahead = end + (end - start) / np.linalg.norm(end - start) * 1.0 - [0, 0, 0.2]
        eyes = np.linspace(start, end, max(2, math.ceil(float(np.linalg.norm(end - start)) / PACE)))
        return eyes, np.broadcast_to(ahead, eyes.shape)

    @functools.cached_property
    def _ways(self) -> list[tuple[np.ndarray, np.ndarray]]:
        """The longest free straight line of each room, the longest first."""
        ways = [way for room in range(len(self._run.rooms)) if (way := self._way(room)) is not None]
        return sorted(ways, key=lambda way: -float(np.linalg.norm(way[1] - way[0])))

    def _way(self, room: int) -> tuple[np.ndarray, np.ndarray] | None:
        air = self._air(room)
        if air is None:
            return None
        spots = air.spots[air.eye_height]
        spots = spots[:: max(1, len(spots) // SPOTS)]
        first, second = np.triu_indices(len(spots), 1)
        lengths = np.linalg.norm(spots[first] - spots[second], axis=1)
        for k in np.argsort(-lengths, kind="stable"):
            if lengths[k] < 2 * PACE:
                break
            start, end = spots[first[k]], spots[second[k]]
            line = np.linspace(start, end, math.ceil(lengths[k] / PACE))
            inside = bool(shapely.covers(air.floor, shapely.LineString(line[:, :2])))
            if inside and free(air.scene, line, min(air.clearance, CLEARANCE)).all():
                return start, start + (end - start) * (1 - self._too_far(start, end))
        return None

    def _too_far(self, start: np.ndarray, end: np.ndarray) -> float:
        """Share of a way to leave out, so that it ends AHEAD before what stands there; at most half."""
        length = float(np.linalg.norm(end - start))
        hit = float(cast_rays(self._run.rays, end[None], (end - start)[None] / length).t[0])
        return min(max(0.0, AHEAD - hit) / length, 0.5)

    def _door(self, number: int) -> tuple[np.ndarray, np.ndarray]:
        ways = [portal for portal in portals(self._run.plan) if portal.is_way]
        if number >= len(ways):
            raise CompareError(f"{self._run.folder}: {len(ways)} doors join rooms; number {number + 1} is none")
        portal = ways[number]
        clearance = min(CLEARANCE, 0.4 * portal.width)
        height = min(self._run.cameras.eye_height, portal.head - clearance - 0.05)
        middle = np.append(portal.ends.mean(axis=0), height)
        ahead = np.append(portal.normal, 0.0)
        before, after = (self._reach(middle, sign * ahead, REACH, clearance) for sign in (-1, 1))
        eyes = np.concatenate([before[::-1], after[1:]])
        if len(eyes) < 2:
            raise CompareError(f"{self._run.folder}: door {number + 1} cannot be walked through")
        return eyes, np.broadcast_to(eyes[-1] + 2 * ahead - [0, 0, 0.15], eyes.shape)


def longest_run(usable: np.ndarray) -> np.ndarray:
    """Indices of the longest run of True in a ring, in order round it."""
    n = len(usable)
    if usable.all():
        return np.arange(n)
    best: list[int] = []
    start = int(np.argmin(usable))  # a place that is not usable, so that no run is cut
    run: list[int] = []
    for k in (np.arange(start, start + n) % n).tolist():
        run = [*run, k] if usable[k] else []
        if len(run) > len(best):
            best = run
    return np.array(best, np.int64)
