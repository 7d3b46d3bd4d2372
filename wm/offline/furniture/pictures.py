"""Framed pictures: landscapes, seas, portraits, still lifes, botanical sheets, temples, plans of clockwork, plain shapes.

A picture consists of flat shapes in thin layers in front of its canvas, in muted colours of the style.
"""

import dataclasses
import math
from collections.abc import Callable

import numpy as np
import shapely
import shapely.affinity
from shapely.geometry.base import BaseGeometry

from wm.offline.furniture.outlines import circle, gear
from wm.offline.furniture.piece import Part, of
from wm.offline.furniture.solids import Real, box, extrude
from wm.offline.style.finish import Rgb, Style
from wm.offline.style.style_sheet import mix_rgb

LAYER = 0.0012
"""Metres between two layers of paint."""
CREAM: Rgb = (0.93, 0.89, 0.80)
SHADE: Rgb = (0.16, 0.14, 0.13)


@dataclasses.dataclass(frozen=True, eq=False)
class Canvas:
    """A canvas that faces -y. Shapes on it have x from -1 to 1 and z from 0 at its lower edge to 1 at its upper edge."""

    half: float  # metres from its middle to its side
    low: float  # metres
    high: float
    face: float  # y of the canvas
    colors: tuple[Rgb, ...]  # of the style's accents, in an order of its own

    def paint(self, shape: BaseGeometry, layer: int, color: Rgb) -> list[Part]:
        """The part of a shape (in metres) that lies on the canvas, in front of `layer` other layers."""
        inside = shape.intersection(shapely.box(-self.half, self.low, self.half, self.high)).simplify(2e-4)
        front = self.face - LAYER * (layer + 1)
        polygons = [p for p in shapely.get_parts(inside) if isinstance(p, shapely.Polygon) and p.area > 1e-5]
        return [part for p in polygons for part in of("painting", extrude(p, front, self.face + 0.001, "y"), color=color)]

    def at(self, x: Real, z: Real) -> tuple[float, float]:
        return x * self.half, self.low + z * (self.high - self.low)

    def path(self, *points: tuple[Real, Real]) -> shapely.Polygon:
        return shapely.Polygon([self.at(x, z) for x, z in points])

    def disc(self, x: Real, z: Real, share: Real) -> shapely.Polygon:
        """A disc whose radius is a share of the smaller side of the canvas."""
        return circle(share * min(2 * self.half, self.high - self.low), at=self.at(x, z), segments=20)

    def ridge(self, rng: np.random.Generator, level: Real, rise: Real) -> shapely.Polygon:
        """The area below a random smooth skyline."""
        t = np.linspace(-1, 1, 15)
        phase, waves = rng.uniform(0, 6, 2), float(rng.uniform(1.2, 2.4))
        line = level + rise * (0.6 * np.sin(waves * t + phase[0]) + 0.4 * np.sin(2.3 * waves * t + phase[1]))
        return self.path((-1, 0), (1, 0), *zip(t[::-1].tolist(), line[::-1].tolist()))


def landscape(c: Canvas, rng: np.random.Generator) -> list[Part]:
    """Three ridges under a pale sky, a sun low or high."""
    sky = mix_rgb(c.colors[0], CREAM, 0.72)
    parts = c.paint(c.path((-1, 0), (1, 0), (1, 1), (-1, 1)), 0, sky)
    parts += c.paint(
        c.disc(float(rng.uniform(-0.6, 0.6)), float(rng.uniform(0.62, 0.82)), 0.09), 1, mix_rgb(c.colors[1], CREAM, 0.45)
    )
    for k, level in enumerate((0.52, 0.36, 0.2)):
        parts += c.paint(
            c.ridge(rng, level, 0.08), 2 + k, mix_rgb(mix_rgb(c.colors[2], CREAM, 0.5 - 0.22 * k), SHADE, 0.05 + 0.12 * k)
        )
    return parts


def sea(c: Canvas, rng: np.random.Generator) -> list[Part]:
    """A horizon, sails on it, and the beach."""
    water: Rgb = (0.36, 0.55, 0.64)
    parts = c.paint(c.path((-1, 0), (1, 0), (1, 1), (-1, 1)), 0, mix_rgb(water, CREAM, 0.78))
    parts += c.paint(c.path((-1, 0), (1, 0), (1, 0.55), (-1, 0.55)), 1, water)
    parts += c.paint(c.ridge(rng, 0.2, 0.04), 2, (0.88, 0.81, 0.66))
    for k in range(2):
        x, tall = float(rng.uniform(-0.7, 0.5)) + 0.3 * k, 0.26 - 0.1 * k
        parts += c.paint(c.path((x, 0.5), (x + 0.2 * tall * 3, 0.5), (x, 0.5 + tall)), 3, CREAM)
        parts += c.paint(
            c.path((x - 0.12, 0.49), (x + 0.2, 0.49), (x + 0.14, 0.45), (x - 0.08, 0.45)), 4, mix_rgb(c.colors[k], SHADE, 0.4)
        )
    return parts


def portrait(c: Canvas, rng: np.random.Generator) -> list[Part]:
    """Head and shoulders before a dark ground."""
    skin: Rgb = (0.80, 0.62, 0.50)
    parts = c.paint(c.path((-1, 0), (1, 0), (1, 1), (-1, 1)), 0, mix_rgb(c.colors[0], SHADE, 0.62))
    x = float(rng.uniform(-0.1, 0.1))
    tall = c.high - c.low
    head = shapely.affinity.translate(shapely.affinity.scale(circle(0.13 * tall), 0.78, 1.0), *c.at(x, 0.63))
    hair = shapely.affinity.translate(shapely.affinity.scale(circle(0.16 * tall), 0.85, 0.95), *c.at(x, 0.66))
    wide = 0.3 * tall
    base = c.at(x, 0.0)
    coat = shapely.affinity.translate(shapely.affinity.scale(circle(1.0), wide, 0.42 * tall), *base)
    parts += c.paint(hair, 1, mix_rgb((0.30, 0.20, 0.13), c.colors[3], 0.15))
    parts += c.paint(
        shapely.box(c.at(x, 0)[0] - 0.045 * tall, base[1] + 0.3 * tall, base[0] + 0.045 * tall, base[1] + 0.56 * tall), 2, skin
    )
    parts += c.paint(coat, 3, mix_rgb(c.colors[1], SHADE, 0.25))
    parts += c.paint(shapely.affinity.translate(shapely.affinity.scale(circle(0.075 * tall), 0.9, 1.5), *c.at(x, 0.36)), 4, CREAM)
    return parts + c.paint(head, 5, skin)


def still_life(c: Canvas, rng: np.random.Generator) -> list[Part]:
    """A jug and fruit on a table."""
    parts = c.paint(c.path((-1, 0), (1, 0), (1, 1), (-1, 1)), 0, mix_rgb(c.colors[0], mix_rgb(CREAM, SHADE, 0.5), 0.55))
    parts += c.paint(c.path((-1, 0), (1, 0), (1, 0.32), (-1, 0.32)), 1, mix_rgb((0.45, 0.30, 0.19), c.colors[0], 0.2))
    x = float(rng.uniform(-0.35, -0.05))
    right = ((0.1, 0.2), (0.24, 0.36), (0.2, 0.55), (0.08, 0.64), (0.13, 0.74))
    jug = (*right, *((-a, b) for a, b in right[::-1]))
    parts += c.paint(c.path(*((x + a, b) for a, b in jug)).buffer(0.008), 2, mix_rgb(c.colors[1], CREAM, 0.3))
    for k in range(4):
        fruit = mix_rgb(c.colors[(2 + k) % len(c.colors)], (0.8, 0.45, 0.2), 0.4)
        parts += c.paint(c.disc(x + 0.34 + 0.17 * k, 0.24 + 0.07 * (k % 2), 0.075), 3 + k, fruit)
    return parts


def botanical(c: Canvas, rng: np.random.Generator) -> list[Part]:
    """One pressed plant on a pale sheet."""
    parts = c.paint(c.path((-1, 0), (1, 0), (1, 1), (-1, 1)), 0, mix_rgb(CREAM, c.colors[3], 0.12))
    green = mix_rgb((0.30, 0.43, 0.26), c.colors[0], 0.3)
    bend = float(rng.uniform(-0.16, 0.16))
    t = np.linspace(0.08, 0.92, 9)
    stem = [c.at(bend * math.sin(3 * z), z) for z in t.tolist()]
    parts += c.paint(shapely.LineString(stem).buffer(0.006), 1, mix_rgb(green, SHADE, 0.3))
    tall = c.high - c.low
    for k, (x, z) in enumerate(stem[2:]):
        long = (0.24 - 0.018 * k) * tall
        for side in (-1.0, 1.0):
            leaf = shapely.affinity.scale(circle(0.5 * long, at=(0.5 * long, 0.0)), 1.0, 0.32, origin=(0, 0))
            turned = shapely.affinity.rotate(leaf, 90 - side * (58 - 3 * k), origin=(0, 0))
            parts += c.paint(shapely.affinity.translate(turned, x, z), 2 + k % 2, mix_rgb(green, CREAM, 0.06 * k))
    return parts


def shapes(c: Canvas, rng: np.random.Generator) -> list[Part]:
    """Large soft shapes: an arch, a disc and a bar that overlap."""
    parts = c.paint(c.path((-1, 0), (1, 0), (1, 1), (-1, 1)), 0, mix_rgb(CREAM, c.colors[3], 0.15))
    x = float(rng.uniform(-0.35, 0.1))
    low = c.at(x, 0.0)
    radius = 0.3 * min(2 * c.half, c.high - c.low)
    arch = c.disc(x, 0.45, 0.3).union(shapely.box(low[0] - radius, low[1], low[0] + radius, c.at(x, 0.45)[1]))
    parts += c.paint(arch, 1, mix_rgb(c.colors[0], CREAM, 0.25))
    parts += c.paint(c.disc(x + 0.55, 0.68, 0.17), 2, mix_rgb(c.colors[1], CREAM, 0.15))
    parts += c.paint(c.ridge(rng, 0.22, 0.06), 3, mix_rgb(c.colors[2], CREAM, 0.2))
    return parts + c.paint(
        c.path((x - 0.5, 0.1), (x + 0.75, 0.1), (x + 0.75, 0.13), (x - 0.5, 0.13)), 4, mix_rgb(c.colors[4], SHADE, 0.3)
    )


def temple(c: Canvas, rng: np.random.Generator) -> list[Part]:
    """Columns and a pediment on a hill, cypresses beside it."""
    parts = c.paint(c.path((-1, 0), (1, 0), (1, 1), (-1, 1)), 0, (0.74, 0.80, 0.80))
    parts += c.paint(c.ridge(rng, 0.5, 0.07), 1, (0.56, 0.60, 0.56))
    parts += c.paint(c.ridge(rng, 0.24, 0.05), 2, (0.62, 0.54, 0.33))
    x, stone = float(rng.uniform(-0.3, 0.3)), (0.90, 0.84, 0.71)
    parts += c.paint(c.path((x - 0.46, 0.62), (x + 0.46, 0.62), (x, 0.8)), 3, stone)
    parts += c.paint(c.path((x - 0.46, 0.22), (x + 0.46, 0.22), (x + 0.46, 0.27), (x - 0.46, 0.27)), 3, stone)
    for k in range(5):
        a = x - 0.38 + 0.19 * k
        parts += c.paint(
            c.path((a - 0.035, 0.26), (a + 0.035, 0.26), (a + 0.035, 0.63), (a - 0.035, 0.63)), 4, mix_rgb(stone, SHADE, 0.08)
        )
    for a in (x - 0.68, x + 0.64, x + 0.8):
        parts += c.paint(
            c.path((a - 0.06, 0.2), (a + 0.06, 0.2), (a + 0.07, 0.4), (a, 0.74), (a - 0.07, 0.4)), 5, (0.22, 0.30, 0.20)
        )
    return parts


def plan_of_wheels(c: Canvas, rng: np.random.Generator) -> list[Part]:
    """A plan of a gear train in pale ink on dark paper."""
    parts = c.paint(c.path((-1, 0), (1, 0), (1, 1), (-1, 1)), 0, (0.14, 0.24, 0.27))
    size = min(2 * c.half, c.high - c.low)
    ink = mix_rgb(CREAM, c.colors[1], 0.25)
    for x, z, share, teeth in ((-0.25, 0.42, 0.27, 24), (0.42, 0.68, 0.17, 15), (0.5, 0.24, 0.12, 11)):
        parts += c.paint(gear(share * size, teeth, turned=float(rng.uniform(0, 1)), at=c.at(x, z)), 1, ink)
    for z in (0.07, 0.93):
        parts += c.paint(c.path((-0.92, z), (0.92, z), (0.92, z + 0.012), (-0.92, z + 0.012)), 1, ink)
    return parts


SUBJECTS: dict[str, tuple[Callable[[Canvas, np.random.Generator], list[Part]], ...]] = {
    "gothic": (portrait, landscape, still_life),
    "victorian": (portrait, landscape, still_life, botanical),
    "baroque": (portrait, landscape, still_life),
    "roman": (temple, landscape, still_life),
    "clockwork": (plan_of_wheels, botanical, landscape),
    "scandinavian": (shapes, botanical, landscape),
    "coastal": (sea, botanical, sea, landscape),
    "surreal": (shapes, landscape, portrait),
}
"""The subjects of each style family. Families that are not listed have landscapes, shapes and plants."""


def subject(style: Style, rng: np.random.Generator, *, half: float, low: float, high: float, face: float) -> list[Part]:
    """The painted parts of one picture."""
    table = SUBJECTS.get(style.family, (landscape, shapes, botanical))
    colors = tuple(style.accents[int(k)] for k in rng.permutation(len(style.accents)))
    canvas = Canvas(half=half, low=low, high=high, face=face, colors=colors)
    ground = of("painting", box((-half, face, low), (half, 0.002, high), 0.0), color=mix_rgb(colors[0], CREAM, 0.6))
    return ground + table[int(rng.integers(len(table)))](canvas, rng)
