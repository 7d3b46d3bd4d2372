"""Counters where things are served or sold: bar with its stools, shop counter with a till, glazed counter of cakes."""

import numpy as np

from wm.offline.furniture.common import frame_wood
from wm.offline.furniture.joinery import BLACK, WHITE
from wm.offline.furniture.piece import FurnitureKind, Model, Size, Top, of, pick
from wm.offline.furniture.solids import box, extrude, lathe, puff, rod, rounded_box, tube
from wm.offline.style.finish import Style


def bar_counter(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """A high panelled counter with an overhanging top and a foot rail; guests sit at its front. A tap and glasses stand on it."""
    w, d, h = size
    top, wood = h - 0.26, frame_wood(style)
    face = -d / 2 + 0.2
    parts = of(wood, box((-w / 2 + 0.02, face, 0.0), (w / 2 - 0.02, d / 2 - 0.02, top - 0.03)))
    count = max(int(w / 0.5), 2)
    for k in range(count):
        x0, x1 = (-w / 2 + 0.05 + (w - 0.1) * (k + e) / count for e in (0, 1))
        parts += of("panel_wood", box((x0 + 0.03, face - 0.018, 0.14), (x1 - 0.03, face + 0.02, top - 0.1), 0.008))
    parts += of(
        "marble" if style.form.ornament > 0.3 else "dark_wood",
        rounded_box((-w / 2, -d / 2 + 0.02, top - 0.045), (w / 2, d / 2, top), 0.014, 1),
    )
    parts += of("brass", rod((-w / 2 + 0.04, face - 0.12, 0.2), (w / 2 - 0.04, face - 0.12, 0.2), 0.018))
    parts += of(
        "brass",
        *(rod((x, face - 0.12, 0.2), (x, face + 0.02, 0.2), 0.012) for x in np.linspace(-w / 2 + 0.12, w / 2 - 0.12, 3).tolist()),
    )
    x = 0.24 * w
    parts += of(
        "chrome",
        lathe([(0.05, 0), (0.035, 0.02), (0.028, 0.17), (0.034, 0.18)], 16, at=(x, 0.05, top)),
        tube([(x, 0.05, top + 0.17), (x, -0.08, top + 0.17), (x, -0.1, top + 0.11)], 0.013, 8),
    )
    parts += of("dark_wood", lathe([(0.01, 0), (0.02, 0.03), (0.014, 0.07)], 10, at=(x, 0.05, top + 0.18)))
    for k in range(4):
        parts += of(
            "glass",
            lathe(
                [(0.028, 0), (0.034, 0.12), (0.031, 0.12), (0.026, 0.012)],
                14,
                at=(-0.3 * w + 0.09 * k, 0.08 * (k % 2), top + 0.001),
            ),
            color=(0.8, 0.84, 0.85),
        )
    return Model(parts)


def bar_stool(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """A high round seat on a column with a foot ring."""
    w, _, h = size
    r = w / 2
    parts = of("chrome", lathe([(r, 0.0), (r, 0.015), (0.05, 0.05), (0.026, 0.09), (0.024, h - 0.09)], 24))
    angle = np.linspace(0, 2 * np.pi, 17)
    parts += of(
        "chrome",
        tube([(0.7 * r * float(np.cos(a)), 0.7 * r * float(np.sin(a)), 0.3) for a in angle], 0.01, 6),
        rod((-0.7 * r, 0, 0.3), (0.7 * r, 0, 0.3), 0.008),
    )
    return Model(parts + of("leather", lathe([(0.9 * r, h - 0.1), (r, h - 0.08), (r, h - 0.03), (0.85 * r, h)], 24, smooth=1)))


def shop_counter(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """A counter with a till, a card reader and a pile of bags; the buyer stands at its front."""
    w, d, h = size
    top, wood = h - 0.3, frame_wood(style)
    parts = of(wood, box((-w / 2 + 0.02, -d / 2 + 0.03, 0.06), (w / 2 - 0.02, d / 2 - 0.02, top - 0.03)))
    parts += of("dark_wood", box((-w / 2 + 0.04, -d / 2 + 0.07, 0.0), (w / 2 - 0.04, d / 2 - 0.05, 0.08)))
    count = max(int(w / 0.16), 5)
    for k in range(count):
        x0, x1 = (-w / 2 + 0.03 + (w - 0.06) * (k + e) / count for e in (0, 1))
        parts += of("panel_wood", box((x0 + 0.006, -d / 2 + 0.012, 0.07), (x1 - 0.006, -d / 2 + 0.05, top - 0.05)))
    parts += of("light_wood", rounded_box((-w / 2, -d / 2, top - 0.04), (w / 2, d / 2, top), 0.01, 1))
    x = 0.22 * w
    side = [(-0.16, 0.0), (0.18, 0.0), (0.18, 0.1), (0.02, 0.14), (-0.16, 0.09)]
    till = [(-y, z + top + 0.001) for y, z in side]
    parts += of("appliance", extrude(till, x - 0.19, x + 0.19, "x"), color=BLACK)
    parts += of(
        "appliance", rounded_box((x - 0.16, -0.09, top + 0.09), (x + 0.16, -0.03, top + 0.3), 0.012, 1), color=(0.2, 0.2, 0.22)
    )
    parts += of("screen", box((x - 0.14, -0.04, top + 0.12), (x + 0.14, -0.024, top + 0.28), 0.0)) + of(
        "screen", box((x - 0.08, -0.094, top + 0.2), (x + 0.08, -0.08, top + 0.27), 0.0)
    )
    for k in range(12):
        key = (x - 0.09 + 0.05 * (k % 4), 0.05 + 0.035 * (k // 4))
        parts += of(
            "appliance", box((key[0], key[1], top + 0.12), (key[0] + 0.034, key[1] + 0.024, top + 0.145), 0.0), color=WHITE
        )
    parts += of(
        "paper",
        *(box((-0.36 * w, -0.1, top + 0.002 + 0.012 * k), (-0.36 * w + 0.3, 0.12, top + 0.013 + 0.012 * k)) for k in range(4)),
        color=(0.68, 0.52, 0.34),
    )
    return Model(parts, (Top(top, -0.16 * w, -d / 2 + 0.05, 0.06 * w, d / 2 - 0.05),))


def cake_counter(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """A counter whose upper half is a lit case with breads and cakes behind a slim frame."""
    w, d, h = size
    low = 0.5
    parts = of("painted_wood", box((-w / 2 + 0.01, -d / 2 + 0.02, 0.05), (w / 2 - 0.01, d / 2, low)), color=WHITE)
    parts += of("dark_metal", box((-w / 2 + 0.04, -d / 2 + 0.06, 0.0), (w / 2 - 0.04, d / 2 - 0.03, 0.06)))
    parts += of(
        frame_wood(style),
        rounded_box((-w / 2, -0.1 * d, h - 0.04), (w / 2, d / 2, h), 0.01, 1),
        box((-w / 2 + 0.012, d / 2 - 0.04, low - 0.01), (w / 2 - 0.012, d / 2 - 0.01, h - 0.03)),
    )
    for x in (-w / 2 + 0.015, w / 2 - 0.015):
        parts += of(
            "chrome",
            tube([(x, -d / 2 + 0.03, low - 0.01), (x, -d / 2 + 0.05, 0.8 * h), (x, -0.1 * d, h - 0.02)], 0.012, 8),
            rod((x, d / 2 - 0.03, low), (x, d / 2 - 0.03, h - 0.02), 0.0118),
        )
    parts += of("chrome", rod((-w / 2, -d / 2 + 0.05, 0.8 * h), (w / 2, -d / 2 + 0.05, 0.8 * h), 0.011))
    for level, y0 in ((low + 0.001, -d / 2 + 0.08), (0.5 * (low + h), -0.24 * d)):
        if level > low + 0.01:
            parts += of("marble", box((-w / 2 + 0.02, y0 - 0.03, level - 0.02), (w / 2 - 0.02, d / 2 - 0.03, level)))
        count = max(int((w - 0.1) / 0.2), 4)
        for k in range(count):
            x, y = -w / 2 + 0.05 + (k + 0.5) * (w - 0.1) / count, 0.5 * (y0 + d / 2 - 0.06)
            if k % 2:
                crust = pick(rng, ((0.72, 0.46, 0.2), (0.55, 0.32, 0.13), (0.82, 0.6, 0.32)))
                parts += of(
                    "woven", puff((x - 0.08, y - 0.13, level), (x + 0.08, y + 0.13, level + 0.1), square=0.8), color=crust
                )
            else:
                icing = pick(rng, ((0.92, 0.7, 0.74), (0.95, 0.92, 0.85), (0.35, 0.19, 0.12)))
                parts += of("ceramic", lathe([(0.075, 0), (0.09, 0.012), (0.06, 0.012)], 18, at=(x, y, level)), color=WHITE)
                parts += of("wax", lathe([(0.07, 0.01), (0.07, 0.09), (0.06, 0.1)], 18, at=(x, y, level)), color=icing)
    return Model(parts)


KINDS = {
    "bar counter": FurnitureKind(bar_counter, "floor", (1.5, 0.64, 1.34), (2.4, 0.72, 1.38)),
    "bar stool": FurnitureKind(bar_stool, "floor", (0.36, 0.36, 0.7), (0.4, 0.4, 0.78)),
    "shop counter": FurnitureKind(shop_counter, "floor", (1.2, 0.58, 1.22), (1.7, 0.66, 1.28)),
    "cake counter": FurnitureKind(cake_counter, "floor", (1.2, 0.66, 1.18), (1.7, 0.76, 1.3)),
}
