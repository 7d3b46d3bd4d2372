"""The camera paths on which scenes are compared, by name: a kind and a number, such as `around1` or `door2`.

    around  round an object, looking at it
    close   towards an object, to where it fills the picture
    along   along the longest way that a room has
    door    through a door, or in a scene without doors the way on which most lies ahead

The number counts objects, ways and doors, the most telling first. Paths are the same whenever they are made of the same scene.
"""

import dataclasses
import json
import pathlib
import re
from collections.abc import Sequence

import numpy as np

from wm.artifacts.digests import json_text
from wm.compare.errors import CompareError
from wm.geometry import load_cameras, opengl_pose
from wm.geometry.rays.pinhole import make_camera
from wm.types import Camera

KINDS = ("around", "close", "along", "door")
DEFAULT = ("around1", "around2", "close1", "along1", "door1")
_NAME = re.compile(rf"({'|'.join(KINDS)})([1-9]\d?)")


@dataclasses.dataclass(frozen=True)
class Picture:
    """What all cameras of a comparison have in common."""

    width: int = 688
    height: int = 384
    fov: float = 60.0  # vertical, degrees
    frames: int = 60
    fps: int = 24

    def camera(self, eye: np.ndarray, target: np.ndarray) -> Camera:
        return make_camera(eye, target, width=self.width, height=self.height, fov_deg=self.fov)


@dataclasses.dataclass(frozen=True, eq=False)
class Trajectory:
    """A path of cameras through one scene."""

    name: str
    cameras: tuple[Camera, ...]


def parse_names(words: Sequence[str]) -> list[str]:
    """The names as they are used: a kind without a number is its first. Raises: CompareError for any other word."""
    names = [word if word[-1:].isdigit() else f"{word}1" for word in words]
    for word, name in zip(words, names):
        if _NAME.fullmatch(name) is None:
            raise CompareError(
                f"trajectories: {word!r} is no trajectory; one of {', '.join(KINDS)}, with a number, would be right"
            )
    if len(set(names)) != len(names):
        raise CompareError("trajectories: one is named twice; each once would be right")
    return names


def kind_of(name: str) -> tuple[str, int]:
    """The kind and the number, from 0 on, of a name that `parse_names` has returned."""
    match = _NAME.fullmatch(name)
    assert match is not None
    return match[1], int(match[2]) - 1


def path_of(name: str, picture: Picture, eyes: np.ndarray, targets: np.ndarray) -> Trajectory:
    """A trajectory from places [n, 3] and what is looked at [n, 3], spread evenly over the frames.

    Directions of view are interpolated and not targets, so that the view turns evenly.
    """
    at = np.linspace(0, len(eyes) - 1, picture.frames)
    looks = targets - eyes
    looks = looks / np.linalg.norm(looks, axis=1, keepdims=True)
    whole = np.arange(len(eyes))
    eye, look = (np.column_stack([np.interp(at, whole, x[:, axis]) for axis in range(3)]) for x in (eyes, looks))
    return Trajectory(name=name, cameras=tuple(picture.camera(a, a + b) for a, b in zip(eye, look)))


def file_text(trajectory: Trajectory, picture: Picture) -> str:
    """The cameras in nerfstudio's transforms.json, as `trajectories=FILE` reads them."""
    first = trajectory.cameras[0]
    rows = [
        {"name": f"{trajectory.name}/{k:04d}", "transform_matrix": opengl_pose(camera).round(9).tolist()}
        for k, camera in enumerate(trajectory.cameras)
    ]
    lens = {"fl_x": float(first.focal[0]), "fl_y": float(first.focal[1]), "cx": picture.width / 2, "cy": picture.height / 2}
    return json_text({"camera_model": "OPENCV", "w": picture.width, "h": picture.height, **lens, "frames": rows})


def read_file(path: pathlib.Path, picture: Picture) -> Trajectory:
    """The cameras of a transforms.json with the picture's size and lens. Raises: CompareError."""
    try:
        views = load_cameras(path)
    except (OSError, ValueError, json.JSONDecodeError) as error:
        raise CompareError(f"trajectories: {error}") from error
    if len(views) < 2:
        raise CompareError(f"trajectories: {path}: {len(views)} cameras; two or more would be a path")
    like = picture.camera(np.zeros(3), np.array([1.0, 0, 0]))
    cameras = [dataclasses.replace(like, T_cam_world=np.asarray(view.camera.T_cam_world, np.float64)) for view in views]
    return Trajectory(name=path.stem, cameras=tuple(cameras))
