"""View planning: the cameras of every room (paper, "Camera Viewpoint Generation").

    bootstrap   2, at eye level at the middles of the room's opposite short sides: together they see all its walls
    perimeter   about 16, at eye level along the walls, evenly by arc length, looking at the middle of what is in sight,
                by turns down to the floor and up to the ceiling (ours: level views leave both unseen near the middle)
    overhead    8, along the same line near the ceiling, looking down
    doorway     one in each door of the room, looking into it (ours: the threshold is where the paper's scenes break)

A wanted position that is not in free air, or from which something near fills the picture, is replaced by the nearest good one.
Perimeter views within `prune_angle` of a bootstrap view are dropped; in a corridor that would be most of them, so once a quarter
is dropped the rest turn aside by TURN instead and look at the walls.
"""

import dataclasses
from collections.abc import Callable, Iterable

import numpy as np
import shapely
from jaxtyping import Float

from wm.geometry.air import RoomAir, candidates, free, look_point, openness, room_air
from wm.geometry.camera import camera_rotation, make_camera
from wm.geometry.footprint import Portal, portals
from wm.geometry.plan_records import FloorPlan
from wm.geometry.raycast import build_ray_scene
from wm.schema import CameraSettings
from wm.types import Camera, Mesh, View

MEDIAN_DEPTH = 0.8  # metres a view should see (`openness`); less in rooms narrower than that
TURN = 35.0  # degrees
_KEPT = 0.75  # share of the perimeter views that pruning leaves
_TRIES = 24  # positions judged by their picture
_APART = 0.15  # metres between two cameras of a kind
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
    views = []
    for index in range(len(plan.rooms)):
        air = room_air(plan, index, scene, settings)
        bootstrap = _bootstrap(air, settings)
        groups = {
            "bootstrap": bootstrap,
            "perimeter": _perimeter(air, bootstrap, settings),
            "overhead": _overhead(air, settings),
            "doorway": _doorways(plan, air, settings) if settings.doorway else [],
        }
        for kind, cameras in groups.items():
            views += [View(camera, index, kind, f"{air.name}/{kind}{k}") for k, camera in enumerate(cameras)]
    return views


def settle(
    air: RoomAir, wanted: Iterable[np.ndarray], aim: Callable[[np.ndarray], np.ndarray], settings: CameraSettings
) -> list[Camera]:
    """For each wanted position a camera at the nearest good one, `aim` telling the target from a position."""
    enough = min(MEDIAN_DEPTH, air.inradius)
    cameras: list[Camera] = []
    taken = np.zeros((0, 3))
    for position in wanted:
        near = candidates(air, position)
        apart = np.all(np.linalg.norm(near[:, None] - taken, axis=-1) > _APART, axis=1)
        best, best_depth, best_spot = None, -1.0, near[0]
        for spot in (near[apart] if apart.any() else near)[:_TRIES]:
            camera = make_view_camera(spot, aim(spot), settings)
            depth = openness(air.scene, camera)
            if depth > best_depth:
                best, best_depth, best_spot = camera, depth, spot
            if depth >= enough:
                break
        assert best is not None  # a room's air has at least one spot
        cameras.append(best)
        taken = np.concatenate([taken, best_spot[None]])
    return cameras


def make_view_camera(
    eye: Float[np.ndarray, "3"], target: Float[np.ndarray, "3"], settings: CameraSettings
) -> Camera:
    """A camera with the image size and field of view of the settings."""
    return make_camera(eye, target, width=settings.width, height=settings.height, fov_deg=settings.fov)


def walk_line(air: RoomAir, start: Float[np.ndarray, "2"], count: int, phase: float) -> Float[np.ndarray, "n 2"]:
    """`count` points along the walls, `air.offset` inside them, evenly by arc length; the first `phase` steps after `start`."""
    walk = air.floor.buffer(-air.offset, join_style="mitre")
    rings = list(shapely.get_exterior_ring(shapely.get_parts(walk))) or [air.floor.representative_point()]
    longest = max(rings, key=lambda ring: ring.length)
    rings = [longest, *(ring for ring in rings if ring is not longest)]
    ends = np.cumsum([ring.length for ring in rings])
    first = shapely.line_locate_point(longest, shapely.Point(start)) if longest.length else 0.0
    along = (np.arange(count) + phase) * ends[-1] / max(count, 1)
    points = []
    for distance in along:
        ring = min(int(np.searchsorted(ends, distance, side="right")), len(rings) - 1)
        local = distance - (ends[ring] - rings[ring].length)
        if ring == 0 and longest.length:
            local = (local + first) % longest.length
        points.append(rings[ring].interpolate(local).coords[0] if rings[ring].length else rings[ring].coords[0])
    return np.array(points).reshape(-1, 2)


def short_sides(air: RoomAir) -> Float[np.ndarray, "2 2"]:
    """The middles of the two short sides of the room, `air.offset` inside.

    The sides are those of the floor's smallest rectangle; of a side that is only partly wall, the longest piece counts.
    """
    corners = shapely.get_coordinates(shapely.oriented_envelope(air.floor))[:4]
    if np.linalg.norm(corners[1] - corners[0]) > np.linalg.norm(corners[2] - corners[1]) + 1e-9:
        corners = np.roll(corners, -1, axis=0)
    across = corners[1] - corners[0]
    along = corners[2] - corners[1]
    inward = along / np.linalg.norm(along) * min(air.offset, np.linalg.norm(along) / 2)
    middles = []
    for corner, step in ((corners[0], inward), (corners[3], -inward)):
        line = shapely.LineString([corner + step, corner + step + across])
        pieces = [piece for piece in shapely.get_parts(line.intersection(air.floor)) if piece.length > 0]
        piece = max(pieces, key=lambda part: part.length) if pieces else line
        middles.append(np.mean(np.asarray(piece.coords), axis=0))
    return np.array(middles)


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
    return next((camera for camera in cameras if openness(air.scene, camera) > min(MEDIAN_DEPTH, air.inradius)), None)


def _into(spot: np.ndarray, inward: np.ndarray, middle: np.ndarray) -> np.ndarray:
    """A target towards `middle`, but at most 30 degrees off the door's axis and 5 degrees below the horizon."""
    ahead, aside = inward @ (middle - spot[:2]), np.array([-inward[1], inward[0]]) @ (middle - spot[:2])
    angle = np.clip(np.arctan2(aside, max(ahead, 1e-6)), -np.pi / 6, np.pi / 6)
    direction = np.cos(angle) * inward + np.sin(angle) * np.array([-inward[1], inward[0]])
    return spot + np.append(direction, -np.tan(np.radians(5.0)))


def _bootstrap(air: RoomAir, settings: CameraSettings) -> list[Camera]:
    wanted = np.column_stack([short_sides(air), np.full(2, air.eye_height)])
    return settle(air, wanted, lambda spot: np.append(look_point(air, spot[:2]), spot[2]), settings)


def _perimeter(air: RoomAir, bootstrap: list[Camera], settings: CameraSettings) -> list[Camera]:
    wanted = walk_line(air, short_sides(air)[0], settings.perimeter, phase=0.5)
    cameras = []
    for parity in (0, 1):
        lift = (settings.fov / 3, -settings.fov / 3)[parity]
        spots = np.column_stack([wanted[parity::2], np.full(len(wanted[parity::2]), air.eye_height)])
        cameras += settle(air, spots, lambda spot, lift=lift: _tilted(air, spot, lift), settings)
    order = np.argsort([*range(0, len(wanted), 2), *range(1, len(wanted), 2)], kind="stable")
    return _prune([cameras[k] for k in order], bootstrap, settings)


def _tilted(air: RoomAir, spot: np.ndarray, lift: float) -> np.ndarray:
    """The middle of the floor (lift > 0) or ceiling (lift < 0) in sight, moved `lift` degrees towards the horizon."""
    middle = look_point(air, spot[:2])
    distance = max(np.linalg.norm(middle - spot[:2]), 1e-3)
    rise = -spot[2] if lift > 0 else air.ceiling - spot[2]
    pitch = np.degrees(np.arctan2(rise, distance)) + lift
    pitch = np.clip(pitch, -35.0, -10.0) if lift > 0 else np.clip(pitch, 8.0, 30.0)
    return np.append(middle, spot[2] + distance * np.tan(np.radians(pitch)))


def _prune(cameras: list[Camera], bootstrap: list[Camera], settings: CameraSettings) -> list[Camera]:
    """Drop what looks where a bootstrap view looks, up to a share; turn the rest of those aside."""
    looks = np.array([camera_rotation(camera)[2] for camera in bootstrap])
    similar = [bool((looks @ camera_rotation(camera)[2] > np.cos(np.radians(settings.prune_angle))).any()) for camera in cameras]
    may_drop = len(cameras) - int(np.ceil(_KEPT * len(cameras)))
    kept = []
    for k, (camera, redundant) in enumerate(zip(cameras, similar)):
        if not redundant:
            kept.append(camera)
        elif may_drop > 0:
            may_drop -= 1
        else:
            kept.append(_turned(camera, TURN if k % 2 else -TURN))
    return kept


def _turned(camera: Camera, degrees: float) -> Camera:
    """The camera turned about the vertical through its centre."""
    c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    T_cam_world = np.array(camera.T_cam_world)
    centre = -T_cam_world[:3, :3].T @ T_cam_world[:3, 3]
    T_cam_world[:3, :3] = T_cam_world[:3, :3] @ np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]])
    T_cam_world[:3, 3] = -T_cam_world[:3, :3] @ centre
    return dataclasses.replace(camera, T_cam_world=T_cam_world)


def _overhead(air: RoomAir, settings: CameraSettings) -> list[Camera]:
    spots = walk_line(air, short_sides(air)[0], settings.overhead, phase=0.0)
    wanted = np.column_stack([spots, np.full(len(spots), air.high)])
    return settle(air, wanted, lambda spot: np.append(look_point(air, spot[:2]), 0.3), settings)


def _doorways(plan: FloorPlan, air: RoomAir, settings: CameraSettings) -> list[Camera]:
    doors = [portal for portal in portals(plan) if portal.kind != "window" and air.index in portal.rooms]
    cameras = [door_camera(air, portal, settings, step=0.0) for portal in doors]
    return [camera for camera in cameras if camera is not None]
