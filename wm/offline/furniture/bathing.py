"""Water and steam: pool, sauna bench and stove, fish tank, boiler."""

import math

import numpy as np

from wm.offline.furniture.greenery import leaf
from wm.offline.furniture.joinery import posts, wheel
from wm.offline.furniture.outlines import rounded
from wm.offline.furniture.piece import FurnitureKind, Model, Part, Size, of, pick
from wm.offline.furniture.solids import ball, box, extrude, lathe, rod, rounded_box, shift, stretch, tube
from wm.offline.style.finish import Style


def pool(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """A raised basin of tiles full of water, a stone rim around it, steps and a ladder's rails at its front."""
    w, d, h = size
    rim = 0.3
    outline = rounded(w, d, 0.12, at=(0.0, -d / 2))
    hole = rounded(w - 2 * rim, d - 2 * rim, 0.3, at=(0.0, -d / 2 + rim))
    parts = of("tile", extrude(outline.buffer(-0.03).difference(hole.buffer(0.02)), 0.0, h - 0.05, "z"))
    parts += of("marble", extrude(outline.difference(hole), h - 0.06, h, "z")) + of(
        "tile", extrude(hole.buffer(0.04), 0.004, 0.05, "z")
    )
    parts += of("water", extrude(hole.buffer(0.03), 0.04, h - 0.08, "z"))
    for s in (-1, 1):
        x = s * 0.26
        path = [
            (x, -d / 2 + 0.14, h - 0.02),
            (x, -d / 2 + 0.14, h + 0.2),
            (x, -d / 2 + rim + 0.08, h + 0.2),
            (x, -d / 2 + rim + 0.1, h - 0.12),
        ]
        parts += of("chrome", tube(path, 0.02, 10, smooth=3))
    return Model(parts)


def sauna_bench(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """Two steps of slatted benches, towels on the upper one."""
    w, d, h = size
    parts: list[Part] = []
    for y0, y1, z in ((-d / 2, -0.02, 0.5 * h), (-0.06, d / 2, h)):
        parts += of(
            "light_wood", *(box((-w / 2, y, z - 0.035), (w / 2, y + 0.085, z)) for y in np.arange(y0, y1 - 0.07, 0.1).tolist())
        )
        parts += of(
            "light_wood",
            *posts((-w / 2 + 0.05, 0.0, w / 2 - 0.05), (y0 + 0.05, y1 - 0.06), 0.0, z - 0.03, 0.06),
            *(box((x - 0.02, y0 + 0.01, z - 0.1), (x + 0.02, y1 - 0.02, z - 0.03)) for x in (-w / 2 + 0.05, 0.0, w / 2 - 0.05)),
        )
    parts += of(
        "linen",
        rounded_box((-0.36 * w, 0.0, h - 0.002), (-0.12 * w, 0.42 * d, h + 0.02), 0.01, 1),
        color=pick(rng, (*style.accents, (0.93, 0.92, 0.9))),
    )
    return Model(parts)


def sauna_stove(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """An iron stove heaped with stones, a wooden guard around it, a bucket with a ladle beside the guard."""
    w, d, h = size
    parts = of(
        "dark_metal",
        rounded_box((-0.26 * w, -0.26 * d, 0.06), (0.26 * w, 0.26 * d, h - 0.2), 0.02),
        box((-0.22 * w, -0.22 * d, 0.0), (0.22 * w, 0.22 * d, 0.08)),
    )
    parts += of("ember", box((-0.12 * w, -0.26 * d - 0.006, 0.2), (0.12 * w, -0.2 * d, 0.4)))
    for _ in range(24):
        a, q, r = float(rng.uniform(0, 2 * math.pi)), float(rng.uniform(0, 1)) ** 0.5, float(rng.uniform(0.045, 0.07))
        at = (0.22 * w * q * math.cos(a), 0.22 * d * q * math.sin(a), h - 0.2 + 0.1 * (1 - q))
        parts += of("stone", shift(stretch(ball((0, 0, 0), r, 8), (1.0, 0.85, 0.8)), at))
    xs, ys = (-w / 2 + 0.025, w / 2 - 0.025), (-d / 2 + 0.025, d / 2 - 0.025)
    parts += of("light_wood", *posts(xs, ys, 0.0, h - 0.08, 0.05))
    for z in (0.45 * h, h - 0.16):
        parts += of(
            "light_wood",
            *(box((-w / 2 + 0.03, y - 0.015, z), (w / 2 - 0.03, y + 0.015, z + 0.06)) for y in ys),
            *(box((x - 0.014, -d / 2 + 0.03, z + 0.001), (x + 0.014, d / 2 - 0.03, z + 0.059)) for x in xs),
        )
    return Model(parts)


def fish_tank(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """Water between slim corners on a cabinet, with sand, weed and fish at its front, a lit lid above."""
    w, d, h = size
    low = 0.46 * h
    parts = of(
        "dark_wood",
        box((-w / 2, -d / 2, 0.0), (w / 2, d / 2, low)),
        *(box((x0 + 0.012, -d / 2 - 0.012, 0.05), (x0 + w / 2 - 0.012, -d / 2 + 0.02, low - 0.04)) for x0 in (-w / 2, 0.0)),
    )
    parts += of(
        "dark_metal",
        box((-w / 2, -d / 2, h - 0.06), (w / 2, d / 2, h)),
        *posts((-w / 2 + 0.012, w / 2 - 0.012), (-d / 2 + 0.012, d / 2 - 0.012), low - 0.01, h - 0.05, 0.02),
    )
    y = -d / 2 + 0.09
    parts += of("water", box((-w / 2 + 0.012, y, low), (w / 2 - 0.012, d / 2 - 0.012, h - 0.08), 0.0)) + of(
        "soil", box((-w / 2 + 0.014, -d / 2 + 0.014, low), (w / 2 - 0.014, d / 2 - 0.014, low + 0.05)), color=(0.78, 0.68, 0.48)
    )
    parts += of(
        "bulb",
        box((-w / 2 + 0.05, -d / 2 + 0.03, h - 0.075), (w / 2 - 0.05, d / 2 - 0.05, h - 0.055), 0.0),
        color=(0.85, 0.95, 1.0),
    )
    for k in range(6):
        x = -w / 2 + 0.12 + k * (w - 0.24) / 5
        parts += of("leaf", leaf((x, y - 0.03, low + 0.04), float(rng.uniform(-0.6, 0.6)), 1.35, 0.5 * (h - low), 0.02, 0.5))
        z, color = (
            low + float(rng.uniform(0.25, 0.75)) * (h - low),
            pick(rng, ((0.95, 0.45, 0.1), (0.95, 0.8, 0.2), (0.3, 0.5, 0.9))),
        )
        parts += of(
            "lacquer",
            shift(stretch(ball((0, 0, 0), 1.0, 10), (0.05, 0.014, 0.026)), (x + 0.05, y - 0.03, z)),
            extrude([(x - 0.03, z + 0.024), (x - 0.03, z - 0.024), (x + 0.012, z)], y - 0.034, y - 0.026, "y"),
            color=color,
        )
    return Model(parts)


def boiler(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """An upright riveted boiler with a fire door, gauges, a valve wheel, and a pipe from its dome."""
    w, d, h = size
    r = 0.44 * min(w, d)
    parts = of("metal", lathe([(r, 0.1), (r, 0.72 * h), (0.85 * r, 0.8 * h), (0.4 * r, 0.86 * h), (0.1, 0.88 * h)], 32)) + of(
        "dark_metal", lathe([(1.08 * r, 0.0), (1.08 * r, 0.12)], 32)
    )
    for z in (0.2, 0.45 * h, 0.7 * h):
        parts += of("brass", lathe([(r + 0.012, z), (r + 0.012, z + 0.05)], 32))
    parts += of("dark_metal", rounded_box((-0.17, -r - 0.05, 0.24), (0.17, -r + 0.12, 0.52), 0.03)) + of(
        "ember", box((-0.1, -r - 0.056, 0.29), (0.1, -r, 0.44))
    )
    for s in (-1, 1):
        parts += of("brass", wheel((s * 0.14, -r - 0.01, 0.6 * h), 0.075, 0.1, "y")) + of(
            "paper", wheel((s * 0.14, -r - 0.02, 0.6 * h), 0.062, 0.1, "y")
        )
        parts += of("dark_metal", rod((s * 0.14, -r - 0.075, 0.6 * h), (s * 0.14 + 0.03, -r - 0.075, 0.6 * h + 0.035), 0.005))
    parts += of(
        "brass",
        tube(
            [(0, 0, 0.86 * h), (0, 0, h - 0.08), (0.3 * w, 0, h - 0.06), (w / 2 - 0.08, 0, h - 0.2), (w / 2 - 0.08, 0, 0.04)],
            0.045,
            14,
            smooth=3,
        ),
    )
    parts += of(
        "lacquer",
        wheel((w / 2 - 0.08, -0.06, 0.5 * h), 0.09, 0.03, "y"),
        rod((w / 2 - 0.08, 0, 0.5 * h), (w / 2 - 0.08, -0.07, 0.5 * h), 0.012),
        color=(0.7, 0.1, 0.08),
    )
    return Model(parts)


KINDS = {
    "pool": FurnitureKind(pool, "floor", (2.0, 1.5, 0.45), (3.2, 2.2, 0.55)),
    "sauna bench": FurnitureKind(sauna_bench, "floor", (1.5, 1.0, 0.85), (2.0, 1.15, 0.95)),
    "sauna stove": FurnitureKind(sauna_stove, "floor", (0.62, 0.62, 0.85), (0.7, 0.7, 0.95)),
    "fish tank": FurnitureKind(fish_tank, "floor", (1.0, 0.42, 1.25), (1.5, 0.5, 1.45), front=0.4),
    "boiler": FurnitureKind(boiler, "floor", (0.9, 0.8, 1.8), (1.1, 0.95, 2.1), front=0.5),
}
