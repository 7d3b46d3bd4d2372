"""Seats of antiquity: the klismos with sabre legs and a bowed back rail, and the couch with scrolled ends."""

import math

import numpy as np
import shapely

from wm.offline.furniture.common import leg
from wm.offline.furniture.piece import Model, Part, Size, of, pick
from wm.offline.furniture.solids import Point3, Real, Solid, ball, box, extrude, puff, rounded_box, shift, tube, turn
from wm.offline.style.finish import Rgb, Style


def sabre_legs(w: Real, d: Real, seat: Real, *, sweep: Real = 0.06, thick: Real = 0.026) -> list[Solid]:
    """Legs of a klismos: swept forward and back."""
    solids = []
    for sx in (-1.0, 1.0):
        for sy in (-1.0, 1.0):
            x, y = sx * (w / 2 - 0.03), sy * (d / 2 - 0.03)
            path = [
                (x, y + sy * sweep, 0.0),
                (x, y - sy * 0.005, seat * 0.4),
                (x, y - sy * 0.01, seat * 0.75),
                (x, y, seat - 0.02),
            ]
            solids.append(tube(path, [0.54 * thick, 0.7 * thick, 0.85 * thick, thick], 10, smooth=2))
    return solids


def bowed(w: Real, y: Real, bow: Real, z: Real, height: Real, thick: Real) -> Solid:
    """A rail from side to side, centred at the height z. Its middle lies at y and its ends `bow` metres in front of that."""
    across = np.linspace(-1, 1, 9)
    path = np.stack([0.5 * w * across, y - bow * across**2, 0 * across], -1)
    round_ = tube(path, thick, 10, smooth=1)
    lift = height / 2 / np.abs(round_.vertices[:, 2]).max()
    return Solid(round_.vertices * [1, 1, lift] + [0, 0, z], round_.faces)


def klismos_back(w: Real, d: Real, seat: Real, h: Real) -> list[Solid]:
    """A bowed board on three posts, from the seat to the height h."""
    y, bow, base = d / 2 - 0.012, 0.088, seat - 0.02
    half = w / 2 - 0.015
    posts = [
        tube([(x, y - bow * (x / half) ** 2, base), (x, y - bow * (x / half) ** 2, h - 0.05)], 0.014, 8)
        for x in (-half, 0.0, half)
    ]
    return [bowed(2 * half, y, bow, h - 0.085, 0.15, 0.011), *posts]


def klismos_armchair(style: Style, rng: np.random.Generator, size: Size, *, wood: str) -> Model:
    """An easy chair on sabre legs: a deep cushion, a bowed padded back, arms that end in scrolls."""
    w, d, h = size
    seat = 0.40 * style.form.low
    wide, deep = 0.86 * w, 0.80 * d
    parts = of(wood, *sabre_legs(wide, deep, seat, sweep=0.09, thick=0.034))
    parts += of(wood, rounded_box((-wide / 2, -deep / 2, seat - 0.07), (wide / 2, deep / 2, seat), 0.016, 1))
    parts += of(
        "brass", box((-0.42 * wide, -deep / 2 - 0.006, seat - 0.048), (0.42 * wide, -deep / 2 + 0.02, seat - 0.024), 0.004)
    )
    parts += of(
        "fabric",
        rounded_box((-wide / 2 + 0.03, -deep / 2 + 0.01, seat - 0.01), (wide / 2 - 0.03, deep / 2 - 0.1, seat + 0.1), 0.04),
    )
    y, bow, arm = deep / 2 - 0.01, 0.13, seat + 0.27
    back = of(wood, bowed(wide, y, bow, h - 0.1, 0.16, 0.017), bowed(wide, y, bow, seat + 0.14, 0.06, 0.014))
    back += of("fabric", bowed(0.84 * wide, y - 0.028, 0.6 * bow, 0.5 * (seat + 0.1 + h - 0.12), h - seat - 0.28, 0.03))
    for x in (-wide / 2 + 0.012, -0.2 * wide, 0.2 * wide, wide / 2 - 0.012):
        bent = y - bow * (2 * x / wide) ** 2
        back += of(wood, tube([(x, bent, seat - 0.03), (x, bent, h - 0.06)], 0.018, 8))
    parts += [Part(p.slot, turn(p.solid, "x", -8, (0, y, seat)), p.color) for p in back]
    for s in (-1.0, 1.0):
        x = s * (wide / 2 - 0.02)
        path: list[Point3] = [
            (x, y - 0.1, arm + 0.05), (x, 0.1 * deep, arm + 0.015), (x, -0.34 * deep, arm - 0.02), (x, -0.44 * deep, arm - 0.012),
        ]  # fmt: skip
        parts += of(wood, tube(path, [0.022, 0.024, 0.026, 0.028], 10, smooth=2), ball((x, -0.45 * deep, arm - 0.02), 0.036, 12))
        post: list[Point3] = [(x, -0.4 * deep, seat - 0.02), (x, -0.34 * deep, seat + 0.1), (x, -0.4 * deep, arm - 0.02)]
        parts += of(wood, tube(post, [0.024, 0.018, 0.022], 10, smooth=2))
    if rng.random() < 0.75:
        parts += bolster((0.0, deep / 2 - 0.19, seat + 0.165), 0.62 * wide, "x", 0.075, pick(rng, style.accents))
    return Model(parts)


def bolster(at: Point3, long: Real, axis: str, radius: Real, color: Rgb) -> list[Part]:
    """A round cushion lying along x or y."""
    half = long / 2
    ends: list[Point3] = [(-half, 0, 0), (-0.86 * half, 0, 0), (0.86 * half, 0, 0), (half, 0, 0)]
    roll = tube(ends, [0.6 * radius, radius, radius, 0.6 * radius], 16)
    return of("fabric_accent", shift(roll if axis == "x" else turn(roll, "z", 90), at), color=color)


def couch(style: Style, rng: np.random.Generator, size: Size, *, wood: str) -> Model:
    """A reclining couch: turned legs, an inlaid frame, a mattress, scrolled ends with bolsters, a low padded back."""
    w, d, h = size
    seat, rail = 0.44 * style.form.low, 0.24
    parts: list[Part] = []
    for sx in (-1.0, 1.0):
        for sy in (-1.0, 1.0):
            parts += of(wood, *leg("turned", sx * (w / 2 - 0.2), sy * (d / 2 - 0.07), rail + 0.01, 0.085))
    parts += of(wood, box((-w / 2 + 0.1, -d / 2 + 0.02, rail), (w / 2 - 0.1, d / 2 - 0.02, rail + 0.09), 0.008))
    parts += of("brass", box((-w / 2 + 0.2, -d / 2 + 0.012, rail + 0.03), (w / 2 - 0.2, -d / 2 + 0.04, rail + 0.06), 0.004))
    parts += of("fabric", rounded_box((-w / 2 + 0.14, -d / 2 + 0.005, rail + 0.08), (w / 2 - 0.14, d / 2 - 0.1, seat), 0.05))
    top, color = 0.72 * h, pick(rng, style.accents)
    for s in (-1.0, 1.0):
        curve = [
            (0.16, rail + 0.05),
            (0.13, rail + 0.2),
            (0.1, top - 0.12),
            (0.06, top - 0.035),
            (0.035, top - 0.03),
            (0.03, top - 0.07),
        ]
        line = shapely.LineString([(s * (w / 2 - a), b) for a, b in curve]).buffer(0.024, quad_segs=3)
        parts += of(wood, extrude(line, -d / 2 + 0.03, d / 2 - 0.06, "y"))
        parts += bolster((s * (w / 2 - 0.24), -0.03, seat + 0.075), 0.7 * d, "y", 0.085, color)
    parts += of("fabric", rounded_box((-w / 2 + 0.13, d / 2 - 0.14, seat - 0.1), (w / 2 - 0.13, d / 2 - 0.03, h - 0.05), 0.045))
    crest = [(math.cos(a) * (w / 2 - 0.12), h - 0.1 + 0.075 * math.sin(a)) for a in np.linspace(0, math.pi, 15)]
    parts += of(wood, extrude(shapely.Polygon(crest), d / 2 - 0.12, d / 2 - 0.02, "y"))
    for s in (-1.0, 1.0):
        upright = turn(puff((-0.19, -0.19, -0.06), (0.19, 0.19, 0.06)), "x", 70)
        lift = seat - 0.01 - float(upright.vertices[:, 2].min())
        parts += of("fabric_accent", shift(upright, (s * 0.2 * w, d / 2 - 0.22, lift)), color=color)
    return Model(parts)
