"""Simple parts that equipment is put together from: posts, wheels, boards between sides, jars, bottles and boxes in a row."""

import numpy as np

from wm.offline.furniture.piece import Part, of, pick
from wm.offline.furniture.solids import Point3, Real, Solid, box, lathe, shift, turn
from wm.offline.style.finish import Rgb, Style

BOTTLE = [(0.9, 0.0), (1.0, 0.04), (1.0, 0.55), (0.36, 0.72), (0.32, 0.96), (0.4, 1.0)]
JAR = [(0.9, 0.0), (1.0, 0.06), (1.0, 0.72), (0.72, 0.8), (0.84, 0.82), (0.84, 1.0)]
WHITE: Rgb = (0.92, 0.92, 0.91)
STEEL: Rgb = (0.62, 0.64, 0.66)
BLACK: Rgb = (0.07, 0.07, 0.08)
GLASSES: tuple[Rgb, ...] = ((0.1, 0.28, 0.14), (0.42, 0.2, 0.05), (0.72, 0.45, 0.12), (0.75, 0.8, 0.78), (0.35, 0.05, 0.08))
"""Colours of bottles."""
PRESERVES: tuple[Rgb, ...] = ((0.75, 0.3, 0.1), (0.55, 0.06, 0.1), (0.82, 0.68, 0.3), (0.35, 0.42, 0.14), (0.88, 0.82, 0.7))
"""Colours of what is kept in jars."""


def posts(xs: tuple[Real, ...], ys: tuple[Real, ...], z0: Real, z1: Real, side: Real) -> list[Solid]:
    """Square posts at every (x, y), from z0 to z1."""
    r = side / 2
    return [box((x - r, y - r, z0), (x + r, y + r, z1)) for x in xs for y in ys]


def wheel(at: Point3, radius: Real, width: Real, axis: str = "x", segments: int = 20) -> Solid:
    """A disc with rounded edges whose axle lies along "x" or "y"."""
    rim = 0.12 * radius
    profile = [(radius - rim, -width / 2), (radius, -0.32 * width), (radius, 0.32 * width), (radius - rim, width / 2)]
    disc = lathe(profile, segments)
    return shift(turn(disc, "y", 90) if axis == "x" else turn(disc, "x", 90), at)


def bottles(rng: np.random.Generator, x0: Real, x1: Real, y: Real, z: Real, height: Real) -> list[Part]:
    """A row of bottles that stand on z between x0 and x1."""
    return _vessels("glass", BOTTLE, GLASSES, rng, (x0, x1), (y, z), height, 0.038)


def jars(rng: np.random.Generator, x0: Real, x1: Real, y: Real, z: Real, height: Real) -> list[Part]:
    """A row of jars with lids that stand on z between x0 and x1."""
    return _vessels("ceramic", JAR, PRESERVES, rng, (x0, x1), (y, z), height, 0.05)


def _vessels(
    slot: str,
    profile: list[tuple[float, float]],
    colors: tuple[Rgb, ...],
    rng: np.random.Generator,
    span: tuple[Real, Real],
    at: tuple[Real, Real],
    height: Real,
    radius: Real,
) -> list[Part]:
    count = max(int((span[1] - span[0]) / (2.4 * radius)), 1)
    pitch = (span[1] - span[0]) / count
    parts: list[Part] = []
    for k in range(count):
        tall = height * float(rng.uniform(0.8, 1.0))
        turned = lathe([(radius * r, tall * z) for r, z in profile], 10)
        parts += of(slot, shift(turned, (span[0] + (k + 0.5) * pitch, at[0], at[1])), color=pick(rng, colors))
    return parts


def cartons(
    style: Style, rng: np.random.Generator, x0: Real, x1: Real, y0: Real, y1: Real, z: Real, height: Real, *, wide: Real = 0.18
) -> list[Part]:
    """Boxes of goods side by side on z, their fronts about y0, in the style's colours and brown card."""
    count = max(int((x1 - x0) / wide), 1)
    pitch = (x1 - x0) / count
    colors = (*style.accents, (0.66, 0.5, 0.32))
    parts: list[Part] = []
    for k in range(count):
        left = x0 + k * pitch
        front, tall = y0 + float(rng.uniform(0.0, 0.2)) * (y1 - y0), height * float(rng.uniform(0.6, 1.0))
        parts += of("paper", box((left + 0.006, front, z), (left + pitch - 0.006, y1, z + tall)), color=pick(rng, colors))
    return parts
