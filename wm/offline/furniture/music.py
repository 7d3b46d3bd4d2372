"""Instruments: upright piano, drum kit, music stand."""

import math

import numpy as np

from wm.offline.furniture.joinery import BLACK, WHITE
from wm.offline.furniture.piece import FurnitureKind, Model, Part, Size, Top, of, pick
from wm.offline.furniture.solids import Point3, Real, box, lathe, rod, rounded_box, shift, turn
from wm.offline.style.finish import Style


def piano(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """An upright piano: case, keyboard with white and black keys, music desk with sheets, pedals."""
    w, d, h = size
    slot, deep = ("dark_wood", None) if style.form.ornament > 0.3 else ("lacquer", BLACK), d / 2
    y = 0.02
    parts = of(
        slot[0],
        box((-w / 2 + 0.02, y, 0.06), (w / 2 - 0.02, deep, h - 0.03)),
        rounded_box((-w / 2, y - 0.02, h - 0.035), (w / 2, deep, h), 0.01, 1),
        color=slot[1],
    )
    parts += of(
        slot[0],
        *(box((s * w / 2, -d / 2 + 0.04, 0.0), (s * (w / 2 - 0.05), deep - 0.01, 0.72)) for s in (-1, 1)),
        box((-w / 2 + 0.04, -d / 2 + 0.06, 0.58), (w / 2 - 0.04, y + 0.05, 0.66)),
        box((-w / 2 + 0.045, -d / 2 + 0.045, 0.56), (w / 2 - 0.045, -d / 2 + 0.075, 0.675)),
        color=slot[1],
    )
    keys = int((w - 0.14) / 0.026)
    pitch = (w - 0.14) / keys
    for k in range(keys):
        x = -w / 2 + 0.07 + k * pitch
        parts += of(
            "wax", box((x + 0.001, -d / 2 + 0.075, 0.655), (x + pitch - 0.001, y + 0.02, 0.685), 0.0), color=(0.94, 0.93, 0.89)
        )
        if k % 7 not in (2, 6) and k < keys - 1:
            parts += of(
                "lacquer", box((x + 0.7 * pitch, -d / 2 + 0.13, 0.68), (x + 1.3 * pitch, y + 0.02, 0.697), 0.0), color=BLACK
            )
    parts += of(
        slot[0],
        turn(box((-0.42, y - 0.03, 0.78), (0.42, y - 0.01, h - 0.12)), "x", -8, (0, y, 0.78)),
        box((-0.42, y - 0.07, 0.77), (0.42, y + 0.01, 0.795)),
        color=slot[1],
    )
    parts += of(
        "paper",
        *(turn(box((x0, y - 0.036, 0.8), (x0 + 0.22, y - 0.028, 1.08), 0.0), "x", -8, (0, y, 0.78)) for x0 in (-0.23, 0.01)),
    )
    parts += of("brass", *(box((x - 0.02, y - 0.1, 0.04), (x + 0.02, y + 0.03, 0.055)) for x in (-0.08, 0.0, 0.08)))
    return Model(parts, (Top(h, -w / 2 + 0.05, 0.04, w / 2 - 0.05, d / 2 - 0.03),))


def drum(at: Point3, radius: Real, height: Real, color: tuple[float, float, float], *, lying: bool = False) -> list[Part]:
    """A drum with chrome rims; lying ones have their skin towards -y."""
    body = lathe([(radius, 0.02), (radius, height - 0.02)], 24)
    rims = [lathe([(1.02 * radius, z), (1.02 * radius, z + 0.025)], 24) for z in (0.0, height - 0.025)]
    skin = lathe([(0.97 * radius, height - 0.01), (0.97 * radius, height + 0.003)], 24)
    if lying:
        body, skin, rims = turn(body, "x", 90), turn(skin, "x", 90), [turn(rim, "x", 90) for rim in rims]
    parts = of("lacquer", shift(body, at), color=color) + of("chrome", *(shift(rim, at) for rim in rims))
    return parts + of("paper", shift(skin, at), color=WHITE)


def drum_kit(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """Bass drum, two toms on it, snare and floor tom at its sides, cymbals on stands."""
    w, d, h = size
    color = pick(rng, ((0.55, 0.05, 0.07), (0.07, 0.15, 0.4), (0.08, 0.08, 0.09), (0.8, 0.78, 0.72)))
    r = 0.28
    parts = drum((0, 0.0, r + 0.02), r, 0.4, color, lying=True)
    for s in (-1, 1):
        parts += drum((s * 0.17, -0.05, 0.64), 0.15, 0.18, color) + of(
            "chrome", rod((s * 0.1, -0.1, 0.5), (s * 0.17, -0.05, 0.68), 0.014)
        )
        x, y = s * (w / 2 - 0.22), d / 2 - 0.22
        parts += drum((x, y, 0.4 if s < 0 else 0.28), 0.18 if s < 0 else 0.2, 0.16 if s < 0 else 0.34, color)
        for k in range(3):
            a = 2 * math.pi * k / 3 + 0.5
            parts += of(
                "chrome",
                rod(
                    (x + 0.2 * math.cos(a), y + 0.2 * math.sin(a), 0.0),
                    (x + 0.08 * math.cos(a), y + 0.08 * math.sin(a), 0.45 if s < 0 else 0.4),
                    0.01,
                ),
            )
        cx, cy, tall = s * (w / 2 - 0.2), -d / 2 + 0.22, h - 0.02 - (0.14 if s < 0 else 0.0)
        parts += of(
            "chrome",
            rod((cx, cy, 0.15), (cx, cy, tall), 0.012),
            *(rod((cx + 0.2 * math.cos(a), cy + 0.2 * math.sin(a), 0.0), (cx, cy, 0.24), 0.009) for a in (0.5, 2.6, 4.7)),
        )
        plate = lathe([(0.2, 0.0), (0.12, 0.012), (0.04, 0.016), (0.03, 0.035), (0.0, 0.04)], 28)
        parts += of("brass", shift(turn(plate, "x", 10), (cx, cy, tall - 0.03)))
    return Model(parts)


def music_stand(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """A tripod with a tilted desk and a sheet of music."""
    w, _, h = size
    parts = of(
        "dark_metal",
        rod((0, 0, 0.12), (0, 0, h - 0.25), 0.011),
        *(
            rod((0, 0, 0.26), (0.46 * w * math.cos(a), 0.46 * w * math.sin(a), 0.01), 0.01)
            for a in (math.pi / 2, math.pi * 7 / 6, math.pi * 11 / 6)
        ),
    )
    desk = of("dark_metal", box((-w / 2, -0.012, 0.0), (w / 2, 0.0, 0.32)), box((-w / 2, -0.05, 0.0), (w / 2, 0.0, 0.014))) + of(
        "paper",
        box((-0.4 * w, -0.02, 0.016), (-0.01, -0.008, 0.29), 0.0),
        box((0.01, -0.02, 0.016), (0.4 * w, -0.008, 0.29), 0.0),
    )
    return Model(parts + [Part(p.slot, shift(turn(p.solid, "x", -22), (0, -0.03, h - 0.32)), p.color) for p in desk])


KINDS = {
    "piano": FurnitureKind(piano, "floor", (1.35, 0.56, 1.15), (1.5, 0.62, 1.28), front=0.7),
    "drum kit": FurnitureKind(drum_kit, "floor", (1.4, 1.1, 1.15), (1.6, 1.25, 1.3)),
    "music stand": FurnitureKind(music_stand, "floor", (0.46, 0.46, 1.1), (0.52, 0.52, 1.3)),
}
