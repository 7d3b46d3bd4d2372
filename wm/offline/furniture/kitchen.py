"""Kitchen pieces: counter with sink, counter, stove, fridge, wall cupboard, hood."""

import itertools

import numpy as np

from wm.offline.furniture.common import front
from wm.offline.furniture.outlines import rectangle, rounded
from wm.offline.furniture.piece import FurnitureKind, Model, Part, Size, Top, of
from wm.offline.furniture.solids import Real, box, extrude, lathe, rod, rounded_box, shift, tube, turn
from wm.offline.style.finish import PERIOD, Style


def base_units(style: Style, w: Real, d: Real, h: Real, *, drawers: bool, basin: Real = 0.0) -> list[Part]:
    """Cupboards without their worktop, open at the top to a depth of `basin`."""
    slot = "wood" if style.family in ("gothic", "rustic", "industrial", "japanese") else "painted_wood"
    face = -d / 2 + 0.045
    parts = of(slot, box((-w / 2, face, 0.09), (w / 2, d / 2, h - 0.037 - basin)))
    if basin:
        low, high = h - 0.04 - basin, h - 0.037
        parts += of(
            slot,
            box((-w / 2, face, low), (w / 2, face + 0.02, high), 0.0),
            box((-w / 2, d / 2 - 0.02, low), (w / 2, d / 2, high), 0.0),
        )
        parts += of(
            slot, *(box((s * w / 2, face + 0.019, low), (s * (w / 2 - 0.02), d / 2 - 0.019, high), 0.0) for s in (-1.0, 1.0))
        )
    parts += of("dark_wood", box((-w / 2 + 0.01, -d / 2 + 0.1, 0.0), (w / 2 - 0.01, d / 2 - 0.02, 0.1)))
    count = max(round(w / 0.5), 1)
    edges = np.linspace(-w / 2 + 0.006, w / 2 - 0.006, count + 1)
    for k, (x0, x1) in enumerate(itertools.pairwise(edges.tolist())):
        side = "right" if k % 2 == 0 else "left"
        if drawers:
            parts += front(style, x0 + 0.004, x1 - 0.004, h - 0.21, h - 0.05, -d / 2 + 0.045, slot=slot, handle="centre")
        parts += front(
            style, x0 + 0.004, x1 - 0.004, 0.11, h - (0.22 if drawers else 0.05), -d / 2 + 0.045, slot=slot, handle=side
        )
    return parts


def worktop(style: Style) -> str:
    return (
        "wood"
        if style.family in ("scandinavian", "coastal", "japanese")
        else ("stone" if style.family in ("gothic", "rustic") else "marble")
    )


def counter(style: Style, rng: np.random.Generator, size: Size) -> Model:
    w, d, h = size
    parts = base_units(style, w, d, h, drawers=True)
    parts += of(worktop(style), rounded_box((-w / 2, -d / 2, h - 0.04), (w / 2, d / 2, h), 0.008, 1))
    return Model(parts, (Top(h, -w / 2 + 0.05, -d / 2 + 0.08, w / 2 - 0.05, d / 2 - 0.06),))


def sink(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """A counter with a basin and a tap; h is the height of the worktop."""
    w, d, top = size
    parts = base_units(style, w, d, top, drawers=False, basin=0.17)
    hole = rounded(0.5, 0.38, 0.05, at=(0.0, -0.21))
    sheet = rectangle(w, d, at=(0.0, -d / 2)).difference(hole)
    parts += of(worktop(style), extrude(sheet, top - 0.04, top, "z"))
    basin = "ceramic" if style.form.ornament > 0.3 else "chrome"
    rim = hole.buffer(0.012)
    parts += of(
        basin,
        extrude(rim.difference(hole.buffer(-0.012)), top - 0.17, top + 0.006, "z"),
        extrude(hole.buffer(-0.004), top - 0.2, top - 0.165, "z"),
    )
    metal = "brass" if style.form.ornament > 0.3 else "chrome"
    y = d / 2 - 0.07
    spout = [
        (0, y, top - 0.01),
        (0, y, top + 0.2),
        (0, y - 0.05, top + 0.28),
        (0, y - 0.13, top + 0.27),
        (0, y - 0.16, top + 0.2),
    ]
    parts += of(metal, tube(spout, 0.011, 8, smooth=3), lathe([(0.025, top - 0.005), (0.02, top + 0.03)], 14, at=(0, y, 0.0)))
    for s in (-1.0, 1.0):
        parts += of(
            metal,
            lathe([(0.018, top - 0.005), (0.015, top + 0.05)], 12, at=(s * 0.09, y, 0.0)),
            rod((s * 0.09 - 0.03, y, top + 0.05), (s * 0.09 + 0.03, y, top + 0.05), 0.007),
        )
    return Model(parts)


def stove(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """A cooker: oven door with window, knobs, four burners, a kettle; cast iron in period styles."""
    w, d, h = size
    body = "dark_metal" if style.family in PERIOD else "appliance"
    trim = "brass" if style.family in PERIOD else "chrome"
    face = -d / 2 + 0.04
    parts = of(
        body,
        rounded_box((-w / 2, face, 0.06), (w / 2, d / 2, h - 0.02), 0.01, 1),
        box((-w / 2 + 0.03, face + 0.04, 0.0), (w / 2 - 0.03, d / 2 - 0.03, 0.07)),
    )
    parts += of("dark_metal", box((-w / 2 + 0.006, face + 0.006, h - 0.025), (w / 2 - 0.006, d / 2 - 0.006, h), 0.004))
    parts += of(body, rounded_box((-w / 2 + 0.03, face - 0.02, 0.17), (w / 2 - 0.03, face + 0.01, h - 0.18), 0.008, 1))
    parts += of("screen", box((-w / 2 + 0.11, face - 0.024, 0.28), (w / 2 - 0.11, face, h - 0.31), 0.003))
    parts += of(trim, shift(turn(rod((0, 0, -w / 2 + 0.08), (0, 0, w / 2 - 0.08), 0.01), "y", 90), (0, face - 0.045, h - 0.22)))
    for s in (-1.0, 1.0):
        parts += of(trim, rod((s * (w / 2 - 0.1), face - 0.045, h - 0.22), (s * (w / 2 - 0.1), face, h - 0.22), 0.007, 6))
    for x in np.linspace(-w / 2 + 0.1, w / 2 - 0.1, 5):
        parts += of(trim, shift(turn(lathe([(0.022, -0.015), (0.018, 0.015)], 14), "x", 90), (x, face - 0.012, h - 0.1)))
    for sx in (-1.0, 1.0):
        for sy in (-1.0, 1.0):
            at = (sx * 0.24 * w, 0.02 + sy * 0.21 * d, h - 0.003)
            parts += of("metal", lathe([(0.085, 0.0), (0.085, 0.012), (0.06, 0.012), (0.06, 0.006)], 20, at=at))
            parts += of(
                "dark_metal",
                *(
                    box(
                        (at[0] - 0.1 * c - 0.006 * s, at[1] - 0.1 * s - 0.006 * c, h + 0.008),
                        (at[0] + 0.1 * c + 0.006 * s, at[1] + 0.1 * s + 0.006 * c, h + 0.02 + 0.001 * s),
                    )
                    for c, s in ((1, 0), (0, 1))
                ),
            )
    x, y = 0.24 * w, 0.02 + 0.21 * d
    kettle = [(0.07, 0.0), (0.085, 0.03), (0.075, 0.09), (0.04, 0.125), (0.02, 0.13), (0.018, 0.15), (0.0, 0.155)]
    parts += of(
        "brass" if style.family in PERIOD else "chrome", lathe([(0.0, 0.0), *kettle], 20, at=(x, y, h + 0.0205), smooth=1)
    )
    handle = [(x - 0.06, y, h + 0.12), (x - 0.045, y, h + 0.2), (x + 0.045, y, h + 0.2), (x + 0.06, y, h + 0.12)]
    return Model(parts + of("dark_wood", tube(handle, 0.007, 7, smooth=2)))


def fridge(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """A fridge with two doors above each other and bar handles: steel, enamel in soft styles, or an icebox in period styles."""
    w, d, h = size
    retro = style.form.softness > 0.7 or style.family in ("midcentury", "surreal")
    icebox = style.family in PERIOD and style.family != "surreal"
    slot = "panel_wood" if icebox else ("painted_wood" if retro else "appliance")
    color = style.accents[1] if retro and not icebox else None
    metal = "brass" if icebox else "chrome"
    bend = 0.06 if retro else 0.012
    face = -d / 2 + 0.1
    split = 0.62 * h
    parts = of(slot, rounded_box((-w / 2, face, 0.03), (w / 2, d / 2, h), bend), color=color)
    parts += of("dark_metal", box((-w / 2 + 0.04, face + 0.03, 0.0), (w / 2 - 0.04, d / 2 - 0.04, 0.05)))
    for low, high in ((0.06, split - 0.004), (split + 0.004, h - 0.02)):
        parts += of(
            slot,
            rounded_box((-w / 2 + 0.006, -d / 2 + 0.035, low), (w / 2 - 0.006, face + 0.02, high), min(bend, 0.03)),
            color=color,
        )
    for low, high in ((split - 0.5, split - 0.08), (split + 0.08, split + 0.36)):
        x = -w / 2 + 0.08
        parts += of(metal, rod((x, -d / 2 + 0.008, low), (x, -d / 2 + 0.008, high), 0.01))
        parts += of(metal, *(rod((x, -d / 2 + 0.008, z), (x, -d / 2 + 0.045, z), 0.007, 6) for z in (low + 0.03, high - 0.03)))
    return Model(parts)


def wall_cupboard(style: Style, rng: np.random.Generator, size: Size) -> Model:
    w, d, h = size
    slot = "wood" if style.family in ("gothic", "rustic", "industrial", "japanese") else "painted_wood"
    parts = of(slot, box((-w / 2, -d / 2 + 0.03, 0.0), (w / 2, d / 2, h)))
    count = max(round(w / 0.45), 2)
    edges = np.linspace(-w / 2 + 0.006, w / 2 - 0.006, count + 1)
    for k, (x0, x1) in enumerate(itertools.pairwise(edges.tolist())):
        parts += front(
            style, x0 + 0.004, x1 - 0.004, 0.012, h - 0.012, -d / 2 + 0.03, slot=slot, handle="right" if k % 2 == 0 else "left"
        )
    return Model(parts)


def hood(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """A cooker hood: a flared skirt and a flue."""
    w, d, h = size
    slot = "brass" if style.family in PERIOD else "appliance"
    skirt = 0.45 * h
    outline = [(-w / 2, 0.0), (w / 2, 0.0), (w / 2, 0.06), (0.17, skirt), (-0.17, skirt), (-w / 2, 0.06)]
    parts = of(slot, extrude(outline, -d / 2, d / 2, "y"))
    return Model(parts + of(slot, box((-0.15, -0.1, skirt - 0.03), (0.15, d / 2 - 0.004, h))))


KINDS = {
    "kitchen counter": FurnitureKind(counter, "floor", (0.9, 0.6, 0.9), (1.6, 0.62, 0.92), front=0.7),
    "sink counter": FurnitureKind(sink, "floor", (1.0, 0.6, 0.9), (1.3, 0.62, 0.92), front=0.7),
    "stove": FurnitureKind(stove, "floor", (0.6, 0.62, 0.9), (0.66, 0.66, 0.92), front=0.7),
    "fridge": FurnitureKind(fridge, "floor", (0.62, 0.66, 1.7), (0.72, 0.7, 1.85), front=0.7),
    "wall cupboard": FurnitureKind(wall_cupboard, "wall", (0.8, 0.32, 0.6), (1.5, 0.36, 0.7)),
    "range hood": FurnitureKind(hood, "wall", (0.62, 0.44, 0.6), (0.7, 0.48, 0.7)),
}
