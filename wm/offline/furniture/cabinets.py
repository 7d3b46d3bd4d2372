"""Closed cases of work and safekeeping: filing cabinet, lockers, server rack, display case, safe, arcade machine."""

import numpy as np

from wm.offline.furniture.common import frame_wood
from wm.offline.furniture.joinery import BLACK, wheel
from wm.offline.furniture.piece import FurnitureKind, Model, Size, Top, of, pick
from wm.offline.furniture.solids import ball, box, extrude, lathe, rod, rounded_box
from wm.offline.furniture.storage import vessel
from wm.offline.style.finish import Style


def filing_cabinet(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """A stack of deep drawers, each with a handle and a label."""
    w, d, h = size
    count = max(round(h / 0.33), 2)
    parts = of("metal", box((-w / 2, -d / 2 + 0.03, 0.03), (w / 2, d / 2, h)))
    parts += of("dark_metal", box((-w / 2 + 0.02, -d / 2 + 0.06, 0.0), (w / 2 - 0.02, d / 2 - 0.02, 0.05)))
    step = (h - 0.08) / count
    for k in range(count):
        z = 0.055 + k * step
        parts += of("metal", box((-w / 2 + 0.012, -d / 2 + 0.012, z), (w / 2 - 0.012, -d / 2 + 0.05, z + step - 0.012)))
        parts += of("dark_metal", box((-0.07, -d / 2, z + 0.5 * step), (0.07, -d / 2 + 0.03, z + 0.5 * step + 0.025)))
        parts += of("paper", box((-0.04, -d / 2 + 0.008, z + 0.72 * step), (0.04, -d / 2 + 0.03, z + 0.72 * step + 0.035)))
    return Model(parts, (Top(h, -w / 2 + 0.03, -d / 2 + 0.06, w / 2 - 0.03, d / 2 - 0.03),))


def lockers(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """A row of narrow steel doors with slits and locks."""
    w, d, h = size
    count = max(round(w / 0.32), 2)
    pitch, color = (w - 0.02) / count, pick(rng, style.accents)
    parts = of("metal", box((-w / 2, -d / 2 + 0.02, 0.06), (w / 2, d / 2, h)))
    parts += of("dark_metal", box((-w / 2 + 0.02, -d / 2 + 0.05, 0.0), (w / 2 - 0.02, d / 2 - 0.03, 0.08)))
    for k in range(count):
        x0, x1 = -w / 2 + 0.01 + k * pitch + 0.006, -w / 2 + 0.01 + (k + 1) * pitch - 0.006
        parts += of("painted_wood", box((x0, -d / 2 + 0.004, 0.08), (x1, -d / 2 + 0.04, h - 0.02)), color=color)
        for j in range(4):
            z = h - 0.16 - 0.035 * j
            parts += of("dark_metal", box((x0 + 0.06, -d / 2, z), (x1 - 0.06, -d / 2 + 0.02, z + 0.012), 0.0))
        parts += of("chrome", box((x1 - 0.045, -d / 2 - 0.014, 0.52 * h), (x1 - 0.025, -d / 2 + 0.02, 0.52 * h + 0.08)))
    return Model(parts)


def server_rack(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """A tall black frame full of units with lights in rows, cables on one side."""
    w, d, h = size
    parts = of("dark_metal", box((-w / 2, -d / 2 + 0.05, 0.0), (w / 2, d / 2, h)))
    for s in (-1, 1):
        parts += of("dark_metal", box((s * w / 2, -d / 2, 0.0), (s * (w / 2 - 0.045), -d / 2 + 0.07, h - 0.002)))
    parts += of(
        "dark_metal", *(box((-w / 2 + 0.04, -d / 2 + 0.002, z), (w / 2 - 0.04, -d / 2 + 0.07, z + 0.05)) for z in (0.0, h - 0.06))
    )
    z = 0.08
    while z < h - 0.16:
        tall = float(rng.choice([0.05, 0.05, 0.095]))
        parts += of(
            "metal" if rng.random() < 0.4 else "appliance",
            box((-w / 2 + 0.05, -d / 2 + 0.02, z), (w / 2 - 0.05, -d / 2 + 0.08, z + tall - 0.01)),
            color=None if rng.random() < 0.3 else (0.16, 0.17, 0.19),
        )
        for k in range(int(rng.integers(2, 6))):
            x, color = -w / 2 + 0.08 + 0.028 * k, pick(rng, ((0.2, 0.95, 0.4), (0.25, 0.6, 1.0), (1.0, 0.6, 0.15)))
            parts += of("bulb", box((x, -d / 2 + 0.014, z + 0.013), (x + 0.012, -d / 2 + 0.03, z + 0.025), 0.0), color=color)
        parts += of("dark_metal", box((0.06, -d / 2 + 0.015, z + 0.01), (w / 2 - 0.09, -d / 2 + 0.03, z + tall - 0.02), 0.0))
        z += tall + 0.006
    return Model(parts)


def display_case(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """A glazed box on a plinth, its glass carried by a thin frame, with exhibits on a cloth."""
    w, d, h = size
    wood, low = frame_wood(style), 0.48 * h
    parts = of(
        wood,
        box((-w / 2, -d / 2, 0.0), (w / 2, d / 2, 0.08)),
        box((-w / 2 + 0.03, -d / 2 + 0.03, 0.06), (w / 2 - 0.03, d / 2 - 0.03, low)),
    )
    parts += of("velvet", box((-w / 2 + 0.02, -d / 2 + 0.02, low - 0.01), (w / 2 - 0.02, d / 2 - 0.02, low + 0.015)))
    xs, ys = (-w / 2 + 0.012, w / 2 - 0.012), (-d / 2 + 0.012, d / 2 - 0.012)
    for z in (low + 0.005, h - 0.012):
        parts += of(
            "brass",
            *(rod((-w / 2, y, z), (w / 2, y, z), 0.012) for y in ys),
            *(rod((x, -d / 2, z), (x, d / 2, z), 0.0118) for x in xs),
        )
    parts += of("brass", *(rod((x, y, low), (x, y, h), 0.0115) for x in xs for y in ys))
    count = max(int(w / 0.32), 2)
    for k in range(count):
        x, tall = -w / 2 + (k + 0.5) * w / count, float(rng.uniform(0.45, 0.75)) * (h - low)
        if k % 2:
            parts += of("stone", box((x - 0.06, -0.06, low + 0.01), (x + 0.06, 0.06, low + 0.06)))
            parts += of(
                "brass",
                lathe(
                    [(0.03, 0), (0.012, 0.3 * tall), (0.06, 0.7 * tall), (0.07, tall - 0.06)],
                    16,
                    at=(x, 0, low + 0.055),
                    smooth=2,
                ),
            )
        else:
            parts += vessel(style, rng, x, 0.0, low + 0.016, min(tall, 0.3))
    return Model(parts)


def safe(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """A heavy steel box with a thick door, a dial and a spoked wheel."""
    w, d, h = size
    face = -d / 2 + 0.08
    parts = of(
        "dark_metal",
        rounded_box((-w / 2, face, 0.03), (w / 2, d / 2, h), 0.025),
        *(ball((sx * (w / 2 - 0.08), y, 0.04), 0.04) for sx in (-1, 1) for y in (face + 0.08, d / 2 - 0.08)),
    )
    parts += of("metal", rounded_box((-w / 2 + 0.06, face - 0.035, 0.1), (w / 2 - 0.06, face + 0.03, h - 0.07), 0.012, 1))
    parts += of("chrome", wheel((-0.1 * w, face - 0.04, 0.68 * h), 0.06, 0.05, "y"))
    parts += of("brass", wheel((0.1 * w, face - 0.045, 0.45 * h), 0.03, 0.07, "y"))
    for k in range(3):
        a = np.pi * k / 3
        c, s = 0.11 * float(np.cos(a)), 0.11 * float(np.sin(a))
        parts += of("brass", rod((0.1 * w - c, face - 0.065, 0.45 * h - s), (0.1 * w + c, face - 0.065, 0.45 * h + s), 0.011))
    return Model(
        parts
        + of(
            "dark_metal",
            *(rod((-w / 2 + 0.05, face - 0.01, z), (-w / 2 + 0.05, face - 0.01, z + 0.12), 0.022) for z in (0.2, h - 0.34)),
        )
    )


def arcade_machine(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """A painted cabinet with a lit sign, a sloping screen and a panel of buttons."""
    w, d, h = size
    side = [
        (d / 2, 0),
        (d / 2, h),
        (-0.2 * d, h),
        (-0.2 * d, h - 0.2),
        (0.02 * d, h - 0.3),
        (-0.1 * d, 0.62 * h),
        (-d / 2, 0.58 * h),
        (-d / 2, 0.5 * h),
        (-0.34 * d, 0.46 * h),
        (-0.34 * d, 0),
    ]
    inner = [(y + 0.02 if y < 0 else y - 0.012, min(z + 0.012, h - 0.012) if z < 0.6 * h else z - 0.014) for y, z in side]
    color = pick(rng, style.accents)
    parts = of("painted_wood", *(extrude(side, s * w / 2, s * (w / 2 - 0.03), "x") for s in (-1, 1)), color=color)
    parts += of("painted_wood", extrude(inner, -w / 2 + 0.028, w / 2 - 0.028, "x"), color=BLACK)
    parts += of(
        "lamp_shade",
        box((-w / 2 + 0.04, -0.2 * d - 0.004, h - 0.19), (w / 2 - 0.04, -0.1 * d, h - 0.025)),
        color=pick(rng, style.accents),
    )
    slope = [(-0.1 * d + 0.0, 0.64 * h), (0.02 * d - 0.004, h - 0.33), (0.06 * d, h - 0.33), (0.0, 0.64 * h)]
    parts += of("screen", extrude(slope, -w / 2 + 0.07, w / 2 - 0.07, "x"))
    y, z = -0.3 * d, 0.6 * h - 0.015
    parts += of("dark_metal", rod((-0.15, y, z - 0.03), (-0.15, y, z + 0.06), 0.008)) + of(
        "fabric_accent", ball((-0.15, y, z + 0.07), 0.022)
    )
    for k in range(4):
        parts += of(
            "bulb",
            lathe([(0.016, 0), (0.012, 0.035)], 10, at=(0.0 + 0.055 * k, y + 0.02 * (k % 2), z - 0.012)),
            color=pick(rng, ((0.9, 0.15, 0.15), (0.95, 0.8, 0.2), (0.2, 0.5, 0.95))),
        )
    return Model(parts)


KINDS = {
    "filing cabinet": FurnitureKind(filing_cabinet, "floor", (0.42, 0.5, 0.72), (0.48, 0.6, 1.34), front=0.5),
    "lockers": FurnitureKind(lockers, "floor", (0.9, 0.42, 1.7), (1.6, 0.5, 1.85), front=0.5),
    "server rack": FurnitureKind(server_rack, "floor", (0.6, 0.75, 1.7), (0.68, 0.95, 2.0), front=0.5),
    "display case": FurnitureKind(display_case, "floor", (0.9, 0.45, 1.1), (1.3, 0.6, 1.35)),
    "safe": FurnitureKind(safe, "floor", (0.6, 0.58, 0.8), (0.8, 0.7, 1.2), front=0.4),
    "arcade machine": FurnitureKind(arcade_machine, "floor", (0.6, 0.72, 1.65), (0.68, 0.82, 1.8), front=0.5),
}
