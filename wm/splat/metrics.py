"""Errors of renders against the truth and the scaffold, as pure functions of arrays on the host (the definitions are ours).

    psnr                      of an image against the image that should be there
    depth_error               M-MAE, M-RMSE: splat depth against the scaffold's, metres
    normal_error              N-Cos, N-Ang: normals of the splat depth against the scaffold's
    normals_from_depth        world normals from central differences of a depth; one_surface: where they are comparable

Every mean is over the pixels of a mask; over no pixel it is NaN, never 0. SSIM is in similarity.py, consistency between views in
reprojection.py.
"""

import dataclasses

import numpy as np
from jaxtyping import Bool, Float, Int, Num

from wm.geometry.rays.pinhole import camera_rays, unproject_depth
from wm.splat.image_checks import check_floats, check_images, check_range, check_shapes
from wm.types import Camera


@dataclasses.dataclass(frozen=True)
class DepthError:
    """Splat depth against scaffold depth.

    Attributes:
        mae: metres
        rmse: metres
    """

    mae: float
    rmse: float


@dataclasses.dataclass(frozen=True)
class NormalError:
    """Splat normals against scaffold normals.

    Attributes:
        cosine: mean cosine of the angle between them
        angle: mean angle, degrees
    """

    cosine: float
    angle: float


def psnr(image: Num[np.ndarray, "..."], truth: Num[np.ndarray, "..."], mask: Bool[np.ndarray, "h w"] | None = None) -> float:
    """Peak signal-to-noise ratio in dB of an image (clipped to [0, 1]) against the truth over the mask; inf for equal ones.

    Args:
        image: [h, w, c] floats from 0 to 1; a render may overshoot.
        truth: [h, w, c] floats from 0 to 1.
        mask: the pixels that count; None for all.

    Raises:
        TypeError: an image is no array of floats.
        ValueError: shapes differ, or values lie outside the range.

    scikit-image's `peak_signal_noise_ratio` gives the same number (tests/splat/test_metrics_peer.py); it is not called because
    the package would then depend on scikit-image for one line, and because it warns for equal images and for an empty mask.
    """
    check_images(image=image, truth=truth)
    check_range("truth", truth if mask is None else truth[mask], 1.0)
    squared = (np.clip(image, 0, 1).astype(np.float64) - truth) ** 2
    error = _mean(squared if mask is None else squared[mask])
    return float(-10 * np.log10(error)) if error != 0 else float("inf")


def depth_error(
    depth: Num[np.ndarray, "..."], scaffold: Num[np.ndarray, "..."], mask: Bool[np.ndarray, "h w"] | None = None
) -> DepthError:
    """M-MAE and M-RMSE in metres where the scaffold is hit (its depth is above 0) and the mask holds.

    A pixel that no gaussian covers (depth 0) counts with its whole distance.

    Raises:
        TypeError: a depth is no array of floats, which metres are.
        ValueError: the shapes differ.
    """
    for name, x in (("depth", depth), ("scaffold", scaffold)):
        check_floats(name, x, "depth in metres, as floats (16 bits of millimetres: depth * 1e-3)")
    check_shapes(depth=depth, scaffold=scaffold)
    where = scaffold > 0 if mask is None else (scaffold > 0) & mask
    difference = (depth.astype(np.float64) - scaffold)[where]
    return DepthError(mae=_mean(np.abs(difference)), rmse=float(np.sqrt(_mean(difference**2))))


def normals_from_depth(depth: Num[np.ndarray, "h w"], camera: Camera) -> Float[np.ndarray, "h w 3"]:
    """World normals facing the camera, from central differences of the depth; 0 on the image's border and where they vanish.

    Raises:
        TypeError: the depth is no array of floats, which metres are.
    """
    check_floats("depth", depth, "depth in metres, as floats (16 bits of millimetres: depth * 1e-3)")
    points = unproject_depth(camera, depth)
    normal = np.zeros_like(points)
    across = points[1:-1, 2:] - points[1:-1, :-2]
    down = points[2:, 1:-1] - points[:-2, 1:-1]
    normal[1:-1, 1:-1] = np.cross(down, across)
    length = np.linalg.norm(normal, axis=-1, keepdims=True)
    return normal / np.where(length > 0, length, 1)


def one_surface(
    face_group: Int[np.ndarray, "h w"], normal: Float[np.ndarray, "h w 3"], *, max_bend: float = 20.0
) -> Bool[np.ndarray, "h w"]:
    """Pixels whose 3x3 neighbourhood is one surface, so that a central difference means its normal.

    Args:
        face_group: what a pixel shows (an object, a surface kind and room, a chart ...); negative: nothing.
        normal: the scaffold's normals.
        max_bend: degrees that the normals of the neighbourhood may differ from the centre's: an object is one group, and its
            edges are not one surface.
    """
    h, w = face_group.shape
    same = np.zeros((h, w), bool)
    if h < 3 or w < 3:
        return same
    centre = (slice(1, h - 1), slice(1, w - 1))
    smooth = face_group[centre] >= 0
    for i in range(3):
        for j in range(3):
            near = (slice(i, h - 2 + i), slice(j, w - 2 + j))
            cosine = (normal[near] * normal[centre]).sum(-1)
            smooth = smooth & (face_group[near] == face_group[centre]) & (cosine >= np.cos(np.radians(max_bend)))
    same[centre] = smooth
    return same


def normal_error(
    depth: Float[np.ndarray, "h w"], camera: Camera, scaffold: Float[np.ndarray, "h w 3"], mask: Bool[np.ndarray, "h w"]
) -> NormalError:
    """N-Cos and N-Ang of the normals of a depth map against the scaffold's, over the mask (`one_surface`).

    Scaffold normals are turned to face the camera. Where the depth has no normal the cosine is 0 and the angle 90 degrees.
    """
    rays = camera_rays(camera).reshape(scaffold.shape)
    away = (scaffold * rays).sum(-1) > 0
    inner = mask.copy()
    inner[[0, -1], :], inner[:, [0, -1]] = False, False
    cosine = (normals_from_depth(depth, camera) * scaffold).sum(-1) * np.where(away, -1.0, 1.0)
    cosine = np.clip(cosine[inner], -1, 1)
    return NormalError(cosine=_mean(cosine), angle=_mean(np.degrees(np.arccos(cosine))))


def _mean(values: np.ndarray) -> float:
    return float(np.mean(values, dtype=np.float64)) if values.size else float("nan")
