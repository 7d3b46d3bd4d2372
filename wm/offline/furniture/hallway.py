"""What stands where one comes in: coat rack and umbrella stand."""

import math

import numpy as np

from wm.offline.furniture.common import frame_wood
from wm.offline.furniture.piece import FurnitureKind, Model, Part, Size, of, pick
from wm.offline.furniture.solids import ball, lathe, puff, rod, rounded_box, shell, shift, tube, turn
from wm.offline.style.finish import Style


def coat_rack(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """A stand with hooks all around, a coat or two, a hat and a bag on it."""
    w, _, h = size
    wood, r = frame_wood(style), w / 2
    parts = of(wood, lathe([(0.03, 0.05), (0.026, h - 0.1), (0.03, h - 0.05)], 14), ball((0, 0, h - 0.03), 0.035, 12))
    for k in range(4):
        a = math.pi / 2 * k + math.pi / 4
        c, s = math.cos(a), math.sin(a)
        parts += of(
            wood,
            tube(
                [(0.02 * c, 0.02 * s, 0.22), (0.6 * r * c, 0.6 * r * s, 0.1), (1.2 * r * c, 1.2 * r * s, 0.02)], 0.02, 8, smooth=2
            ),
        )
        parts += of(
            wood,
            tube(
                [(0.02 * c, 0.02 * s, h - 0.26), (0.45 * r * c, 0.45 * r * s, h - 0.2), (0.6 * r * c, 0.6 * r * s, h - 0.08)],
                0.012,
                8,
                smooth=2,
            ),
        )
        parts += of("brass", ball((0.6 * r * c, 0.6 * r * s, h - 0.08), 0.018, 8))
        if k < 2:
            coat = rounded_box((-0.07, -0.17, 0.62), (0.07, 0.17, h - 0.17), 0.06)
            parts += of(
                "fabric", shift(turn(coat, "z", math.degrees(a)), (0.55 * r * c, 0.55 * r * s, 0)), color=pick(rng, style.accents)
            )
    hat = [(0.15, 0.0), (0.16, 0.012), (0.09, 0.03), (0.085, 0.11), (0.06, 0.13)]
    parts += of("fabric", lathe(hat, 20, at=(-0.42 * r, -0.42 * r, h - 0.1)), color=(0.2, 0.16, 0.13))
    bag = puff((-0.13, -0.05, 0.0), (0.13, 0.05, 0.28), square=0.3)
    return Model(
        parts
        + of(
            "leather",
            shift(turn(bag, "z", -45), (0.4 * r, -0.4 * r, h - 0.62)),
            tube([(0.4 * r, -0.4 * r, h - 0.36), (0.42 * r, -0.42 * r, h - 0.1)], 0.01, 6),
        )
    )


def umbrella_stand(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """A tall pot with furled umbrellas and a walking stick in it."""
    w, _, h = size
    r, rim = w / 2, 0.62 * h
    parts: list[Part] = of(
        "brass" if style.form.ornament > 0.3 else "dark_metal",
        shell([(0.86 * r, 0.0), (0.94 * r, 0.5 * rim), (r, rim)], 0.012),
        lathe([(0.84 * r, 0.004), (0.84 * r, 0.03)], 24),
    )
    for k in range(3):
        a = 2.1 * k + float(rng.uniform(-0.3, 0.3))
        c, s = math.cos(a), math.sin(a)
        foot, top = (-0.3 * r * c, -0.3 * r * s, 0.03), (0.75 * r * c, 0.75 * r * s, h - 0.05)
        if k == 2:
            parts += of(frame_wood(style), rod(foot, top, 0.011))
        else:
            parts += of(
                "fabric",
                tube(
                    [foot, (0.1 * r * c, 0.1 * r * s, 0.3 * h), (0.55 * r * c, 0.55 * r * s, 0.82 * h)], [0.008, 0.026, 0.034], 8
                ),
                color=pick(rng, style.accents),
            )
            parts += of("dark_metal", rod((0.5 * r * c, 0.5 * r * s, 0.78 * h), top, 0.006))
        hook = [
            top,
            (top[0] + 0.01 * c, top[1] + 0.01 * s, h - 0.012),
            (top[0] + 0.05 * c, top[1] + 0.05 * s, h - 0.012),
            (top[0] + 0.06 * c, top[1] + 0.06 * s, h - 0.06),
        ]
        parts += of("wood", tube(hook, 0.01, 8, smooth=2))
    return Model(parts)


KINDS = {
    "coat rack": FurnitureKind(coat_rack, "floor", (0.46, 0.46, 1.65), (0.54, 0.54, 1.8)),
    "umbrella stand": FurnitureKind(umbrella_stand, "floor", (0.22, 0.22, 0.8), (0.26, 0.26, 0.9)),
}
