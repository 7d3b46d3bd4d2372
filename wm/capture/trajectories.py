"""Cameras along a trajectory: a walk through all rooms, an orbit in each, the run's own views, or those of a file."""

import dataclasses

import numpy as np
import shapely

from wm.capture.request import CaptureError, CaptureRequest
from wm.errors import InputError
from wm.finished import FinishedRun
from wm.geometry import CameraFileError, camera_center, interior_polygon, load_cameras, make_camera, walkthrough
from wm.geometry.cameras.air import RoomAir, free, room_air
from wm.schema import CameraSettings
from wm.types import Camera, View

_SHARES = (0.75, 0.6, 0.45, 0.3, 0.15)
"""Of the way from a room's middle to its wall: an orbiting camera stands at the first that is free."""
_LOOK_HEIGHT = 0.9
"""Metres above the floor of the point that an orbit looks at."""
_SECOND = 1.0


@dataclasses.dataclass(frozen=True, eq=False)
class Station:
    """A camera and when it was there."""

    camera: Camera
    time: float  # seconds from the start
    name: str  # of the view of a run or a file; empty on a walk or an orbit
    room: str | None  # the id of the room in which it stands


def stations(run: FinishedRun, request: CaptureRequest) -> list[Station]:
    """The cameras of the request in order.

    Raises:
        CaptureError: the trajectory has no camera, or its file cannot be read.
    """
    settings = _settings(run, request)
    step = 1 / request.fps
    match request.trajectory:
        case "walk":
            try:
                cameras = walkthrough(run.plan, run.rays, settings, fps=request.fps, speed=request.speed)
            except InputError as error:
                raise CaptureError(f"{run.folder}: trajectory=walk: {error}") from None
            named = [(camera, "") for camera in cameras]
        case "orbit":
            named = [
                (camera, "") for index in range(len(run.rooms)) for camera in _orbit(run, index, settings, round(request.fps))
            ]
        case "views" | "heldout":
            step, own = _SECOND, run.views if request.trajectory == "views" else run.heldout
            named = [(_resized(view.camera, request), view.name) for view in own]
        case _:
            step, named = _SECOND, [(_resized(view.camera, request), view.name) for view in _from_file(request)]
    if not named:
        raise CaptureError(f"trajectory={request.trajectory} has no camera in this run; another trajectory would be right")
    floors = [interior_polygon(run.plan, index) for index in range(len(run.rooms))]
    return [Station(camera, k * step, name, _room(run.rooms, floors, camera)) for k, (camera, name) in enumerate(named)]


def _settings(run: FinishedRun, request: CaptureRequest) -> CameraSettings:
    asked = {"width": request.width, "height": request.height, "fov": request.fov}
    return dataclasses.replace(run.cameras, **{name: value for name, value in asked.items() if value is not None})


def _resized(camera: Camera, request: CaptureRequest) -> Camera:
    """The same place and direction, in the size and with the vertical field of view that are asked for."""
    if (request.width, request.height, request.fov) == (None, None, None):
        return camera
    width, height = request.width or camera.width, request.height or camera.height
    old = np.asarray(camera.focal, np.float64)
    vertical = old[1] * height / camera.height if request.fov is None else height / (2 * np.tan(np.radians(request.fov) / 2))
    return Camera(
        T_cam_world=camera.T_cam_world,
        focal=np.array([old[0] / old[1] * vertical, vertical]),
        principal=np.array([width / 2, height / 2]),
        width=width,
        height=height,
    )


def _from_file(request: CaptureRequest) -> tuple[View, ...]:
    try:
        return load_cameras(request.trajectory)
    except CameraFileError as error:
        raise CaptureError(str(error)) from None


def _orbit(run: FinishedRun, index: int, settings: CameraSettings, count: int) -> list[Camera]:
    """Cameras around the middle of a room that look at it. Where furniture leaves no place for one, there is none.

    Raises:
        CaptureError: no place is free in the whole room.
    """
    try:
        air = room_air(run.plan, index, run.rays, settings)
    except InputError as error:
        raise CaptureError(f"{run.folder}: trajectory=orbit: {error}") from None
    middle = shapely.maximum_inscribed_circle(air.floor)
    centre = np.array(middle.coords[0])
    cameras = []
    for angle in 2 * np.pi * np.arange(count) / count:
        places = _places(air, centre, np.array([np.cos(angle), np.sin(angle)]))
        good = places[free(run.rays, places, air.clearance)]
        if len(good):
            target = np.array([*centre, min(_LOOK_HEIGHT, air.eye_height / 2)])
            cameras.append(make_camera(good[0], target, width=settings.width, height=settings.height, fov_deg=settings.fov))
    if not cameras:
        raise CaptureError(
            f"{run.folder}: trajectory=orbit: room {air.name} has no free place around its middle; walk would be right"
        )
    return cameras


def _places(air: RoomAir, centre: np.ndarray, direction: np.ndarray) -> np.ndarray:
    """Places on the way from a room's middle to its wall, the outermost first, at eye height."""
    way = shapely.LineString([centre, centre + 1e3 * direction]).intersection(air.floor.boundary)
    reach = shapely.distance(shapely.Point(centre), way)
    flat = centre + np.array(_SHARES)[:, None] * reach * direction
    return np.column_stack([flat, np.full(len(flat), air.eye_height)])


def _room(rooms: list[str], floors: list[shapely.Polygon], camera: Camera) -> str | None:
    x, y, _ = camera_center(camera)
    return next((name for name, floor in zip(rooms, floors) if shapely.intersects_xy(floor, x, y)), None)
