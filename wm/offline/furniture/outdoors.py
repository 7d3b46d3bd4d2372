"""Things for open air and glass houses: deck chair, railing planter, potting bench, fountain."""

import math

import numpy as np

from wm.offline.furniture.common import frame_wood
from wm.offline.furniture.greenery import leaf
from wm.offline.furniture.joinery import posts
from wm.offline.furniture.piece import FurnitureKind, Model, Part, Size, Top, of, pick
from wm.offline.furniture.solids import Real, ball, box, lathe, rod, shell, tube
from wm.offline.style.finish import Style


def seedling(
    rng: np.random.Generator, x: Real, y: Real, z: Real, tall: Real, *, bloom: tuple[float, float, float] | None = None
) -> list[Part]:
    """A tuft of leaves, with a flower above it where it has a colour."""
    start = float(rng.uniform(0, math.pi))
    solids = [leaf((x, y, z), start + 1.26 * k, 1.0, 0.8 * tall, 0.16 * tall, 1.4) for k in range(5)]
    parts = of("leaf", *solids)
    if bloom is not None:
        parts += of("leaf", rod((x, y, z), (x, y, z + 0.9 * tall), 0.005, 5)) + of(
            "flower", ball((x, y, z + tall), 0.03, 8), color=bloom
        )
    return parts


def deck_chair(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """Striped cloth slung in a folding wooden frame."""
    w, d, h = size
    wood, color = frame_wood(style), pick(rng, style.accents)
    parts: list[Part] = []
    for s in (-1, 1):
        x = s * (w / 2 - 0.02)
        parts += of(wood, rod((x, -d / 2 + 0.04, 0.36), (x, d / 2 - 0.06, 0.0 + 0.02), 0.021)) + of(
            wood, rod((x * 0.92, -d / 2 + 0.12, 0.02), (x * 0.92, d / 2 - 0.02, h - 0.02), 0.021)
        )
        parts += of(wood, rod((x, -0.1 * d, 0.28), (x * 0.95, 0.3 * d, 0.62 * h), 0.016))
    for y, z in ((-d / 2 + 0.04, 0.36), (d / 2 - 0.02, h - 0.02), (d / 2 - 0.06, 0.03), (-d / 2 + 0.12, 0.03)):
        parts += of(wood, rod((-w / 2, y, z), (w / 2, y, z), 0.018))
    sag = [(-d / 2 + 0.04, 0.375), (-0.25 * d, 0.24), (0.05 * d, 0.25), (0.3 * d, 0.55 * h), (d / 2 - 0.02, h - 0.005)]
    stripes = 6
    for k in range(stripes):
        x = -w / 2 + 0.06 + (k + 0.5) * (w - 0.12) / stripes
        strip = tube([(x, y, z) for y, z in sag], (w - 0.12) / stripes / 2 * 1.02, 10, flatten=0.1, smooth=3)
        parts += of("fabric", strip, color=color if k % 2 else (0.93, 0.91, 0.86))
    return Model(parts)


def railing_planter(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """A stretch of balcony railing with a box of flowers hung on it."""
    w, d, h = size
    y = d / 2 - 0.03
    parts = of(
        "dark_metal",
        box((-w / 2, y - 0.025, h - 0.28), (w / 2, y + 0.025, h - 0.24)),
        box((-w / 2, y - 0.015, 0.08), (w / 2, y + 0.015, 0.11)),
    )
    parts += of(
        "dark_metal",
        *(rod((x, y, 0.09), (x, y, h - 0.26), 0.008, 6) for x in np.arange(-w / 2 + 0.1, w / 2 - 0.06, 0.11).tolist()),
        *posts((-w / 2 + 0.02, w / 2 - 0.02), (y,), 0.0, h - 0.25, 0.04),
    )
    low = h - 0.46
    parts += of("terracotta", box((-w / 2 + 0.04, -d / 2, low), (w / 2 - 0.04, y - 0.03, h - 0.24), 0.012)) + of(
        "soil", box((-w / 2 + 0.06, -d / 2 + 0.02, h - 0.26), (w / 2 - 0.06, y - 0.05, h - 0.235))
    )
    count = int(w / 0.14)
    for k in range(count):
        x = -w / 2 + 0.1 + (k + 0.5) * (w - 0.2) / count
        parts += seedling(
            rng,
            x,
            0.5 * (y - d / 2) - 0.01,
            h - 0.24,
            float(rng.uniform(0.14, 0.2)),
            bloom=pick(rng, ((0.85, 0.12, 0.2), (0.95, 0.6, 0.7), (0.95, 0.85, 0.4))),
        )
    return Model(parts)


def potting_bench(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """A slatted bench with pots of seedlings, a watering can, and empty pots below."""
    w, d, h = size
    wood, top = frame_wood(style), 0.86
    parts = of(
        wood,
        *posts((-w / 2 + 0.04, w / 2 - 0.04), (-d / 2 + 0.05, d / 2 - 0.04), 0.0, top - 0.01, 0.07),
        *posts((-w / 2 + 0.04, w / 2 - 0.04), (d / 2 - 0.04,), top - 0.02, h, 0.06),
    )
    parts += of(
        wood,
        *(box((-w / 2, y, top - 0.03), (w / 2, y + 0.085, top)) for y in np.arange(-d / 2, d / 2 - 0.07, 0.095).tolist()),
        box((-w / 2 + 0.02, -d / 2 + 0.06, 0.2), (w / 2 - 0.02, d / 2 - 0.05, 0.225)),
    )
    parts += of(wood, box((-w / 2 + 0.01, d / 2 - 0.16, h - 0.16), (w / 2 - 0.01, d / 2 - 0.012, h - 0.135)))
    pot_shape = [(0.055, 0.0), (0.075, 0.1), (0.085, 0.1), (0.085, 0.125), (0.07, 0.125), (0.066, 0.1)]
    count = int((w - 0.4) / 0.21)
    for k in range(count):
        x = -w / 2 + 0.14 + k * 0.21
        for y, z in ((0.04, top + 0.001), (0.0, 0.226)):
            parts += of("terracotta", lathe(pot_shape, 16, at=(x, y, z)))
        parts += of("soil", lathe([(0.066, 0.09), (0.066, 0.105)], 14, at=(x, 0.04, top))) + seedling(
            rng, x, 0.04, top + 0.1, float(rng.uniform(0.16, 0.26))
        )
        parts += of("terracotta", lathe([(0.7 * r, 0.7 * z) for r, z in pot_shape], 12, at=(x, d / 2 - 0.09, h - 0.134)))
    x = w / 2 - 0.18
    parts += of(
        "metal",
        lathe([(0.09, 0), (0.095, 0.01), (0.09, 0.17), (0.04, 0.19)], 18, at=(x, -0.03, top + 0.001)),
        tube([(x - 0.07, -0.03, top + 0.05), (x - 0.2, -0.03, top + 0.22)], [0.018, 0.012], 8),
        lathe([(0.012, 0), (0.035, 0.03)], 12, at=(x - 0.2, -0.03, top + 0.21)),
    )
    handle = [(x + 0.06, -0.03, top + 0.17), (x + 0.03, -0.03, top + 0.27), (x - 0.05, -0.03, top + 0.22)]
    return Model(
        parts + of("metal", tube(handle, 0.008, 8, smooth=2)), (Top(top, -w / 2 + 0.05, -d / 2 + 0.02, w / 2 - 0.4, -0.06),)
    )


def fountain(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """A round stone basin with water, and two bowls on a stem."""
    w, _, h = size
    r = w / 2
    parts = of(
        "stone",
        shell([(0.94 * r, 0.0), (0.94 * r, 0.3), (r, 0.34), (r, 0.42)], 0.1),
        lathe([(0.9 * r, 0.002), (0.9 * r, 0.08)], 28),
    )
    parts += of("water", lathe([(0.88 * r, 0.06), (0.88 * r, 0.36)], 28))
    stem = [(0.16, 0.05), (0.1, 0.3), (0.07, 0.4), (0.1, 0.5), (0.05, 0.56), (0.05, h - 0.1), (0.07, h - 0.05), (0.0, h)]
    parts += of("stone", lathe(stem, 20, smooth=1))
    for z, reach in ((0.58 * h, 0.55 * r), (0.82 * h, 0.32 * r)):
        bowl = [(0.06, z), (0.7 * reach, z + 0.06), (reach, z + 0.13), (0.95 * reach, z + 0.13), (0.6 * reach, z + 0.085)]
        parts += of("stone", lathe(bowl, 26)) + of("water", lathe([(0.88 * reach, z + 0.09), (0.9 * reach, z + 0.118)], 24))
        for k in range(6):
            a = math.pi / 3 * k
            c, s = math.cos(a), math.sin(a)
            path = [
                (0.97 * reach * c, 0.97 * reach * s, z + 0.125),
                (1.06 * reach * c, 1.06 * reach * s, z + 0.09),
                (1.1 * reach * c, 1.1 * reach * s, 0.36 if z < 0.7 * h else 0.58 * h + 0.1),
            ]
            parts += of("water", tube(path, 0.009, 6, smooth=2))
    return Model(parts)


KINDS = {
    "deck chair": FurnitureKind(deck_chair, "floor", (0.56, 0.95, 0.84), (0.64, 1.1, 0.95), front=0.3),
    "railing planter": FurnitureKind(railing_planter, "floor", (0.9, 0.28, 1.05), (1.4, 0.34, 1.2)),
    "potting bench": FurnitureKind(potting_bench, "floor", (1.2, 0.55, 1.3), (1.7, 0.64, 1.45), front=0.5),
    "fountain": FurnitureKind(fountain, "floor", (1.0, 1.0, 1.2), (1.5, 1.5, 1.6)),
}
