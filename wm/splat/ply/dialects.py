"""Which columns of a PLY file make gaussians, as different programs name them.

INRIA            x y z, f_dc_*, f_rest_*, opacity, scale_0..2, rot_0..3
2DGS             the same without scale_2: discs, whose third axis has the length 0
red, green, blue in place of f_dc_*: whole numbers of 8 or 16 bits, or numbers from 0 to 1
point cloud      x y z red green blue alone: a round gaussian at every point, as trainers start from one
"""

import numpy as np
from jaxtyping import Float, Float32
from scipy.spatial import KDTree

from wm.splat.ply.errors import PlyError
from wm.splat.rasterizer.checks import DEGREES
from wm.splat.rasterizer.harmonics import SH_C0
from wm.types import Gaussians

Columns = dict[str, np.ndarray]

DC = ("f_dc_0", "f_dc_1", "f_dc_2")
_RGB = ("red", "green", "blue")
_ROTATION = tuple(f"rot_{i}" for i in range(4))
_POINT_OPACITY = 0.1  # of a point of a cloud (Kerbl et al. 2023, reference implementation, `create_from_pcd`)
_NEAREST = 3  # neighbours whose mean squared distance is the size of a point, squared (ibid.)


def to_gaussians(file: str, columns: Columns) -> Gaussians:
    """Gaussians (NumPy float32 leaves) from named columns of equal length.

    Raises:
        PlyError: a column is missing, or the number of f_rest_* is that of no degree that can be rendered.
    """
    means = _stack(file, columns, ("x", "y", "z"))
    sh = _harmonics(file, columns)
    if not any(name in columns for name in ("opacity", "scale_0", *_ROTATION)) and _RGB[0] in columns:
        return _of_points(means, sh)
    scales = ("scale_0", "scale_1") if _is_flat(columns) else ("scale_0", "scale_1", "scale_2")
    log_scales = _stack(file, columns, scales)
    if len(scales) == 2:
        log_scales = np.concatenate([log_scales, np.full((len(means), 1), -np.inf, np.float32)], axis=1)
    return Gaussians(
        means=means,
        quats=_stack(file, columns, _ROTATION),
        log_scales=log_scales,
        opacity_logits=_stack(file, columns, ("opacity",))[:, 0],
        sh=sh,
    )


def _is_flat(columns: Columns) -> bool:
    """Whether these are the discs of 2DGS: two scales, and all else that a gaussian has."""
    return "scale_2" not in columns and all(name in columns for name in ("scale_0", "scale_1", "opacity", *_ROTATION))


def _harmonics(file: str, columns: Columns) -> Float32[np.ndarray, "n k 3"]:
    rest = sum(name.startswith("f_rest_") for name in columns)
    k = 1 + rest // 3
    if rest % 3 or k not in DEGREES:
        right = ", ".join(str(3 * (count - 1)) for count in DEGREES)
        raise PlyError(f"{file}: {rest} f_rest_* properties; one of {right} (degree 0 to 3) would be right")
    if DC[0] not in columns and _RGB[0] in columns:
        colors = np.stack([_unit(column) for column in _columns(file, columns, _RGB)], axis=-1)
        dc = ((colors - 0.5) / SH_C0).astype(np.float32)
    else:
        dc = _stack(file, columns, DC)
    # all of red's higher coefficients first, then green's, then blue's
    higher = _stack(file, columns, tuple(f"f_rest_{i}" for i in range(rest))) if rest else np.zeros((len(dc), 0), np.float32)
    return np.concatenate([dc[:, None], np.swapaxes(higher.reshape(len(dc), 3, k - 1), 1, 2)], axis=1)


def _unit(column: np.ndarray) -> Float[np.ndarray, " n"]:
    """Colours from 0 to 1 of whole numbers, whose largest is 1, or of numbers as they are."""
    scale = np.iinfo(column.dtype).max if np.issubdtype(column.dtype, np.integer) else 1
    return column.astype(np.float64) / scale


def _of_points(means: Float32[np.ndarray, "n 3"], sh: Float32[np.ndarray, "n k 3"]) -> Gaussians:
    """Round gaussians as large as points are apart."""
    n = len(means)
    size = np.zeros(n)
    if n > 1:
        distance = KDTree(means).query(means, k=min(n, _NEAREST + 1))[0][:, 1:]  # without the point itself
        size = (distance**2).mean(axis=1)
    log_scales = 0.5 * np.log(np.maximum(size, 1e-7))
    return Gaussians(
        means=means,
        quats=np.tile(np.array([1, 0, 0, 0], np.float32), (n, 1)),
        log_scales=np.repeat(log_scales[:, None], 3, axis=1).astype(np.float32),
        opacity_logits=np.full(n, np.log(_POINT_OPACITY / (1 - _POINT_OPACITY)), np.float32),
        sh=sh,
    )


def _stack(file: str, columns: Columns, names: tuple[str, ...]) -> Float32[np.ndarray, "n c"]:
    with np.errstate(over="ignore"):  # a double beyond float32 is infinite, which the rasterizer leaves out
        return np.stack([column.astype(np.float32) for column in _columns(file, columns, names)], axis=-1)


def _columns(file: str, columns: Columns, names: tuple[str, ...]) -> list[np.ndarray]:
    missing = [name for name in names if name not in columns]
    if missing:
        raise PlyError(f"{file}: element vertex has no property {', '.join(missing)}: not a file of gaussians")
    return [columns[name] for name in names]
