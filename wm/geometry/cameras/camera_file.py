"""Cameras from nerfstudio's transforms.json, of which wm's `cameras.json` is one.

Its cameras look along -z with y up (OpenGL) and are given as camera to world; ours look along +z with y down. Intrinsics stand
with each frame, or once for all. `applied_transform` has moved all poses out of the world in which they were measured.

Source: nerfstudio's documentation, "Data conventions".
"""

import json
import math
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image

from wm.geometry.mesh.axes import OPENGL_FROM_OPENCV
from wm.types import OUTSIDE, Camera, View

_DISTORTION = ("k1", "k2", "k3", "k4", "p1", "p2")


class CameraFileError(ValueError):
    """A file of cameras that cannot be read. The message names the file, the frame, and what would be right."""


def load_cameras(path: str | Path, *, undo_applied_transform: bool = True) -> tuple[View, ...]:
    """The views of a `cameras.json`, or of any transforms.json of pinhole cameras, in the order of its frames.

    Args:
        path: the file.
        undo_applied_transform: bring poses back into the world before the file's `applied_transform`; otherwise they are
            as the file has them, which is where its `ply_file_path` lies.

    Returns:
        Views whose cameras have float64 leaves. `room` numbers the rooms that frames name, in order of their first frames,
        OUTSIDE where a frame names none; `name` is the frame's, or its `file_path` without suffix; `kind` may be empty.

    Raises:
        CameraFileError: the file is no such JSON, a frame lacks a number, or its lens is not a pinhole's.
    """
    path = Path(path)
    try:
        file = json.loads(path.read_text(encoding="utf-8"))
    except ValueError as error:
        raise CameraFileError(f"{path}: not JSON: {error}") from None
    frames = file.get("frames") if isinstance(file, dict) else None
    if not isinstance(frames, list) or not all(isinstance(frame, dict) for frame in frames):
        raise CameraFileError(f"{path}: no list 'frames' of objects; a transforms.json has one")
    undo = _undo(str(path), file.get("applied_transform")) if undo_applied_transform else np.eye(4)
    rooms: dict[str, int] = {}
    views = []
    for k, frame in enumerate(frames):
        where, numbers = f"{path}, frame {k}", {**file, **frame}
        room = rooms.setdefault(str(frame["room"]), len(rooms)) if "room" in frame else OUTSIDE
        name = str(frame.get("name") or Path(str(frame.get("file_path", k))).with_suffix("").as_posix())
        camera = _camera(where, numbers, undo @ _pose(where, frame.get("transform_matrix")), path.parent)
        views.append(View(camera=camera, room=room, kind=str(frame.get("kind", "")), name=name))
    return tuple(views)


def _undo(file: str, applied: Any) -> np.ndarray:
    if applied is None:
        return np.eye(4)
    matrix = _matrix(f"{file}: applied_transform", applied)
    if abs(np.linalg.det(matrix[:3, :3])) < 1e-12:
        raise CameraFileError(f"{file}: applied_transform cannot be undone; a rotation and a shift would be right")
    return np.linalg.inv(matrix)


def _pose(where: str, value: Any) -> np.ndarray:
    if value is None:
        raise CameraFileError(f"{where}: no transform_matrix; a 4 x 4 pose, camera to world, would be right")
    return _matrix(f"{where}: transform_matrix", value)


def _matrix(where: str, value: Any) -> np.ndarray:
    """[4, 4] of finite numbers, from four rows of four or the first three of them."""
    try:
        matrix = np.array(value, np.float64)
    except (TypeError, ValueError):
        matrix = np.zeros(0)
    if matrix.shape not in ((3, 4), (4, 4)) or not np.isfinite(matrix).all():
        raise CameraFileError(f"{where} is no 4 x 4 matrix of finite numbers")
    return np.concatenate([matrix[:3], [[0.0, 0, 0, 1]]])


def _camera(where: str, numbers: Mapping[str, Any], T_world_gl: np.ndarray, folder: Path) -> Camera:
    scale = np.cbrt(np.linalg.det(T_world_gl[:3, :3]))
    rotation = T_world_gl[:3, :3] / (scale if scale > 0 else 1)
    if not np.allclose(rotation @ rotation.T, np.eye(3), atol=1e-3) or scale <= 0:
        raise CameraFileError(f"{where}: transform_matrix does not rotate; a rotation and a place would be right")
    if "FISHEYE" in str(numbers.get("camera_model", "")).upper() or any(numbers.get(name) for name in _DISTORTION):
        raise CameraFileError(f"{where}: the lens distorts ({', '.join(_DISTORTION)}); undistorted images would be right")
    T_world_cam = np.eye(4)
    T_world_cam[:3, :3], T_world_cam[:3, 3] = rotation, T_world_gl[:3, 3]
    width, height = _size(where, numbers, folder)
    fx = _focal(where, numbers, "x", width)
    fy = _focal(where, numbers, "y", height) if "fl_y" in numbers or "camera_angle_y" in numbers else fx
    principal = [_number(where, numbers, name, size / 2) for name, size in (("cx", width), ("cy", height))]
    return Camera(
        T_cam_world=np.linalg.inv(T_world_cam @ OPENGL_FROM_OPENCV),
        focal=np.array([fx, fy]),
        principal=np.array(principal),
        width=width,
        height=height,
    )


def _size(where: str, numbers: Mapping[str, Any], folder: Path) -> tuple[int, int]:
    """Width and height in pixels, as the file says, or else as the image has them."""
    if "w" in numbers and "h" in numbers:
        width, height = (_number(where, numbers, name, 0.0) for name in ("w", "h"))
        if min(width, height) < 1 or width % 1 or height % 1:
            raise CameraFileError(f"{where}: {width} x {height} pixels; whole numbers from 1 on would be right")
        return int(width), int(height)
    image = folder / str(numbers.get("file_path", ""))
    for file in (image, image.with_name(image.name + ".png")):
        if file.is_file():
            with Image.open(file) as opened:
                return opened.size
    raise CameraFileError(f"{where}: neither w and h nor an image {image} whose size could be taken; w and h would be right")


def _focal(where: str, numbers: Mapping[str, Any], axis: str, size: int) -> float:
    if f"fl_{axis}" in numbers:
        focal = _number(where, numbers, f"fl_{axis}", 0.0)
    else:
        angle = _number(where, numbers, f"camera_angle_{axis}", math.nan)
        focal = 0.5 * size / math.tan(0.5 * angle) if 0 < angle < math.pi else math.nan
    if not focal > 0:
        raise CameraFileError(f"{where}: no focal length; fl_{axis} above 0 pixels, or camera_angle_{axis}, would be right")
    return focal


def _number(where: str, numbers: Mapping[str, Any], name: str, default: float) -> float:
    value = numbers.get(name, default)
    if isinstance(value, bool) or not isinstance(value, int | float) or math.isinf(value):
        raise CameraFileError(f"{where}: {name} is {value!r}; a number would be right")
    return float(value)
