"""Held-out views: never trained on, and placed where no training view stands (design.md, section 6).

    between   half-way between consecutive training views of a kind, looking half-way between where they look
    close     0.6 to 1.2 m from an object, looking at it
    door      a step before a door, looking through it into the room
A quarter of a room's views are close and a quarter look through doors, as far as it has objects and doors; the rest are between.
"""

import itertools
from collections.abc import Iterator, Sequence

import numpy as np
import shapely

from wm.geometry.cameras.air import RoomAir, candidates, free, openness, room_air
from wm.geometry.cameras.views import depth_wanted, door_camera, make_view_camera
from wm.geometry.plan.openings import portals
from wm.geometry.plan.records import FloorPlan
from wm.geometry.rays.pinhole import camera_center, camera_rotation
from wm.geometry.rays.raycast import RayScene, occluded, ray_scene
from wm.schema import CameraSettings
from wm.types import Camera, Mesh, View

_CLOSE = (0.6, 1.2)  # metres from the nearest point of an object's bounding box
_DISTANCES = (0.7, 0.9, 1.1)  # metres from its edge, along a bearing, that are tried
_BEARINGS = 24
_SMALL = 0.15  # metres: things smaller than this along every axis are not worth a view
_STEPS = (-0.7, -1.0, -0.5, -0.35)
"""Metres before the middle of a door's wall, seen from the room that is looked into; tried in this order."""
_APART = 0.1
"""Metres from every training camera: a view nearer than that tells nothing new."""
_DEFAULTS = CameraSettings()


def place_heldout(
    plan: FloorPlan, mesh: Mesh | RayScene, views: Sequence[View], settings: CameraSettings = _DEFAULTS
) -> list[View]:
    """`heldout_per_room` views of every room, in free air, at least 0.1 m from any training camera; fewer where none is left.

    Args:
        plan, mesh: as for `place_cameras`.
        views: the training views.

    Returns: views of kind "heldout"; `room` is the room looked into, also where the camera stands before its door.
    """
    if settings.heldout_per_room == 0:
        return []
    scene = ray_scene(mesh)
    taken = np.array([camera_center(view.camera) for view in views]).reshape(-1, 3)
    heldout = []
    for index in range(len(plan.rooms)):
        air = room_air(plan, index, scene, settings)
        own = [view for view in views if view.room == index]
        few = settings.heldout_per_room // 4
        close = _some(_close(air, settings), few, taken)
        doors = _some(_doors(plan, air, settings), few, taken)
        between = _some(_between(air, own, settings), settings.heldout_per_room - len(close) - len(doors), taken)
        cameras = [*between, *close, *doors]
        heldout += [View(camera, index, "heldout", f"{air.name}/heldout{k}") for k, camera in enumerate(cameras)]
    return heldout


def _some(cameras: Iterator[Camera], count: int, taken: np.ndarray) -> list[Camera]:
    apart = (camera for camera in cameras if np.all(np.linalg.norm(taken - camera_center(camera), axis=1) > _APART))
    return list(itertools.islice(apart, count))


def _between(air: RoomAir, views: list[View], settings: CameraSettings) -> Iterator[Camera]:
    """Pairs of the perimeter first, every other one, then the rest, then pairs near the ceiling, then one bootstrap pair."""
    for kind in ("perimeter", "overhead", "bootstrap"):
        cameras = [view.camera for view in views if view.kind == kind]
        pairs = list(itertools.pairwise([*cameras, *cameras[:1]])) if len(cameras) > 2 else list(itertools.pairwise(cameras))
        for first, second in [*pairs[::2], *pairs[1::2]]:
            wanted = (camera_center(first) + camera_center(second)) / 2
            look = camera_rotation(first)[2] + camera_rotation(second)[2]
            if np.linalg.norm(look) < 0.2:  # opposite views have no direction half-way
                look = camera_rotation(first)[0]
            for spot in candidates(air, wanted)[:8]:
                camera = make_view_camera(spot, spot + look, settings)
                if openness(air.scene, [camera])[0] > depth_wanted(air):
                    yield camera
                    break


def _close(air: RoomAir, settings: CameraSettings) -> Iterator[Camera]:
    """One view of each object, the largest first."""
    mesh = air.scene.mesh
    things = np.unique(mesh.face_object[(mesh.face_room == air.index) & (mesh.face_object >= 0)])
    boxes = []
    for thing in things:
        corners = mesh.vertices[mesh.faces[mesh.face_object == thing].reshape(-1)]
        boxes.append((corners.min(axis=0), corners.max(axis=0)))
    boxes = [(low, high) for low, high in boxes if np.max(high - low) > _SMALL]
    for low, high in sorted(boxes, key=lambda box: -float(np.prod(np.maximum(box[1] - box[0], 0.01)))):
        camera = _beside(air, low, high, settings)
        if camera is not None:
            yield camera


def _beside(air: RoomAir, low: np.ndarray, high: np.ndarray, settings: CameraSettings) -> Camera | None:
    """A camera around a box, somewhat above its middle: of the free spots that see it, the one nearest to the room's middle."""
    middle = (low + high) / 2
    bearings = np.arange(_BEARINGS) * 2 * np.pi / _BEARINGS
    around = np.column_stack([np.cos(bearings), np.sin(bearings)])
    edge = 1.0 / np.max(np.abs(around) / np.maximum((high - low)[:2] / 2, 1e-3), axis=1)
    height = np.clip(middle[2] + 0.3, 0.9, air.eye_height)
    flat = np.concatenate([middle[:2] + around * (edge + distance)[:, None] for distance in _DISTANCES])
    spots = np.column_stack([flat, np.full(len(flat), height)])
    nearest = np.clip(spots, low, high)
    distance = np.linalg.norm(nearest - spots, axis=1)
    usable = (_CLOSE[0] <= distance) & (distance <= _CLOSE[1]) & shapely.contains_xy(air.floor, *flat.T)
    usable[usable] = free(air.scene, spots[usable], air.clearance)
    usable[usable] = ~occluded(air.scene, spots[usable], (nearest - spots)[usable], 0.97)
    if not usable.any():
        return None
    centre = np.append(air.samples.mean(axis=0), height)
    best = np.argmin(np.linalg.norm(spots[usable] - centre, axis=1))
    return make_view_camera(spots[usable][best], middle, settings)


def _doors(plan: FloorPlan, air: RoomAir, settings: CameraSettings) -> Iterator[Camera]:
    for portal in portals(plan):
        if portal.is_way and air.index in portal.rooms:
            for step in _STEPS:
                camera = door_camera(air, portal, settings, step=step)
                if camera is not None:
                    yield camera
                    break
