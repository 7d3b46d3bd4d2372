"""Decorative objects on walls and at walls: pictures, mirror, clocks, fireplace, folding screen."""

import math

import numpy as np
import shapely

from wm.offline.furniture.common import COLUMN, frame_wood
from wm.offline.furniture.outlines import arch, frame, rectangle, rounded
from wm.offline.furniture.pictures import subject
from wm.offline.furniture.piece import FurnitureKind, Model, Part, Size, Top, of
from wm.offline.furniture.solids import Point3, Real, ball, box, extrude, lathe, rod, rounded_box, shift, stretch, turn
from wm.offline.style.finish import Rgb, Style


def framed(
    style: Style, outline: shapely.Polygon, d: Real, border: Real, inside: str, *, wood: str, color: Rgb | None = None
) -> list[Part]:
    """A frame around a flat inset. Its back is at y = d / 2."""
    parts = of(wood, extrude(frame(outline, border), -d / 2 + 0.25 * d, d / 2, "y"))
    if style.form.ornament > 0.3:
        parts += of(
            wood, extrude(frame(outline.buffer(-0.3 * border, join_style="mitre"), 0.35 * border), -d / 2, d / 2 - 0.004, "y")
        )
    return parts + of(inside, extrude(outline.buffer(-0.9 * border, join_style="mitre"), 0.0, d / 2 - 0.003, "y"), color=color)


def frame_slot(style: Style) -> str:
    if style.form.ornament > 0.4:
        return "brass"
    return "dark_metal" if style.form.panel == "flat" and style.form.legs != "tapered" else "wood"


def picture(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """A framed painting in a passe-partout."""
    w, d, h = size
    border = 0.07 if style.form.ornament > 0.4 else 0.025
    parts = framed(style, rectangle(w, h), d, border, "paper", wood=frame_slot(style))
    mat = border if style.form.ornament > 0.4 else border + 0.12 * min(w, h)
    return Model(parts + subject(style, rng, half=w / 2 - mat, low=mat, high=h - mat, face=-0.004))


def mirror(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """A mirror in the outline of the style."""
    w, d, h = size
    kind = {"pointed_arch": "pointed", "round_arch": "round", "wave": "wave"}.get(style.form.back, "")
    outline = arch(kind, w, h) if kind else rounded(w, h, 0.49 * w if style.form.softness > 0.5 else 0.02)
    return Model(framed(style, outline, d, 0.06 if style.form.ornament > 0.4 else 0.022, "mirror", wood=frame_slot(style)))


def fireplace(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """A fireplace with a burning fire: jambs, lintel, mantel, a dark firebox, logs, flames."""
    w, d, h = size
    stone = "marble" if style.form.legs in ("column", "cabriole") or style.form.ornament < 0.2 else "stone"
    opening_w, opening_h = 0.55 * w, 0.62 * h
    wall = rectangle(w - 0.12, h - 0.05)
    kind = {"pointed": "pointed", "arched": "round"}.get(style.form.panel, "")
    hole = arch(kind, opening_w, opening_h, at=(0.0, 0.04)) if kind else rectangle(opening_w, opening_h, at=(0.0, 0.04))
    face, back = -d / 2 + 0.09, d / 2
    parts = of(stone, extrude(wall.difference(hole), face, back - 0.02, "y"))
    parts += of("soot", box((-w / 2 + 0.075, back - 0.024, 0.002), (w / 2 - 0.075, back, h - 0.055), 0.0))
    parts += of(
        stone,
        rounded_box((-w / 2, -d / 2 + 0.02, h - 0.06), (w / 2, d / 2, h), 0.014, 1),
        rounded_box((-w / 2 + 0.03, -d / 2 + 0.045, h - 0.1), (w / 2 - 0.03, d / 2 - 0.004, h - 0.05), 0.014, 1),
    )
    parts += of("soot", box((-opening_w / 2 - 0.04, -d / 2, 0.0), (opening_w / 2 + 0.04, back - 0.022, 0.036), 0.004))
    x = opening_w / 2 + (w - 0.12 - opening_w) / 4
    for s in (-1.0, 1.0):
        if style.form.legs == "column" or style.form.ornament > 0.6:
            parts += of(stone, lathe([(0.055 * r + 0.004, z * (h - 0.1)) for r, z in COLUMN], 18, at=(s * x, face - 0.012, 0.0)))
        elif style.form.ornament > 0.1:
            parts += of(stone, box((s * x - 0.06, face - 0.025, 0.0), (s * x + 0.06, face + 0.02, h - 0.1), 0.008))
    if kind:
        parts += of(
            stone,
            extrude(
                hole.buffer(0.045).difference(hole.buffer(0.003)).intersection(rectangle(w, h, at=(0, 0.05))),
                face - 0.02,
                face + 0.015,
                "y",
            ),
        )
    middle = 0.5 * (face + back) + 0.01
    for k, (dx, dy) in enumerate(((0.0, -0.05), (0.0, 0.06), (0.02, 0.0))):
        log = turn(lathe([(0.042, -0.17), (0.045, 0.17)], 10), "y", 90)
        parts += of("dark_wood", shift(turn(log, "z", (-14, 12, 50)[k]), (dx, middle + dy, 0.085 if k < 2 else 0.16)))
    parts += of("ember", shift(stretch(ball((0, 0, 0), 0.19, 12), (1.0, 0.45, 0.28)), (0, middle, 0.06)))
    for k in range(7):
        tall = float(rng.uniform(0.16, 0.34)) * min(1.0, opening_h / 0.55) * (1.0 - 0.09 * abs(k - 3))
        at = (float(k - 3) * 0.05, middle + float(rng.uniform(-0.05, 0.04)), 0.12)
        tongue = [(0.0, 0.0), (0.032, 0.12), (0.038, 0.3), (0.022, 0.6), (0.008, 0.85), (0.0, 1.0)]
        parts += of("flame", shift(lathe([(r, z * tall) for r, z in tongue], 9, smooth=1), at))
    return Model(parts, (Top(h, -w / 2 + 0.06, -d / 2 + 0.06, w / 2 - 0.06, d / 2 - 0.06),))


def clock(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """A longcase clock."""
    w, d, h = size
    wood = frame_wood(style)
    parts = of(
        wood,
        box((-w / 2, -d / 2, 0.0), (w / 2, d / 2, 0.09), 0.01),
        box((-w / 2 + 0.02, -d / 2 + 0.02, 0.085), (w / 2 - 0.02, d / 2, 0.45)),
    )
    parts += of(wood, box((-w / 2 + 0.07, -d / 2 + 0.05, 0.44), (w / 2 - 0.07, d / 2, h - 0.5)))
    kind = "pointed" if style.form.back == "pointed_arch" else "round"
    hood = arch(kind, w - 0.02, 0.5 if kind == "round" else 0.52, at=(0.0, h - 0.52))
    parts += of(
        wood, extrude(hood, -d / 2 + 0.02, d / 2, "y"), rounded_box((-w / 2, -d / 2, h - 0.54), (w / 2, d / 2, h - 0.5), 0.012, 1)
    )
    window = rectangle(w - 0.24, h - 1.15, at=(0.0, 0.52))
    parts += of("lacquer", extrude(window, -d / 2 + 0.043, -d / 2 + 0.06, "y")) + of(
        "brass", extrude(window.buffer(0.015, join_style="mitre").difference(window), -d / 2 + 0.038, -d / 2 + 0.06, "y")
    )
    parts += of(
        "brass",
        shift(turn(lathe([(0.055, -0.004), (0.055, 0.004)], 20), "x", 90), (0, -d / 2 + 0.038, 0.68)),
        rod((0, -d / 2 + 0.038, 0.7), (0, -d / 2 + 0.038, h - 0.66), 0.005, 6),
    )
    return Model(parts + dial(0.34 * w, (0.0, -d / 2 + 0.02, h - 0.31)))


def dial(radius: Real, at: Point3) -> list[Part]:
    """A clock face towards -y: rim, dial, hour marks, hands."""
    x, y, z = at
    parts = of("brass", shift(turn(lathe([(radius, -0.012), (1.06 * radius, 0.0), (radius, 0.012)], 32), "x", 90), at))
    parts += of("paper", shift(turn(lathe([(0.93 * radius, -0.015), (0.93 * radius, 0.015)], 32), "x", 90), at))
    for k in range(12):
        mark = box((-0.02 * radius, -0.004, 0.72 * radius), (0.02 * radius, 0.004, 0.88 * radius), 0.0)
        parts += of("dark_metal", shift(turn(mark, "y", 30.0 * k), (x, y - 0.016, z)))
    for angle, long in ((-52.0, 0.5), (63.0, 0.78)):
        hand = box((-0.025 * radius, -0.003, -0.08 * radius), (0.025 * radius, 0.003, long * radius), 0.0)
        parts += of("dark_metal", shift(turn(hand, "y", angle), (x, y - 0.02 - 0.001 * long, z)))
    return parts


def wall_clock(style: Style, rng: np.random.Generator, size: Size) -> Model:
    w, d, _ = size
    return Model([Part(p.slot, stretch(p.solid, (1.0, d / 0.035, 1.0)), p.color) for p in dial(w / 2.12, (0.0, 0.0, w / 2))])


def folding_screen(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """Three hinged panels standing in a zigzag."""
    w, d, h = size
    wood = frame_wood(style)
    pitch = w / 3
    parts: list[Part] = []
    kind = {"pointed_arch": "pointed", "round_arch": "round", "wave": "wave"}.get(style.form.back, "")
    slope = math.degrees(math.atan2(d - 0.03, pitch))
    for k in range(3):
        outline = arch(kind, pitch - 0.012, h) if kind else rectangle(pitch - 0.012, h)
        field = outline.buffer(-0.035, join_style="mitre")
        slot = "paper" if style.family == "japanese" else "fabric"
        panel = [
            *of(wood, extrude(outline.difference(field), -0.014, 0.014, "y")),
            *of(slot, extrude(field.buffer(0.004, join_style="mitre"), -0.005, 0.005, "y")),
        ]
        if style.family == "japanese":
            for z in np.linspace(0.25, h - 0.25, 5):
                panel += of(wood, box((-pitch / 2 + 0.03, -0.009, z - 0.008), (pitch / 2 - 0.03, 0.009, z + 0.008), 0.0))
            panel += of(wood, box((-0.008, -0.0085, 0.03), (0.008, 0.0085, h - 0.03), 0.0))
        turned = [Part(p.slot, stretch(p.solid, (1 / math.cos(math.radians(slope)), 1, 1)), p.color) for p in panel]
        sign = 1 if k % 2 == 0 else -1
        parts += [Part(p.slot, shift(turn(p.solid, "z", sign * slope), ((k - 1) * pitch, 0.0, 0.0)), p.color) for p in turned]
    return Model(parts)


KINDS = {
    "picture": FurnitureKind(picture, "wall", (0.45, 0.035, 0.4), (0.9, 0.045, 0.7)),
    "mirror": FurnitureKind(mirror, "wall", (0.5, 0.035, 0.8), (0.7, 0.045, 1.1)),
    "wall clock": FurnitureKind(wall_clock, "wall", (0.32, 0.035, 0.32), (0.42, 0.04, 0.42)),
    "fireplace": FurnitureKind(fireplace, "floor", (1.3, 0.42, 1.1), (1.7, 0.5, 1.3), front=0.9),
    "grandfather clock": FurnitureKind(clock, "floor", (0.46, 0.28, 1.95), (0.54, 0.32, 2.15), front=0.3),
    "folding screen": FurnitureKind(folding_screen, "floor", (1.3, 0.28, 1.6), (1.6, 0.36, 1.8)),
}
