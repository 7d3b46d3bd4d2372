"""View planning: the cameras of every room (paper, "Camera Viewpoint Generation").

    bootstrap   2, at eye level at the middles of the room's opposite short sides: together they see all its walls
    perimeter   about 16, at eye level along the walls, evenly by arc length, looking at the middle of what is in sight
    overhead    8, along the same line near the ceiling, looking down
    doorway     one in each door of the room, looking into it (ours: the threshold is where the paper's scenes break)

A wanted position that is not in free air, or from which something near fills the picture, is replaced by the nearest good one.
Perimeter and overhead views may turn up to TURN aside and tilt, and where furniture takes their place, stand elsewhere within
reach; of these the ones are picked that see most (`aim.py`: ours; level views towards the middle alone miss floor, ceiling,
niches and the aisles between shelves). No perimeter view within `prune_angle` of a
bootstrap view is picked, so that pruning costs no views; a position with no other choice is dropped.
"""

from collections.abc import Callable, Iterable

import numpy as np
from jaxtyping import Float

from wm.geometry.aim import choose_views
from wm.geometry.air import RoomAir, candidates, free, look_point, openness, room_air
from wm.geometry.camera import camera_center, camera_rotation, make_camera
from wm.geometry.footprint import Portal, portals
from wm.geometry.plan_records import FloorPlan
from wm.geometry.raycast import build_ray_scene
from wm.geometry.stations import short_sides, walk_line
from wm.geometry.surface_points import SurfacePoints, some_points, surface_points, times_seen
from wm.schema import CameraSettings
from wm.types import Camera, Mesh, View

MEDIAN_DEPTH = 0.8  # metres a view should see (`openness`); less in rooms narrower than that
TURN = 30.0  # degrees to either side of the middle that a perimeter or overhead view may look
_TILTS = (-30.0, -15.0, 0.0, 15.0, 30.0)  # degrees of a perimeter view above the horizon
_OVERHEAD_TILTS = (-45.0, -30.0)
_TRIES = 24  # positions judged by their picture
_APART = 0.15  # metres between two cameras of a kind
_REACH = 1.2  # metres around a wanted position taken by furniture within which its view may stand
_PLACES = 6  # positions there
_POINTS = 2000  # surface points a room by which views are picked
_DEFAULTS = CameraSettings()


def place_cameras(plan: FloorPlan, mesh: Mesh, settings: CameraSettings = _DEFAULTS) -> list[View]:
    """The training cameras of every room, in free air, in the order bootstrap, perimeter, overhead, doorway.

    Args:
        plan: a valid plan.
        mesh: its structure, with or without objects.
        settings: numbers and sizes of the views.

    Raises: ValueError if a room has no free spot for a camera, naming the room and why.
    Source: WorldMesh, "Camera Viewpoint Generation"; where ours differs is said at the top of this file.
    """
    scene = build_ray_scene(mesh)
    points = surface_points(mesh, _POINTS * len(plan.rooms))
    views = []
    for index in range(len(plan.rooms)):
        air = room_air(plan, index, scene, settings)
        own = some_points(points, mesh.face_room[points.face] == index)
        for kind, cameras in _room_cameras(plan, air, own, settings).items():
            views += [View(camera, index, kind, f"{air.name}/{kind}{k}") for k, camera in enumerate(cameras)]
    return views


def settle(
    air: RoomAir, wanted: Iterable[np.ndarray], aim: Callable[[np.ndarray], np.ndarray], settings: CameraSettings
) -> list[Camera]:
    """For each wanted position a camera at the nearest good one, `aim` telling the target from a position."""
    cameras: list[Camera] = []
    taken = np.zeros((0, 3))
    for position in wanted:
        near = candidates(air, position)
        apart = np.all(np.linalg.norm(near[:, None] - taken, axis=-1) > _APART, axis=1)
        tried, depths = [], []
        for spot in (near[apart] if apart.any() else near)[:_TRIES]:
            tried.append(make_view_camera(spot, aim(spot), settings))
            depths.append(openness(air.scene, tried[-1:])[0])
            if depths[-1] >= depth_wanted(air):
                break
        cameras.append(tried[int(np.argmax(depths))])
        taken = np.concatenate([taken, camera_center(cameras[-1])[None]])
    return cameras


def depth_wanted(air: RoomAir) -> float:
    """The `openness` that a view of a room should have, metres."""
    return min(MEDIAN_DEPTH, air.inradius)


def make_view_camera(eye: Float[np.ndarray, "3"], target: Float[np.ndarray, "3"], settings: CameraSettings) -> Camera:
    """A camera with the image size and field of view of the settings."""
    return make_camera(eye, target, width=settings.width, height=settings.height, fov_deg=settings.fov)


def door_camera(air: RoomAir, portal: Portal, settings: CameraSettings, *, step: float) -> Camera | None:
    """A camera in the middle of a door, looking into the room; nudged into the room by up to 1 m (None: that is not free).

    Args:
        step: metres by which it stands before (behind, if negative) the middle of the wall, seen from inside the room.
    """
    side = portal.rooms.index(air.index)
    inward = portal.normal * (1.0 if side == 1 else -1.0)
    clearance = min(air.clearance, 0.45 * portal.width)
    height = min(air.eye_height, portal.head - clearance)
    threshold = portal.ends.mean(axis=0)
    middle = look_point(air, threshold + inward * (portal.half_depths[side] + 0.05))
    steps = step + np.arange(0.0, 1.01, 0.1)
    spots = np.column_stack([threshold + steps[:, None] * inward, np.full(len(steps), height)])
    spots = spots[free(air.scene, spots, clearance)]
    cameras = (make_view_camera(spot, _into(spot, inward, middle), settings) for spot in spots)
    return next((camera for camera in cameras if openness(air.scene, [camera])[0] > depth_wanted(air)), None)


def _into(spot: np.ndarray, inward: np.ndarray, middle: np.ndarray) -> np.ndarray:
    """A target towards `middle`, but at most 30 degrees off the door's axis and 5 degrees below the horizon."""
    aside = np.array([-inward[1], inward[0]])
    angle = np.arctan2(aside @ (middle - spot[:2]), max(inward @ (middle - spot[:2]), 1e-6))
    angle = np.clip(angle, -np.pi / 6, np.pi / 6)
    return spot + np.append(np.cos(angle) * inward + np.sin(angle) * aside, -np.tan(np.radians(5.0)))


def _room_cameras(
    plan: FloorPlan, air: RoomAir, points: SurfacePoints, settings: CameraSettings
) -> dict[str, list[Camera]]:
    sides = short_sides(air)
    bootstrap = settle(air, _at(sides, air.eye_height), lambda spot: np.append(look_point(air, spot[:2]), spot[2]), settings)
    doors = [portal for portal in portals(plan) if portal.kind != "window" and air.index in portal.rooms and settings.doorway]
    doorway = [camera for camera in (door_camera(air, portal, settings, step=0.0) for portal in doors) if camera is not None]
    perimeter, overhead = _perimeter(air, sides[0], bootstrap, settings), _overhead(air, sides[0], settings)
    chosen = choose_views(air.scene, points, perimeter + overhead, times_seen(air.scene, points, bootstrap + doorway))
    return {
        "bootstrap": bootstrap,
        "perimeter": chosen[: len(perimeter)],
        "overhead": chosen[len(perimeter) :],
        "doorway": doorway,
    }


def _perimeter(air: RoomAir, start: np.ndarray, bootstrap: list[Camera], settings: CameraSettings) -> list[list[Camera]]:
    """For each perimeter position the views to choose from."""
    wanted = _at(walk_line(air, start, settings.perimeter, phase=0.5), air.eye_height)
    settled = settle(air, wanted, lambda spot: np.append(look_point(air, spot[:2]), spot[2]), settings)
    looks = np.array([camera_rotation(camera)[2] for camera in bootstrap])
    limit = np.cos(np.radians(settings.prune_angle))
    options = []
    for position, camera in zip(wanted, settled):
        views = [view for place in _elsewhere(air, position, camera, settings) for view in _around(air, place, _TILTS, settings)]
        distinct = [view for view in views if np.all(looks @ camera_rotation(view)[2] < limit)]
        if distinct:
            options.append(distinct)
    return options


def _overhead(air: RoomAir, start: np.ndarray, settings: CameraSettings) -> list[list[Camera]]:
    """For each overhead position the views to choose from."""
    wanted = _at(walk_line(air, start, settings.overhead, phase=0.0), air.high)
    settled = settle(air, wanted, lambda spot: np.append(look_point(air, spot[:2]), 0.3), settings)
    options = []
    for position, camera in zip(wanted, settled):
        places = _elsewhere(air, position, camera, settings)
        options.append([view for place in places for view in [place, *_around(air, place, _OVERHEAD_TILTS, settings)]])
    return options


def _elsewhere(air: RoomAir, wanted: np.ndarray, camera: Camera, settings: CameraSettings) -> list[Camera]:
    """The camera, and where furniture keeps it from its wanted position, others within reach that it may stand at instead."""
    if np.linalg.norm(camera_center(camera) - wanted) < _APART:
        return [camera]
    spots = candidates(air, wanted)
    spots = spots[np.linalg.norm(spots - wanted, axis=1) < _REACH]
    chosen = [camera_center(camera)]
    while len(chosen) < _PLACES and len(spots):
        gap = np.min([np.linalg.norm(spots - spot, axis=1) for spot in chosen], axis=0)
        if gap.max() < _APART:
            break
        chosen.append(spots[np.argmax(gap)])
    lower = camera_rotation(camera)[2][2]
    return [make_view_camera(s, np.append(look_point(air, s[:2]), s[2] + lower), settings) for s in chosen]


def _around(air: RoomAir, camera: Camera, tilts: tuple[float, ...], settings: CameraSettings) -> list[Camera]:
    """The camera's heading, and TURN to either side of it where that sees far enough, each with every tilt."""
    eye, look = camera_center(camera), camera_rotation(camera)[2]
    headings = np.arctan2(look[1], look[0]) + np.radians([0.0, -TURN, TURN])
    levels = np.column_stack([np.cos(headings), np.sin(headings), np.full(3, np.tan(np.radians(np.mean(tilts))))])
    depths = openness(air.scene, [make_view_camera(eye, eye + level, settings) for level in levels])
    kept = levels[(depths >= depth_wanted(air)) | (np.arange(3) == 0)]
    rises = np.tan(np.radians(tilts))
    return [make_view_camera(eye, eye + np.append(level[:2], rise), settings) for level in kept for rise in rises]


def _at(points: Float[np.ndarray, "n 2"], height: float) -> Float[np.ndarray, "n 3"]:
    return np.column_stack([points, np.full(len(points), height)])
