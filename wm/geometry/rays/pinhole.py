"""Pinhole cameras on the host: where they stand, and which ray belongs to which pixel.

Frames: p_cam = T_cam_world @ p_world with OpenCV axes (x right, y down, z forward), so the rows of the rotation are the
camera's right, down and forward axes in the world. Pixel (i, j) has its centre at (i + 0.5, j + 0.5):
    (u, v) = focal * p_cam[:2] / p_cam[2] + principal,        p_cam = depth * (((u, v) - principal) / focal, 1).
Everything is float64.
"""

import dataclasses

import numpy as np
from jaxtyping import Float

from wm.types import Camera

_PARALLEL = 1e-6  # sine of the angle to the vertical below which no "up" is defined


def make_camera(
    eye: Float[np.ndarray, "3"], target: Float[np.ndarray, "3"], *, width: int, height: int, fov_deg: float
) -> Camera:
    """A level camera at `eye` that looks at `target`, with its principal point in the image's middle.

    Args:
        eye, target: world points, metres; they must differ.
        width, height: image size, pixels.
        fov_deg: vertical field of view, degrees, in (0, 180).

    Looking straight up or down, where no image is level, the world's x axis points right.
    Raises: ValueError for a size below one pixel, a field of view out of range, or an eye that is its own target.
    """
    if width < 1 or height < 1:
        raise ValueError(f"a camera image needs at least one pixel, not width {width}, height {height}")
    if not 0.0 < fov_deg < 180.0:
        raise ValueError(f"the vertical field of view must lie between 0 and 180 degrees, not {fov_deg}")
    eye = np.asarray(eye, np.float64)
    forward = np.asarray(target, np.float64) - eye
    distance = np.linalg.norm(forward)
    if not np.isfinite(distance) or distance == 0.0:
        raise ValueError(f"a camera needs finite, different eye and target, not eye {eye}, target {target}")
    rotation = look_rotations(forward[None])[0]
    T_cam_world = np.eye(4)
    T_cam_world[:3, :3] = rotation
    T_cam_world[:3, 3] = -rotation @ eye
    focal = height / (2.0 * np.tan(np.radians(fov_deg) / 2.0))
    principal = np.array([width / 2.0, height / 2.0])
    return Camera(T_cam_world=T_cam_world, focal=np.array([focal, focal]), principal=principal, width=width, height=height)


def look_rotations(looks: Float[np.ndarray, "n 3"]) -> Float[np.ndarray, "n 3 3"]:
    """World-to-camera rotations of level cameras that look along the given directions (not 0, need not be unit)."""
    forward = looks / np.linalg.norm(looks, axis=1, keepdims=True)
    right = np.stack([forward[:, 1], -forward[:, 0], np.zeros(len(looks))], axis=1)  # forward x up
    sine = np.linalg.norm(right, axis=1, keepdims=True)
    vertical = sine <= _PARALLEL
    right = np.where(vertical, [[1.0, 0.0, 0.0]], right / np.where(vertical, 1.0, sine))
    right = right - forward * np.sum(right * forward, axis=1, keepdims=True)
    right = right / np.linalg.norm(right, axis=1, keepdims=True)
    return np.stack([right, np.cross(forward, right), forward], axis=1)


def camera_rotation(camera: Camera) -> Float[np.ndarray, "3 3"]:
    """Rotation from world to camera: its rows are right, down and forward in the world."""
    return np.asarray(camera.T_cam_world, np.float64)[:3, :3]


def camera_center(camera: Camera) -> Float[np.ndarray, "3"]:
    """Where the camera stands in the world, metres."""
    T_cam_world = np.asarray(camera.T_cam_world, np.float64)
    return -T_cam_world[:3, :3].T @ T_cam_world[:3, 3]


def camera_quat(camera: Camera) -> Float[np.ndarray, "4"]:
    """Unit quaternion (wxyz, w >= 0) of the camera-to-world rotation: the orientation of the camera.

    Source: Shepperd, "Quaternion from rotation matrix", 1978: the largest component first, so no division is by a small number.
    """
    r = camera_rotation(camera).T
    trace = np.trace(r)
    squared = 1.0 + np.array([trace, *(2.0 * np.diagonal(r) - trace)])  # 4 w^2, 4 x^2, 4 y^2, 4 z^2
    wx, wy, wz = r[2, 1] - r[1, 2], r[0, 2] - r[2, 0], r[1, 0] - r[0, 1]
    xy, xz, yz = r[1, 0] + r[0, 1], r[0, 2] + r[2, 0], r[2, 1] + r[1, 2]
    rows = np.array([[0, wx, wy, wz], [wx, 0, xy, xz], [wy, xy, 0, yz], [wz, xz, yz, 0]]) + np.diag(squared)
    quat = rows[np.argmax(squared)]
    quat = quat / np.linalg.norm(quat)
    return -quat if quat[0] < 0 else quat


def ray_basis(camera: Camera) -> tuple[Float[np.ndarray, "w 3"], Float[np.ndarray, "h 3"]]:
    """World vectors (columns, rows) whose sums `columns[i] + rows[j]` are the pixels' rays, with d . forward = 1.

    A pinhole's rays are separable in i and j, so h + w vectors give all h w rays: a caller adds those it needs.
    """
    right, down, forward = camera_rotation(camera)
    focal, principal = np.asarray(camera.focal, np.float64), np.asarray(camera.principal, np.float64)
    x = (np.arange(camera.width) + 0.5 - principal[0]) / focal[0]
    y = (np.arange(camera.height) + 0.5 - principal[1]) / focal[1]
    return x[:, None] * right, y[:, None] * down + forward


def camera_rays(camera: Camera) -> Float[np.ndarray, "pixels 3"]:
    """Directions through the pixel centres in the world, row-major, with d . forward = 1: centre + t d has z-depth t."""
    return basis_rays(*ray_basis(camera))


def basis_rays(columns: Float[np.ndarray, "w 3"], rows: Float[np.ndarray, "h 3"]) -> Float[np.ndarray, "pixels 3"]:
    """The sums of every row's and every column's part, row-major. Axis by axis: an inner loop over 3 numbers is slow."""
    out = np.empty((len(rows), len(columns), 3), columns.dtype)
    for axis in range(3):
        np.add(rows[:, None, axis], columns[:, axis], out=out[..., axis])
    return out.reshape(-1, 3)


def project_points(camera: Camera, points: Float[np.ndarray, "n 3"]) -> tuple[Float[np.ndarray, "n 2"], Float[np.ndarray, "n"]]:
    """Pixel positions and z-depths of world points; where the depth is not positive the position is NaN."""
    T_cam_world = np.asarray(camera.T_cam_world, np.float64)
    p_cam = np.asarray(points, np.float64) @ T_cam_world[:3, :3].T + T_cam_world[:3, 3]
    depth = p_cam[:, 2]
    safe = np.where(depth > 0, depth, np.nan)
    return p_cam[:, :2] / safe[:, None] * np.asarray(camera.focal, np.float64) + np.asarray(camera.principal, np.float64), depth


def unproject_depth(camera: Camera, depth: Float[np.ndarray, "h w"]) -> Float[np.ndarray, "h w 3"]:
    """World points at the given z-depths along the rays of the pixel centres (where the depth is 0: the camera's centre)."""
    if depth.shape != (camera.height, camera.width):
        raise ValueError(f"depth of shape {depth.shape} does not fit a camera of {camera.height} x {camera.width} pixels")
    rays = camera_rays(camera).reshape(camera.height, camera.width, 3)
    return camera_center(camera) + np.asarray(depth, np.float64)[..., None] * rays


def scale_camera(camera: Camera, factor: float) -> Camera:
    """The same view at `factor` times the resolution (sizes rounded to whole pixels, at least one; the field of view is kept).

    With rounding the two axes scale by their own ratio, so that the image still shows exactly what it showed.
    """
    if not (np.isfinite(factor) and factor > 0):
        raise ValueError(f"a camera scales by a positive factor, not {factor}")
    width, height = max(1, round(camera.width * factor)), max(1, round(camera.height * factor))
    ratio = np.array([width / camera.width, height / camera.height])
    focal, principal = np.asarray(camera.focal, np.float64) * ratio, np.asarray(camera.principal, np.float64) * ratio
    return dataclasses.replace(camera, focal=focal, principal=principal, width=width, height=height)
