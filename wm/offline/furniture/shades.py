"""Lamp shades: shells, globes, lanterns, paper shades, bowls, and a wheel of globes."""

import math

import numpy as np

from wm.offline.furniture.outlines import gear
from wm.offline.furniture.piece import Part, of
from wm.offline.furniture.solids import Real, ball, box, extrude, lathe, rod, rounded_box, shell
from wm.offline.style.finish import Style


def shade(style: Style, kind: str, radius: Real, height: Real, z: Real) -> list[Part]:
    """A lamp shade whose lower end is at z: an open shell around a bulb, or a closed globe."""
    if kind in ("globe", "cluster"):
        return of("lamp_shade", ball((0, 0, z + radius), radius, 24))
    if kind == "lantern":
        side = radius * 0.75
        parts = of(
            "lamp_shade",
            rounded_box((-side * 0.86, -side * 0.86, z + 0.02), (side * 0.86, side * 0.86, z + height - 0.02), 0.01, 1),
        )
        for sx in (-1.0, 1.0):
            for sy in (-1.0, 1.0):
                parts += of(
                    "dark_metal",
                    box((sx * side - 0.009, sy * side - 0.009, z), (sx * side + 0.009, sy * side + 0.009, z + height)),
                )
        for low in (z, z + height - 0.03):
            parts += of("dark_metal", box((-side - 0.012, -side - 0.012, low), (side + 0.012, side + 0.012, low + 0.025)))
        return parts
    if kind == "paper":  # a flattened lantern of paper over hoops
        turns = np.linspace(-0.5 * math.pi, 0.5 * math.pi, 19)
        ribbed = [
            (radius * math.cos(a) * (1 - 0.02 * (k % 2)), z + 0.5 * height * (1 + math.sin(a))) for k, a in enumerate(turns)
        ]
        return of("lamp_shade", lathe([(max(r, 0.06 * radius), h) for r, h in ribbed], 28))
    if kind in ("rattan", "dome"):
        slot = "woven" if kind == "rattan" else ("brass" if style.form.ornament > 0.5 else "painted_wood")
        dome = [(1.0, 0.0), (0.97, 0.2), (0.8, 0.55), (0.45, 0.85), (0.12, 1.0)]
        outer = [(radius * r, z + height * share) for r, share in dome]
        return [*of(slot, shell(outer, 0.008)), *of("bulb", ball((0, 0, z + 0.35 * height), min(0.05, 0.3 * radius)))]
    if kind == "bowl":
        bowl = [
            (0.03, 0.0),
            (0.5 * radius, 0.12 * height),
            (0.85 * radius, 0.45 * height),
            (radius, height),
            (0.94 * radius, height),
        ]
        return of("lamp_shade", lathe([(r, z + h) for r, h in bowl], 28, smooth=1))
    top = {"cone": 0.5, "candle": 0.6, "tripod": 0.6}.get(kind, 0.86) * radius
    outer = [(radius, z), (top, z + height)]
    if kind in ("cone", "candle", "tripod"):
        outer = [(radius, z), (0.78 * radius, z + 0.35 * height), (0.62 * radius, z + 0.7 * height), (top, z + height)]
    bulb = ball((0, 0, z + 0.45 * height), 0.035)
    return [*of("lamp_shade", shell(outer, 0.004)), *of("bulb", bulb)]


def standing(style: Style) -> str:
    """The shade of standing lamps in a room whose hanging lamps have this shade."""
    hung, usual = style.form.lamp, "cone" if style.form.ornament > 0.5 else "drum"
    lantern = "cone" if style.form.ornament > 0.5 else "lantern"
    table = {"cluster": "globe", "bowl": "cone", "rattan": "drum", "paper": "drum", "dome": usual, "lantern": lantern}
    return table.get(hung, hung)


def wheel_of_globes(w: Real, h: Real) -> list[Part]:
    """A gear wheel that hangs level on rods, amber globes below its rim."""
    r, level = 0.5 * w - 0.07, 0.2
    parts = of("brass", extrude(gear(r, 24, spokes=6), level, level + 0.022, "z"))
    parts += of("dark_metal", lathe([(0.05, h - 0.03), (0.05, h)], 16), rod((0, 0, level - 0.03), (0, 0, h - 0.02), 0.009))
    for k in range(4):
        a = math.pi / 2 * k + 0.4
        x, y = 0.93 * r * math.cos(a), 0.93 * r * math.sin(a)
        parts += of(
            "dark_metal",
            rod((x, y, level + 0.02), (0.02 * math.cos(a), 0.02 * math.sin(a), min(h - 0.05, level + 0.34)), 0.004, 6),
        )
        parts += of("brass", lathe([(0.02, level - 0.075), (0.03, level - 0.03), (0.014, level + 0.02)], 12, at=(x, y, 0)))
        parts += of("lamp_shade", ball((x, y, level - 0.125), 0.068, 16))
    return parts
