"""Games: billiard table, table tennis table, dartboard."""

import math

import numpy as np

from wm.offline.furniture.common import TURNED, frame_wood
from wm.offline.furniture.joinery import WHITE, posts, wheel
from wm.offline.furniture.piece import FurnitureKind, Model, Size, of
from wm.offline.furniture.solids import ball, box, extrude, lathe, rod, rounded_box, shift, turn
from wm.offline.style.finish import Style

BAIZE = (0.05, 0.34, 0.18)


def billiard_table(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """A slate bed under green cloth between wooden rails with six pockets, balls and a cue on it."""
    w, d, h = size
    wood, rail, bed = frame_wood(style), 0.13, h - 0.05
    parts = of(wood, box((-w / 2 + 0.05, -d / 2 + 0.05, h - 0.24), (w / 2 - 0.05, d / 2 - 0.05, bed - 0.02)))
    for x in (-w / 2 + 0.2, w / 2 - 0.2):
        for y in (-d / 2 + 0.18, d / 2 - 0.18):
            parts += of(wood, lathe([(0.09 * r, z * (h - 0.22)) for r, z in TURNED], 18, at=(x, y, 0.0)))
    parts += of(
        "velvet",
        box((-w / 2 + rail - 0.02, -d / 2 + rail - 0.02, bed - 0.03), (w / 2 - rail + 0.02, d / 2 - rail + 0.02, bed)),
        color=BAIZE,
    )
    for s in (-1, 1):
        parts += of(wood, rounded_box((-w / 2, s * d / 2, h - 0.1), (w / 2, s * (d / 2 - rail + 0.04), h), 0.02)) + of(
            "velvet",
            box(
                (-w / 2 + rail + 0.03, s * (d / 2 - rail + 0.045), bed - 0.01),
                (w / 2 - rail - 0.03, s * (d / 2 - rail), h - 0.008),
            ),
            color=BAIZE,
        )
        parts += of(
            wood, rounded_box((s * w / 2, -d / 2 + 0.05, h - 0.099), (s * (w / 2 - rail + 0.04), d / 2 - 0.05, h - 0.001), 0.02)
        ) + of(
            "velvet",
            box(
                (s * (w / 2 - rail + 0.045), -d / 2 + rail + 0.03, bed - 0.01),
                (s * (w / 2 - rail), d / 2 - rail - 0.03, h - 0.009),
            ),
            color=BAIZE,
        )
        for x in (-w / 2 + 0.085, 0.0, w / 2 - 0.085):
            parts += of(
                "soot", lathe([(0.055, h - 0.09), (0.055, h + 0.002)], 18, at=(x, s * (d / 2 - (0.085 if x else 0.06)), 0.0))
            )
    colors = ((0.8, 0.1, 0.1), (0.9, 0.75, 0.1), (0.1, 0.2, 0.6), (0.9, 0.45, 0.1), (0.1, 0.4, 0.2), (0.45, 0.1, 0.35))
    k = 0
    for row in range(4):
        for j in range(row + 1):
            parts += of(
                "ceramic", ball((0.16 * w + 0.052 * row, (j - row / 2) * 0.06, bed + 0.028), 0.028, 10), color=colors[k % 6]
            )
            k += 1
    parts += of("ceramic", ball((-0.24 * w, 0.03, bed + 0.028), 0.028, 10), color=WHITE)
    return Model(parts + of("light_wood", rod((-0.38 * w, -0.18 * d, bed + 0.012), (0.08 * w, -0.27 * d, bed + 0.012), 0.011)))


def tennis_table(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """A blue table with white lines and a net, two bats and a ball on it."""
    w, d, h = size
    top = h - 0.15
    parts = of(
        "dark_metal",
        *posts((-0.36 * w, 0.36 * w), (-0.38 * d, 0.38 * d), 0.0, top - 0.02, 0.05),
        *(box((s * 0.36 * w - 0.02, -0.38 * d, 0.1), (s * 0.36 * w + 0.02, 0.38 * d, 0.14)) for s in (-1, 1)),
    )
    for s in (-1, 1):
        parts += of("painted_wood", box((s * w / 2, -d / 2, top - 0.03), (s * 0.004, d / 2, top)), color=(0.1, 0.25, 0.45))
        parts += of(
            "paper",
            box((s * w / 2 - s * 0.001, -d / 2 + 0.001, top - 0.01), (s * (w / 2 - 0.02), d / 2 - 0.001, top + 0.002), 0.0),
            box((-w / 2 + 0.001, s * (d / 2 - 0.001), top - 0.01), (w / 2 - 0.001, s * (d / 2 - 0.02), top + 0.0018), 0.0),
            color=WHITE,
        )
    parts += of(
        "dark_metal", *(rod((0, s * (d / 2 + 0.05), top - 0.02), (0, s * (d / 2 + 0.05), h), 0.009) for s in (-1, 1))
    ) + of(
        "paper",
        box((-0.004, -d / 2 - 0.05, top + 0.02), (0.004, d / 2 + 0.05, h - 0.02), 0.0),
        box((-0.006, -d / 2 - 0.05, h - 0.022), (0.006, d / 2 + 0.05, h - 0.004), 0.0),
        color=WHITE,
    )
    for s in (-1, 1):
        x, y = s * 0.32 * w, s * 0.12 * d
        parts += of("painted_wood", lathe([(0.075, 0.002), (0.075, 0.014)], 20, at=(x, y, top)), color=(0.7, 0.1, 0.1)) + of(
            "light_wood", box((x - 0.014, y + 0.06, top + 0.002), (x + 0.014, y + 0.17, top + 0.02))
        )
    return Model(parts + of("paper", ball((0.1 * w, 0.05, top + 0.02), 0.02, 10), color=WHITE))


def dartboard(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """A round board of black and cream wedges with rings and three darts in it."""
    w, d, _ = size
    r = w / 2
    parts = of("lacquer", wheel((0, d / 2 - 0.03, r), r, 0.06, "y", 40), color=(0.05, 0.05, 0.05))
    for k in range(20):
        a0, a1 = 2 * math.pi * (k - 0.5) / 20, 2 * math.pi * (k + 0.5) / 20
        wedge = [
            (0.08 * r * math.cos((a0 + a1) / 2), 0.08 * r * math.sin((a0 + a1) / 2)),
            *((0.74 * r * math.cos(a), 0.74 * r * math.sin(a)) for a in np.linspace(a0, a1, 4)),
        ]
        parts += of(
            "paper",
            shift(extrude(wedge, d / 2 - 0.066, d / 2 - 0.05, "y"), (0, 0, r)),
            color=(0.1, 0.1, 0.1) if k % 2 else (0.9, 0.84, 0.7),
        )
    parts += of("lacquer", wheel((0, d / 2 - 0.056, r), 0.09 * r, 0.03, "y", 16), color=(0.7, 0.08, 0.08))
    for x, z in ((0.05, 0.1), (-0.3, 0.2), (0.2, -0.35)):
        parts += of("brass", rod((x * r, d / 2 - 0.06, r + z * r), (x * r, -d / 2 + 0.03, r + z * r + 0.004), 0.005, 6)) + of(
            "fabric_accent",
            turn(
                box((x * r - 0.016, -d / 2, r + z * r - 0.001), (x * r + 0.016, -d / 2 + 0.04, r + z * r + 0.006), 0.0),
                "y",
                40,
                (x * r, 0, r + z * r),
            ),
        )
    return Model(parts)


KINDS = {
    "billiard table": FurnitureKind(billiard_table, "floor", (1.9, 1.05, 0.8), (2.5, 1.4, 0.86)),
    "tennis table": FurnitureKind(tennis_table, "floor", (1.8, 1.0, 0.9), (2.5, 1.4, 0.92)),
    "dartboard": FurnitureKind(dartboard, "wall", (0.42, 0.14, 0.42), (0.46, 0.16, 0.46)),
}
