"""Beds: headboard, frame, mattress, pillows, blanket; and a four-poster bed."""

import numpy as np

from wm.offline.furniture.common import COLUMN, TURNED, finial, frame_wood, legs, tracery
from wm.offline.furniture.outlines import arch, frame, rectangle, rounded
from wm.offline.furniture.piece import FurnitureKind, Model, Part, Size, of, pick
from wm.offline.furniture.solids import Real, box, extrude, lathe, puff, rod, rounded_box, turn
from wm.offline.style.finish import Style


def headboard(style: Style, w: Real, y: Real, low: Real, high: Real, *, wood: str) -> list[Part]:
    """The board behind the pillows, between the heights `low` and `high`, in front of the plane y."""
    kind = style.form.back
    tall = high - low
    if kind == "pointed_arch":
        count = 3
        pitch = (w - 0.02) / count
        parts = of(wood, box((-w / 2, y - 0.03, low), (w / 2, y - 0.004, low + 0.4 * tall)))
        for k in range(count):
            x = -(w - 0.02) / 2 + (k + 0.5) * pitch
            height = (0.94 if k != 1 else 1.0) * tall
            parts += of(wood, extrude(tracery(pitch, height, 0.05, at=(x, low)), y - 0.045, y - 0.006, "y"))
            inside = arch("pointed", pitch, height, at=(x, low)).buffer(-0.02)
            parts += of("panel_wood", extrude(inside, y - 0.022, y - 0.009, "y"))
        return parts
    if kind in ("round_arch", "wave", "klismos"):
        outline = arch("wave" if kind == "wave" else "round", w, tall, at=(0.0, low))
        if kind == "klismos":
            outline = rounded(w, tall * 0.8, 0.12, at=(0.0, low))
        parts = of(wood, extrude(frame(outline, 0.06), y - 0.06, y, "y"))
        return parts + of(
            "fabric",
            extrude(outline.buffer(-0.05), y - 0.045, y - 0.012, "y"),
            extrude(outline.buffer(-0.11), y - 0.058, y - 0.02, "y"),
        )
    if kind == "slats" or kind == "spindle":
        bars = [
            box((-w / 2 + 0.03, y - 0.035, z - 0.05), (w / 2 - 0.03, y - 0.012, z + 0.03), 0.005)
            for z in np.linspace(low + 0.18, high - 0.12, 3)
        ]
        if kind == "spindle":
            bars = [
                rod((x, y - 0.024, low + 0.1), (x, y - 0.024, high - 0.05), 0.011)
                for x in np.linspace(-w / 2 + 0.1, w / 2 - 0.1, 11)
            ]
        posts = [
            rounded_box((s * (w / 2 - 0.025) - 0.025, y - 0.05, 0.0), (s * (w / 2 - 0.025) + 0.025, y, high), 0.012, 1)
            for s in (-1.0, 1.0)
        ]
        rail = rounded_box((-w / 2 + 0.01, y - 0.045, high - 0.08), (w / 2 - 0.01, y - 0.005, high - 0.01), 0.015, 1)
        return of(wood, *bars, *posts, rail)
    if style.form.softness > 0.5:
        count = 4
        pitch = w / count
        pads = [
            rounded_box((-w / 2 + k * pitch + 0.002, y - 0.09, low), (-w / 2 + (k + 1) * pitch - 0.002, y, high), 0.03)
            for k in range(count)
        ]
        return of("fabric", *pads)
    return of(wood, rounded_box((-w / 2, y - 0.05, low), (w / 2, y, high), 0.012, 1))


def bed(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """A bed. Its head is at the back of the piece, its foot at the front."""
    w, d, h = size
    wood = frame_wood(style)
    form = style.form
    base = {"slab": 0.1, "column": 0.2}.get(form.legs, 0.24) * form.low
    mattress = base + 0.3
    y_head = d / 2
    foot_y = -d / 2
    parts = headboard(style, w, y_head, 0.06, h, wood=wood)
    parts += of(wood, rounded_box((-w / 2, foot_y, base - 0.1), (w / 2, y_head - 0.05, base + 0.06), 0.015, 1))
    if form.ornament > 0.5 and form.legs in ("turned", "cabriole", "column"):
        parts += legs(style, w - 0.02, d - 0.04, base - 0.05, 0.09, slot=wood, kind="straight")  # its posts are turned
    elif form.legs != "slab":
        parts += legs(style, w - 0.02, d - 0.04, base - 0.05, 0.075, slot=wood)
    else:
        parts += of(wood, box((-w / 2 + 0.1, foot_y + 0.1, 0.0), (w / 2 - 0.1, y_head - 0.1, base - 0.09)))
    inner = w / 2 - 0.03
    parts += of("linen", rounded_box((-inner, foot_y + 0.035, base + 0.03), (inner, y_head - 0.06, mattress), 0.06))
    cover_end = y_head - 0.06 - 0.3 * d
    parts += of(
        "blanket", rounded_box((-w / 2 - 0.012, foot_y - 0.006, base + 0.1), (w / 2 + 0.012, cover_end, mattress + 0.045), 0.07)
    )
    parts += of(
        "linen",
        rounded_box((-w / 2 - 0.02, cover_end - 0.2, base + 0.16), (w / 2 + 0.02, cover_end + 0.05, mattress + 0.06), 0.06),
    )
    if rng.random() < 0.6:
        parts += of(
            "fabric_accent",
            rounded_box(
                (-w / 2 - 0.026, foot_y + 0.12, base + 0.08), (w / 2 + 0.026, foot_y + 0.12 + 0.24 * d, mattress + 0.057), 0.06
            ),
        )
    count = 2 if w > 1.2 else 1
    for k in range(count):
        x = 0.0 if count == 1 else (k - 0.5) * (w / 2)
        half = min(0.36, w / 2 / count - 0.03)
        lying = puff((x - half, y_head - 0.62, mattress - 0.02), (x + half, y_head - 0.16, mattress + 0.15), square=0.3)
        parts += of("pillow", turn(lying, "x", 14, (x, y_head - 0.4, mattress + 0.05)))
        if form.ornament > 0.25 or rng.random() < 0.5:
            small = puff((x - 0.2, y_head - 0.76, mattress + 0.0), (x + 0.2, y_head - 0.46, mattress + 0.14), square=0.3)
            parts += of("fabric_accent", turn(small, "x", 34, (x, y_head - 0.6, mattress + 0.06)), color=pick(rng, style.accents))
    if form.ornament > 0.5 and form.legs in ("turned", "cabriole", "column"):
        parts += footboard(style, w, foot_y, base, wood=wood)
    return Model(parts)


def footboard(style: Style, w: Real, y: Real, base: Real, *, wood: str) -> list[Part]:
    """A low board and two posts with finials at the foot."""
    top = base + 0.36
    parts = of(wood, box((-w / 2 + 0.03, y - 0.045, base - 0.08), (w / 2 - 0.03, y - 0.012, top)))
    parts += of(wood, rounded_box((-w / 2 + 0.02, y - 0.055, top - 0.02), (w / 2 - 0.02, y - 0.002, top + 0.02), 0.012, 1))
    if style.form.panel in ("pointed", "arched"):
        kind = "pointed" if style.form.panel == "pointed" else "round"
        count = max(int(w / 0.3), 3)
        pitch = (w - 0.12) / count
        board = rectangle(w - 0.1, top - base + 0.04, at=(0.0, base - 0.06))
        for k in range(count):
            board = board.difference(
                arch(kind, pitch - 0.05, top - base - 0.05, at=(-(w - 0.12) / 2 + (k + 0.5) * pitch, base - 0.02))
            )
        parts += of(wood, extrude(board, y - 0.058, y - 0.04, "y"))
    profile = COLUMN if style.form.legs == "column" else TURNED
    for s in (-1.0, 1.0):
        x = s * (w / 2 - 0.02)
        parts += of(wood, lathe([(0.008 + 0.034 * r, z * (top + 0.08)) for r, z in profile], 16, at=(x, y - 0.03, 0.0)))
        parts += of(wood, finial(x, y - 0.03, top + 0.077, 0.09))
    return parts


def four_poster(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """A bed under a canopy on four posts, with curtains at the head."""
    w, d, h = size
    wood = frame_wood(style)
    inner = bed(style, rng, (w - 0.16, d - 0.12, min(1.35, 0.62 * h)))
    parts = list(inner.parts)
    profile = COLUMN if style.form.legs == "column" else TURNED
    for sx in (-1.0, 1.0):
        for sy in (-1.0, 1.0):
            x, y = sx * (w / 2 - 0.05), sy * (d / 2 - 0.05)
            parts += of(wood, box((x - 0.045, y - 0.045, 0.0), (x + 0.045, y + 0.045, 0.5), 0.008))
            parts += of(wood, lathe([(0.012 + 0.03 * r, 0.49 + z * (h - 0.6)) for r, z in profile], 16, at=(x, y, 0.0)))
    parts += of(wood, rounded_box((-w / 2, -d / 2, h - 0.12), (w / 2, d / 2, h), 0.02, 1))
    valance = rounded_box((-w / 2 + 0.012, -d / 2 + 0.012, h - 0.3), (w / 2 - 0.012, d / 2 - 0.012, h - 0.1), 0.012, 1)
    parts += of("curtain", valance)
    for s in (-1.0, 1.0):
        t = np.linspace(0, 1, 26)
        ys = d / 2 - 0.1 - 0.42 * t
        xs = s * (w / 2 - 0.06) + 0.022 * np.sin(t * 2 * np.pi * 4.5)
        outline = [*zip(xs - 0.006, ys), *zip((xs + 0.006)[::-1], ys[::-1])]
        parts += of("curtain", extrude([(float(a), float(b)) for a, b in outline], 0.06, h - 0.2, "z"))
    return Model(parts)


KINDS = {
    "bed": FurnitureKind(bed, "floor", (1.5, 2.05, 1.05), (1.85, 2.15, 1.35), front=0.4),
    "single bed": FurnitureKind(bed, "floor", (0.95, 2.0, 0.95), (1.05, 2.1, 1.2), front=0.3),
    "four-poster bed": FurnitureKind(four_poster, "floor", (1.75, 2.2, 2.1), (1.95, 2.3, 2.25), front=0.4),
}
