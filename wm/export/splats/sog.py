"""Target `sog`: PlayCanvas's Spatially Ordered Gaussians, the smallest: a sixth of the PLY file. y up.

Scales and colours are looked up in tables of 256 values each, made for the file, so that a value far from all others may be
off by more than the rest: 99.9 % of the gaussians must lie within the steps.
"""

import numpy as np
from jaxtyping import Int64

from wm.export.splats.comparing import Steps
from wm.export.splats.copying import SplatCopy
from wm.splat.formats import save_packed
from wm.splat.formats.compressed_ply import morton_codes
from wm.splat.rasterizer.harmonics import SH_C0
from wm.types import Gaussians

_TURN = 1.2  # degrees: 8 bits of each of three components
_BITS = 21  # of gaussforge's curve
_LARGEST_STEP = 8  # times the mean distance between values of a table


def _order(gaussians: Gaussians) -> Int64[np.ndarray, " n"]:
    """gaussforge's order. It is given gaussians that lie so, and those at one place, whose order is open, are few."""
    return np.argsort(morton_codes(gaussians.means, bits=_BITS), kind="stable")


def _steps(gaussians: Gaussians) -> Steps:
    stretched = np.log1p(np.abs(gaussians.means)) * np.sign(gaussians.means)
    step = np.ptp(stretched, axis=0) / 65535  # of sign(x) log(1 + |x|), which gaussforge cuts off and does not round
    table = _LARGEST_STEP / 256 / 2
    return Steps(
        means=1.01 * step * (1 + np.abs(gaussians.means)) + 1e-6,
        log_scales=table * float(np.ptp(gaussians.log_scales)) + 1e-6,
        color=min(1.0, table * SH_C0 * float(np.ptp(gaussians.sh[:, 0]))) + 1e-6,
        degrees=_TURN,
        share=0.999,
    )


COPY = SplatCopy("sog", "splats.sog", lambda path, gaussians: save_packed(path, gaussians, "sog"), _steps, _order)
write, check = COPY.write, COPY.check
