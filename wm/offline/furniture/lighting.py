"""Lamps: floor and table lamps, chandelier, pendant, candelabra, sconce. Their shades, bulbs and flames glow."""

import math

import numpy as np

from wm.offline.furniture.common import COLUMN, TURNED, candle
from wm.offline.furniture.outlines import arch
from wm.offline.furniture.piece import FurnitureKind, Model, Part, Size, of, pick
from wm.offline.furniture.shades import shade, standing, wheel_of_globes
from wm.offline.furniture.solids import ball, extrude, lathe, rod, shell, shift, tube, turn
from wm.offline.style.finish import Style


def floor_lamp(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """A floor lamp: a tripod, an arched lamp, or a lamp on a turned stem."""
    w, _, h = size
    r = w / 2
    kind = standing(style)
    tall = 0.3 if kind != "globe" else 2 * min(r, 0.16)
    under = h - tall
    if style.form.legs == "tapered" or kind == "lantern":
        parts = []
        for k in range(3):
            a = 2 * math.pi * k / 3 + math.pi / 2
            parts += of(
                "wood",
                rod(
                    (0.95 * r * math.cos(a), 0.95 * r * math.sin(a), 0.0),
                    (0.02 * math.cos(a), 0.02 * math.sin(a), under - 0.02),
                    0.013,
                ),
            )
        parts += of(
            "brass", lathe([(0.03, under - 0.06), (0.03, under)], 16), rod((0, 0, under - 0.02), (0, 0, under + 0.1), 0.008)
        )
    elif style.form.ornament > 0.3:
        parts = of("brass", lathe([(0.15, 0.0), (0.15, 0.02), (0.06, 0.05), (0.03, 0.09)], 24, smooth=1))
        parts += of("brass", lathe([(0.006 + 0.022 * q, 0.08 + z * (under - 0.04)) for q, z in TURNED], 16, smooth=1))
    else:
        parts = of("dark_metal", lathe([(0.14, 0.0), (0.14, 0.018), (0.012, 0.024), (0.012, under + 0.1)], 28))
    return Model(parts + shade(style, kind, min(r, 0.16) if kind == "globe" else r * 0.95, tall, under))


def table_lamp(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """A lamp for a table top: vase, column or stem below the shade."""
    w, _, h = size
    r = w / 2
    kind = "cone" if style.form.lamp in ("candle", "tripod") else standing(style)
    tall = 0.42 * h if kind != "globe" else 2 * min(r, 0.3 * h)
    under = h - tall
    if kind == "lantern":
        return Model(
            of("dark_metal", lathe([(0.06, 0.0), (0.06, 0.015), (0.02, 0.02), (0.02, under + 0.01)], 20))
            + shade(style, kind, r, tall, under)
        )
    if style.form.legs == "column":
        parts = of("marble", lathe([(0.045 * q + 0.01, z * under) for q, z in COLUMN], 24))
    elif style.form.ornament > 0.3:
        parts = of("brass", lathe([(0.065, 0.0), (0.065, 0.015)], 24))
        vase = [(0.03, 0.01), (0.075, 0.3), (0.07, 0.5), (0.025, 0.85), (0.02, 1.0)]
        parts += of(
            "ceramic", lathe([(q, 0.01 + z * (under - 0.01)) for q, z in vase], 24, smooth=2), color=pick(rng, style.accents)
        )
    else:
        parts = of(
            "ceramic",
            lathe([(0.05, 0.0), (0.07, 0.2 * under), (0.06, 0.7 * under), (0.02, 0.9 * under), (0.012, under)], 24, smooth=2),
            color=pick(rng, style.accents),
        )
    parts += of("brass", rod((0, 0, under - 0.01), (0, 0, under + 0.12), 0.006))
    return Model(parts + shade(style, kind, min(r, 0.3 * h) if kind == "globe" else r, tall, under))


def chandelier(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """Arms with candles or bulbs around a stem, on a chain."""
    w, _, h = size
    reach = w / 2 - 0.03
    body = min(0.5, 0.6 * h)
    metal = "dark_metal" if style.family in ("gothic", "rustic") else "brass"
    count = 8 if style.form.ornament > 0.7 else 6
    parts = of(
        metal,
        lathe(
            [(0.0, 0.0), (0.02, 0.01), (0.035, 0.05), (0.02, 0.1), (0.045, 0.16), (0.06, 0.22), (0.03, 0.3), (0.018, body)],
            20,
            smooth=1,
        ),
    )
    parts += of(
        metal, rod((0, 0, body - 0.02), (0, 0, h - 0.03), 0.008), lathe([(0.06, h - 0.035), (0.055, h - 0.02), (0.065, h)], 20)
    )
    for k in range(int((h - body - 0.06) / 0.05)):
        link = tube([(0.012 * math.cos(a), 0.0, 0.02 * math.sin(a)) for a in np.linspace(0.1, 2 * math.pi - 0.1, 9)], 0.004, 5)
        parts += of(metal, shift(turn(link, "z", 90 * (k % 2)), (0, 0, body + 0.03 + 0.05 * k)))
    if style.family in ("gothic", "rustic"):
        parts += of(metal, shell([(reach + 0.012, 0.17), (reach + 0.012, 0.21)], 0.024, 36))
    for k in range(count):
        a = 2 * math.pi * (k + 0.5) / count
        c, s = math.cos(a), math.sin(a)
        arm = [
            (0.02 * c, 0.02 * s, 0.2),
            (0.4 * reach * c, 0.4 * reach * s, 0.11),
            (0.8 * reach * c, 0.8 * reach * s, 0.12),
            (reach * c, reach * s, 0.2),
        ]
        parts += of(metal, tube(arm, 0.008, 6, smooth=3))
        parts += of(
            metal,
            lathe(
                [(0.01, 0.0), (0.035, 0.015), (0.036, 0.02), (0.014, 0.022), (0.014, 0.03)], 12, at=(reach * c, reach * s, 0.195)
            ),
        )
        parts += candle(reach * c, reach * s, 0.222, 0.09)
        if style.form.ornament > 0.85 and style.family != "gothic":
            parts += of(
                "glass", lathe([(0.0, 0.0), (0.011, 0.025), (0.0, 0.05)], 6, at=(0.8 * reach * c, 0.8 * reach * s, 0.055))
            )
    return Model(parts)


def pendant(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """A single hanging lamp: globe, dome, drum or lantern on a cord."""
    w, _, h = size
    kind = style.form.lamp
    tall = {"globe": w, "drum": 0.5 * w, "lantern": 0.9 * w, "paper": 0.72 * w, "bowl": 0.38 * w}.get(kind, 0.55 * w)
    cord = [
        *of("dark_metal", rod((0, 0, tall - 0.02), (0, 0, h - 0.02), 0.005, 6)),
        *of("dark_metal", lathe([(0.05, h - 0.03), (0.05, h)], 16)),
    ]
    cord += of("dark_metal", lathe([(0.025, tall - 0.015), (0.025, tall + 0.04)], 12))
    if kind == "globe":
        return Model(cord + of("lamp_shade" if style.form.ornament > 0.3 else "bulb", ball((0, 0, w / 2), w / 2, 24)))
    if kind == "lantern":
        return Model(cord + shade(style, "lantern", 0.62 * w, tall, 0.0))
    if kind in ("paper", "rattan", "dome"):
        return Model(cord + shade(style, kind, w / 2, tall, 0.0))
    if kind == "cluster":
        return Model(wheel_of_globes(w, h))
    if kind == "bowl":
        chains = [
            rod((0.46 * w * math.cos(a), 0.46 * w * math.sin(a), tall - 0.02), (0, 0, h - 0.02), 0.006, 6)
            for a in (0.3, 2.4, 4.5)
        ]
        parts = of("brass", *chains, lathe([(0.06, h - 0.03), (0.05, h)], 16), ball((0, 0, 0.012), 0.014, 8))
        return Model(parts + [Part(p.slot, shift(p.solid, (0, 0, 0.015)), p.color) for p in shade(style, kind, w / 2, tall, 0.0)])
    if style.family in ("industrial", "midcentury"):
        outer = [(w / 2, 0.0), (0.46 * w, 0.35 * tall), (0.26 * w, 0.8 * tall), (0.05 * w, tall)]
        return Model(cord + of("dark_metal", shell(outer, 0.006)) + of("bulb", ball((0, 0, 0.35 * tall), 0.05)))
    spokes = [
        rod((0, 0, 0.93 * tall), (0.4 * w * math.cos(a), 0.4 * w * math.sin(a), 0.93 * tall), 0.004, 5) for a in (0.3, 2.4, 4.5)
    ]
    return Model(
        cord + shade(style, kind, w / 2, tall, 0.0) + of("dark_metal", *spokes, rod((0, 0, 0.45 * tall), (0, 0, tall), 0.006, 6))
    )


def candelabra(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """A standing candelabra with five arms."""
    w, _, h = size
    metal = "dark_metal" if style.family in ("gothic", "rustic", "industrial") else "brass"
    reach, top = w / 2 - 0.02, h - 0.2
    parts = of(metal, lathe([(0.15, 0.0), (0.14, 0.025), (0.05, 0.06), (0.025, 0.12)], 20, smooth=1))
    parts += of(
        metal,
        lathe([(0.006 + 0.02 * q, 0.1 + z * (top - 0.28)) for q, z in TURNED], 14, smooth=1),
        rod((0, 0, top - 0.2), (0, 0, top), 0.011),
    )
    for k in range(4):
        a = math.pi * k / 2 + math.pi / 4
        c, s = math.cos(a), math.sin(a)
        arm = [
            (0.0, 0.0, top - 0.19),
            (0.5 * reach * c, 0.5 * reach * s, top - 0.22),
            (0.95 * reach * c, 0.95 * reach * s, top - 0.15),
            (reach * c, reach * s, top - 0.06),
        ]
        parts += of(metal, tube(arm, 0.009, 7, smooth=3))
        parts += of(
            metal, lathe([(0.01, 0.0), (0.034, 0.012), (0.034, 0.018), (0.013, 0.02)], 12, at=(reach * c, reach * s, top - 0.065))
        )
        parts += candle(reach * c, reach * s, top - 0.046, 0.12)
    parts += of(metal, lathe([(0.01, top - 0.01), (0.036, top + 0.004), (0.036, top + 0.01), (0.013, top + 0.012)], 12))
    return Model(parts + candle(0, 0, top + 0.011, 0.13))


def sconce(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """A lamp on the wall: a back plate, an arm, a candle or a small shade."""
    w, d, h = size
    metal = "dark_metal" if style.family in ("gothic", "rustic", "industrial", "cyberpunk") else "brass"
    kind = "pointed" if style.form.back == "pointed_arch" else "round"
    parts = of(metal, extrude(arch(kind, 0.6 * w, 0.75 * h), d / 2 - 0.018, d / 2, "y"))
    reach = d / 2 - 0.075
    arm = [(0, d / 2 - 0.01, 0.3 * h), (0, 0.3 * d, 0.18 * h), (0, -reach + 0.05, 0.16 * h), (0, -reach, 0.3 * h)]
    parts += of(
        metal,
        tube(arm, 0.008, 7, smooth=3),
        lathe([(0.01, 0.0), (0.04, 0.014), (0.04, 0.02), (0.013, 0.022)], 12, at=(0, -reach, 0.29 * h)),
    )
    if style.form.lamp in ("candle", "tripod"):
        return Model(parts + candle(0, -reach, 0.29 * h + 0.021, 0.45 * h))
    lamp = shade(style, "globe" if style.form.lamp == "globe" else "cone", 0.07, 0.5 * h, 0.29 * h + 0.03)
    return Model(parts + [Part(p.slot, shift(p.solid, (0, -reach, 0)), p.color) for p in lamp])


def candles(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """Three candles of different heights on a tray."""
    w, _d, h = size
    parts = of("brass", lathe([(w / 2, 0.0), (w / 2, 0.012)], 24))
    for k, share in enumerate((1.0, 0.72, 0.5)):
        a = 2 * math.pi * k / 3 + 0.4
        parts += candle(0.24 * w * math.cos(a), 0.24 * w * math.sin(a), 0.011, share * h - 0.07, radius=0.022)
    return Model(parts)


KINDS = {
    "floor lamp": FurnitureKind(floor_lamp, "floor", (0.38, 0.38, 1.45), (0.48, 0.48, 1.7)),
    "candelabra": FurnitureKind(candelabra, "floor", (0.42, 0.42, 1.45), (0.5, 0.5, 1.7)),
    "table lamp": FurnitureKind(table_lamp, "object", (0.24, 0.24, 0.4), (0.32, 0.32, 0.52)),
    "candles": FurnitureKind(candles, "object", (0.18, 0.18, 0.18), (0.22, 0.22, 0.26)),
    "chandelier": FurnitureKind(chandelier, "ceiling", (0.7, 0.7, 0.7), (0.95, 0.95, 0.85)),
    "pendant lamp": FurnitureKind(pendant, "ceiling", (0.34, 0.34, 0.6), (0.5, 0.5, 0.8)),
    "wall sconce": FurnitureKind(sconce, "wall", (0.14, 0.2, 0.3), (0.18, 0.24, 0.38)),
}
