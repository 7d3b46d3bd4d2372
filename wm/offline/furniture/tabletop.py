"""Small things for surfaces: vase, bowl of fruit, books, tableware, candlestick, screens."""

import math

import numpy as np

from wm.offline.furniture.common import candle
from wm.offline.furniture.piece import FurnitureKind, Model, Size, of, pick
from wm.offline.furniture.solids import ball, box, extrude, lathe, rounded_box, shift, turn
from wm.offline.furniture.storage import vessel
from wm.offline.style.finish import Style


def vase(style: Style, rng: np.random.Generator, size: Size) -> Model:
    return Model(vessel(style, rng, 0.0, 0.0, 0.0, size[2]))


def bowl(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """A bowl of fruit."""
    w, _, h = size
    r = w / 2
    parts = of(
        "ceramic",
        lathe(
            [(0.4 * r, 0.0), (0.45 * r, 0.1 * h), (0.85 * r, 0.45 * h), (r, 0.7 * h), (0.94 * r, 0.7 * h), (0.7 * r, 0.4 * h)], 24
        ),
        color=pick(rng, style.accents),
    )
    for k in range(6):
        a = 2 * math.pi * k / 5
        at = (0.5 * r * math.cos(a), 0.5 * r * math.sin(a), 0.66 * h) if k < 5 else (0.0, 0.0, h - 0.3 * r)
        parts += of("flower", ball(at, 0.29 * r, 10), color=((0.75, 0.2, 0.15), (0.85, 0.55, 0.15), (0.5, 0.6, 0.2))[k % 3])
    return Model(parts)


def book_pile(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """A pile of books. Each is a cover around a block of pages."""
    w, d, h = size
    count = max(int(h / 0.035), 2)
    z, parts = 0.0, []
    for _k in range(count):
        thick = h / count
        wide, deep = w * float(rng.uniform(0.8, 0.95)), d * float(rng.uniform(0.8, 0.95))
        color = pick(rng, style.accents)
        angle = float(rng.uniform(-9, 9))
        pages = box(
            (-wide / 2 + 0.006, -deep / 2 + 0.006, z + 0.003), (wide / 2 - 0.004, deep / 2 - 0.006, z + thick - 0.003), 0.0
        )
        covers = [
            box((-wide / 2, -deep / 2, z), (wide / 2, deep / 2, z + 0.0035), 0.0),
            box((-wide / 2, -deep / 2, z + thick - 0.0035), (wide / 2, deep / 2, z + thick), 0.0),
            box(
                (-wide / 2 - 0.003, -deep / 2 + 0.0005, z + 0.0005),
                (-wide / 2 + 0.004, deep / 2 - 0.0005, z + thick - 0.0005),
                0.0,
            ),
        ]
        parts += of("paper", turn(pages, "z", angle)) + of("book", *(turn(c, "z", angle) for c in covers), color=color)
        z += thick + 0.0006
    return Model(parts)


def open_book(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """A book lying open."""
    w, d, _ = size
    t = np.linspace(0, 1, 8)
    page = [(float(w / 2 * a), float(0.012 + 0.022 * math.sin(math.pi * min(1.0, 1.15 * (1 - a))) * (1 - 0.4 * a))) for a in t]
    parts = of("leather", box((-w / 2 - 0.006, -d / 2 - 0.006, 0.0), (w / 2 + 0.006, d / 2 + 0.006, 0.006), 0.0))
    for s in (-1.0, 1.0):
        outline = [
            (0.002 * s, 0.004),
            (s * w / 2, 0.004),
            *((s * x + (0.002 * s if x == 0 else 0.0), z) for x, z in reversed(page)),
        ]
        parts += of("paper", extrude(outline, -d / 2, d / 2, "y"))
    return Model(parts)


def tableware(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """A plate and a cup."""
    w, _, h = size
    r = 0.5 * (w - 0.08)
    parts = of("ceramic", lathe([(0.6 * r, 0.0), (r, 0.02), (r - 0.004, 0.023), (0.62 * r, 0.008)], 28))
    cup = shift(
        lathe([(0.022, 0.0), (0.036, 0.4 * h), (0.038, h), (0.034, h), (0.03, 0.5 * h)], 18, smooth=1), (r + 0.035, 0.3 * r, 0.0)
    )
    return Model(parts + of("ceramic", cup, color=pick(rng, style.accents)))


def urn_candle(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """A single candlestick."""
    _, _, h = size
    stem = 0.55 * h
    profile = [(0.05, 0.0), (0.048, 0.06), (0.015, 0.14), (0.022, 0.4), (0.012, 0.5), (0.016, 0.8), (0.03, 0.92), (0.03, 1.0)]
    parts = of("brass", lathe([(r, z * stem) for r, z in profile], 18, smooth=1))
    return Model(parts + candle(0, 0, stem - 0.002, h - stem - 0.05))


def television(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """A flat screen on a foot."""
    w, d, h = size
    parts = of("dark_metal", rounded_box((-w / 2, -0.02, 0.07), (w / 2, 0.025, h), 0.008, 1))
    parts += of("screen", box((-w / 2 + 0.012, -0.0225, 0.085), (w / 2 - 0.012, 0.0, h - 0.012), 0.0))
    return Model(
        parts
        + of("dark_metal", box((-0.05, -0.01, 0.01), (0.05, 0.02, 0.09)), box((-0.22 * w, -d / 2, 0.0), (0.22 * w, d / 2, 0.014)))
    )


def monitor(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """A computer screen with a keyboard in front of it."""
    w, d, h = size
    y = d / 2 - 0.1
    parts = of(
        "dark_metal",
        rounded_box((-w / 2, y, 0.12), (w / 2, y + 0.03, h), 0.008, 1),
        box((-0.025, y + 0.02, 0.01), (0.025, y + 0.045, 0.24)),
        box((-0.11, y - 0.07, 0.0), (0.11, y + 0.1, 0.012)),
    )
    parts += of("screen", box((-w / 2 + 0.01, y - 0.003, 0.132), (w / 2 - 0.01, y + 0.01, h - 0.01), 0.0))
    return Model(parts + of("appliance", rounded_box((-0.21, -d / 2, 0.0), (0.21, -d / 2 + 0.13, 0.018), 0.006, 1)))


KINDS = {
    "vase": FurnitureKind(vase, "object", (0.14, 0.14, 0.2), (0.2, 0.2, 0.32)),
    "bowl": FurnitureKind(bowl, "object", (0.24, 0.24, 0.13), (0.3, 0.3, 0.16)),
    "pile of books": FurnitureKind(book_pile, "object", (0.2, 0.26, 0.08), (0.24, 0.3, 0.16)),
    "open book": FurnitureKind(open_book, "object", (0.3, 0.22, 0.04), (0.36, 0.26, 0.04)),
    "tableware": FurnitureKind(tableware, "object", (0.3, 0.26, 0.08), (0.34, 0.28, 0.09)),
    "candlestick": FurnitureKind(urn_candle, "object", (0.1, 0.1, 0.26), (0.1, 0.1, 0.36)),
    "television": FurnitureKind(television, "object", (1.0, 0.2, 0.64), (1.25, 0.24, 0.76)),
    "computer monitor": FurnitureKind(monitor, "object", (0.55, 0.42, 0.42), (0.65, 0.46, 0.48)),
}
