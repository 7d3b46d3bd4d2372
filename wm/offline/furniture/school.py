"""Things to learn and research with: pupil desk, blackboard, easel, lab bench, telescope."""

import math

import numpy as np

from wm.offline.furniture.common import frame_wood
from wm.offline.furniture.joinery import WHITE, wheel
from wm.offline.furniture.piece import FurnitureKind, Model, Part, Size, Top, of, pick
from wm.offline.furniture.solids import ball, box, lathe, rod, rounded_box, shift, stretch, tube, turn
from wm.offline.style.finish import Style

CHALKBOARD = (0.07, 0.17, 0.13)


def pupil_desk(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """A small desk on a steel frame with a shelf for books and an exercise book on it; one sits at its front."""
    w, d, h = size
    xs, ys = (-w / 2 + 0.04, w / 2 - 0.04), (-d / 2 + 0.05, d / 2 - 0.05)
    parts = of("metal", *(rod((x, y, 0.0), (x, y, h - 0.02), 0.016) for x in xs for y in ys))
    parts += of("metal", *(rod((x, ys[0], 0.06), (x, ys[1], 0.06), 0.015) for x in xs))
    parts += of(frame_wood(style), rounded_box((-w / 2, -d / 2, h - 0.028), (w / 2, d / 2, h), 0.01, 1))
    parts += of(
        "metal",
        box((-w / 2 + 0.06, -d / 2 + 0.08, h - 0.15), (w / 2 - 0.06, d / 2 - 0.06, h - 0.135)),
        box((-w / 2 + 0.06, d / 2 - 0.07, h - 0.148), (w / 2 - 0.06, d / 2 - 0.058, h - 0.02)),
    )
    parts += of("book", box((-0.12, -0.1, h - 0.134), (0.08, 0.12, h - 0.08)), color=pick(rng, style.accents))
    parts += of(
        "paper",
        shift(
            turn(box((-0.1, -0.14, 0.0), (0.1, 0.14, 0.008), 0.001), "z", float(rng.uniform(-8, 8))), (-0.04, -0.04, h + 0.001)
        ),
    )
    return Model(parts + of("wood", rod((0.14 * w, -0.12, h + 0.005), (0.2 * w, 0.04, h + 0.005), 0.004)))


def blackboard(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """A green board in a wooden frame, chalk lines on it, chalk and sponge on its ledge."""
    w, d, h = size
    wood = frame_wood(style)
    parts = of("painted_wood", box((-w / 2 + 0.03, -0.006, 0.05), (w / 2 - 0.03, d / 2, h - 0.03)), color=CHALKBOARD)
    parts += of(wood, box((-w / 2, -0.02, h - 0.05), (w / 2, d / 2, h)), box((-w / 2, -d / 2, 0.0), (w / 2, d / 2, 0.06)))
    parts += of(wood, *(box((s * w / 2, -0.018, 0.05), (s * (w / 2 - 0.05), d / 2 - 0.001, h - 0.04)) for s in (-1, 1)))
    for k in range(4):
        z, long = h - 0.22 - 0.16 * k, float(rng.uniform(0.25, 0.42)) * w
        parts += of("paper", box((-w / 2 + 0.15, -0.009, z), (-w / 2 + 0.15 + long, 0.0, z + 0.025), 0.0), color=WHITE)
    parts += of(
        "paper",
        *(
            rod((0.12 * w, -0.006, 0.3 * h + 0.3 * h * a), (0.36 * w, -0.006, 0.3 * h + 0.3 * h * b), 0.006)
            for a, b in ((0, 0), (0, 1.2), (1.2, 0))
        ),
        color=WHITE,
    )
    chalk = [rod((x, -d / 2 + 0.02, 0.066), (x + 0.08, -d / 2 + 0.02, 0.066), 0.007) for x in (0.1, 0.22)]
    return Model(
        parts
        + of("paper", *chalk, color=WHITE)
        + of("fabric", box((-0.3, -d / 2 + 0.006, 0.055), (-0.18, -0.025, 0.1)), color=(0.85, 0.7, 0.3))
    )


def easel(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """A painter's tripod with a canvas in work."""
    w, d, h = size
    wood = frame_wood(style)
    parts = of(
        wood,
        *(rod((s * (w / 2 - 0.03), -d / 2 + 0.04, 0.0), (s * 0.06, 0.02, h - 0.02), 0.02) for s in (-1, 1)),
        rod((0, d / 2 - 0.02, 0.0), (0, 0.03, h - 0.1), 0.02),
    )
    lean, foot = math.degrees(math.atan2(d / 2 - 0.02, h)), 0.34 * h
    canvas = of(wood, box((-0.42 * w, -0.09, -0.03), (0.42 * w, 0.03, 0.0)), box((-0.025, -0.01, -0.06), (0.025, 0.02, 0.62 * h)))
    canvas += of("paper", box((-0.4 * w, -0.055, 0.001), (0.4 * w, -0.015, 0.5 * h)))
    canvas += of("painting", box((-0.385 * w, -0.059, 0.015), (0.385 * w, -0.03, 0.5 * h - 0.015), 0.0))
    for _ in range(5):
        at = float(rng.uniform(-0.25, 0.25)) * w, -0.059, float(rng.uniform(0.1, 0.4)) * h
        stroke = stretch(ball((0, 0, 0), float(rng.uniform(0.03, 0.08)), 10), (1.4, 0.1, 1.0))
        canvas += of("paper", shift(stroke, at), color=pick(rng, style.accents))
    y = -d / 2 + 0.04 + foot / h * (d / 2 - 0.02) - 0.04
    return Model(parts + [Part(p.slot, shift(turn(p.solid, "x", -lean), (0, y, foot)), p.color) for p in canvas])


def lab_bench(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """A bench with drawers, a sink with a tap, a microscope, flasks and a stand of test tubes on it."""
    w, d, h = size
    top = 0.9
    parts = of("painted_wood", box((-w / 2 + 0.01, -d / 2 + 0.05, 0.08), (w / 2 - 0.01, d / 2, top - 0.03)), color=WHITE)
    parts += of(
        "dark_metal",
        box((-w / 2 + 0.03, -d / 2 + 0.1, 0.0), (w / 2 - 0.03, d / 2 - 0.03, 0.1)),
        box((-w / 2, -d / 2, top - 0.035), (w / 2, d / 2, top)),
    )
    count = max(int(w / 0.42), 3)
    for k in range(count):
        x0, x1 = (-w / 2 + 0.02 + (w - 0.04) * (k + e) / count for e in (0, 1))
        for z0, z1 in ((0.1, 0.62), (0.63, top - 0.045)):
            parts += of(
                "painted_wood", box((x0 + 0.006, -d / 2 + 0.03, z0), (x1 - 0.006, -d / 2 + 0.07, z1)), color=(0.82, 0.86, 0.87)
            )
            parts += of(
                "chrome",
                box(((x0 + x1) / 2 - 0.05, -d / 2 + 0.012, z1 - 0.07), ((x0 + x1) / 2 + 0.05, -d / 2 + 0.04, z1 - 0.055)),
            )
    x = -w / 2 + 0.3
    parts += of(
        "chrome",
        tube(
            [(x, d / 2 - 0.1, top), (x, d / 2 - 0.1, top + 0.28), (x, d / 2 - 0.26, top + 0.26), (x, d / 2 - 0.27, top + 0.2)],
            0.012,
            8,
            smooth=3,
        ),
        rounded_box((x - 0.2, -0.2, top - 0.02), (x + 0.2, d / 2 - 0.14, top + 0.004), 0.01),
    )
    parts += microscope(0.02 * w, 0.0, top, h - top)
    for k in range(3):
        flask = lathe(
            [(0.055, 0.0), (0.06, 0.01), (0.02, 0.12), (0.018, 0.17), (0.022, 0.175)],
            16,
            at=(w / 2 - 0.5 + 0.15 * k, 0.05 * (-1) ** k, top),
        )
        parts += of("glass", flask, color=((0.25, 0.6, 0.85), (0.45, 0.8, 0.35), (0.9, 0.55, 0.2))[k])
    return Model(parts, (Top(top, 0.1 * w + 0.1, d / 2 - 0.2, w / 2 - 0.04, d / 2 - 0.02),))


def microscope(x: float, y: float, z: float, tall: float) -> list[Part]:
    parts = of(
        "dark_metal",
        rounded_box((x - 0.08, y - 0.12, z), (x + 0.08, y + 0.1, z + 0.03), 0.01, 1),
        box((x - 0.06, y - 0.09, z + 0.3 * tall), (x + 0.06, y + 0.05, z + 0.3 * tall + 0.015)),
    )
    parts += of(
        "appliance",
        tube([(x, y + 0.07, z + 0.02), (x, y + 0.09, z + 0.5 * tall), (x, y - 0.02, z + 0.75 * tall)], 0.025, 10, smooth=2),
    )
    parts += of("chrome", rod((x, y - 0.03, z + 0.38 * tall), (x, y - 0.03, z + 0.8 * tall), 0.02))
    return (
        parts
        + of("dark_metal", rod((x, y - 0.02, z + 0.74 * tall), (x, y - 0.1, z + tall), 0.022))
        + of("chrome", wheel((x, y + 0.08, z + 0.3 * tall), 0.03, 0.12))
    )


def telescope(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """A brass tube on a wooden tripod, pointing up."""
    w, d, h = size
    hub = (0.0, 0.0, 0.62 * h)
    feet = [(0.46 * w * float(np.cos(a)), 0.46 * d * float(np.sin(a)), 0.0) for a in (np.pi / 2, np.pi * 7 / 6, np.pi * 11 / 6)]
    parts = of(frame_wood(style), *(rod(foot, hub, 0.024) for foot in feet)) + of(
        "dark_metal", *(ball((x, y, 0.02), 0.022, 8) for x, y, _ in feet)
    )
    parts += of("brass", ball(hub, 0.06, 12), rod(hub, (0, 0, 0.72 * h), 0.03))
    y0, y1, z0, z1 = 0.4 * d, -0.42 * d, 0.56 * h, 0.95 * h
    at = [(0.0, y0 + (y1 - y0) * t, z0 + (z1 - z0) * t) for t in (0.0, 0.14, 0.15, 0.55, 0.56, 0.96, 0.97, 1.0)]
    return Model(parts + of("brass", tube(at, [0.028, 0.028, 0.05, 0.05, 0.07, 0.07, 0.085, 0.085], 20)))


KINDS = {
    "pupil desk": FurnitureKind(pupil_desk, "floor", (0.66, 0.48, 0.7), (0.76, 0.54, 0.76)),
    "blackboard": FurnitureKind(blackboard, "wall", (1.8, 0.12, 1.0), (2.6, 0.14, 1.2)),
    "easel": FurnitureKind(easel, "floor", (0.7, 0.7, 1.6), (0.8, 0.8, 1.85)),
    "lab bench": FurnitureKind(lab_bench, "floor", (1.5, 0.66, 1.24), (2.0, 0.76, 1.32), front=0.6),
    "telescope": FurnitureKind(telescope, "floor", (0.8, 1.1, 1.5), (0.95, 1.4, 1.75)),
}
