"""Rotations from the axes of a file into those of the comparison, in which z points up.

Gaussians are never turned, since their harmonics would have to turn too: cameras are turned into the file's axes instead.
"""

import dataclasses
from collections.abc import Sequence

import numpy as np
from jaxtyping import Float

from wm.geometry.rays.pinhole import camera_rotation
from wm.types import Camera

UP = {
    "x": (1.0, 0.0, 0.0), "-x": (-1.0, 0.0, 0.0), "y": (0.0, 1.0, 0.0), "-y": (0.0, -1.0, 0.0),
    "z": (0.0, 0.0, 1.0), "-z": (0.0, 0.0, -1.0),
}  # fmt: skip
"""The axes of a file that may point up."""


def upright(up: Sequence[float] | Float[np.ndarray, "3"]) -> Float[np.ndarray, "3 3"]:
    """The shortest rotation that brings a direction of the file to +z.

    Source: Rodrigues' formula for the rotation between two unit vectors.
    """
    unit = np.asarray(up, np.float64) / np.linalg.norm(up)
    cosine = float(unit[2])
    if cosine < -1 + 1e-9:  # upside down: half a turn about x
        return np.diag([1.0, -1.0, -1.0])
    axis = np.cross(unit, [0.0, 0.0, 1.0])
    skew = np.array([[0, -axis[2], axis[1]], [axis[2], 0, -axis[0]], [-axis[1], axis[0], 0]])
    return np.eye(3) + skew + skew @ skew / (1 + cosine)


def mean_up(cameras: Sequence[Camera]) -> Float[np.ndarray, "3"]:
    """The mean of what cameras hold for up; z where they point every way."""
    total = -np.sum([camera_rotation(camera)[1] for camera in cameras], axis=0)
    length = float(np.linalg.norm(total))
    return total / length if length > 1e-3 * len(cameras) else np.array([0.0, 0.0, 1.0])


def moved_camera(camera: Camera, T_given_other: Float[np.ndarray, "4 4"]) -> Camera:
    """A camera as another frame sees it.

    Args:
        T_given_other: takes points of the other frame to the one in which the camera is given.
    """
    return dataclasses.replace(camera, T_cam_world=np.asarray(camera.T_cam_world, np.float64) @ T_given_other)


def rotation_matrix(rotation: Float[np.ndarray, "3 3"]) -> Float[np.ndarray, "4 4"]:
    """A rotation as a transform of points."""
    T = np.eye(4)
    T[:3, :3] = rotation
    return T
