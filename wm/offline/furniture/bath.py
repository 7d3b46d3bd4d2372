"""Bathroom pieces: bathtub, washbasin, toilet, shower, towel rail."""

import numpy as np
import shapely

from wm.offline.furniture.common import front
from wm.offline.furniture.outlines import rounded
from wm.offline.furniture.piece import FurnitureKind, Model, Part, Size, of
from wm.offline.furniture.solids import (
    Real,
    Solid,
    ball,
    box,
    closed,
    extrude,
    lathe,
    rod,
    rounded_box,
    shift,
    stretch,
    tube,
    turn,
)
from wm.offline.style.finish import Style

WHITE = (0.93, 0.92, 0.9)
"""Sanitary ware is white in every style."""


def vessel_of(rings: list[tuple[shapely.Polygon, float]]) -> Solid:
    """A loft through outlines at given heights, closed by flat caps. Each outline is resampled to the same number of points."""
    n = 40
    stack = []
    for outline, z in rings:
        ring = shapely.orient_polygons(outline).exterior
        centre = outline.centroid
        samples = [ring.interpolate(k / 400, normalized=True) for k in range(400)]
        angles = np.array([np.arctan2(p.y - centre.y, p.x - centre.x) for p in samples])
        order = np.argsort(angles)
        wanted = (np.arange(n) + 0.5) * 2 * np.pi / n - np.pi
        xs = np.interp(wanted, angles[order], np.array([samples[k].x for k in order]), period=2 * np.pi)
        ys = np.interp(wanted, angles[order], np.array([samples[k].y for k in order]), period=2 * np.pi)
        stack.append(np.stack([xs, ys, np.full(n, z)], -1))
    first, last = stack[0].mean(0), stack[-1].mean(0)
    k = np.arange(n)
    after = (k + 1) % n
    faces = [np.stack([np.zeros_like(k), 1 + after, 1 + k], 1)]
    for r in range(len(stack) - 1):
        a, b = 1 + r * n, 1 + (r + 1) * n
        faces += [np.stack([a + k, a + after, b + after], 1), np.stack([a + k, b + after, b + k], 1)]
    end = 1 + len(stack) * n
    faces.append(np.stack([end - n + k, end - n + after, np.full_like(k, end)], 1))
    return closed(np.concatenate([first[None], *stack, last[None]]), np.concatenate(faces))


def tap(x: Real, y: Real, z: Real, reach: Real, height: Real, metal: str) -> list[Part]:
    """A swan-neck tap with two handles, reaching towards -y."""
    neck = [
        (x, y, z),
        (x, y, z + 0.8 * height),
        (x, y - 0.4 * reach, z + height),
        (x, y - reach, z + 0.85 * height),
        (x, y - reach, z + 0.7 * height),
    ]
    parts = of(metal, tube(neck, 0.011, 8, smooth=3))
    for s in (-1.0, 1.0):
        parts += of(
            metal,
            rod((x + s * 0.08, y, z), (x + s * 0.08, y, z + 0.05), 0.009),
            rod((x + s * 0.08 - 0.025, y, z + 0.05), (x + s * 0.08 + 0.025, y, z + 0.05), 0.007),
        )
    return parts


def bathtub(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """A tub with water: on feet in ornate styles, otherwise a smooth oval or a tiled box."""
    w, d, h = size
    metal = "brass" if style.form.ornament > 0.3 else "chrome"
    feet = style.form.ornament > 0.3 and style.form.legs != "column"
    low = 0.12 if feet else 0.0
    outline = rounded(w, d, 0.48 * d, at=(0.0, -d / 2))

    def ring(inset: float) -> shapely.Polygon:
        return outline.buffer(-inset)

    if style.form.legs in ("slab", "column"):
        slot = "marble" if style.form.legs == "column" else "wood"
        hole = rounded(w - 0.16, d - 0.16, 0.12, at=(0.0, -d / 2 + 0.08))
        frame = shapely.box(-w / 2, -d / 2, w / 2, d / 2).difference(hole)
        parts = of(slot, extrude(frame, 0.0, h, "z"), extrude(hole.buffer(0.01), 0.01, 0.15, "z"))
        return Model(
            parts
            + of("water", extrude(hole.buffer(0.004), 0.14, h - 0.1, "z"))
            + tap(-w / 2 + 0.04, 0.0, h - 0.01, 0.0001, 0.12, metal)[1:]
        )
    shell = [
        (ring(0.1), low),
        (ring(0.055), low + 0.1),
        (ring(0.03), h - 0.1),
        (ring(0.012), h - 0.03),
        (ring(0.0), h - 0.018),
        (ring(0.0), h),
        (ring(0.045), h),
        (ring(0.055), h - 0.03),
        (ring(0.075), h - 0.16),
    ]
    parts = of("ceramic", vessel_of(shell), color=WHITE) + of("water", extrude(ring(0.06), h - 0.2, h - 0.12, "z"))
    if feet:
        for sx in (-1.0, 1.0):
            for sy in (-1.0, 1.0):
                x, y = sx * (w / 2 - 0.36), sy * (d / 2 - 0.14)
                parts += of(
                    metal,
                    tube(
                        [(x, y + sy * 0.04, 0.015), (x, y + sy * 0.045, 0.06), (x, y - sy * 0.02, 0.17)],
                        [0.022, 0.018, 0.03],
                        10,
                        smooth=2,
                    ),
                    ball((x, y + sy * 0.04, 0.024), 0.024, 10),
                )
    spout = [Part(p.slot, turn(p.solid, "z", 90), p.color) for p in tap(0.0, 0.0, 0.0, 0.14, 0.2, metal)]
    return Model(parts + [Part(p.slot, shift(p.solid, (-w / 2 + 0.03, 0.0, h - 0.008)), p.color) for p in spout])


def washbasin(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """A basin in a vanity, or on a pedestal."""
    w, d, h = size
    metal = "brass" if style.form.ornament > 0.3 else "chrome"
    parts: list[Part] = []
    if w > 0.66:
        slot = "painted_wood" if style.form.panel == "slats" else "wood"
        parts += of(slot, box((-w / 2 + 0.02, -d / 2 + 0.04, 0.12), (w / 2 - 0.02, d / 2, h - 0.03)))
        parts += of(
            slot,
            *(
                box((s * (w / 2 - 0.06) - 0.025, y - 0.025, 0.0), (s * (w / 2 - 0.06) + 0.025, y + 0.025, 0.13))
                for s in (-1.0, 1.0)
                for y in (-d / 2 + 0.09, d / 2 - 0.05)
            ),
        )
        for x0, x1, side in ((-w / 2 + 0.03, -0.004, "right"), (0.004, w / 2 - 0.03, "left")):
            parts += front(style, x0, x1, 0.14, h - 0.05, -d / 2 + 0.04, slot=slot, handle=side)
        parts += of("marble", rounded_box((-w / 2, -d / 2, h - 0.035), (w / 2, d / 2, h), 0.008, 1))
        bowl = lathe([(0.05, 0.0), (0.15, 0.05), (0.19, 0.12), (0.176, 0.12), (0.13, 0.05), (0.04, 0.025)], 32, smooth=1)
        parts += of("ceramic", shift(stretch(bowl, (1.1, 0.85, 1.0)), (0, -0.02, h - 0.002)), color=WHITE)
        parts += tap(0.0, d / 2 - 0.06, h - 0.005, 0.12, 0.24, metal)
        return Model(parts)
    parts += of(
        "ceramic",
        lathe([(0.12, 0.0), (0.11, 0.03), (0.07, 0.12), (0.065, 0.55 * h), (0.09, h - 0.15)], 24, at=(0, 0.04, 0.0), smooth=2),
        color=WHITE,
    )
    oval = rounded(w, d, 0.24, at=(0.0, -d / 2))
    rings = [
        (oval.buffer(-0.15), h - 0.17),
        (oval.buffer(-0.06), h - 0.1),
        (oval.buffer(-0.004), h - 0.035),
        (oval, h - 0.006),
        (oval.buffer(-0.012), h),
        (oval.buffer(-0.035), h),
        (oval.buffer(-0.06), h - 0.03),
        (oval.buffer(-0.12), h - 0.11),
    ]
    parts += of("ceramic", vessel_of(rings), color=WHITE)
    return Model(parts + tap(0.0, d / 2 - 0.05, h - 0.012, 0.1, 0.14, metal))


def toilet(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """Bowl, seat, lid and cistern."""
    w, d, h = size
    seat, deep = 0.42, d - 0.2
    y = -d / 2
    outline = rounded(w, deep, 0.49 * w, at=(0.0, y))
    slim = rounded(0.5 * w, 0.7 * deep, 0.12, at=(0.0, y + 0.26 * deep))
    rings = [
        (slim.buffer(0.02), 0.0),
        (slim, 0.04),
        (slim.buffer(-0.005), 0.16),
        (outline.buffer(-0.06), 0.3),
        (outline.buffer(-0.012), seat - 0.04),
        (outline.buffer(-0.012), seat - 0.025),
    ]
    parts = of("ceramic", vessel_of(rings), color=WHITE)
    seat_slot, tint = ("wood", None) if style.form.ornament > 0.3 else ("ceramic", WHITE)
    parts += of(seat_slot, extrude(outline.difference(outline.buffer(-0.085)), seat - 0.023, seat, "z"), color=tint)
    lid = extrude(outline.buffer(-0.002), 0.0, 0.018, "z")
    parts += of(seat_slot, turn(shift(lid, (0, 0, seat + 0.003)), "x", -80, (0, y + deep - 0.01, seat + 0.012)), color=tint)
    parts += of(
        "ceramic", rounded_box((-0.26 * w, y + 0.6 * deep, 0.0), (0.26 * w, d / 2 - 0.02, seat - 0.03), 0.03), color=WHITE
    )
    parts += of(
        "ceramic",
        rounded_box((-w / 2 - 0.01, d / 2 - 0.17, seat - 0.06), (w / 2 + 0.01, d / 2, h - 0.035), 0.03),
        rounded_box((-w / 2 - 0.02, d / 2 - 0.18, h - 0.045), (w / 2 + 0.02, d / 2, h), 0.014, 1),
        color=WHITE,
    )
    return Model(
        parts
        + of(
            "brass" if style.form.ornament > 0.3 else "chrome",
            lathe([(0.025, h - 0.002), (0.022, h + 0.008)], 16, at=(0, d / 2 - 0.09, 0.0)),
        )
    )


def shower(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """A glazed corner: tray, two glass walls in a metal frame, riser and rose."""
    w, d, h = size
    metal = "brass" if style.form.ornament > 0.3 else "chrome"
    parts = of("ceramic", rounded_box((-w / 2, -d / 2, 0.0), (w / 2, d / 2, 0.06), 0.012, 1), color=WHITE)
    for s in (-1.0, 1.0):
        parts += of(
            "glass",
            box((s * (w / 2 - 0.012) - 0.004, -d / 2 + 0.02, 0.055), (s * (w / 2 - 0.012) + 0.004, d / 2 - 0.004, h - 0.02), 0.0),
        )
        parts += of(
            metal, box((s * (w / 2 - 0.012) - 0.012, -d / 2, 0.05), (s * (w / 2 - 0.012) + 0.012, -d / 2 + 0.024, h), 0.003)
        )
        parts += of(
            metal,
            box((s * (w / 2 - 0.012) - 0.01, -d / 2 + 0.02, h - 0.022), (s * (w / 2 - 0.012) + 0.01, d / 2, h - 0.002), 0.003),
        )
    parts += of(metal, box((-w / 2 + 0.02, -d / 2 + 0.002, h - 0.022), (w / 2 - 0.02, -d / 2 + 0.022, h - 0.0015), 0.003))
    parts += of("glass", box((-w / 2 + 0.02, -d / 2 + 0.008, 0.055), (-0.02, -d / 2 + 0.016, h - 0.02), 0.0))
    riser = [
        (0, d / 2 - 0.03, 1.0),
        (0, d / 2 - 0.03, h - 0.12),
        (0, d / 2 - 0.1, h - 0.05),
        (0, d / 2 - 0.28, h - 0.07),
        (0, d / 2 - 0.32, h - 0.11),
    ]
    parts += of(
        metal,
        tube(riser, 0.01, 8, smooth=2),
        lathe([(0.1, h - 0.13), (0.1, h - 0.118), (0.02, h - 0.1)], 24, at=(0, d / 2 - 0.32, 0.0)),
    )
    return Model(parts + of(metal, rounded_box((-0.09, d / 2 - 0.06, 1.0), (0.09, d / 2 - 0.012, 1.05), 0.01, 1)))


def towel_rail(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """Two rails on the wall with a towel over one."""
    w, d, h = size
    metal = "brass" if style.form.ornament > 0.3 else "chrome"
    parts: list[Part] = []
    for z in (h - 0.02, 0.5 * h):
        parts += of(metal, shift(turn(rod((0, 0, -w / 2), (0, 0, w / 2), 0.009), "y", 90), (0, -d / 2 + 0.03, z)))
        parts += of(
            metal, *(rod((s * (w / 2 - 0.03), -d / 2 + 0.03, z), (s * (w / 2 - 0.03), d / 2, z), 0.008, 6) for s in (-1.0, 1.0))
        )
    t = np.linspace(0, np.pi, 7)
    y, z, r = -d / 2 + 0.03, h - 0.02, 0.013
    outer = [
        (y - r - 0.006, 0.0),
        *((y - (r + 0.006) * np.cos(a), z + (r + 0.006) * np.sin(a)) for a in t),
        (y + r + 0.006, 0.16),
    ]
    inner = [(y + r, 0.16), *((y + r * np.cos(a), z + r * np.sin(a)) for a in t), (y - r, 0.0)]
    return Model(parts + of("linen", extrude([(float(a), float(b)) for a, b in [*outer, *inner]], -0.3 * w, 0.3 * w, "x")))


KINDS = {
    "bathtub": FurnitureKind(bathtub, "floor", (1.55, 0.72, 0.55), (1.75, 0.8, 0.62), front=0.5),
    "washbasin": FurnitureKind(washbasin, "floor", (0.52, 0.44, 0.84), (0.95, 0.5, 0.88), front=0.55),
    "toilet": FurnitureKind(toilet, "floor", (0.37, 0.66, 0.76), (0.4, 0.7, 0.82), front=0.5),
    "shower": FurnitureKind(shower, "floor", (0.85, 0.85, 2.0), (0.95, 0.95, 2.05), front=0.5),
    "towel rail": FurnitureKind(towel_rail, "wall", (0.5, 0.1, 0.5), (0.65, 0.12, 0.6)),
}
