"""Open shelves with what is kept on them: jars, goods, bottles, boxes, clothes, shoes, weapons."""

import numpy as np

from wm.offline.furniture.common import frame_wood
from wm.offline.furniture.joinery import bottles, cartons, jars, posts
from wm.offline.furniture.piece import FurnitureKind, Model, Part, Size, of, pick
from wm.offline.furniture.solids import Real, box, lathe, rod, rounded_box, shift, tube, turn
from wm.offline.furniture.storage import carcass
from wm.offline.style.finish import Style


def boards(w: Real, d: Real, heights: list[float], thickness: Real = 0.022) -> list:
    """Shelves whose upper sides lie at the heights."""
    return [box((-w / 2, -d / 2 + 0.006, z - thickness), (w / 2, d / 2 - 0.006, z)) for z in heights]


def cased(style: Style, size: Size, levels: int) -> tuple[list[Part], list[float]]:
    """An open case in the style's wood, and the heights of its boards."""
    w, d, h = size
    heights = np.linspace(0.1, h - 0.03, levels + 1)[:-1].tolist()
    parts = of(frame_wood(style), *carcass(w, d, 0.0, h))
    return parts + of(frame_wood(style), *boards(w - 0.044, d - 0.02, heights)), heights


def larder_shelf(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """Preserves in jars, tins and a few bottles on five boards."""
    w, d, _ = size
    parts, heights = cased(style, size, 5)
    room = heights[1] - heights[0] - 0.05
    inner = w / 2 - 0.05
    for k, z in enumerate(heights):
        if k == 0:
            parts += cartons(style, rng, -inner, inner, -d / 2 + 0.03, d / 2 - 0.03, z + 0.001, 0.85 * room, wide=0.26)
        elif k == 4:
            parts += bottles(rng, -inner, inner, 0.0, z + 0.001, min(room, 0.3))
        else:
            parts += jars(rng, -inner, inner, -0.05, z + 0.001, min(0.75 * room, 0.22))
    return Model(parts)


def shop_shelf(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """A gondola: a back panel on a plinth and four boards of goods with price strips along their edges."""
    w, d, h = size
    heights = np.linspace(0.14, h - 0.34, 4).tolist()
    parts = of(
        "painted_wood",
        box((-w / 2, d / 2 - 0.05, 0.0), (w / 2, d / 2, h)),
        box((-w / 2, -d / 2, 0.0), (w / 2, d / 2 - 0.01, 0.12)),
    )
    for k, z in enumerate(heights):
        deep = d if k == 0 else d - 0.08
        y0 = d / 2 - deep
        parts += of("metal", box((-w / 2 + 0.004, y0 + 0.004, z - 0.022), (w / 2 - 0.004, d / 2 - 0.03, z)))
        parts += of("paper", box((-w / 2 + 0.01, y0 - 0.004, z - 0.035), (w / 2 - 0.01, y0 + 0.012, z - 0.004)))
        room = (heights[1] - heights[0]) * 0.72
        parts += cartons(style, rng, -w / 2 + 0.03, w / 2 - 0.03, y0 + 0.03, d / 2 - 0.07, z + 0.001, room, wide=0.14)
    return Model(parts)


def bottle_shelf(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """A case with a mirror behind rows of bottles, doors below."""
    w, d, h = size
    wood = frame_wood(style)
    parts = of(wood, *carcass(w, d, 0.0, h), box((-w / 2 + 0.004, -d / 2 + 0.004, 0.0), (w / 2 - 0.004, d / 2 - 0.02, 0.62)))
    parts += of("mirror", box((-w / 2 + 0.026, d / 2 - 0.034, 0.64), (w / 2 - 0.026, d / 2 - 0.014, h - 0.03)))
    count = max(int(w / 0.45), 2)
    for k in range(count):
        x0, x1 = (-w / 2 + 0.03 + (w - 0.06) * (k + e) / count for e in (0, 1))
        parts += of(wood, box((x0 + 0.008, -d / 2 - 0.012, 0.06), (x1 - 0.008, -d / 2 + 0.02, 0.57)))
        parts += of("brass", rod((x1 - 0.05, -d / 2 - 0.02, 0.3), (x1 - 0.05, -d / 2 - 0.02, 0.42), 0.007))
    step = (h - 0.66) / 4
    for k in range(4):
        z = 0.625 + k * step
        if k:
            parts += of(wood, *boards(w - 0.044, d - 0.06, [z]))
        parts += bottles(rng, -w / 2 + 0.04, w / 2 - 0.04, -0.02, z + 0.001, min(step - 0.06, 0.31))
    return Model(parts)


def storage_rack(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """A metal rack with boxes and crates."""
    w, d, h = size
    xs, ys = (-w / 2 + 0.02, w / 2 - 0.02), (-d / 2 + 0.02, d / 2 - 0.02)
    parts = of("metal", *posts(xs, ys, 0.0, h, 0.04))
    heights = np.linspace(0.12, h - 0.04, 4).tolist()
    parts += of("metal", *boards(w - 0.01, d - 0.01, heights, 0.03))
    for z in heights[:-1]:
        parts += cartons(
            style,
            rng,
            -w / 2 + 0.05,
            w / 2 - 0.05,
            -d / 2 + 0.04,
            d / 2 - 0.05,
            z + 0.001,
            0.8 * (heights[1] - heights[0]),
            wide=0.36,
        )
    return Model(parts)


def clothes_rack(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """A rail between two posts with clothes on hangers, a board for shoes below."""
    w, d, h = size
    parts = of("dark_metal", *(rod((s * (w / 2 - 0.02), 0, 0.03), (s * (w / 2 - 0.02), 0, h - 0.02), 0.016) for s in (-1, 1)))
    parts += of("dark_metal", rod((-w / 2, 0, h - 0.02), (w / 2, 0, h - 0.02), 0.016))
    parts += of(
        "dark_metal", *(box((s * (w / 2 - 0.02) - 0.02, -d / 2, 0), (s * (w / 2 - 0.02) + 0.02, d / 2, 0.04)) for s in (-1, 1))
    )
    parts += of(frame_wood(style), box((-w / 2 + 0.03, -d / 2 + 0.06, 0.12), (w / 2 - 0.03, d / 2 - 0.06, 0.14)))
    count = int((w - 0.2) / 0.09)
    for k in range(count):
        x, long = -w / 2 + 0.1 + (k + 0.5) * (w - 0.2) / count, float(rng.uniform(0.7, 1.15))
        low = max(h - 0.13 - long, 0.2)
        cloth = rounded_box((-0.026, -0.22, low), (0.026, 0.22, h - 0.13), 0.025)
        parts += of("fabric", shift(turn(cloth, "z", float(rng.uniform(-9, 9))), (x, 0, 0)), color=pick(rng, style.accents))
        parts += of("chrome", tube([(x, 0, h - 0.14), (x, 0, h - 0.05), (x, 0.016, h - 0.006)], 0.004, 6))
    return Model(parts)


def shoe_rack(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """Two boards with pairs of shoes."""
    w, d, h = size
    wood = frame_wood(style)
    parts = of(wood, *(box((s * w / 2, -d / 2, 0.0), (s * (w / 2 - 0.022), d / 2, h)) for s in (-1, 1)))
    parts += of(wood, *boards(w - 0.04, d, [0.1, 0.1 + 0.5 * (h - 0.1), h - 0.003]))
    for z in (0.101, 0.101 + 0.5 * (h - 0.1)):
        count = int((w - 0.1) / 0.24)
        for k in range(count):
            x, color = (
                -w / 2 + 0.05 + (k + 0.5) * (w - 0.1) / count,
                pick(rng, ((0.12, 0.09, 0.07), (0.4, 0.22, 0.1), *style.accents)),
            )
            for s in (-1, 1):
                sole = rounded_box((-0.04, -0.12, 0.0), (0.04, 0.12, 0.05), 0.024)
                shaft = rounded_box((-0.036, 0.0, 0.02), (0.036, 0.11, 0.1), 0.03)
                parts += of("leather", *(shift(part, (x + s * 0.05, 0, z)) for part in (sole, shaft)), color=color)
    return Model(parts)


def weapon_rack(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """Spears and swords upright in a wooden rack."""
    w, d, h = size
    wood = frame_wood(style)
    parts = of(
        wood,
        box((-w / 2, -d / 2, 0.0), (w / 2, d / 2, 0.1)),
        *posts((-w / 2 + 0.04, w / 2 - 0.04), (d / 2 - 0.05,), 0.05, 1.15, 0.07),
    )
    parts += of(wood, *(box((-w / 2, d / 2 - 0.08, z), (w / 2, d / 2 - 0.02, z + 0.08)) for z in (0.55, 1.05)))
    count = max(int((w - 0.2) / 0.17), 3)
    for k in range(count):
        x, y = -w / 2 + 0.12 + (k + 0.5) * (w - 0.24) / count, -0.02
        if k % 2:
            parts += of(wood, rod((x, y, 0.09), (x, y + 0.04, h - 0.25), 0.014))
            parts += of("metal", lathe([(0.0, 0.0), (0.018, 0.0), (0.034, 0.07), (0.0, 0.26)], 8, at=(x, y + 0.04, h - 0.27)))
        else:
            parts += of("metal", box((x - 0.024, y - 0.005, 0.09), (x + 0.024, y + 0.005, 0.95)))
            parts += of("brass", box((x - 0.09, y - 0.016, 0.945), (x + 0.09, y + 0.016, 0.975)))
            parts += of("leather", rod((x, y, 0.97), (x, y, 1.14), 0.016))
    return Model(parts)


KINDS = {
    "larder shelf": FurnitureKind(larder_shelf, "floor", (0.8, 0.34, 1.7), (1.2, 0.4, 2.0), front=0.5),
    "shop shelf": FurnitureKind(shop_shelf, "floor", (0.9, 0.42, 1.45), (1.3, 0.5, 1.7), front=0.5),
    "bottle shelf": FurnitureKind(bottle_shelf, "floor", (1.2, 0.32, 1.9), (1.8, 0.36, 2.1), front=0.4),
    "storage rack": FurnitureKind(storage_rack, "floor", (0.9, 0.42, 1.6), (1.4, 0.5, 1.9), front=0.4),
    "clothes rack": FurnitureKind(clothes_rack, "floor", (1.0, 0.5, 1.6), (1.5, 0.54, 1.75), front=0.4),
    "shoe rack": FurnitureKind(shoe_rack, "floor", (0.7, 0.28, 0.44), (0.95, 0.32, 0.52), front=0.2),
    "weapon rack": FurnitureKind(weapon_rack, "floor", (0.9, 0.3, 1.8), (1.4, 0.36, 2.0), front=0.4),
}
