"""View planning: the cameras of every room (paper, "Camera Viewpoint Generation").

    bootstrap   2, at eye level at the middles of the room's opposite short sides: together they see all its walls
    perimeter   about 16, at eye level along the walls, evenly by arc length, looking at the middle of what is in sight
    overhead    8, along the same line near the ceiling, looking down
    doorway     one in each door of the room, looking into it (ours: the threshold is where the paper's scenes break)

A wanted position that is not in free air, or from which something near fills the picture, is replaced by the nearest good one.
Perimeter and overhead views may turn up to TURN aside and tilt, perimeter views may stand LOWER, and where furniture takes its
place a view may stand elsewhere within reach; of these the ones are picked that see most (`aim.py`: ours; level views towards
the middle alone miss floor, ceiling, niches and the aisles between shelves). No perimeter view within `prune_angle` of a
bootstrap view is picked, so that pruning costs no views; a position with no other choice is dropped.
"""

from collections.abc import Callable, Iterable

import numpy as np
from jaxtyping import Float

from wm.geometry.cameras.aim import Aims, choose_aims
from wm.geometry.cameras.air import RoomAir, candidates, free, look_point, openness, room_air
from wm.geometry.cameras.stations import short_sides, walk_line
from wm.geometry.plan.openings import portals
from wm.geometry.plan.portal import Portal
from wm.geometry.plan.records import FloorPlan
from wm.geometry.rays.pinhole import camera_center, camera_rotation, make_camera
from wm.geometry.rays.raycast import RayScene, ray_scene
from wm.geometry.rays.surface_points import SurfacePoints, some_points, surface_points, times_seen
from wm.schema import CameraSettings
from wm.types import Camera, Mesh, View

MEDIAN_DEPTH = 0.8  # metres a view should see (`openness`); less in rooms narrower than that
_BOOTSTRAP = 2.0  # a bootstrap view should see this many times as far: the whole room is imagined from it
TURN = 30.0  # degrees to either side of the middle that a perimeter or overhead view may look
LOWER = 0.5  # metres below eye level at which a perimeter view may stand: what is under shelves is seen from there only
_TILTS = (-30.0, -15.0, 0.0, 15.0, 30.0)  # degrees of a perimeter view above the horizon
_OVERHEAD_TILTS = (-45.0, -30.0)
_TRIES = 24  # positions of which a small picture is rendered and judged
_APART = 0.15  # metres between two training cameras of one kind; held-out views keep 0.1 m from all of them
_REACH = 1.5  # metres around a wanted position taken by furniture within which its view may stand
_PLACES = 8  # positions within _REACH that are offered
_POINTS = 2000  # surface points per room by which views are picked
_DEFAULTS = CameraSettings()


def place_cameras(plan: FloorPlan, mesh: Mesh | RayScene, settings: CameraSettings = _DEFAULTS) -> list[View]:
    """The training cameras of every room, in free air, in the order bootstrap, perimeter, overhead, doorway.

    Args:
        plan: a valid plan.
        mesh: its structure, with or without objects; give a RayScene where there is one, so that it is not built again.
        settings: numbers and sizes of the views.

    Raises: InputError if a room has no free spot for a camera, naming the room and why.
    Source: WorldMesh, "Camera Viewpoint Generation"; where ours differs is said at the top of this file.
    """
    scene = ray_scene(mesh)
    mesh = scene.mesh
    points = surface_points(mesh, _POINTS * len(plan.rooms))
    views = []
    for index in range(len(plan.rooms)):
        air = room_air(plan, index, scene, settings)
        own = some_points(points, mesh.face_room[points.face] == index)
        for kind, cameras in _room_cameras(plan, air, own, settings).items():
            views += [View(camera, index, kind, f"{air.name}/{kind}{k}") for k, camera in enumerate(cameras)]
    return views


def bootstrap_cameras(plan: FloorPlan, scene: RayScene, room: int, settings: CameraSettings = _DEFAULTS) -> list[Camera]:
    """The two cameras from which a room is imagined: at the middles of its short sides, looking across it.

    Raises: InputError if the room has no free spot for a camera, naming the room and why.
    """
    return _bootstrap(room_air(plan, room, scene, settings), settings)


def settle(
    air: RoomAir,
    wanted: Iterable[np.ndarray],
    aim: Callable[[np.ndarray], np.ndarray],
    settings: CameraSettings,
    *,
    depth: float,
) -> list[Camera]:
    """For each wanted position a camera at the nearest one that sees `depth` far, else at the one near it that sees farthest.

    `aim` tells the target from a position.
    """
    cameras: list[Camera] = []
    taken = np.zeros((0, 3))
    for position in wanted:
        near = candidates(air, position)
        apart = np.all(np.linalg.norm(near[:, None] - taken, axis=-1) > _APART, axis=1)
        tried, depths = [], []
        for spot in (near[apart] if apart.any() else near)[:_TRIES]:
            tried.append(make_view_camera(spot, aim(spot), settings))
            depths.append(openness(air.scene, tried[-1:])[0])
            if depths[-1] >= depth:
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
    """A camera in the middle of a door, looking into the room; moved into the room by up to 1 m; None where none of these places
    is free.

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


def _room_cameras(plan: FloorPlan, air: RoomAir, points: SurfacePoints, settings: CameraSettings) -> dict[str, list[Camera]]:
    sides = short_sides(air)
    bootstrap = _bootstrap(air, settings)
    doors = [portal for portal in portals(plan) if portal.is_way and air.index in portal.rooms and settings.doorway]
    doorway = [camera for camera in (door_camera(air, portal, settings, step=0.0) for portal in doors) if camera is not None]
    perimeter = _distinct(_options(air, sides[0], settings, "perimeter"), bootstrap, settings)
    options = [*perimeter, *_options(air, sides[0], settings, "overhead")]
    half_height = np.tan(np.radians(settings.fov) / 2)
    picks = choose_aims(
        air.scene,
        points,
        options,
        times_seen(air.scene, points, bootstrap + doorway),
        half_extent=(half_height * settings.width / settings.height, half_height),
    )
    aimed = [
        make_view_camera(aims.eyes[pick], aims.eyes[pick] + aims.looks[pick], settings) for aims, pick in zip(options, picks)
    ]
    return {
        "bootstrap": bootstrap,
        "perimeter": aimed[: len(perimeter)],
        "overhead": aimed[len(perimeter) :],
        "doorway": doorway,
    }


def _bootstrap(air: RoomAir, settings: CameraSettings) -> list[Camera]:
    wanted = _at(short_sides(air), air.eye_height)
    return settle(air, wanted, _level(air), settings, depth=_BOOTSTRAP * depth_wanted(air))


def _options(air: RoomAir, start: np.ndarray, settings: CameraSettings, kind: str) -> list[Aims]:
    """For each position along the walls the views to choose from: some places, up to three headings, every tilt."""
    count, phase, height, drop, tilts = {
        "perimeter": (settings.perimeter, 0.5, air.eye_height, 0.0, _TILTS),
        "overhead": (settings.overhead, 0.0, air.high, air.high - 0.3, _OVERHEAD_TILTS),
    }[kind]
    wanted = _at(walk_line(air, start, count, phase), height)
    settled = settle(air, wanted, _level(air, drop), settings, depth=depth_wanted(air))
    places = [_elsewhere(air, position, camera_center(camera)) for position, camera in zip(wanted, settled)]
    if kind == "perimeter":
        places = [np.concatenate([place, _lower(air, place)]) for place in places]
    eyes = np.repeat(np.concatenate([*places, np.zeros((0, 3))]), 3, axis=0)
    if not len(eyes):
        return []
    ahead = np.array([look_point(air, eye[:2]) - eye[:2] for eye in eyes[::3]])
    headings = np.repeat(np.arctan2(ahead[:, 1], ahead[:, 0]), 3) + np.tile(np.radians([0.0, -TURN, TURN]), len(ahead))
    levels = np.column_stack([np.cos(headings), np.sin(headings)])
    typical = np.append(levels, np.full((len(levels), 1), np.tan(np.radians(np.mean(tilts)))), axis=1)
    depths = openness(air.scene, [make_view_camera(eye, eye + look, settings) for eye, look in zip(eyes, typical)])
    usable = (depths >= depth_wanted(air)) | (np.arange(len(eyes)) % 3 == 0)
    owner = np.repeat(np.arange(len(places)), [3 * len(place) for place in places])
    rises = np.tan(np.radians(tilts))
    options = []
    for k in range(len(places)):
        own = np.flatnonzero(usable & (owner == k))
        looks = np.column_stack([np.repeat(levels[own], len(rises), axis=0), np.tile(rises, len(own))])
        options.append(Aims(eyes=np.repeat(eyes[own], len(rises), axis=0), looks=looks))
    return options


def _level(air: RoomAir, drop: float = 0.0) -> Callable[[np.ndarray], np.ndarray]:
    """The look point of a position, at its height or `drop` metres lower."""
    return lambda spot: np.append(look_point(air, spot[:2]), spot[2] - drop)


def _distinct(options: list[Aims], bootstrap: list[Camera], settings: CameraSettings) -> list[Aims]:
    """The options without those that look where a bootstrap view looks."""
    taken = np.array([camera_rotation(camera)[2] for camera in bootstrap])
    kept = []
    for aims in options:
        cosines = aims.looks / np.linalg.norm(aims.looks, axis=1, keepdims=True) @ taken.T
        distinct = np.all(cosines < np.cos(np.radians(settings.prune_angle)), axis=1)
        if distinct.any():
            kept.append(Aims(eyes=aims.eyes[distinct], looks=aims.looks[distinct]))
    return kept


def _elsewhere(air: RoomAir, wanted: np.ndarray, settled: np.ndarray) -> Float[np.ndarray, "n 3"]:
    """Where the camera settled and, if furniture kept it from its wanted position, other free spots within reach of that."""
    if np.linalg.norm(settled - wanted) < _APART:
        return settled[None]
    spots = candidates(air, wanted)
    spots = spots[np.linalg.norm(spots - wanted, axis=1) < _REACH]
    chosen = [settled]
    while len(chosen) < _PLACES and len(spots):
        gap = np.min([np.linalg.norm(spots - spot, axis=1) for spot in chosen], axis=0)
        if gap.max() < _APART:
            break
        chosen.append(spots[np.argmax(gap)])
    return np.array(chosen)


def _lower(air: RoomAir, place: Float[np.ndarray, "n 3"]) -> Float[np.ndarray, "m 3"]:
    """Those of the places, LOWER down, that are in free air there."""
    lower = place - [0.0, 0.0, LOWER]
    return lower[free(air.scene, lower, air.clearance)]


def _at(points: Float[np.ndarray, "n 2"], height: float) -> Float[np.ndarray, "n 3"]:
    return np.column_stack([points, np.full(len(points), height)])
