"""Seats of ceremony: pew and throne."""

import numpy as np

from wm.offline.furniture.common import finial, frame_wood, tracery
from wm.offline.furniture.outlines import arch, frame
from wm.offline.furniture.piece import FurnitureKind, Model, Size, of
from wm.offline.furniture.solids import box, extrude, rod, rounded_box
from wm.offline.style.finish import Style


def pew(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """A long wooden seat between carved ends, with a high back and a ledge for books behind it."""
    w, d, h = size
    wood = frame_wood(style)
    end = [
        (-d / 2, 0.0),
        (d / 2 - 0.08, 0.0),
        (d / 2 - 0.03, h - 0.08),
        (d / 2 - 0.09, h),
        (d / 2 - 0.17, h - 0.08),
        (d / 2 - 0.2, 0.66),
        (-d / 2 + 0.06, 0.6),
        (-d / 2 + 0.02, 0.5),
    ]
    parts = of(wood, *(extrude(end, s * w / 2, s * (w / 2 - 0.05), "x") for s in (-1, 1)))
    parts += of(
        wood,
        box((-w / 2 + 0.04, -d / 2 + 0.04, 0.42), (w / 2 - 0.04, d / 2 - 0.15, 0.455)),
        box((-w / 2 + 0.045, d / 2 - 0.17, 0.3), (w / 2 - 0.045, d / 2 - 0.135, h - 0.05)),
    )
    parts += of(
        wood,
        box((-w / 2 + 0.04, d / 2 - 0.16, h - 0.2), (w / 2 - 0.04, d / 2, h - 0.17)),
        rounded_box((-w / 2 + 0.04, d / 2 - 0.19, h - 0.07), (w / 2 - 0.04, d / 2 - 0.12, h - 0.02), 0.015, 1),
    )
    parts += of(wood, box((-w / 2 + 0.05, -0.02, 0.0), (w / 2 - 0.05, 0.02, 0.43)))
    for k in range(3):
        x = (k - 1) * 0.28 * w
        parts += of(
            "book",
            box((x - 0.06, d / 2 - 0.12, h - 0.168), (x + 0.06, d / 2 - 0.02, h - 0.13)),
            color=((0.35, 0.07, 0.06), (0.08, 0.12, 0.25), (0.1, 0.2, 0.12))[k],
        )
    return Model(parts)


def throne(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """A great chair on a step: a tall arched back, arms that end in knobs, red velvet."""
    w, d, h = size
    wood, step = "brass" if style.form.ornament > 0.3 else frame_wood(style), 0.16
    y = d / 2 - 0.12
    parts = of("stone", box((-w / 2, -d / 2, 0.0), (w / 2, d / 2, step), 0.012))
    kind = "pointed" if style.form.back in ("pointed_arch", "plain", "panel") else "round"
    outline = arch(kind, 0.72 * w, h - step - 0.1, at=(0.0, step))
    back = tracery(0.72 * w, h - step - 0.1, 0.07, at=(0, step)) if kind == "pointed" else frame(outline, 0.07)
    parts += of(wood, extrude(back, y - 0.05, y + 0.05, "y")) + of(
        "velvet", extrude(outline.buffer(-0.05), y - 0.03, y + 0.02, "y"), color=(0.5, 0.04, 0.07)
    )
    half = 0.36 * w
    for s in (-1, 1):
        parts += of(
            wood,
            box((s * half - 0.045, y - 0.04, step - 0.01), (s * half + 0.045, y + 0.06, 0.8 * h)),
            finial(s * half, y, 0.8 * h - 0.004, 0.14),
        )
        parts += of(wood, box((s * half - 0.04, -d / 2 + 0.14, step - 0.01), (s * half + 0.04, -d / 2 + 0.22, step + 0.62)))
        parts += of(
            wood,
            rounded_box((s * half - 0.055, -d / 2 + 0.1, step + 0.6), (s * half + 0.055, y, step + 0.67), 0.02),
            finial(s * half, -d / 2 + 0.18, step + 0.66, 0.12),
        )
    parts += of(wood, box((-half, -d / 2 + 0.15, step + 0.2), (half, y, step + 0.38))) + of(
        "velvet",
        rounded_box((-half + 0.045, -d / 2 + 0.12, step + 0.37), (half - 0.045, y - 0.04, step + 0.49), 0.045),
        color=(0.5, 0.04, 0.07),
    )
    return Model(
        parts
        + of(
            wood, finial(0.0, y, h - 0.12, 0.12), rod((-half, -d / 2 + 0.18, step + 0.1), (half, -d / 2 + 0.18, step + 0.1), 0.02)
        )
    )


KINDS = {
    "pew": FurnitureKind(pew, "floor", (1.3, 0.55, 0.92), (2.2, 0.62, 1.02)),
    "throne": FurnitureKind(throne, "floor", (0.95, 0.9, 1.8), (1.15, 1.05, 2.1), front=0.8),
}
