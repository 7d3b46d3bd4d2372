"""Rotations as the formats write them."""

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import Rotation


def quaternion(R: Float[np.ndarray, "3 3"]) -> Float[np.ndarray, "4"]:
    """wxyz of a rotation, w not negative."""
    return Rotation.from_matrix(R).as_quat(canonical=True, scalar_first=True)


def roll_pitch_yaw(R: Float[np.ndarray, "3 3"]) -> Float[np.ndarray, "3"]:
    """Radians about the fixed axes x, y and z, in that order: URDF's `rpy`."""
    return Rotation.from_matrix(R).as_euler("xyz")
