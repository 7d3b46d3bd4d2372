"""Target `spz`: Niantic's packed splats, version 3, about a fifth of the PLY file. y up, as SPZ defines it."""

from wm.export.splats.comparing import Steps
from wm.export.splats.copying import SplatCopy
from wm.splat.formats import save_packed
from wm.splat.rasterizer.harmonics import SH_C0

_MEANS = 0.51 / 4096  # metres: 12 bits of fraction
_SCALES = 0.51 / 16  # of the logarithm
_COLOR = 0.51 / 255 / 0.15 * SH_C0  # 8 bits over coefficients from -3.3 to 3.3
_TURN = 0.28  # degrees: 10 bits of each of three components, and what follows for the fourth

COPY = SplatCopy(
    "spz",
    "splats.spz",
    lambda path, gaussians: save_packed(path, gaussians, "spz"),
    lambda _: Steps(means=_MEANS, log_scales=_SCALES, color=_COLOR, degrees=_TURN),
)
write, check = COPY.write, COPY.check
