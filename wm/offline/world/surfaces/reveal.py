"""Jambs, heads, thresholds and the leaf of a closed door: the faces of an opening within the wall's thickness."""

import numpy as np

from wm.offline.world.materials.wall import trim_profile
from wm.offline.world.noise import edge
from wm.offline.world.surfaces.texel_sheet import F32, Chart, Interior, TexelSheet, grid, lay, over, shaded, with_cavities

STOP = 0.022
"""Metres that the stop which a door would shut against covers on either side of the middle of a jamb."""
LEAF = 0.45
"""Metres of the smaller side from which an upright face is a door's leaf: jambs are as deep as a wall is thick at most."""
_FRAME, _RAIL, _GROOVE = (
    0.11,
    0.95,
    0.012,
)  # metres: around a leaf's panels, height of the rail between them, width of its grooves
_HANDLE = (0.08, 1.05, 0.07, 0.012)  # metres from the leaf's edge and above the floor, half its length and half its height


def reveal_sheet(chart: Chart, interior: Interior) -> TexelSheet:
    """The trim with its grain along the longer side; upright and overhead faces carry a door stop along their middle."""
    s, t = grid(chart)
    if abs(chart.normal[2]) < 0.5 and min(chart.shape) * chart.texel > LEAF:
        return _leaf(chart, interior)
    lengthwise = chart.shape[1] >= chart.shape[0]
    along, across = (s, t) if lengthwise else (t, s)
    trim = lay(chart, trim_profile(interior.surfaces.trim), along, across, seed=interior.seed + 53)
    width = min(chart.shape) * chart.texel
    if chart.normal[2] > 0.5 or width < 0.08:  # a threshold is walked over
        return with_cavities(trim, chart.texel)
    off = np.abs(across - F32(width / 2)) - F32(STOP)  # metres off the stop, negative on it
    sheet = shaded(trim, 1 - 0.25 * np.exp(-np.maximum(off, 0) / 0.015) * (off > 0))
    return with_cavities(over(sheet, trim, edge(-off, chart.texel), lift=0.012), chart.texel)


def _leaf(chart: Chart, interior: Interior) -> TexelSheet:
    """A leaf with an upper and a lower panel sunk into it, and a handle beside its edge."""
    s, t = grid(chart)
    width, height = chart.shape[1] * chart.texel, chart.shape[0] * chart.texel
    wood = lay(chart, trim_profile(interior.surfaces.trim), t, s, seed=interior.seed + 59)
    sheet = wood
    rail = min(_RAIL, height / 2)
    for low, high in ((_FRAME, rail - _FRAME / 2), (rail + _FRAME / 2, height - _FRAME)):
        inside = np.minimum(np.minimum(s - F32(_FRAME), F32(width - _FRAME) - s), np.minimum(t - F32(low), F32(high) - t))
        sheet = over(sheet, wood, edge(inside, chart.texel), lift=-0.01)
        sheet = shaded(sheet, 1 - 0.45 * np.exp(-((inside / F32(_GROOVE)) ** 2)))
    aside, above, length, thick = _HANDLE
    near = np.minimum(F32(length) - np.abs(s - F32(aside + length)), F32(thick) - np.abs(t - F32(above)))
    return with_cavities(shaded(sheet, 1 - 0.8 * edge(near, chart.texel)), chart.texel)
