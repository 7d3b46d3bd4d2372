"""Tables: dining (long and round), coffee, side, console, desk, nightstand."""

import itertools

import numpy as np

from wm.offline.furniture.common import COLUMN, TURNED, frame_wood, front, legs
from wm.offline.furniture.outlines import arch, rounded
from wm.offline.furniture.piece import FurnitureKind, Model, Part, Size, Top, of
from wm.offline.furniture.solids import Real, box, extrude, lathe, rounded_box, shift, tube
from wm.offline.style.finish import Style


def slab_top(style: Style, w: Real, d: Real, h: Real, thickness: Real, *, slot: str) -> list[Part]:
    """A table top with the edge of the style."""
    if style.form.ornament > 0.5:
        lower = rounded_box(
            (-w / 2 + 0.015, -d / 2 + 0.015, h - thickness - 0.012), (w / 2 - 0.015, d / 2 - 0.015, h - thickness * 0.5), 0.008, 1
        )
        return of(slot, rounded_box((-w / 2, -d / 2, h - thickness), (w / 2, d / 2, h), 0.012, 1), lower)
    if style.form.softness > 0.5:
        corner = extrude(rounded(w, d, 0.05, at=(0.0, -d / 2)), h - thickness, h, "z")
        return of(slot, corner)
    return of(slot, box((-w / 2, -d / 2, h - thickness), (w / 2, d / 2, h), 0.003))


def top_of(w: Real, d: Real, h: Real, inset: Real = 0.03) -> tuple[Top, ...]:
    return (Top(h, -w / 2 + inset, -d / 2 + inset, w / 2 - inset, d / 2 - inset),)


def table(style: Style, w: Real, d: Real, h: Real, *, thickness: Real, leg: Real, apron: Real = 0.07) -> Model:
    """A rectangular table on legs, or on end panels or marble trestles in some styles."""
    form = style.form
    if form.legs == "column":
        parts = of("marble", rounded_box((-w / 2, -d / 2, h - thickness - 0.01), (w / 2, d / 2, h), 0.012, 1))
        for s in (-1.0, 1.0):
            outline = [
                (-0.36 * d, 0.0),
                (0.36 * d, 0.0),
                (0.36 * d, 0.06),
                (0.24 * d, 0.11),
                (0.16 * d, h * 0.5),
                (0.22 * d, h - 0.15),
                (0.38 * d, h - 0.08),
                (0.38 * d, h - thickness),
                (-0.38 * d, h - thickness),
                (-0.38 * d, h - 0.08),
                (-0.22 * d, h - 0.15),
                (-0.16 * d, h * 0.5),
                (-0.24 * d, 0.11),
                (-0.36 * d, 0.06),
            ]
            x = s * (w / 2 - 0.16 * w)
            parts += of("marble", extrude(outline, x - 0.05, x + 0.05, "x"))
        return Model(parts, top_of(w, d, h))
    wood = frame_wood(style)
    parts = slab_top(style, w, d, h, thickness, slot=wood)
    if form.legs == "slab":
        for s in (-1.0, 1.0):
            x = s * (w / 2 - 0.05)
            parts += of(wood, box((x - 0.025, -d / 2 + 0.02, 0.0), (x + 0.025, d / 2 - 0.02, h - thickness + 0.005)))
        return Model(parts, top_of(w, d, h))
    parts += legs(style, w - 0.05, d - 0.05, h - thickness + 0.004, leg, slot=wood)
    if form.legs != "hairpin" and apron:
        under, lower = h - thickness + 0.004, h - thickness - apron
        gap = 0.03 + leg * 0.6
        for s in (-1.0, 1.0):
            y, x = s * (d / 2 - gap - 0.012), s * (w / 2 - gap - 0.012)
            parts += of(wood, box((-w / 2 + gap, y - 0.011, lower), (w / 2 - gap, y + 0.011, under)))
            parts += of(wood, box((x - 0.0108, -d / 2 + gap, lower + 0.002), (x + 0.0108, d / 2 - gap, under)))
    return Model(parts, top_of(w, d, h))


def dining_table(style: Style, rng: np.random.Generator, size: Size) -> Model:
    return table(style, *size, thickness=0.04, leg=0.09)


def round_table(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """A pedestal table."""
    w, _, h = size
    r = w / 2
    stone = style.form.legs == "column"
    slot = "marble" if stone else frame_wood(style)
    parts = of(slot, lathe([(r - 0.02, h - 0.04), (r, h - 0.03), (r, h - 0.008), (r - 0.008, h)], 36))
    profile = COLUMN if stone else TURNED
    if style.form.legs in ("tapered", "slab", "straight", "hairpin"):
        parts += of(
            slot,
            lathe(
                [
                    (0.42 * r, 0.0),
                    (0.42 * r, 0.012),
                    (0.12 * r + 0.02, 0.05),
                    (0.045 * r + 0.018, 0.14),
                    (0.04 * r + 0.016, h - 0.12),
                    (0.12 * r + 0.01, h - 0.035),
                ],
                28,
                smooth=1,
            ),
        )
        return Model(parts, (Top(h, -0.6 * r, -0.6 * r, 0.6 * r, 0.6 * r),))
    parts += of(slot, lathe([(0.012 + (0.03 + 0.11 * r) * q, 0.12 + z * (h - 0.155)) for q, z in profile], 24))
    for k in range(3):
        a = 2 * np.pi * k / 3 + np.pi / 6
        c, s = float(np.cos(a)), float(np.sin(a))
        path = [
            (0.03 * c, 0.03 * s, 0.24),
            (0.3 * r * c, 0.3 * r * s, 0.2),
            (0.55 * r * c, 0.55 * r * s, 0.06),
            (0.68 * r * c, 0.68 * r * s, 0.026),
        ]
        parts += of(slot, tube(path, [0.04, 0.034, 0.028, 0.025], 10, smooth=2))
    return Model(parts, (Top(h, -0.6 * r, -0.6 * r, 0.6 * r, 0.6 * r),))


def coffee_table(style: Style, rng: np.random.Generator, size: Size) -> Model:
    w, d, h = size
    model = table(style, w, d, h, thickness=0.035, leg=0.06, apron=0.05 if style.form.ornament > 0.3 else 0.0)
    if style.form.legs in ("tapered", "straight", "turned") and rng.random() < 0.6:
        z = 0.35 * h
        shelf = box((-w / 2 + 0.06, -d / 2 + 0.06, z), (w / 2 - 0.06, d / 2 - 0.06, z + 0.018))
        return Model([*model.parts, *of(frame_wood(style), shelf)], model.tops)
    return model


def side_table(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """A small table beside a seat: round on a stem, or square on legs."""
    w, d, h = size
    if rng.random() < 0.6:
        side = min(w, d)
        return round_table(style, rng, (side, side, h))
    return table(style, w, d, h, thickness=0.025, leg=0.04, apron=0.05)


def console_table(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """A narrow table against a wall, with one or two drawers in some styles."""
    w, d, h = size
    model = table(style, w, d, h, thickness=0.03, leg=0.05, apron=0.0 if style.form.legs in ("slab", "column") else 0.12)
    if style.form.legs in ("slab", "column", "hairpin"):
        return model
    parts = list(model.parts)
    for x0, x1 in ((-w / 2 + 0.09, -0.01), (0.01, w / 2 - 0.09)):
        parts += front(style, x0, x1, h - 0.14, h - 0.045, -d / 2 + 0.055, slot=frame_wood(style), handle="centre")
    return Model(parts, model.tops)


def desk(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """A writing desk: a pedestal of drawers on one side or both, legs or a panel otherwise. The chair is at its front."""
    w, d, h = size
    form = style.form
    wood = frame_wood(style)
    parts = slab_top(style, w, d, h, 0.035, slot=wood)
    if form.ornament > 0.3:
        parts += of(
            "leather", rounded_box((-w / 2 + 0.12, -d / 2 + 0.08, h - 0.012), (w / 2 - 0.12, d / 2 - 0.1, h + 0.002), 0.003, 1)
        )
    sides = (-1.0, 1.0) if w > 1.35 and form.ornament > 0.3 else (1.0,)
    wide = 0.38
    for s in (-1.0, 1.0):
        x0, x1 = (w / 2 - 0.03 - wide, w / 2 - 0.03) if s > 0 else (-w / 2 + 0.03, -w / 2 + 0.03 + wide)
        if s not in sides:
            thin = 0.03
            x0 = -w / 2 + 0.03
            parts += of(wood, box((x0, -d / 2 + 0.04, 0.0), (x0 + thin, d / 2 - 0.04, h - 0.03)))
            continue
        parts += of(wood, box((x0, -d / 2 + 0.05, 0.05), (x1, d / 2 - 0.03, h - 0.03)))
        parts += of(wood, box((x0 + 0.02, -d / 2 + 0.08, 0.0), (x1 - 0.02, d / 2 - 0.05, 0.06)))
        levels = np.linspace(0.07, h - 0.055, 4)
        for low, high in itertools.pairwise(levels.tolist()):
            parts += front(style, x0 + 0.012, x1 - 0.012, low + 0.004, high - 0.004, -d / 2 + 0.05, slot=wood, handle="centre")
    parts += of(wood, box((-w / 2 + 0.05, d / 2 - 0.06, 0.3), (w / 2 - 0.05, d / 2 - 0.04, h - 0.03)))
    return Model(
        parts, (Top(h + (0.002 if form.ornament > 0.3 else 0.0), -w / 2 + 0.06, -d / 2 + 0.05, w / 2 - 0.06, d / 2 - 0.04),)
    )


def nightstand(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """A small cupboard beside a bed: two drawers, or a drawer above a door."""
    w, d, h = size
    wood = frame_wood(style)
    foot = 0.14 if style.form.legs in ("tapered", "hairpin", "cabriole") else 0.08
    parts = (
        legs(style, w - 0.01, d - 0.01, foot + 0.01, 0.045, slot=wood)
        if style.form.legs != "column"
        else of(wood, box((-w / 2 + 0.03, -d / 2 + 0.04, 0.0), (w / 2 - 0.03, d / 2 - 0.02, foot + 0.01)))
    )
    parts += of(wood, box((-w / 2 + 0.01, -d / 2 + 0.03, foot), (w / 2 - 0.01, d / 2, h - 0.03)))
    parts += of(
        "marble" if style.form.ornament > 0.6 else wood, rounded_box((-w / 2, -d / 2, h - 0.032), (w / 2, d / 2, h), 0.008, 1)
    )
    middle = foot + 0.5 * (h - foot)
    for low, high in ((foot + 0.015, middle - 0.006), (middle + 0.006, h - 0.045)):
        parts += front(style, -w / 2 + 0.03, w / 2 - 0.03, low, high, -d / 2 + 0.03, slot=wood, handle="centre")
    return Model(parts, top_of(w, d, h, 0.025))


def kitchen_island(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """A free-standing counter with doors on its front."""
    w, d, h = size
    slot = "painted_wood"
    parts = of(slot, box((-w / 2 + 0.03, -d / 2 + 0.05, 0.08), (w / 2 - 0.03, d / 2 - 0.05, h - 0.035)))
    parts += of("dark_wood", box((-w / 2 + 0.06, -d / 2 + 0.09, 0.0), (w / 2 - 0.06, d / 2 - 0.09, 0.09)))
    parts += of(
        "wood" if style.family in ("rustic", "scandinavian", "coastal") else "marble",
        rounded_box((-w / 2, -d / 2, h - 0.04), (w / 2, d / 2, h), 0.01, 1),
    )
    count = max(int(w / 0.5), 2)
    edges = np.linspace(-w / 2 + 0.04, w / 2 - 0.04, count + 1)
    for k, (x0, x1) in enumerate(itertools.pairwise(edges.tolist())):
        parts += front(
            style, x0 + 0.004, x1 - 0.004, 0.1, h - 0.06, -d / 2 + 0.05, slot=slot, handle="right" if k % 2 == 0 else "left"
        )
    return Model(parts, top_of(w, d, h))


def altar(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """A stone or wooden table with a carved arcade, for halls."""
    w, d, h = size
    slot = "stone" if style.form.ornament > 0.3 else frame_wood(style)
    parts = of(
        slot,
        rounded_box((-w / 2, -d / 2, h - 0.07), (w / 2, d / 2, h), 0.015, 1),
        box((-w / 2 + 0.03, -d / 2 + 0.03, 0.0), (w / 2 - 0.03, d / 2 - 0.02, 0.09), 0.01),
    )
    body = box((-w / 2 + 0.07, -d / 2 + 0.09, 0.08), (w / 2 - 0.07, d / 2 - 0.04, h - 0.06))
    parts += of(slot, body)
    kind = "pointed" if style.form.back == "pointed_arch" else "round"
    count = 5
    pitch = (w - 0.16) / count
    wall = arch("", w - 0.16, h - 0.16, at=(0.0, 0.085))
    for k in range(count):
        wall = wall.difference(arch(kind, pitch - 0.05, h - 0.28, at=(-(w - 0.16) / 2 + (k + 0.5) * pitch, 0.12)))
    parts += of(slot, shift(extrude(wall, 0.0, 0.035, "y"), (0.0, -d / 2 + 0.058, 0.0)))
    return Model(parts, top_of(w, d, h))


KINDS = {
    "dining table": FurnitureKind(dining_table, "floor", (1.3, 0.85, 0.73), (2.2, 1.0, 0.77)),
    "round table": FurnitureKind(round_table, "floor", (0.85, 0.85, 0.72), (1.15, 1.15, 0.76)),
    "coffee table": FurnitureKind(coffee_table, "floor", (0.85, 0.5, 0.36), (1.2, 0.65, 0.44)),
    "side table": FurnitureKind(side_table, "floor", (0.42, 0.42, 0.5), (0.52, 0.52, 0.6)),
    "console table": FurnitureKind(console_table, "floor", (0.9, 0.32, 0.78), (1.3, 0.38, 0.88)),
    "desk": FurnitureKind(desk, "floor", (1.2, 0.6, 0.74), (1.6, 0.72, 0.78), front=0.75),
    "nightstand": FurnitureKind(nightstand, "floor", (0.4, 0.36, 0.5), (0.5, 0.42, 0.58), front=0.2),
    "kitchen island": FurnitureKind(kitchen_island, "floor", (1.1, 0.65, 0.9), (1.6, 0.85, 0.92), front=0.7),
    "altar table": FurnitureKind(altar, "floor", (1.3, 0.5, 0.85), (1.7, 0.6, 0.95), front=0.4),
}
