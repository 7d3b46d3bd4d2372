"""The free air of a room: where a camera can stand, where it should look from there, and how much it would see.

A point is free if a ball of the wanted clearance around it touches nothing (probed by rays in even directions) and it is not
inside a solid (from inside, rays meet the backs of faces: normals point into free air).
"""

import dataclasses
from collections.abc import Sequence

import numpy as np
import shapely
from jaxtyping import Bool, Float
from shapely.geometry import Polygon
from shapely.geometry.base import BaseGeometry

from wm.errors import InputError
from wm.geometry.plan.footprint import interior_polygon
from wm.geometry.plan.records import FloorPlan
from wm.geometry.rays.pinhole import camera_center, camera_rays, scale_camera
from wm.geometry.rays.raycast import RayScene, cast_rays
from wm.schema import CameraSettings
from wm.types import Camera

FACE = 0.1
"""Metres of free air around the eye of a visitor; a camera wants more (CameraSettings.clearance), to see past what is near."""
_DIRECTIONS = 96
"""Rays per probe: 0.36 rad apart, so that at half the usual clearance of 0.3 m nothing wider than 6 cm slips through."""
_INSIDE = 0.3
"""Share of rays that meet backs of faces from which a point counts as inside a solid: 1 in a box, less where solids overlap,
and about 0 in a room with a few open sheets (a curtain, a sail)."""
_SPOTS = 600
"""At most this many grid points per room and height: 0.18 m apart in a room of 20 m^2."""
_SAMPLES = 200
"""Floor points that stand for the room's area when it is asked what a camera sees of it."""
_THUMBNAIL = 24
"""Pixels across of the picture by which a view is judged."""


@dataclasses.dataclass(frozen=True, eq=False)
class RoomAir:
    """A room as a camera sees it."""

    index: int  # into FloorPlan.rooms
    name: str  # the room's id
    scene: RayScene
    floor: Polygon  # inside the inner wall faces
    inradius: float  # of the largest circle on the floor, metres
    offset: float  # from the walls at which cameras walk: the wanted one, less in a narrow room
    clearance: float  # around a camera: the wanted one, less in a narrow room
    eye_height: float  # the wanted one, less under a low ceiling
    ceiling: float  # its height
    high: float  # the height of overhead cameras
    samples: np.ndarray  # [s, 2] float64: points evenly spread over the floor
    spots: dict[float, np.ndarray]  # height -> [n, 3] free points on a grid


def room_air(plan: FloorPlan, index: int, scene: RayScene, settings: CameraSettings) -> RoomAir:
    """Survey a room at eye height and near its ceiling.

    Raises: InputError if no point of the room is free at eye height, naming the room and why.
    """
    room, floor = plan.rooms[index], interior_polygon(plan, index)
    inradius = shapely.maximum_inscribed_circle(floor).length
    offset = min(settings.wall_offset, 0.7 * inradius)
    clearance = min(settings.clearance, 0.75 * offset)
    headroom = min(0.3, room.ceiling_height / 4)
    eye_height = min(settings.eye_height, room.ceiling_height - headroom)
    high = max(min(room.ceiling_height - headroom - 0.05, 2.0 * settings.eye_height), eye_height)
    grid = floor_grid(floor.buffer(-clearance), _SPOTS)
    spots = {}
    for height in {eye_height: None, high: None}:
        points = np.column_stack([grid, np.full(len(grid), height)])
        spots[height] = points[free(scene, points, clearance)]
    if not len(spots[eye_height]):
        raise InputError(
            f"room {room.id}: no free spot for a camera: none of {len(grid)} points {eye_height:.2f} m above its floor has "
            f"{clearance:.2f} m of free air around it (walls and {_count_objects(scene, index)} objects stand in the way)"
        )
    return RoomAir(
        index=index,
        name=room.id,
        scene=scene,
        floor=floor,
        inradius=inradius,
        offset=offset,
        clearance=clearance,
        eye_height=eye_height,
        ceiling=room.ceiling_height,
        high=high,
        samples=floor_grid(floor, _SAMPLES),
        spots=spots,
    )


def free(scene: RayScene, points: Float[np.ndarray, "n 3"], clearance: float) -> Bool[np.ndarray, "n"]:
    """Whether a ball of radius `clearance` around each point touches nothing, and the point is not inside a solid."""
    directions = sphere_directions(_DIRECTIONS)
    origins = np.repeat(points, _DIRECTIONS, axis=0)
    hits = cast_rays(scene, origins, np.tile(directions, (len(points), 1)))
    nearest = hits.t.reshape(-1, _DIRECTIONS).min(axis=1)
    facing = np.sum(scene.normals[hits.face].reshape(-1, _DIRECTIONS, 3) * directions, axis=-1)
    return (nearest > clearance) & (np.mean(facing > 0, axis=1) < _INSIDE)


def candidates(air: RoomAir, wanted: Float[np.ndarray, "3"]) -> Float[np.ndarray, "n 3"]:
    """Free points of the room, nearest to the wanted one first: itself if it is free, then grid points of its height."""
    height = min(air.spots, key=lambda known: abs(known - wanted[2]))
    spots = air.spots[height] if len(air.spots[height]) else air.spots[air.eye_height]
    order = np.argsort(np.linalg.norm(spots - wanted, axis=1), kind="stable")
    itself = shapely.contains_xy(air.floor, *wanted[:2]) and free(air.scene, wanted[None], air.clearance)[0]
    return np.concatenate([wanted[None], spots[order]]) if itself else spots[order]


def look_point(air: RoomAir, position: Float[np.ndarray, "2"]) -> Float[np.ndarray, "2"]:
    """The middle of the floor that is in line of sight over the furniture: in a convex room, its centre from anywhere.

    Where that point is under the camera, the farthest floor in sight is taken instead.
    """
    lines = shapely.linestrings(np.stack([np.broadcast_to(position, air.samples.shape), air.samples], axis=1))
    seen = air.samples[shapely.covers(air.floor, lines)]
    if not len(seen):
        return np.asarray(air.floor.representative_point().coords[0])
    middle = seen.mean(axis=0)
    if np.linalg.norm(middle - position) > min(0.5, air.inradius / 2):
        return middle
    return seen[np.argmax(np.linalg.norm(seen - position, axis=1))]


def openness(scene: RayScene, cameras: Sequence[Camera]) -> Float[np.ndarray, "cameras"]:
    """How far each view sees, metres: its median depth, or three times its 20th percentile if something near fills it."""
    thumbnails = [scale_camera(camera, _THUMBNAIL / camera.width) for camera in cameras]
    directions = [camera_rays(camera) for camera in thumbnails]
    origins = [np.broadcast_to(camera_center(camera), rays.shape) for camera, rays in zip(thumbnails, directions)]
    depth = cast_rays(scene, np.concatenate(origins), np.concatenate(directions)).t.reshape(len(thumbnails), -1)
    near, median = np.quantile(depth, [0.2, 0.5], axis=1, method="lower")  # a miss is inf: do not interpolate
    return np.minimum(median, 3.0 * near).astype(np.float64)


def sphere_directions(count: int) -> Float[np.ndarray, "r 3"]:
    """Unit vectors spread evenly over the sphere. Source: the Fibonacci lattice, Gonzalez, Math. Geosci. 42, 2010."""
    k = np.arange(count) + 0.5
    z = 1.0 - 2.0 * k / count
    angle = np.pi * (1.0 + 5.0**0.5) * k
    radius = np.sqrt(1.0 - z**2)
    return np.column_stack([radius * np.cos(angle), radius * np.sin(angle), z])


def floor_grid(area: BaseGeometry, count: int) -> Float[np.ndarray, "n 2"]:
    """[n, 2]: about `count` points of a square grid in the area, at most 10 per metre; its innermost point where none fits."""
    if area.is_empty:
        return np.zeros((0, 2))
    step = max(0.1, (area.area / count) ** 0.5)
    low, high = np.array(area.bounds[:2]), np.array(area.bounds[2:])
    numbers = np.maximum(1, np.floor((high - low) / step).astype(int))
    x, y = (a + (np.arange(n) + 0.5) * (b - a) / n for a, b, n in zip(low, high, numbers))
    points = np.stack(np.meshgrid(x, y), axis=-1).reshape(-1, 2)
    points = points[shapely.contains_xy(area, *points.T)]
    return points if len(points) else np.asarray(area.representative_point().coords)


def _count_objects(scene: RayScene, index: int) -> int:
    objects = scene.mesh.face_object[scene.mesh.face_room == index]
    return len(np.unique(objects[objects >= 0]))
