"""The cameras that come with a scene of any program, and which way is up by them."""

import dataclasses
import pathlib

import numpy as np

from wm.compare.adapters.files import reading
from wm.compare.axes import UP, mean_up, moved_camera, rotation_matrix, upright
from wm.compare.records import Source
from wm.geometry import load_cameras
from wm.types import Camera

NAME = "transforms.json"


@dataclasses.dataclass(frozen=True, eq=False)
class OwnCameras:
    """Cameras in the world whose z points up."""

    file: pathlib.Path | None
    cameras: tuple[Camera, ...]
    R_world_file: np.ndarray  # [3, 3]


def own_cameras(source: Source, file: pathlib.Path, *, up: str = "z") -> OwnCameras:
    """The cameras of `METHOD.cameras`, or of the transforms.json beside a file.

    Args:
        up: the axis that points up where neither `METHOD.up` nor a camera says.

    Raises: CompareError.
    """
    beside = file.with_name(NAME)
    path = source.cameras or (beside if beside.is_file() else None)
    views = () if path is None else reading(source, path, "cameras in nerfstudio's transforms.json", load_cameras)
    cameras = [view.camera for view in views]
    direction = UP[source.up] if source.up else mean_up(cameras) if cameras else UP[up]
    rotation = upright(direction)
    turned = tuple(moved_camera(camera, rotation_matrix(rotation.T)) for camera in cameras)
    return OwnCameras(file=path, cameras=turned, R_world_file=rotation)
