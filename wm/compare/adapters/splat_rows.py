"""antimatter15's .splat: 32 bytes a gaussian, position, extents and colours as they are drawn.

    float32 x y z, float32 extents, uint8 red green blue opacity, uint8 quaternion wxyz as 128 + 128 q

Source: antimatter15/splat, convert.py. Writers cut fractions off, so the middle of each step is taken.
"""

import pathlib

import numpy as np

from wm.splat.rasterizer.harmonics import SH_C0
from wm.types import Gaussians

ROW = np.dtype([("position", "<f4", 3), ("extent", "<f4", 3), ("color", "u1", 4), ("quat", "u1", 4)])


def read_splat(path: pathlib.Path) -> Gaussians:
    """Gaussians (NumPy float32 leaves) of degree 0. Raises: ValueError where the file is no whole number of rows."""
    raw = path.read_bytes()
    if len(raw) % ROW.itemsize:
        raise ValueError(f"{path}: {len(raw)} bytes are no whole number of rows of {ROW.itemsize} bytes")
    rows = np.frombuffer(raw, ROW)
    color = np.minimum((rows["color"].astype(np.float64) + 0.5) / 255, 254.5 / 255)
    quats = (rows["quat"].astype(np.float64) + 0.5 - 128) / 128
    with np.errstate(divide="ignore"):
        log_scales = np.log(rows["extent"].astype(np.float64))
    return Gaussians(
        means=rows["position"].copy(),
        quats=quats.astype(np.float32),
        log_scales=log_scales.astype(np.float32),
        opacity_logits=np.log(color[:, 3] / (1 - color[:, 3])).astype(np.float32),
        sh=((color[:, None, :3] - 0.5) / SH_C0).astype(np.float32),
    )
