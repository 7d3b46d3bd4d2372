"""Things of a laundry: washing machine, ironing board, drying rack."""

import numpy as np

from wm.offline.furniture.joinery import BLACK, WHITE, wheel
from wm.offline.furniture.outlines import rounded
from wm.offline.furniture.piece import FurnitureKind, Model, Part, Size, Top, of, pick
from wm.offline.furniture.solids import box, extrude, rod, rounded_box, shift, tube
from wm.offline.style.finish import Style


def washing_machine(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """A white case with a round glass door, a drawer and a dial."""
    w, d, h = size
    face = -d / 2 + 0.03
    middle = (0.0, face, 0.44 * h)
    parts = of("appliance", rounded_box((-w / 2, face, 0.02), (w / 2, d / 2, h), 0.015, 1), color=WHITE)
    parts += of("dark_metal", box((-w / 2 + 0.03, face + 0.04, 0.0), (w / 2 - 0.03, d / 2 - 0.03, 0.05)))
    parts += of("chrome", wheel(middle, 0.36 * w, 0.055, "y", 32)) + of(
        "appliance", wheel(middle, 0.29 * w, 0.062, "y", 28), color=BLACK
    )
    parts += of("glass", wheel((0, face - 0.004, 0.44 * h), 0.24 * w, 0.07, "y", 28))
    parts += of(
        "appliance", box((-w / 2 + 0.03, face - 0.012, h - 0.14), (-0.06, face + 0.02, h - 0.05)), color=(0.78, 0.79, 0.8)
    )
    parts += of("chrome", wheel((0.06, face, h - 0.095), 0.035, 0.05, "y"))
    parts += of("screen", box((0.13, face - 0.006, h - 0.13), (w / 2 - 0.04, face + 0.02, h - 0.06)))
    return Model(parts, (Top(h, -w / 2 + 0.05, -d / 2 + 0.08, w / 2 - 0.05, d / 2 - 0.05),))


def ironing_board(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """A padded board with a narrow nose on crossed legs, an iron standing on it."""
    w, d, h = size
    top = h - 0.14
    board = rounded(w, d - 0.02, 0.12, at=(0.0, -d / 2 + 0.01)).union(
        rounded(0.4 * w, 0.5 * d, 0.2 * d, at=(-0.3 * w, -0.25 * d))
    )
    outline = board.intersection(board.buffer(0))
    parts = of("fabric", extrude(outline, top - 0.035, top, "z"), color=pick(rng, style.accents))
    for s in (-1, 1):
        y = s * 0.32 * d
        parts += of(
            "chrome",
            rod((-0.34 * w, y, 0.02), (0.3 * w, 0.9 * y, top - 0.03), 0.011),
            rod((0.34 * w, y, 0.02), (-0.3 * w, 0.9 * y, top - 0.03), 0.011),
        )
    parts += of("chrome", *(rod((s * 0.34 * w, -d / 2, 0.015), (s * 0.34 * w, d / 2, 0.015), 0.014) for s in (-1, 1)))
    x = 0.3 * w
    sole = [(x - 0.12, 0.0), (x - 0.02, 0.055), (x + 0.1, 0.055), (x + 0.1, -0.055), (x - 0.02, -0.055)]
    parts += of("chrome", extrude(sole, top + 0.001, top + 0.015, "z"))
    parts += of("appliance", rounded_box((x - 0.05, -0.045, top + 0.012), (x + 0.095, 0.045, top + 0.07), 0.02), color=WHITE)
    handle = [(x - 0.04, 0, top + 0.06), (x - 0.02, 0, top + 0.13), (x + 0.08, 0, top + 0.13), (x + 0.085, 0, top + 0.06)]
    return Model(parts + of("dark_metal", tube(handle, 0.011, 8)))


def drying_rack(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """A folding rack with washing over its bars."""
    w, d, h = size
    parts: list[Part] = []
    for s in (-1, 1):
        x = s * (w / 2 - 0.012)
        parts += of(
            "chrome", rod((x, -d / 2, 0.0), (x, 0.3 * d, h - 0.03), 0.011), rod((x, d / 2, 0.0), (x, -0.3 * d, h - 0.03), 0.011)
        )
        parts += of("chrome", rod((x, -d / 2 + 0.01, h - 0.03), (x, d / 2 - 0.01, h - 0.03), 0.011))
    ys = np.linspace(-d / 2 + 0.02, d / 2 - 0.02, 7).tolist()
    parts += of("chrome", *(rod((-w / 2, y, h - 0.03), (w / 2, y, h - 0.03), 0.006) for y in ys))
    for k, y in enumerate(ys[1:-1]):
        wide, drop = float(rng.uniform(0.3, 0.5)) * w, float(rng.uniform(0.3, 0.55)) * h
        x = (-1) ** k * 0.2 * w
        cloth = [
            box((-wide / 2, -0.012, h - drop), (wide / 2, -0.004, h)),
            box((-wide / 2, 0.004, h - 0.8 * drop), (wide / 2, 0.012, h)),
        ]
        fold = box((-wide / 2 + 0.001, -0.0115, h - 0.022), (wide / 2 - 0.001, 0.0115, h - 0.001))
        parts += of("linen", *(shift(solid, (x, y, 0.0)) for solid in (*cloth, fold)), color=pick(rng, (WHITE, *style.accents)))
    return Model(parts)


KINDS = {
    "washing machine": FurnitureKind(washing_machine, "floor", (0.58, 0.58, 0.84), (0.62, 0.64, 0.88), front=0.6),
    "ironing board": FurnitureKind(ironing_board, "floor", (1.2, 0.36, 0.98), (1.35, 0.4, 1.06)),
    "drying rack": FurnitureKind(drying_rack, "floor", (1.0, 0.5, 0.9), (1.2, 0.56, 1.0)),
}
