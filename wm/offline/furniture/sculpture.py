"""Decorative objects on the floor: statue, column, armour, globe, chess piece, mushroom, lectern."""

import math

import numpy as np

from wm.offline.furniture.common import COLUMN, finial, frame_wood, tracery
from wm.offline.furniture.piece import FurnitureKind, Model, Part, Size, of, pick
from wm.offline.furniture.solids import Solid, ball, box, extrude, lathe, rod, rounded_box, shift, stretch, tube, turn
from wm.offline.furniture.tabletop import open_book
from wm.offline.style.finish import Style


def statue(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """A draped figure on a pedestal."""
    w, _, h = size
    foot = 0.42 * h
    slot = "marble" if style.form.legs in ("column", "cabriole") else "stone"
    half = 0.42 * w
    parts = of(
        slot,
        box((-half - 0.03, -half - 0.03, 0.0), (half + 0.03, half + 0.03, 0.06), 0.01),
        box((-half, -half, 0.055), (half, half, foot - 0.05), 0.01),
    )
    parts += of(slot, box((-half - 0.03, -half - 0.03, foot - 0.055), (half + 0.03, half + 0.03, foot), 0.012))
    tall = h - foot
    gown = [
        (0.150, 0.0),
        (0.155, 0.03),
        (0.118, 0.22),
        (0.1, 0.42),
        (0.112, 0.5),
        (0.085, 0.6),
        (0.1, 0.7),
        (0.112, 0.76),
        (0.05, 0.82),
        (0.034, 0.845),
        (0.036, 0.87),
    ]
    body = lathe(
        [(0.0, foot - 0.002), *((r * tall, foot - 0.002 + z * tall) for r, z in gown), (0.0, foot + 0.875 * tall)], 40, smooth=2
    )
    angle = np.arctan2(body.vertices[:, 1], body.vertices[:, 0])
    height = (body.vertices[:, 2] - foot) / tall
    folds = 1 + 0.09 * np.clip(0.6 - height, 0, 0.6) * np.sin(9 * angle + 5 * height)
    body = stretch(Solid(body.vertices * np.stack([folds, folds, np.ones_like(folds)], -1), body.faces), (1.0, 0.75, 1.0))
    head = stretch(ball((0, 0, 0), 0.062 * tall, 16), (0.82, 0.95, 1.15))
    parts += of(slot, body, shift(head, (0, -0.008, foot + 0.925 * tall)))
    hair = stretch(ball((0, 0, 0), 0.064 * tall, 14), (0.9, 0.8, 0.9))
    parts += of(slot, shift(hair, (0, 0.02, foot + 0.94 * tall)))
    s = tall
    arm = [
        (0.1 * s, 0, foot + 0.765 * s),
        (0.155 * s, 0.0, foot + 0.62 * s),
        (0.1 * s, -0.09 * s, foot + 0.52 * s),
        (0.02 * s, -0.12 * s, foot + 0.56 * s),
    ]
    down = [
        (-0.1 * s, 0, foot + 0.765 * s),
        (-0.145 * s, 0.01, foot + 0.62 * s),
        (-0.15 * s, -0.03 * s, foot + 0.48 * s),
        (-0.14 * s, -0.05 * s, foot + 0.4 * s),
    ]
    return Model(
        parts + of(slot, *(tube(path, [0.036 * s, 0.03 * s, 0.024 * s, 0.02 * s], 10, smooth=2) for path in (arm, down)))
    )


def column(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """A fluted column with a bust or an urn on it."""
    w, _, h = size
    slot = "marble" if style.form.ornament > 0.3 else "stone"
    shaft = 0.66 * h
    half = w / 2
    parts = of(
        slot,
        box((-half, -half, 0.0), (half, half, 0.07), 0.01),
        lathe([(0.95 * half, 0.068), (0.97 * half, 0.09), (0.72 * half, 0.12)], 28, smooth=1),
    )
    flutes = 20
    t = np.arange(flutes * 4) * 2 * np.pi / (flutes * 4)
    radius = 0.68 * half * (1 - 0.07 * (np.arange(flutes * 4) % 4 == 2))
    parts += of(
        slot, extrude([(float(r * math.cos(a)), float(r * math.sin(a))) for r, a in zip(radius, t)], 0.11, shaft - 0.1, "z")
    )
    parts += of(
        slot,
        lathe([(0.66 * half, shaft - 0.105), (0.95 * half, shaft - 0.055), (0.97 * half, shaft - 0.045)], 28, smooth=1),
        box((-half, -half, shaft - 0.05), (half, half, shaft), 0.008),
    )
    tall = h - shaft
    if rng.random() < 0.5:
        urn = [
            (0.16, 0.0),
            (0.16, 0.05),
            (0.07, 0.12),
            (0.09, 0.18),
            (0.3, 0.5),
            (0.3, 0.62),
            (0.14, 0.78),
            (0.22, 0.86),
            (0.16, 0.9),
            (0.0, 1.0),
        ]
        return Model(
            parts
            + of(
                "ceramic" if style.form.ornament > 0.6 else slot,
                lathe([(0.0, shaft - 0.002), *((0.75 * r * tall, shaft - 0.002 + z * tall) for r, z in urn)], 28, smooth=1),
            )
        )
    parts += of(slot, lathe([(0.13 * tall, shaft - 0.002), (0.1 * tall, shaft + 0.12 * tall)], 20))
    chest = stretch(ball((0, 0, 0), 0.3 * tall, 18), (1.0, 0.6, 0.75))
    head = stretch(ball((0, 0, 0), 0.2 * tall, 18), (0.78, 0.9, 1.1))
    nose = lathe([(0.035 * tall, 0.0), (0.0, 0.1 * tall)], 6)
    parts += of(
        slot,
        shift(chest, (0, 0, shaft + 0.3 * tall)),
        lathe([(0.09 * tall, shaft + 0.4 * tall), (0.08 * tall, shaft + 0.66 * tall)], 16),
    )
    return Model(
        parts + of(slot, shift(head, (0, -0.02 * tall, shaft + 0.77 * tall)), shift(nose, (0, -0.19 * tall, shaft + 0.7 * tall)))
    )


def armour(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """A suit of armour on a base, with a halberd."""
    w, d, h = size
    metal = "steel"
    parts = of("dark_wood", box((-0.4 * w, -0.4 * d, 0.0), (0.4 * w, 0.4 * d, 0.06), 0.008))
    s = (h - 0.06) / 1.8
    for side in (-1.0, 1.0):
        x = side * 0.1 * s
        parts += of(
            metal,
            tube(
                [(x, 0, 0.08), (x, 0.01, 0.06 + 0.45 * s), (x * 0.9, 0, 0.06 + 0.86 * s)],
                [0.055 * s, 0.06 * s, 0.085 * s],
                12,
                smooth=2,
            ),
        )
        parts += of(
            metal,
            ball((x, -0.02, 0.06 + 0.47 * s), 0.066 * s, 10),
            rounded_box((x - 0.045 * s, -0.17 * s, 0.058), (x + 0.045 * s, 0.06 * s, 0.058 + 0.08 * s), 0.03),
        )
        parts += of(
            metal,
            tube(
                [
                    (side * 0.22 * s, 0, 0.06 + 1.38 * s),
                    (side * 0.27 * s, 0, 0.06 + 1.12 * s),
                    (side * 0.25 * s, -0.1 * s, 0.06 + 0.9 * s),
                ],
                [0.06 * s, 0.05 * s, 0.042 * s],
                10,
                smooth=2,
            ),
        )
        parts += of(
            metal,
            ball((side * 0.215 * s, 0, 0.06 + 1.4 * s), 0.085 * s, 12),
            ball((side * 0.25 * s, -0.11 * s, 0.06 + 0.87 * s), 0.052 * s, 10),
        )
    torso = lathe(
        [(0.19, 0.72), (0.17, 0.82), (0.135, 0.98), (0.17, 1.15), (0.185, 1.3), (0.12, 1.43), (0.07, 1.48)], 24, smooth=2
    )
    parts += of(metal, shift(stretch(torso, (1.15 * s, 0.85 * s, s)), (0, 0, 0.06)))
    helm = lathe([(0.085, 1.47), (0.1, 1.55), (0.105, 1.66), (0.07, 1.76), (0.0, 1.79)], 20, smooth=2)
    parts += of(metal, shift(stretch(helm, (s, 1.1 * s, s)), (0, 0, 0.06)))
    parts += of("soot", box((-0.07 * s, -0.128 * s, 0.06 + 1.635 * s), (0.07 * s, -0.06 * s, 0.06 + 1.65 * s), 0.0))
    x, y = 0.31 * s, -0.12 * s
    parts += of("dark_wood", rod((x, y, 0.05), (x, y, h + 0.1), 0.014))
    blade_ = [(x - 0.02, h - 0.14), (x + 0.1, h - 0.2), (x + 0.12, h - 0.02), (x - 0.02, h - 0.05)]
    return Model(
        parts
        + of(metal, extrude(blade_, y - 0.005, y + 0.005, "y"), lathe([(0.018, h + 0.09), (0.0, h + 0.24)], 8, at=(x, y, 0.0)))
    )


def globe(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """A terrestrial globe in its stand."""
    w, _, h = size
    r = 0.44 * w
    z = h - 0.5 * w
    parts = of(
        frame_wood(style), lathe([(0.32 * w, 0.0), (0.3 * w, 0.02), (0.05 * w, 0.05), (0.04 * w, z - r - 0.01)], 20, smooth=1)
    )
    parts += of("ceramic", ball((0, 0, z), r, 24), color=(0.33, 0.47, 0.55))
    arc = [(0.0, 1.1 * r * math.cos(a), z + 1.1 * r * math.sin(a)) for a in np.linspace(-1.9, 1.3, 15)]
    parts += of("brass", tube(arc, 0.012 * w + 0.003, 6))
    for k in range(6):
        a, b = 1.1 * k + float(rng.uniform(0, 0.5)), float(rng.uniform(-0.9, 0.9))
        at = (r * 0.8 * math.cos(a) * math.cos(b), r * 0.8 * math.sin(a) * math.cos(b), z + r * 0.8 * math.sin(b))
        parts += of("ceramic", ball(at, float(rng.uniform(0.22, 0.245)) * r * 1.02, 12), color=(0.72, 0.62, 0.4))
    return Model(parts)


def trophy(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """A turned wooden chess piece, larger than life."""
    w, _, h = size
    r = w / 2
    profile = [
        (1.0, 0.0),
        (1.0, 0.06),
        (0.8, 0.1),
        (0.85, 0.13),
        (0.5, 0.22),
        (0.38, 0.45),
        (0.36, 0.6),
        (0.62, 0.64),
        (0.62, 0.67),
        (0.4, 0.7),
        (0.55, 0.82),
        (0.6, 0.88),
        (0.3, 0.92),
    ]
    parts = of("lacquer", lathe([(r * q, z * h) for q, z in profile], 32, smooth=1), color=pick(rng, style.accents))
    return Model(parts + of("brass", finial(0.0, 0.0, 0.91 * h, 0.09 * h)))


def mushroom(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """A mushroom taller than a child, its cap glowing faintly."""
    w, _, h = size
    cap = 0.42 * h
    stem = [(0.16, 0.0), (0.12, 0.15), (0.09, 0.5), (0.1, 1.0)]
    parts = of("ceramic", lathe([(w * r, z * (h - 0.6 * cap)) for r, z in stem], 20, smooth=2))
    dome = [(0.1, 0.25), (0.44, 0.2), (0.5, 0.1), (0.49, 0.22), (0.42, 0.5), (0.26, 0.82), (0.0, 1.0)]
    parts += of("lamp_shade", lathe([(w * r, h - cap + z * cap) for r, z in dome], 28, smooth=2), color=pick(rng, style.accents))
    for k in range(9):
        a, t = 2.4 * k, 0.35 + 0.55 * (k / 9)
        at = (
            0.44 * w * (1 - 0.62 * t) * 1.05 * math.cos(a),
            0.44 * w * (1 - 0.62 * t) * 1.05 * math.sin(a),
            h - cap + cap * (0.36 + 0.55 * t),
        )
        parts += of("pillow", ball(at, 0.045 * w + 0.01, 8))
    return Model(parts)


def lectern(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """A reading stand with an open book."""
    w, d, h = size
    wood = frame_wood(style)
    parts = of(
        wood,
        box((-0.4 * w, -0.4 * d, 0.0), (0.4 * w, 0.4 * d, 0.05), 0.01),
        lathe([(0.03 * r + 0.015, 0.045 + z * (h - 0.25)) for r, z in COLUMN], 16),
    )
    if style.form.back == "pointed_arch":
        parts += of(wood, extrude(tracery(0.5 * w, 0.42 * h, 0.035, at=(0.0, 0.28 * h)), -0.02, 0.02, "y"))
    board = of(wood, box((-w / 2, -d / 2, 0.0), (w / 2, d / 2, 0.025)), box((-w / 2, -d / 2, 0.02), (w / 2, -d / 2 + 0.02, 0.05)))
    book = open_book(style, rng, (0.82 * w, 0.7 * d, 0.05)).parts
    board += [Part(p.slot, shift(p.solid, (0, 0.01, 0.0255)), p.color) for p in book]
    return Model(parts + [Part(p.slot, shift(turn(p.solid, "x", 28), (0, 0, h - 0.22)), p.color) for p in board])


KINDS = {
    "statue": FurnitureKind(statue, "floor", (0.46, 0.46, 1.6), (0.54, 0.54, 1.85)),
    "column": FurnitureKind(column, "floor", (0.34, 0.34, 1.3), (0.42, 0.42, 1.6)),
    "globe": FurnitureKind(globe, "floor", (0.46, 0.46, 0.85), (0.54, 0.54, 1.0)),
    "suit of armour": FurnitureKind(armour, "floor", (0.62, 0.5, 1.8), (0.68, 0.55, 1.9)),
    "lectern": FurnitureKind(lectern, "floor", (0.5, 0.42, 1.15), (0.56, 0.46, 1.25), front=0.5),
    "chess piece": FurnitureKind(trophy, "floor", (0.42, 0.42, 1.1), (0.55, 0.55, 1.6)),
    "giant mushroom": FurnitureKind(mushroom, "floor", (0.6, 0.6, 0.9), (0.8, 0.8, 1.4)),
}
