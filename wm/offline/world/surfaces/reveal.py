"""Jambs, heads and thresholds: the faces of an opening within the wall's thickness."""

import numpy as np

from wm.offline.world.materials.wall import trim_profile
from wm.offline.world.noise import edge
from wm.offline.world.surfaces.texel_sheet import F32, Chart, Interior, TexelSheet, grid, lay, over, shaded, with_cavities

STOP = 0.022
"""Metres that the stop which a door would shut against covers on either side of the middle of a jamb."""


def reveal_sheet(chart: Chart, interior: Interior) -> TexelSheet:
    """The trim with its grain along the longer side; upright and overhead faces carry a door stop along their middle."""
    s, t = grid(chart)
    lengthwise = chart.shape[1] >= chart.shape[0]
    along, across = (s, t) if lengthwise else (t, s)
    trim = lay(chart, trim_profile(interior.surfaces.trim), along, across, seed=interior.seed + 53)
    width = min(chart.shape) * chart.texel
    if chart.normal[2] > 0.5 or width < 0.08:  # a threshold is walked over
        return with_cavities(trim, chart.texel)
    off = np.abs(across - F32(width / 2)) - F32(STOP)  # metres off the stop, negative on it
    sheet = shaded(trim, 1 - 0.25 * np.exp(-np.maximum(off, 0) / 0.015) * (off > 0))
    return with_cavities(over(sheet, trim, edge(-off, chart.texel), lift=0.012), chart.texel)
