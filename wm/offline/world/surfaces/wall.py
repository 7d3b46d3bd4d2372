"""Walls: the finish above, wainscot below, skirting, cornice, and casings around the openings."""

import dataclasses

import numpy as np

from wm.geometry.plan.site import WallOpening
from wm.offline.style.finish import Finish
from wm.offline.world.materials import flat_points
from wm.offline.world.materials.wall import trim_profile
from wm.offline.world.materials.wood import NARROW, framed_panel
from wm.offline.world.noise import cells, edge
from wm.offline.world.surfaces.frieze import frieze
from wm.offline.world.surfaces.texel_sheet import (
    F32,
    Chart,
    Interior,
    TexelSheet,
    as_sheet,
    cropped,
    grid,
    lay,
    over,
    pasted,
    shaded,
    with_cavities,
)

CASED = 0.14  # metres beside an opening that its casing covers at most
BESIDE = 0.5  # metres beside an opening that its casing and the shadow of that reach at most
STILE = 0.085  # metres: frame between two panels of a wainscot


def wall_sheet(chart: Chart, openings: tuple[WallOpening, ...], interior: Interior) -> TexelSheet:
    """One wall of a room; `openings` are its openings in the chart's own metres."""
    s, t = grid(chart)
    z = t + F32(chart.origin[2])
    seed = interior.seed
    surfaces, ornament = interior.surfaces, interior.style.form.ornament
    sheet = lay(chart, surfaces.wall, s, z, seed=seed)
    if surfaces.wall.material == "painted_wood":
        sheet = _shiplap(sheet, z)
    trim = lay(chart, trim_profile(surfaces.trim), s, z, seed=seed + 50)
    skirting = 0.10 + 0.09 * ornament
    if surfaces.wainscot is not None and surfaces.wainscot_height > 0:
        sheet = _wainscot(chart, sheet, trim, s, z, openings, interior, surfaces.wainscot, skirting)
    sheet = _band(sheet, trim, skirting - z, depth=0.018, nosing=0.035, texel=chart.texel)
    sheet = frieze(chart, sheet, s, z, interior, top=interior.height - cornice_depth(ornament) - 0.02)
    sheet = _cornice(chart, sheet, trim, z, interior)
    for opening in openings:
        window = (slice(None), slice(*np.searchsorted(s[0], [opening.low - BESIDE, opening.high + BESIDE])))
        part = _casing(chart, cropped(sheet, window), cropped(trim, window), s[window], z[window], opening, interior)
        sheet = pasted(sheet, window, part)
    return with_cavities(sheet, chart.texel)


def opening_distance(s: np.ndarray, z: np.ndarray, opening: WallOpening) -> np.ndarray:
    """Metres outside the opening's rectangle, the floor counting as open below a door; negative inside."""
    across = np.abs(s - F32((opening.low + opening.high) / 2)) - F32((opening.high - opening.low) / 2)
    above = z - F32(opening.head)
    below = F32(opening.sill) - z if opening.sill > 0.05 else np.full_like(z, -np.inf)
    return np.maximum(across, np.maximum(above, below))


def _shiplap(sheet: TexelSheet, z: np.ndarray) -> TexelSheet:
    """Painted boards laid level, a groove every 18 cm."""
    _, offset = cells(z, 0.18)
    groove = np.clip(F32(1) - (F32(0.09) - np.abs(offset)) / F32(0.012), 0, 1)
    return shaded(dataclasses.replace(sheet, height=(sheet.height - F32(0.006) * groove).astype(F32)), 1 - 0.2 * groove)


def _wainscot(
    chart: Chart, sheet: TexelSheet, trim: TexelSheet, s: np.ndarray, z: np.ndarray, openings: tuple[WallOpening, ...],
    interior: Interior, finish: Finish, skirting: float,
) -> TexelSheet:  # fmt: skip
    """The lower wall: panels that divide each stretch between doors evenly, closed by a rail."""
    top = min(interior.surfaces.wainscot_height, 0.6 * interior.height)
    if finish.material == "panelling" and finish.scale >= NARROW:
        length = chart.shape[1] * chart.texel
        column, across, width = _stretches(s, openings, length, top, finish.scale)
        low, high = skirting + STILE, top - STILE - 0.03
        inset = np.minimum(width / 2 - STILE / 2 - np.abs(across), (high - low) / 2 - np.abs(z - (low + high) / 2))
        points = flat_points(s.ravel(), z.ravel(), footprint=chart.texel)
        layer = as_sheet(framed_panel(points, finish, interior.seed + 20, inset.ravel(), column.ravel()), chart.shape)
    else:
        layer = lay(chart, finish, s, z, seed=interior.seed + 20)
    sheet = over(sheet, layer, edge(F32(top) - z, chart.texel), lift=0.012)
    sheet = _band(sheet, trim, F32(0.035) - np.abs(z - F32(top)), depth=0.028, nosing=0.03, texel=chart.texel)
    return shaded(sheet, 1 - 0.16 * np.exp(-np.maximum(z - F32(top + 0.035), 0) / 0.04) * (z > top + 0.035))


def _stretches(
    s: np.ndarray, openings: tuple[WallOpening, ...], length: float, top: float, width: float
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Panel number, metres from its middle and its width, for panels of about `width` between the openings below `top`."""
    cuts = sorted((opening.low - CASED, opening.high + CASED) for opening in openings if opening.sill < top)
    edges, start = [], 0.0
    for left, right in [*cuts, (length, length)]:
        if left - start > 0.05:
            edges.append((start, left))
        start = max(start, right)
    column, across, widths = np.zeros(s.shape, np.int32), np.zeros(s.shape, F32), np.full(s.shape, F32(width))
    for k, (a, b) in enumerate(edges):
        count = max(1, round((b - a) / width))
        each = (b - a) / count
        here = (s >= a) & (s < b)
        number = np.floor((s - a) / each)
        column = np.where(here, number + 100 * k, column).astype(np.int32)
        across = np.where(here, s - a - (number + 0.5) * each, across).astype(F32)
        widths = np.where(here, F32(each), widths)
    return column, across, widths


def cornice_depth(ornament: float) -> float:
    """Metres that a cornice reaches down from the ceiling."""
    return 0.05 + 0.15 * ornament


def _cornice(chart: Chart, sheet: TexelSheet, trim: TexelSheet, z: np.ndarray, interior: Interior) -> TexelSheet:
    """A run moulding under the ceiling: cove and bead, deeper in ornate styles; plain styles get a thin line or none."""
    ornament = interior.style.form.ornament
    if ornament < 0.15:
        return sheet
    depth = cornice_depth(ornament)
    below = F32(interior.height) - z  # metres under the ceiling
    cove = np.clip(F32(1) - below / F32(depth), 0, 1)
    profile = F32(0.35 * depth) * cove**2 + F32(0.010) * edge(F32(0.03) - np.abs(below - F32(depth - 0.03)), 0.02)
    profile += F32(0.012) * edge(F32(0.025) - np.abs(below - F32(0.45 * depth)), 0.02) * F32(ornament > 0.5)
    material = trim if interior.surfaces.trim.material in ("wood", "metal", "painted_wood") and ornament > 0.5 else None
    layer = material if material is not None else lay(chart, interior.surfaces.ceiling, *grid(chart), seed=interior.seed + 70)
    sheet = over(sheet, layer, edge(F32(depth) - below, chart.texel), lift=profile)
    return shaded(sheet, 1 - 0.22 * np.exp(-np.maximum(below - F32(depth), 0) / 0.07) * (below > depth))


def _casing(
    chart: Chart, sheet: TexelSheet, trim: TexelSheet, s: np.ndarray, z: np.ndarray, opening: WallOpening, interior: Interior
) -> TexelSheet:
    """An architrave around an opening: a stepped band with a bead at its inner and a back band at its outer edge.

    Doors and passages of ornate styles stand under a cap, windows on a sill board.
    """
    ornament = interior.style.form.ornament
    width = 0.10 + 0.04 * ornament
    distance = opening_distance(s, z, opening)
    steps = F32(0.014) * edge(F32(width) - distance, 0.012)
    steps += F32(0.012) * edge(distance - F32(0.76 * width), 0.010) + F32(0.007) * edge(F32(0.22 * width) - distance, 0.010)
    sheet = over(sheet, trim, edge(F32(width) - distance, chart.texel), lift=steps)
    inside = (distance > 0) & (distance < width)
    for quirk in (0.24 * width, 0.74 * width):  # the fine shadows that tell one moulding from the next
        sheet = shaded(sheet, 1 - 0.30 * np.exp(-(((distance - F32(quirk)) / F32(0.009)) ** 2)) * inside)
    outside = np.maximum(distance - F32(width), 0)
    sheet = shaded(sheet, 1 - 0.30 * np.exp(-outside / 0.035) * (outside > 0))
    half, middle = (opening.high - opening.low) / 2 + width, (opening.low + opening.high) / 2
    if opening.kind == "window":  # the sill board stands out below
        board = np.minimum(F32(0.05) - np.abs(z - F32(opening.sill - 0.05)), F32(half + 0.04) - np.abs(s - F32(middle)))
        return _band(sheet, trim, board, depth=0.03, nosing=0.02, texel=chart.texel)
    tall = 0.05 + 0.05 * ornament
    low = opening.head + width
    if ornament < 0.1 or low + tall > interior.height - cornice_depth(ornament) - 0.02:
        return sheet
    cap = np.minimum(F32(tall / 2) - np.abs(z - F32(low + tall / 2)), F32(half + 0.035) - np.abs(s - F32(middle)))
    sheet = shaded(sheet, 1 - 0.35 * np.exp(-np.maximum(F32(low) - z, 0) / 0.02) * (z < low) * (np.abs(s - F32(middle)) < half))
    return _band(sheet, trim, cap, depth=0.035, nosing=0.03, texel=chart.texel)


def _band(sheet: TexelSheet, trim: TexelSheet, inside: np.ndarray, *, depth: float, nosing: float, texel: float) -> TexelSheet:
    """A moulding where `inside` (metres within its outline) is positive, rounded over `nosing` at its edge."""
    profile = F32(depth) * np.sqrt(np.clip(inside / F32(nosing), 0, 1))
    return over(sheet, trim, edge(inside, texel), lift=profile)
