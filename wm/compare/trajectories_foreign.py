"""Trajectories through a scene of which nothing is known but what it shows: from its own cameras, or from its middle.

The scene is looked at from one place all round; what is seen in a level band tells how far the air is free in every direction,
and every path stays within SAFE of that. Lengths go by the scene's own scale, so that the unit of the file does not matter.

    around  an arc round what stands nearest in a direction; number 2 takes the next direction, at least APART away
    close   from that place towards it
    along   along the longest straight line through that place
    door    in the direction in which most lies ahead: where such a scene leads out of what its maker saw
"""

import functools
import math

import numpy as np

from wm.compare.consistency import HOLE
from wm.compare.drawing import Drawer
from wm.compare.errors import CompareError
from wm.compare.records import ComparedScene
from wm.compare.trajectories import Picture, Trajectory, kind_of, path_of
from wm.geometry.rays.pinhole import camera_center, camera_rays, make_camera

HEADINGS = 36  # directions that are told apart
THUMBNAIL = 48  # pixels across of the pictures by which the scene is surveyed
BAND = math.radians(20)  # directions up to so far above and below the horizon count
SAFE = 0.7  # share of the free distance that a path uses
ARC = math.radians(40)  # to either side, round what is looked at
APART = 5  # headings between two things that are walked round
NEAREST = 0.35  # share of the distance that is left before a thing looked at closely


class ForeignPaths:
    """The trajectories of one scene; it is surveyed when the first is asked for."""

    def __init__(self, scene: ComparedScene, draw: Drawer, picture: Picture) -> None:
        self._scene, self._draw, self._picture = scene, draw, picture

    def path(self, name: str) -> Trajectory:
        """The trajectory of a name. Raises: CompareError where the scene has no such path."""
        kind, number = kind_of(name)
        eyes, targets = {"around": self._around, "close": self._close, "along": self._along, "door": self._door}[kind](number)
        return path_of(name, self._picture, eyes, targets)

    @functools.cached_property
    def eye(self) -> np.ndarray:
        """The place from which the scene is surveyed: of its own cameras the innermost, else where its maker looked from, else
        the most open of nine places about the middle of the box that holds nine tenths of it."""
        if self._scene.cameras:
            centers = np.array([camera_center(camera) for camera in self._scene.cameras])
            return centers[np.argmin(np.linalg.norm(centers - np.median(centers, axis=0), axis=1))]
        if self._scene.eye is not None:
            return np.asarray(self._scene.eye, np.float64)
        points = np.asarray(self._scene.gaussians.means if self._scene.gaussians is not None else self._vertices, np.float64)
        points = points[np.isfinite(points).all(axis=1)] @ np.asarray(self._scene.R_world_file).T
        low, high = np.quantile(points, [0.05, 0.95], axis=0)
        shares = np.array([(x, y, 0.5) for x in (0.5, 0.35, 0.65) for y in (0.5, 0.35, 0.65)])
        spots = low + shares * (high - low)
        return spots[np.argmax([float(np.median(self._survey(spot))) for spot in spots])]

    @property
    def _vertices(self) -> np.ndarray:
        assert self._scene.mesh is not None
        return self._scene.mesh.vertices

    @functools.cached_property
    def free(self) -> np.ndarray:
        """[HEADINGS] how far the air is free in each direction, in the scene's unit; 0 where nothing is seen."""
        found = self._survey(self.eye)
        if not found.any():
            raise CompareError(f"{self._scene.method}: nothing is to be seen from {self.eye.round(2).tolist()}, its middle")
        return found

    def _survey(self, eye: np.ndarray) -> np.ndarray:
        nearest: list[list[float]] = [[] for _ in range(HEADINGS)]
        for k in range(8):
            heading = 2 * math.pi * k / 8
            ahead = np.array([math.cos(heading), math.sin(heading), 0.0])
            camera = make_camera(eye, eye + ahead, width=THUMBNAIL, height=THUMBNAIL, fov_deg=60.0)
            render = self._draw(camera)
            rays = camera_rays(camera)
            length = np.linalg.norm(rays, axis=1)
            seen = (np.asarray(render.alpha).reshape(-1) >= HOLE) & (np.abs(np.arcsin(rays[:, 2] / length)) < BAND)
            index = _heading(rays)
            distance = np.asarray(render.depth, np.float64).reshape(-1) * np.hypot(rays[:, 0], rays[:, 1])
            for k in np.unique(index):
                nearest[k] += distance[seen & (index == k)].tolist()
        return np.array([float(np.quantile(values, 0.1)) if values else 0.0 for values in nearest])

    def _things(self) -> list[int]:
        """Headings in which something stands, nearest first, at least APART from each other."""
        order = [int(k) for k in np.argsort(np.where(self.free > 0, self.free, np.inf), kind="stable") if self.free[k] > 0]
        taken: list[int] = []
        for k in order:
            if all(min((k - other) % HEADINGS, (other - k) % HEADINGS) >= APART for other in taken):
                taken.append(k)
        return taken

    def _thing(self, number: int) -> int:
        things = self._things()
        if number >= len(things):
            raise CompareError(f"{self._scene.method}: {len(things)} directions can be walked round; number {number + 1} is none")
        return things[number]

    def _around(self, number: int) -> tuple[np.ndarray, np.ndarray]:
        heading = self._thing(number)
        ahead, distance = _direction(heading), float(self.free[heading])
        target = self.eye + distance * ahead
        radius = (1 - 0.15) * distance
        start = math.atan2(-ahead[1], -ahead[0])
        sides = []
        for sign in (-1, 1):
            angles = start + sign * np.linspace(0, ARC, 25)
            places = target + radius * np.column_stack([np.cos(angles), np.sin(angles), np.zeros(25)])
            inside = self._is_free(places)
            sides.append(places[: max(1, int(np.argmin(inside)) if not inside.all() else 25)])
        eyes = np.concatenate([sides[0][::-1], sides[1][1:]])
        return self._checked(eyes, f"around{number + 1}"), np.broadcast_to(target, eyes.shape)

    def _is_free(self, places: np.ndarray) -> np.ndarray:
        """Whether each place is seen to be free from the middle."""
        away = places - self.eye
        return np.hypot(away[:, 0], away[:, 1]) <= SAFE * self.free[_heading(away)]

    def _checked(self, eyes: np.ndarray, name: str) -> np.ndarray:
        if len(eyes) < 2:
            raise CompareError(f"{self._scene.method}: {name}: no free way from its middle")
        return eyes

    def _close(self, number: int) -> tuple[np.ndarray, np.ndarray]:
        heading = self._thing(number)
        ahead, distance = _direction(heading), float(self.free[heading])
        eyes = self.eye + np.linspace(0, (1 - NEAREST) * distance, 25)[:, None] * ahead
        return eyes, np.broadcast_to(self.eye + distance * ahead, eyes.shape)

    def _along(self, number: int) -> tuple[np.ndarray, np.ndarray]:
        opposite = np.roll(self.free, -HEADINGS // 2)
        order = np.argsort(-(self.free + opposite)[: HEADINGS // 2], kind="stable")
        heading = int(order[min(number, len(order) - 1)])
        ahead = _direction(heading)
        eyes = self.eye + np.linspace(-0.5 * SAFE * opposite[heading], 0.5 * SAFE * self.free[heading], 25)[:, None] * ahead
        return self._checked(eyes, f"along{number + 1}"), eyes + ahead

    def _door(self, number: int) -> tuple[np.ndarray, np.ndarray]:
        order = [int(k) for k in np.argsort(-self.free, kind="stable")]
        heading = order[min(number, len(order) - 1)]
        ahead = _direction(heading)
        eyes = self.eye + np.linspace(0, SAFE * self.free[heading], 25)[:, None] * ahead
        return eyes, eyes + ahead


def _heading(directions: np.ndarray) -> np.ndarray:
    """[n] which of the HEADINGS is nearest to directions [n, 3]."""
    return np.round(np.arctan2(directions[:, 1], directions[:, 0]) / (2 * math.pi) * HEADINGS).astype(int) % HEADINGS


def _direction(heading: int) -> np.ndarray:
    angle = 2 * math.pi * heading / HEADINGS
    return np.array([math.cos(angle), math.sin(angle), 0.0])
