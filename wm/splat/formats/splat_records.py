"""antimatter15's `.splat`: 32 bytes a gaussian, colours of one direction only, no header.

    3 float32  the mean
    3 float32  the scales, not their logarithms
    4 uint8    red, green, blue, opacity
    4 uint8    the quaternion wxyz, 128 + 128 q

Written here since libraries cut numbers off where they should round them. Colours beyond 0..1 and the higher bands are lost.
Source: antimatter15/splat (MIT), `convert.py` and `main.js`.
"""

from pathlib import Path

import numpy as np

from wm.splat.formats.errors import SplatFileError
from wm.splat.ply.standard import packable
from wm.splat.rasterizer.harmonics import SH_C0
from wm.types import Gaussians

RECORD = np.dtype([("mean", "<f4", 3), ("scale", "<f4", 3), ("rgba", "u1", 4), ("quat", "u1", 4)])


def save_splat(path: str | Path, gaussians: Gaussians) -> None:
    """Write gaussians as a `.splat` file, in their order and axes."""
    g = packable(gaussians)
    rows = np.zeros(len(g.means), RECORD)
    colors = 0.5 + SH_C0 * g.sh[:, 0]
    opacity = 1 / (1 + np.exp(-g.opacity_logits))
    rows["mean"], rows["scale"] = g.means, np.exp(g.log_scales)
    rows["rgba"] = np.round(np.clip(np.c_[colors, opacity], 0, 1) * 255)
    rows["quat"] = np.clip(np.round(128 + 128 * g.quats), 0, 255)
    Path(path).write_bytes(rows.tobytes())


def read_splat(file: str, raw: bytes) -> Gaussians:
    """The gaussians (NumPy float32 leaves) of the bytes of a `.splat` file.

    Raises:
        SplatFileError: the bytes are no whole number of records, or hold numbers that no file has.
    """
    if not raw or len(raw) % RECORD.itemsize:
        raise SplatFileError(
            f"{file}: {len(raw)} bytes; a multiple of {RECORD.itemsize} would be right for .splat (is it truncated?)"
        )
    rows = np.frombuffer(raw, RECORD)
    if not (np.isfinite(rows["mean"]).all() and (rows["scale"] >= 0).all()):
        raise SplatFileError(
            f"{file}: means that are not finite, or negative scales; a .splat file has none (is it another format?)"
        )
    rgba = rows["rgba"] / 255
    opacity = np.clip(rgba[:, 3], 0.5 / 255, 254.5 / 255)  # 0 and 255 have infinite logarithms
    with np.errstate(divide="ignore"):
        log_scales = np.log(rows["scale"])  # zero is a disc
    quats = (rows["quat"].astype(np.float32) - 128) / 128
    return Gaussians(
        means=rows["mean"].copy(),
        quats=np.where((quats == 0).all(axis=1, keepdims=True), np.array([1, 0, 0, 0], np.float32), quats),
        log_scales=log_scales,
        opacity_logits=np.log(opacity / (1 - opacity)).astype(np.float32),
        sh=((rgba[:, None, :3] - 0.5) / SH_C0).astype(np.float32),
    )
