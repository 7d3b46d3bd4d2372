"""Floors and ceilings, laid out in world x and y."""

import dataclasses

import numpy as np

from wm.offline.style.finish import Finish
from wm.offline.world.materials.wall import trim_profile
from wm.offline.world.noise import cells, edge, fbm
from wm.offline.world.surfaces.texel_sheet import (
    F32,
    Chart,
    Interior,
    TexelSheet,
    grid,
    inside_distance,
    lay,
    over,
    shaded,
    with_cavities,
)

DESIGNS: dict[str, dict[str, str]] = {
    # family -> room type -> ceiling; "" is every other room
    "gothic": {
        "": "beams",
        "hall": "coffers",
        "library": "coffers",
        "dining": "coffers",
        "living": "coffers",
        "bathroom": "plain",
    },
    "victorian": {"": "rosette", "bathroom": "plain", "kitchen": "plain", "corridor": "panels"},
    "baroque": {"": "rosette", "hall": "sky", "living": "sky", "corridor": "panels", "bathroom": "panels"},
    "roman": {"": "coffers", "kitchen": "beams", "bathroom": "plain", "corridor": "coffers"},
    "scandinavian": {"": "plain", "living": "boards", "bedroom": "boards"},
    "midcentury": {"": "boards", "bathroom": "plain"},
    "coastal": {"": "boards", "living": "beams", "bathroom": "plain"},
    "rustic": {"": "beams"},
    "industrial": {"": "beams", "bathroom": "plain"},
    "japanese": {"": "lattice", "bathroom": "boards"},
    "moroccan": {"": "coffers", "bathroom": "plain", "corridor": "beams"},
    "clockwork": {"": "coffers", "hall": "glazed", "bathroom": "plain"},
    "surreal": {"": "sky", "bathroom": "plain"},
}


def floor_sheet(chart: Chart, interior: Interior) -> TexelSheet:
    """A floor: its finish along the room's longer side, and in ornate styles a border that follows the walls."""
    x, y = _world(chart)
    finish = interior.surfaces.floor
    span = np.ptp(interior.polygon, axis=0)
    low = interior.polygon.min(axis=0)
    a, b = (x - F32(low[0]), y - F32(low[1])) if span[0] >= span[1] else (y - F32(low[1]), x - F32(low[0]))
    sheet = lay(chart, finish, a, b, seed=interior.seed + 1)
    if interior.style.form.ornament >= 0.5 and min(span) > 2.2 and finish.material in BORDERED:
        sheet = _floor_border(chart, sheet, finish, a, b, inside_distance(interior.polygon, x, y), interior)
    return with_cavities(sheet, chart.texel)


BORDERED = ("herringbone", "parquet", "mosaic", "checker_tiles", "marble", "stone_tiles", "sectile")
"""Floors that ornate styles frame with a border."""


def ceiling_sheet(chart: Chart, interior: Interior) -> TexelSheet:
    """A ceiling after the family's habit: plain, boards, ribs of several sorts, plasterwork, a painted sky, or glazing."""
    designs = DESIGNS.get(interior.style.family, {"": "plain"})
    design = designs.get(interior.kind, designs[""])
    x, y = _world(chart)
    finish = interior.surfaces.ceiling
    sheet = lay(chart, finish, x, y, seed=interior.seed + 2)
    wall = inside_distance(interior.polygon, x, y)
    low, high = interior.polygon.min(axis=0), interior.polygon.max(axis=0)
    trim = lay(chart, trim_profile(interior.surfaces.trim), x, y, seed=interior.seed + 51)
    if design == "boards":
        sheet = _boards(chart, sheet, x if high[1] - low[1] >= high[0] - low[0] else y)
    elif design == "beams":
        sheet = _ribs(chart, sheet, trim, x, y, low, high, wall, across=1.3, along=None, width=0.20)
    elif design in ("coffers", "lattice"):
        pitch, width = (1.15, 0.19) if design == "coffers" else (0.62, 0.045)
        sheet = _ribs(chart, sheet, trim, x, y, low, high, wall, across=pitch, along=pitch, width=width)
    elif design == "sky":
        sheet = _sky(chart, sheet, trim, x, y, wall, interior)
    elif design == "glazed":
        sheet = _sky(chart, sheet, trim, x, y, wall, interior)
        sheet = _ribs(chart, sheet, trim, x, y, low, high, wall, across=0.85, along=0.85, width=0.06)
    if design in ("rosette", "panels"):
        sheet = _mouldings(chart, sheet, wall, (0.32, 0.52))
    if design == "rosette" and min(high - low) > 2.4:
        sheet = _rosette(
            chart, sheet, x - F32((low[0] + high[0]) / 2), y - F32((low[1] + high[1]) / 2), radius=0.13 * min(high - low) + 0.1
        )
    return with_cavities(sheet, chart.texel, reach=0.05, strength=9.0)


def _world(chart: Chart) -> tuple[np.ndarray, np.ndarray]:
    s, t = grid(chart)
    x = F32(chart.origin[0]) + s * F32(chart.u[0]) + t * F32(chart.v[0])
    y = F32(chart.origin[1]) + s * F32(chart.u[1]) + t * F32(chart.v[1])
    return x, y


def _floor_border(
    chart: Chart, sheet: TexelSheet, finish: Finish, a: np.ndarray, b: np.ndarray, wall: np.ndarray, interior: Interior
) -> TexelSheet:
    """A plain margin along the walls and an inlaid double line."""
    wooden = finish.material in ("herringbone", "parquet")
    margin = (
        dataclasses.replace(finish, material="wood_planks", scale=0.14)
        if wooden
        else dataclasses.replace(finish, material="marble", scale=0.6)
    )
    dark = finish.colors[min(1, len(finish.colors) - 1)]
    if wooden:
        dark = tuple(0.5 * c for c in finish.colors[0])
        margin = dataclasses.replace(margin, colors=(tuple(0.8 * c for c in finish.colors[0]), *finish.colors[1:]))
    line_finish = dataclasses.replace(finish, material="lacquer", colors=(dark,), contrast=0.5)
    sheet = over(sheet, lay(chart, margin, a, b, seed=interior.seed + 30), edge(F32(0.30) - wall, chart.texel))
    line_sheet = dataclasses.replace(lay(chart, line_finish, a, b, seed=interior.seed + 31), roughness=sheet.roughness)
    for middle, half in ((0.30, 0.028), (0.38, 0.014)):
        sheet = over(sheet, line_sheet, edge(F32(half) - np.abs(wall - F32(middle)), chart.texel))
    return sheet


def _boards(chart: Chart, sheet: TexelSheet, across: np.ndarray) -> TexelSheet:
    """Tongue-and-groove boards: a V groove every 12 cm."""
    _, offset = cells(across, 0.12)
    groove = np.clip(F32(1) - (F32(0.06) - np.abs(offset)) / F32(0.010), 0, 1)
    sheet = dataclasses.replace(sheet, height=(sheet.height - F32(0.005) * groove).astype(F32))
    return shaded(sheet, 1 - 0.18 * groove)


def _ribs(
    chart: Chart, sheet: TexelSheet, trim: TexelSheet, x: np.ndarray, y: np.ndarray, low: np.ndarray, high: np.ndarray,
    wall: np.ndarray, *, across: float, along: float | None, width: float,
) -> TexelSheet:  # fmt: skip
    """Beams across the longer side, and also along it for coffers: evenly divided, with a rib at the walls."""
    span = high - low
    first = 0 if span[0] >= span[1] else 1
    coordinates = ((x - F32(low[0])), (y - F32(low[1])))
    distances = []
    for axis, pitch in ((first, across), (1 - first, along)):
        if pitch is not None:
            each = span[axis] / max(1, round(span[axis] / pitch))
            distances.append(np.abs(coordinates[axis] - np.round(coordinates[axis] / F32(each)) * F32(each)))
    if along is not None:
        distances.append(wall)
    rib = np.minimum.reduce(distances) - F32(width / 2)  # metres off the rib, negative on it
    depth = 0.45 * width
    # the recess is dark where it meets the rib, and a bead runs along the rib's foot
    recess = 1 - 0.42 * np.exp(-np.maximum(rib, 0) / (0.55 * width)) * (rib > 0)
    sheet = shaded(sheet, recess)
    rounded = F32(depth) * np.sqrt(np.clip(-rib / F32(0.22 * width), 0, 1))
    sheet = over(sheet, trim, edge(-rib, chart.texel), lift=rounded)
    if along is not None and width > 0.1:
        bead = edge(F32(0.018) - np.abs(rib - F32(0.05)), chart.texel)
        sheet = over(sheet, trim, bead, lift=0.012)
    return sheet


def _mouldings(chart: Chart, sheet: TexelSheet, wall: np.ndarray, distances: tuple[float, ...]) -> TexelSheet:
    """Plaster beads that follow the walls."""
    height = sheet.height
    for distance in distances:
        height = height + F32(0.02) * np.sqrt(np.clip(F32(1) - ((wall - F32(distance)) / F32(0.03)) ** 2, 0, 1))
    sheet = dataclasses.replace(sheet, height=height.astype(F32))
    return shaded(sheet, 1 - 0.10 * np.sum([np.exp(-(((wall - F32(d + 0.04)) / 0.02) ** 2)) for d in distances], axis=0))


def _rosette(chart: Chart, sheet: TexelSheet, dx: np.ndarray, dy: np.ndarray, *, radius: float) -> TexelSheet:
    """A plaster rose: rings, and petals between them."""
    r, angle = np.hypot(dx, dy) / F32(radius), np.arctan2(dy, dx)
    petals = np.sqrt(np.abs(np.cos(F32(8) * angle))) * np.clip((r - 0.3) * 8, 0, 1) * np.clip((0.8 - r) * 8, 0, 1)
    inner = np.sqrt(np.abs(np.cos(F32(4) * angle))) * np.clip((0.28 - r) * 8, 0, 1)
    rings = sum(np.clip(1 - ((r - k) / 0.05) ** 2, 0, 1) for k in (0.30, 0.84, 0.97))
    height = F32(0.022) * (np.maximum(petals, inner) + rings) * (r < 1.05)
    sheet = dataclasses.replace(sheet, height=(sheet.height + height).astype(F32))
    return shaded(sheet, 1 - 0.13 * (1 - np.clip(petals + inner + rings, 0, 1)) * (r < 0.97))


def _sky(
    chart: Chart, sheet: TexelSheet, trim: TexelSheet, x: np.ndarray, y: np.ndarray, wall: np.ndarray, interior: Interior
) -> TexelSheet:
    """A painted sky in a gilt or plaster frame."""
    cloud = fbm((x, y), wavelength=1.6, octaves=4, footprint=chart.texel, seed=interior.seed + 60)
    blue = np.array([0.30, 0.46, 0.66], F32)[:, None, None]
    white = np.array([0.86, 0.82, 0.76], F32)[:, None, None]
    painted = dataclasses.replace(sheet, albedo=(blue + (white - blue) * np.clip(0.45 + 0.75 * cloud, 0, 1)).astype(F32))
    sheet = over(sheet, painted, edge(wall - F32(0.6), chart.texel))
    rounded = F32(0.03) * np.sqrt(np.clip(F32(1) - ((wall - F32(0.6)) / F32(0.07)) ** 2, 0, 1))
    sheet = over(sheet, trim, edge(F32(0.07) - np.abs(wall - F32(0.6)), chart.texel), lift=rounded)
    return _mouldings(chart, sheet, wall, (0.3,))
