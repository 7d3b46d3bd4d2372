"""Gaussians in other axes: z up, as wm and its PLY files have it, or y up, as viewers and glTF expect.

A rotation turns means and quaternions; coefficients of spherical harmonics mix within their band, so that the colour seen along a
turned direction is the one that was seen along the direction itself.
"""

import jax
import numpy as np
from jaxtyping import Float, Float32

from wm.geometry.mesh.axes import Y_UP
from wm.splat.ply.standard import unit_quats
from wm.splat.rasterizer.checks import DEGREES
from wm.splat.rasterizer.harmonics import harmonics
from wm.types import Gaussians

_DIRECTIONS = np.random.default_rng(0).normal(size=(64, 3))
_DIRECTIONS /= np.linalg.norm(_DIRECTIONS, axis=1, keepdims=True)
"""More than the 7 functions of the highest band, and not in a plane: they determine the matrix of a band."""


def to_y_up(gaussians: Gaussians) -> Gaussians:
    """Gaussians that stand z-up, with y up."""
    return turned(gaussians, Y_UP)


def to_z_up(gaussians: Gaussians) -> Gaussians:
    """Gaussians that stand y-up, with z up."""
    return turned(gaussians, Y_UP.T)


def turned(
    gaussians: Gaussians, rotation: Float[np.ndarray, "3 3"], scale: float = 1.0, shift: Float[np.ndarray, "3"] | None = None
):
    """Gaussians (NumPy float32 leaves) moved by x -> scale * rotation @ x + shift, colours with them.

    Args:
        gaussians: leaves on host or device.
        rotation: with determinant 1.
        scale: positive.
        shift: metres; none without it.
    """
    g = jax.tree.map(np.asarray, gaussians)
    means = scale * (g.means.astype(np.float64) @ rotation.T) + (0 if shift is None else shift)
    return Gaussians(
        means=means.astype(np.float32),
        quats=_turned_quats(rotation, g.quats),
        log_scales=(g.log_scales + np.log(scale)).astype(np.float32),
        opacity_logits=g.opacity_logits,
        sh=_turned_harmonics(rotation, g.sh),
    )


def _turned_quats(rotation: Float[np.ndarray, "3 3"], quats: Float[np.ndarray, "n 4"]) -> Float32[np.ndarray, "n 4"]:
    w, *v = _quaternion(rotation)
    v = np.array(v)
    unit = unit_quats(quats).astype(np.float64)
    real, imaginary = unit[:, :1], unit[:, 1:]
    product = [w * real - imaginary @ v[:, None], w * imaginary + real * v + np.cross(v, imaginary)]
    return np.concatenate(product, axis=1).astype(np.float32)


def _quaternion(rotation: Float[np.ndarray, "3 3"]) -> Float[np.ndarray, "4"]:
    """wxyz: the eigenvector of the largest eigenvalue of Bar-Itzhack's matrix (Journal of Guidance 23(6), 2000)."""
    r = rotation
    k = np.array(
        [
            [r[0, 0] + r[1, 1] + r[2, 2], r[2, 1] - r[1, 2], r[0, 2] - r[2, 0], r[1, 0] - r[0, 1]],
            [r[2, 1] - r[1, 2], r[0, 0] - r[1, 1] - r[2, 2], r[1, 0] + r[0, 1], r[0, 2] + r[2, 0]],
            [r[0, 2] - r[2, 0], r[1, 0] + r[0, 1], r[1, 1] - r[0, 0] - r[2, 2], r[2, 1] + r[1, 2]],
            [r[1, 0] - r[0, 1], r[0, 2] + r[2, 0], r[2, 1] + r[1, 2], r[2, 2] - r[0, 0] - r[1, 1]],
        ]
    )
    q = np.linalg.eigh(k)[1][:, -1]
    return q if q[np.abs(q).argmax()] > 0 else -q


def _turned_harmonics(rotation: Float[np.ndarray, "3 3"], sh: Float[np.ndarray, "n k 3"]) -> Float32[np.ndarray, "n k 3"]:
    degree = DEGREES[sh.shape[1]]
    before, after = (np.stack(harmonics(d.T, degree)[1:]) if degree else None for d in (_DIRECTIONS, _DIRECTIONS @ rotation.T))
    if before is None or after is None:
        return sh.astype(np.float32)
    bands = [sh[:, :1]]
    for band in range(1, degree + 1):
        rows = slice(band**2 - 1, (band + 1) ** 2 - 1)
        matrix = np.linalg.lstsq(after[rows].T, before[rows].T, rcond=None)[0]  # after.T @ matrix = before.T
        bands.append(np.einsum("ij,njc->nic", matrix, sh[:, band**2 : (band + 1) ** 2]))
    return np.concatenate(bands, axis=1).astype(np.float32)
