"""Target `splat`: antimatter15's `.splat`, which every viewer opens. 32 bytes a gaussian, y up."""

from wm.export.splats.comparing import Steps
from wm.export.splats.copying import SplatCopy
from wm.splat.formats import save_splat

_TURN = 1.6  # degrees: steps of 1/128 in each of four components; 1 itself is stored as 127/128

COPY = SplatCopy("splat", "splats.splat", save_splat, lambda _: Steps(means=1e-9, log_scales=1e-5, degrees=_TURN))
write, check = COPY.write, COPY.check
