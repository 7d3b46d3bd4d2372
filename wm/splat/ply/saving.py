"""Gaussians and coloured points as PLY files.

Gaussians: one `vertex` element, binary little endian, float32 each: x y z, nx ny nz (zero), f_dc_0..2, f_rest_0..3(k-1)-1
channel-major (all of red's higher coefficients, then green's, then blue's), opacity (the logit), scale_0..2 (logs), rot_0..3
(wxyz). Colour is 0.5 + C0 f_dc + ..., which is our `Gaussians.sh` as it stands.

Source: Kerbl et al. 2023, reference implementation, `GaussianModel.save_ply`.
"""

from collections.abc import Mapping
from pathlib import Path

import numpy as np
from jaxtyping import Float, Int, UInt8

from wm.splat.ply.standard import bounded_logits, unit_quats
from wm.types import Gaussians


def save_ply(
    path: str | Path, gaussians: Gaussians, *, antialias: bool = False, labels: Mapping[str, Int[np.ndarray, " n"]] | None = None
) -> None:
    """Write gaussians as a PLY file; equal gaussians give equal bytes.

    Quaternions are written with unit length and opacities within bounds, which changes no render and which other programs
    rely on: some turn gaussians whose quaternions are not unit, and write infinite opacities.

    Args:
        path: where; an existing file is overwritten.
        gaussians: leaves on host or device, written as float32.
        antialias: whether they were trained with `RasterSettings.antialias`; the file then says so by the comment
            `SplatRenderMode: mip`, which Brush, gsplat and splat-transform read.
        labels: whole numbers of each gaussian by name, written after the others as int32 properties. Readers of gaussians
            leave them out.
    """
    sh = np.asarray(gaussians.sh, np.float32)
    n, k = sh.shape[:2]
    rest = np.swapaxes(sh[:, 1:], 1, 2).reshape(n, 3 * (k - 1))
    columns = [
        np.asarray(gaussians.means), np.zeros((n, 3)), sh[:, 0], rest,
        bounded_logits(np.asarray(gaussians.opacity_logits))[:, None], np.asarray(gaussians.log_scales),
        unit_quats(np.asarray(gaussians.quats)),
    ]  # fmt: skip
    table = np.concatenate([column.astype("<f4") for column in columns], axis=1)
    comments = ["comment SplatRenderMode: mip"] if antialias else []
    fields = [f"float {name}" for name in _field_names(k)]
    if labels:
        table = np.concatenate([table.view("<i4"), np.stack([*labels.values()], axis=1).astype("<i4")], axis=1)
        fields += [f"int {name}" for name in labels]
    Path(path).write_bytes(_header(n, comments, fields) + table.tobytes())


def save_point_cloud(path: str | Path, points: Float[np.ndarray, "n 3"], colors: UInt8[np.ndarray, "n 3"]) -> None:
    """Write points with colours as a PLY file (x y z red green blue), as trainers of gaussians start from; equal points give
    equal bytes.

    Args:
        path: where; an existing file is overwritten.
        points: metres, world; written as float32.
        colors: sRGB, 8 bits.
    """
    fields = [f"float {name}" for name in ("x", "y", "z")] + [f"uchar {name}" for name in ("red", "green", "blue")]
    table = np.zeros(len(points), [("position", "<f4", 3), ("color", "u1", 3)])
    table["position"], table["color"] = points, colors
    Path(path).write_bytes(_header(len(points), [], fields) + table.tobytes())


def _header(count: int, comments: list[str], fields: list[str]) -> bytes:
    lines = ["ply", "format binary_little_endian 1.0", *comments, f"element vertex {count}"]
    return "\n".join([*lines, *(f"property {field}" for field in fields), "end_header\n"]).encode("ascii")


def _field_names(k: int) -> list[str]:
    """The properties of one gaussian with k SH coefficients, in the order in which they are written."""
    names = ["x", "y", "z", "nx", "ny", "nz", "f_dc_0", "f_dc_1", "f_dc_2"]
    names += [f"f_rest_{i}" for i in range(3 * (k - 1))]
    return [*names, "opacity", *(f"scale_{i}" for i in range(3)), *(f"rot_{i}" for i in range(4))]
