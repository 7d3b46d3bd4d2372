"""Axes of other programs' files: y up for z up, and cameras of OpenGL for those of OpenCV.

Ours are right-handed with z up, and cameras look along +z with y down. glTF has y up; its cameras and nerfstudio's look along -z
with y up.
"""

import numpy as np
from jaxtyping import Float

from wm.types import Camera

Y_UP = np.array([[1.0, 0, 0], [0, 0, 1], [0, -1, 0]])
"""From z up to y up: (x, y, z) becomes (x, z, -y). Its transpose leads back."""

OPENGL_FROM_OPENCV = np.diag([1.0, -1.0, -1.0, 1.0])
"""Turns a camera's axes half about x; its own inverse."""


def opengl_pose(camera: Camera) -> Float[np.ndarray, "4 4"]:
    """The pose of a camera as transforms.json has it: camera to world, with OpenGL's axes."""
    return np.linalg.inv(np.asarray(camera.T_cam_world, np.float64)) @ OPENGL_FROM_OPENCV
