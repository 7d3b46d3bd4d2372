"""Things of stables and cellars: horse stall, hay bale, trough, barrel."""

import numpy as np

from wm.offline.furniture.common import frame_wood
from wm.offline.furniture.joinery import posts
from wm.offline.furniture.piece import FurnitureKind, Model, Size, of
from wm.offline.furniture.solids import box, lathe, rod, rounded_box, shell, shift, tube, turn
from wm.offline.style.finish import Style

STRAW = (0.8, 0.65, 0.3)


def horse_stall(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """A box of boards and bars, open at its front but for a half door, straw on its floor and a hay rack at the back."""
    w, d, h = size
    wood, half = frame_wood(style), 0.58 * h
    xs = (-w / 2 + 0.06, w / 2 - 0.06)
    parts = of(wood, *posts(xs, (-d / 2 + 0.06, d / 2 - 0.06), 0.0, h, 0.12))
    planks = max(int(half / 0.16), 4)
    for k in range(planks):
        z0, z1 = 0.06 + (half - 0.06) * k / planks, 0.05 + (half - 0.06) * (k + 1) / planks
        for x in xs:
            parts += of(wood, box((x - 0.022, -d / 2 + 0.1, z0), (x + 0.022, d / 2 - 0.1, z1)))
        parts += of(wood, box((-w / 2 + 0.1, d / 2 - 0.08, z0), (w / 2 - 0.1, d / 2 - 0.04, z1)))
        if k < planks - 1:
            parts += of("dark_wood", box((-w / 2 + 0.14, -d / 2 + 0.035, z0), (w / 2 - 0.14, -d / 2 + 0.08, z1)))
    for x in xs:
        parts += of(
            "dark_metal",
            *(rod((x, y, half - 0.02), (x, y, h - 0.05), 0.012, 6) for y in np.arange(-d / 2 + 0.2, d / 2 - 0.14, 0.14).tolist()),
        )
        parts += of(wood, box((x - 0.03, -d / 2 + 0.1, h - 0.08), (x + 0.03, d / 2 - 0.1, h - 0.01)))
    brace = [(-w / 2 + 0.18, -d / 2 + 0.03, 0.12), (w / 2 - 0.18, -d / 2 + 0.03, half - 0.3)]
    parts += of(
        "dark_metal",
        tube(brace, 0.02, 6),
        *(box((-w / 2 + 0.08, -d / 2 + 0.02, z), (-w / 2 + 0.5, -d / 2 + 0.045, z + 0.04)) for z in (0.2, half - 0.36)),
    )
    parts += of("woven", rounded_box((-w / 2 + 0.12, -d / 2 + 0.1, 0.0), (w / 2 - 0.12, d / 2 - 0.1, 0.07), 0.03), color=STRAW)
    rack = [
        rod((x, d / 2 - 0.1, half - 0.05), (x, d / 2 - 0.34, half + 0.32), 0.01, 6)
        for x in np.linspace(-0.3 * w, 0.3 * w, 9).tolist()
    ]
    parts += of("dark_metal", *rack, rod((-0.32 * w, d / 2 - 0.34, half + 0.32), (0.32 * w, d / 2 - 0.34, half + 0.32), 0.014))
    return Model(
        parts
        + of("woven", rounded_box((-0.28 * w, d / 2 - 0.24, half + 0.1), (0.28 * w, d / 2 - 0.1, half + 0.34), 0.05), color=STRAW)
    )


def hay_bale(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """Pressed hay tied with two cords, stalks sticking out."""
    w, d, h = size
    parts = of(
        "woven", rounded_box((-w / 2 + 0.02, -d / 2 + 0.02, 0.0), (w / 2 - 0.02, d / 2 - 0.02, h - 0.01), 0.05), color=STRAW
    )
    for x in (-0.22 * w, 0.22 * w):
        loop = [(x, -d / 2 + 0.014, 0.02), (x, -d / 2 + 0.014, h - 0.02), (x, d / 2 - 0.014, h - 0.02), (x, d / 2 - 0.014, 0.02)]
        parts += of("leather", tube(loop, 0.01, 6))
    for _ in range(26):
        x, y = float(rng.uniform(-0.4, 0.4)) * w, float(rng.uniform(-0.4, 0.4)) * d
        dx, dy = float(rng.uniform(-0.08, 0.08)), float(rng.uniform(-0.08, 0.08))
        parts += of(
            "woven",
            rod((x, y, h - 0.03), (x + dx, y + dy, h - float(rng.uniform(-0.02, 0.01))), 0.003, 4),
            color=(0.88, 0.75, 0.42),
        )
    return Model(parts)


def trough(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """A stone trough full of water."""
    w, d, h = size
    t = 0.07
    parts = of("stone", box((-w / 2, -d / 2, 0.0), (w / 2, d / 2, h - 0.16), 0.012))
    parts += of("stone", *(box((-w / 2, s * d / 2, h - 0.18), (w / 2, s * (d / 2 - t), h), 0.01) for s in (-1, 1)))
    parts += of(
        "stone",
        *(box((s * w / 2, -d / 2 + t - 0.006, h - 0.18), (s * (w / 2 - t), d / 2 - t + 0.006, h - 0.004), 0.01) for s in (-1, 1)),
    )
    return Model(
        parts
        + of("water", box((-w / 2 + t - 0.01, -d / 2 + t - 0.01, h - 0.17), (w / 2 - t + 0.01, d / 2 - t + 0.01, h - 0.05), 0.0))
    )


def barrel(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """Staves in iron hoops, lying on a cradle with its tap towards the front."""
    w, d, h = size
    r, z = min(w, h - 0.08) / 2, h - min(w, h - 0.08) / 2
    stave = [
        (0.8 * r, -d / 2),
        (0.8 * r, -d / 2 + 0.03),
        (0.94 * r, -0.22 * d),
        (r, 0.0),
        (0.94 * r, 0.22 * d),
        (0.8 * r, d / 2 - 0.03),
        (0.8 * r, d / 2),
    ]
    parts = of("dark_wood", shift(turn(lathe(stave, 22), "x", 90), (0, 0, z)))
    for y, q in ((-0.42 * d, 0.87), (-0.2 * d, 0.965), (0.2 * d, 0.965), (0.42 * d, 0.87)):
        parts += of("dark_metal", shift(turn(shell([(q * r, -0.02), (q * r, 0.02)], 0.03, 22), "x", 90), (0, y, z)))
    parts += of("light_wood", shift(turn(lathe([(0.74 * r, -0.004), (0.74 * r, 0.004)], 22), "x", 90), (0, -d / 2 - 0.002, z)))
    parts += of(
        "brass",
        rod((0, -d / 2 + 0.01, z - 0.5 * r), (0, -d / 2 - 0.07, z - 0.5 * r), 0.014),
        rod((0, -d / 2 - 0.05, z - 0.5 * r), (0, -d / 2 - 0.05, z - 0.5 * r + 0.06), 0.01),
    )
    for y in (-0.28 * d, 0.28 * d):
        parts += of(
            "wood",
            *(box((s * w / 2, y - 0.04, 0.0), (s * 0.3 * w, y + 0.04, 0.2)) for s in (-1, 1)),
            box((-w / 2 + 0.02, y - 0.035, 0.0), (w / 2 - 0.02, y + 0.035, 0.07)),
        )
    return Model(parts)


KINDS = {
    "horse stall": FurnitureKind(horse_stall, "floor", (1.8, 1.9, 1.8), (2.4, 2.5, 2.1), front=0.6),
    "hay bale": FurnitureKind(hay_bale, "floor", (0.85, 0.45, 0.38), (1.0, 0.5, 0.46)),
    "trough": FurnitureKind(trough, "floor", (1.0, 0.42, 0.5), (1.4, 0.5, 0.6), front=0.3),
    "barrel": FurnitureKind(barrel, "floor", (0.62, 0.8, 0.74), (0.72, 0.95, 0.86)),
}
