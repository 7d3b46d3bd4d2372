"""Things to exercise with: treadmill, exercise bike, weight bench, dumbbell rack, punching bag, yoga mat."""

import numpy as np

from wm.offline.furniture.joinery import BLACK, posts, wheel
from wm.offline.furniture.piece import FurnitureKind, Model, Part, Size, of, pick
from wm.offline.furniture.solids import Point3, Real, box, lathe, rod, rounded_box, shift, tube, turn
from wm.offline.style.finish import Style


def treadmill(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """A belt between side rails, and a console on two uprights at its back end, where one looks while running."""
    w, d, h = size
    y = d / 2 - 0.22
    parts = of("dark_metal", rounded_box((-w / 2 + 0.02, -d / 2, 0.03), (w / 2 - 0.02, d / 2, 0.15), 0.03))
    parts += of("leather", box((-w / 2 + 0.13, -d / 2 + 0.03, 0.1), (w / 2 - 0.13, d / 2 - 0.36, 0.162)), color=BLACK)
    parts += of("chrome", *(box((s * (w / 2 - 0.11), -d / 2 + 0.04, 0.1), (s * (w / 2 - 0.04), y, 0.172)) for s in (-1, 1)))
    parts += of("dark_metal", rounded_box((-w / 2, d / 2 - 0.36, 0.0), (w / 2, d / 2 - 0.01, 0.25), 0.06))
    for s in (-1, 1):
        x = s * (w / 2 - 0.07)
        parts += of("chrome", tube([(x, y, 0.1), (x, y - 0.06, h - 0.2), (x, y - 0.5, h - 0.32)], 0.025, 10))
    console = turn(rounded_box((-w / 2 + 0.04, -0.05, -0.15), (w / 2 - 0.04, 0.05, 0.16), 0.03), "x", -20)
    face = turn(box((-0.17, -0.056, -0.03), (0.17, -0.02, 0.13)), "x", -20)
    return Model(
        parts + of("dark_metal", shift(console, (0, y - 0.06, h - 0.19))) + of("screen", shift(face, (0, y - 0.06, h - 0.19)))
    )


def exercise_bike(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """A flywheel in a frame with saddle, pedals and handlebar."""
    w, d, h = size
    y = d / 2 - 0.26
    parts = of(
        "dark_metal", *(box((-w / 2, s * (d / 2 - 0.06) - 0.05, 0), (w / 2, s * (d / 2 - 0.06) + 0.05, 0.06)) for s in (-1, 1))
    )
    parts += of("dark_metal", box((-0.035, -d / 2 + 0.05, 0.03), (0.035, d / 2 - 0.05, 0.09)))
    parts += of("metal", wheel((0, y, 0.36), 0.24, 0.05)) + of("fabric_accent", wheel((0, y, 0.36), 0.1, 0.08))
    parts += of(
        "dark_metal",
        rod((0, -d / 2 + 0.3, 0.08), (0, -d / 2 + 0.22, h - 0.34), 0.03),
        rod((0, y, 0.3), (0, y - 0.06, h - 0.1), 0.03),
    )
    parts += of("dark_metal", rod((0, -0.04, 0.32), (0, y, 0.36), 0.028), wheel((0, -0.04, 0.32), 0.11, 0.06))
    for s in (-1, 1):
        parts += of("chrome", rod((s * 0.05, -0.04, 0.32), (s * 0.06, -0.04 + s * 0.1, 0.32 - s * 0.12), 0.014))
        parts += of(
            "leather", box((s * 0.06, s * 0.1 - 0.08, 0.3 - s * 0.12), (s * 0.15, s * 0.1 + 0.0, 0.33 - s * 0.12)), color=BLACK
        )
    parts += of("leather", rounded_box((-0.11, -d / 2 + 0.08, h - 0.36), (0.11, -d / 2 + 0.36, h - 0.28), 0.035), color=BLACK)
    bar = [
        (-w / 2 + 0.02, y - 0.26, h - 0.06),
        (-w / 2 + 0.04, y - 0.1, h - 0.1),
        (w / 2 - 0.04, y - 0.1, h - 0.1),
        (w / 2 - 0.02, y - 0.26, h - 0.06),
    ]
    return Model(parts + of("chrome", tube(bar, 0.016, 8)) + of("screen", box((-0.08, y - 0.09, h - 0.12), (0.08, y - 0.06, h))))


def plates(x: Real, y: Real, z: Real, side: Real) -> list[Part]:
    """Three discs of falling size on the end of a bar."""
    return of("dark_metal", *(wheel((x + side * 0.045 * k, y, z), 0.21 - 0.04 * k, 0.042) for k in range(3)))


def weight_bench(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """A padded bench, and a loaded barbell over its head on two uprights."""
    w, d, h = size
    y = d / 2 - 0.26
    parts = of(
        "leather", rounded_box((-0.15, -d / 2, 0.4), (0.15, d / 2 - 0.3, 0.48), 0.03), color=pick(rng, (BLACK, *style.accents))
    )
    parts += of("dark_metal", box((-0.04, -d / 2 + 0.035, 0.34), (0.04, d / 2 - 0.05, 0.41)))
    parts += of(
        "dark_metal",
        box((-0.4, -d / 2 + 0.02, 0.0), (0.4, -d / 2 + 0.1, 0.06)),
        box((-0.03, -d / 2 + 0.04, 0.02), (0.03, -d / 2 + 0.1, 0.36)),
    )
    parts += of(
        "dark_metal", *posts((-0.42, 0.42), (y,), 0.0, h - 0.19, 0.06), box((-0.42, y - 0.025, 0.345), (0.42, y + 0.025, 0.405))
    )
    parts += of("dark_metal", *(box((s * 0.42 - 0.035, y - 0.4, 0.0), (s * 0.42 + 0.035, d / 2, 0.05)) for s in (-1, 1)))
    parts += of("chrome", rod((-w / 2, y - 0.03, h - 0.2), (w / 2, y - 0.03, h - 0.2), 0.014))
    return Model(parts + plates(w / 2 - 0.16, y - 0.03, h - 0.2, 1) + plates(-w / 2 + 0.16, y - 0.03, h - 0.2, -1))


def dumbbell(at: Point3, length: Real, radius: Real) -> list[Part]:
    """A dumbbell that lies along y."""
    x, y, z = at
    heads = [wheel((x, y + s * (length / 2 - 0.035), z), radius, 0.07, "y", 8) for s in (-1, 1)]
    return of("dark_metal", *heads) + of("chrome", rod((x, y - length / 2, z), (x, y + length / 2, z), 0.013))


def dumbbell_rack(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """Two tilted shelves of dumbbells between end frames, heavy ones below."""
    w, d, h = size
    parts: list[Part] = []
    for s in (-1, 1):
        x = s * (w / 2 - 0.03)
        parts += of(
            "metal",
            box((x - 0.03, -d / 2, 0.0), (x + 0.03, d / 2, 0.06)),
            rod((x, -d / 2 + 0.06, 0.03), (x, d / 2 - 0.06, h), 0.028),
        )
        parts += of("metal", rod((x, d / 2 - 0.05, 0.03), (x, d / 2 - 0.06, h - 0.01), 0.026))
    for level, radius in ((0.28, 0.075), (h - 0.16, 0.058)):
        y = 0.1 * d * (level / h) - 0.02
        parts += of(
            "metal",
            *(box((-w / 2 + 0.02, y + s * 0.1 - 0.03, level - 0.02), (w / 2 - 0.02, y + s * 0.1 + 0.03, level)) for s in (-1, 1)),
        )
        count = int((w - 0.16) / (2.25 * radius))
        for k in range(count):
            x = -w / 2 + 0.08 + (k + 0.5) * (w - 0.16) / count
            parts += dumbbell((x, y, level + radius - 0.004), min(0.34, d - 0.08), radius)
    return Model(parts)


def punching_bag(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """A leather bag on a bent stand."""
    w, d, h = size
    parts = of("dark_metal", rounded_box((-w / 2, -d / 2, 0.0), (w / 2, d / 2, 0.06), 0.02))
    parts += of("dark_metal", tube([(0, d / 2 - 0.08, 0.03), (0, d / 2 - 0.08, h - 0.04), (0, -0.1, h - 0.03)], 0.035, 10))
    parts += of("chrome", rod((0, -0.08, h - 0.05), (0, -0.08, h - 0.32), 0.012))
    bag = [(0.12, 0.42), (0.17, 0.46), (0.17, h - 0.36), (0.08, h - 0.28)]
    return Model(parts + of("leather", lathe(bag, 24, at=(0, -0.08, 0)), color=pick(rng, ((0.5, 0.07, 0.06), (0.1, 0.1, 0.11)))))


def yoga_mat(style: Style, rng: np.random.Generator, size: Size) -> Model:
    w, d, h = size
    sheet = of("rug", rounded_box((-w / 2, -d / 2, 0.0), (w / 2, d / 2, h), 0.003, 1), color=pick(rng, style.accents))
    return Model(sheet)


KINDS = {
    "treadmill": FurnitureKind(treadmill, "floor", (0.74, 1.55, 1.3), (0.84, 1.75, 1.42), front=0.3),
    "exercise bike": FurnitureKind(exercise_bike, "floor", (0.5, 1.0, 1.12), (0.56, 1.15, 1.25)),
    "weight bench": FurnitureKind(weight_bench, "floor", (1.5, 1.3, 1.15), (1.7, 1.45, 1.3)),
    "dumbbell rack": FurnitureKind(dumbbell_rack, "floor", (1.2, 0.5, 0.8), (1.6, 0.56, 0.92), front=0.4),
    "punching bag": FurnitureKind(punching_bag, "floor", (0.6, 0.8, 1.75), (0.7, 0.9, 1.95)),
    "yoga mat": FurnitureKind(yoga_mat, "flat", (0.6, 1.7, 0.008), (0.68, 1.85, 0.008)),
}
