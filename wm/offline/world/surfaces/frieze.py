"""The band below a cornice: gear wheels in mesh, or a meander, in families that have one."""

import dataclasses

import numpy as np

from wm.offline.style.finish import Rgb
from wm.offline.style.style_sheet import mix_rgb
from wm.offline.world.materials.gears import TEETH, TOOTH, wheel
from wm.offline.world.noise import cells, edge
from wm.offline.world.surfaces.texel_sheet import F32, Chart, Interior, TexelSheet, cropped, lay, over, pasted, shaded

FRIEZES: dict[str, tuple[str, float]] = {"clockwork": ("gears", 0.24), "roman": ("meander", 0.2)}
"""Ornament and height (metres) of a family's frieze."""
BELOW = 0.3
"""Metres below a frieze that its shadow reaches at most."""
MEANDER = ("#######", "#.....#", "#.###.#", "#.#...#", "#.#####", "#......", "#######")
"""One repeat of a Greek key, seen from above: the lines are #; repeats share their left edge with the one before."""


def frieze(chart: Chart, sheet: TexelSheet, s: np.ndarray, z: np.ndarray, interior: Interior, *, top: float) -> TexelSheet:
    """The wall with its family's frieze, whose upper edge lies at the height `top`; bathrooms and low rooms have none."""
    name, tall = FRIEZES.get(interior.style.family, ("", 0.0))
    if not name or interior.kind == "bathroom" or top < 2.2:
        return sheet
    window = (slice(*np.searchsorted(z[:, 0], [top - tall - BELOW, top + 0.05])), slice(None))
    s, z = s[window], z[window]
    part = dataclasses.replace(chart, shape=s.shape)
    return pasted(sheet, window, _band(part, cropped(sheet, window), s, z, interior, name, top=top, tall=tall))


def _band(
    chart: Chart, sheet: TexelSheet, s: np.ndarray, z: np.ndarray, interior: Interior, name: str, *, top: float, tall: float
) -> TexelSheet:
    """The strip of wall about the frieze, with it."""
    middle = F32(top - tall / 2)
    inside = F32(tall / 2) - np.abs(z - middle)
    if name == "gears":
        figure = _gears(s, z - middle, tall, chart.texel)
        ground, drawn = _colors(interior, 0.55)
    else:
        figure = _meander(s, z - middle, tall, chart.texel)
        ground, drawn = _colors(interior, 0.0)
    finish = dataclasses.replace(interior.surfaces.wall, material="plaster", scale=0.8, contrast=0.5)
    below = lay(chart, dataclasses.replace(finish, colors=(ground,)), s, z, seed=interior.seed + 71)
    above = lay(chart, dataclasses.replace(finish, colors=(drawn,), roughness=0.4), s, z, seed=interior.seed + 72)
    band = over(below, above, figure, lift=0.012 if name == "gears" else 0.0)
    sheet = over(sheet, band, edge(inside, chart.texel))
    line = edge(F32(0.012) - np.abs(inside), chart.texel)
    sheet = over(sheet, above, line, lift=0.008)
    return shaded(sheet, 1 - 0.12 * np.exp(-np.maximum(-inside, 0) / 0.03) * (inside < 0))


def _colors(interior: Interior, darkened: float) -> tuple[Rgb, Rgb]:
    """Ground and figure: the wainscot's colour or the wall's, and the trim's or the accent."""
    surfaces = interior.surfaces
    base = surfaces.wainscot.colors[0] if surfaces.wainscot is not None else surfaces.wall.colors[0]
    gilt = interior.style.slot("brass").colors[0]
    return mix_rgb(base, (0.05, 0.08, 0.07), darkened), mix_rgb(gilt, (1.0, 0.95, 0.8), 0.1)


def _gears(s: np.ndarray, t: np.ndarray, tall: float, texel: float) -> np.ndarray:
    """Coverage by a row of equal wheels in mesh."""
    radius = 0.44 * tall
    pitch = (2 - TOOTH) * radius
    column, ds = cells(s, pitch)
    odd = (column % 2).astype(F32)
    here = wheel(ds, t, radius, turned=odd * F32(np.pi / TEETH), soft=texel)
    beside = wheel(np.abs(ds) - F32(pitch), t, radius, turned=(1 - odd) * F32(np.pi / TEETH), soft=texel)
    return np.maximum(here, beside)


def _meander(s: np.ndarray, t: np.ndarray, tall: float, texel: float) -> np.ndarray:
    """Coverage by a Greek key of seven by seven strokes, the last column left to the next repeat."""
    key = np.array([[stroke == "#" for stroke in row] for row in MEANDER])[::-1, :-1]
    stroke = tall / (len(MEANDER) + 2)
    rows, columns = key.shape
    shares = np.linspace(-0.375, 0.375, 4) * texel  # four samples per texel along each axis, for even edges
    cover = np.zeros(s.shape, F32)
    for a in shares:
        column = np.floor((s + F32(a)) / F32(stroke)).astype(np.int64) % columns
        for b in shares:
            row = np.floor((t + F32(b)) / F32(stroke) + F32(rows / 2)).astype(np.int64)
            cover += key[np.clip(row, 0, rows - 1), column] * ((row >= 0) & (row < rows))
    return (cover / F32(len(shares) ** 2)).astype(F32)
