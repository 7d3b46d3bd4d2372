"""Target `compressed_ply`: PlayCanvas's compressed PLY, a quarter of the PLY file. y up, in the order of a Morton curve."""

import numpy as np

from wm.export.splats.comparing import Steps
from wm.export.splats.copying import SplatCopy
from wm.splat.formats import save_compressed_ply
from wm.splat.formats.compressed_ply import chunk_extents, morton_order
from wm.splat.rasterizer.harmonics import SH_C0
from wm.types import Gaussians

_BITS = np.array([2047, 1023, 2047])
_TURN = 0.28  # degrees: 10 bits of each of three components, and what follows for the fourth


def _steps(gaussians: Gaussians) -> Steps:
    colors = 0.5 + SH_C0 * gaussians.sh[:, 0]
    return Steps(
        means=0.51 * chunk_extents(gaussians.means) / _BITS + 1e-6,
        log_scales=0.51 * chunk_extents(gaussians.log_scales) / _BITS + 1e-5,
        color=0.51 / 255 * max(1.0, float(np.ptp(colors))) + 1e-6,
        degrees=_TURN,
    )


COPY = SplatCopy(
    "compressed_ply", "splats.compressed.ply", save_compressed_ply, _steps, lambda gaussians: morton_order(gaussians.means)
)
write, check = COPY.write, COPY.check
