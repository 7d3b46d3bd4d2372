"""Where people are treated: hospital bed, examination table, drip stand, barber chair."""

import numpy as np

from wm.offline.furniture.joinery import BLACK, WHITE, posts, wheel
from wm.offline.furniture.piece import FurnitureKind, Model, Size, of, pick
from wm.offline.furniture.solids import box, lathe, puff, rod, rounded_box, tube, turn
from wm.offline.style.finish import Style


def hospital_bed(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """A bed on castors with its head raised, end boards and rails at its sides."""
    w, d, h = size
    xs, ys, bed = (-w / 2 + 0.08, w / 2 - 0.08), (-d / 2 + 0.12, d / 2 - 0.12), 0.48
    parts = of("chrome", *posts(xs, ys, 0.1, bed, 0.045)) + of(
        "dark_metal", *(wheel((x, y, 0.06), 0.06, 0.04) for x in xs for y in ys)
    )
    parts += of("metal", box((-w / 2 + 0.04, -d / 2 + 0.04, bed - 0.05), (w / 2 - 0.04, d / 2 - 0.04, bed)))
    parts += of(
        "appliance",
        rounded_box((-w / 2, d / 2 - 0.045, bed - 0.12), (w / 2, d / 2, h), 0.02, 1),
        rounded_box((-w / 2, -d / 2, bed - 0.12), (w / 2, -d / 2 + 0.045, 0.82 * h), 0.02, 1),
        color=WHITE,
    )
    parts += of(
        "linen", rounded_box((-w / 2 + 0.05, -d / 2 + 0.06, bed - 0.004), (w / 2 - 0.05, 0.18 * d, bed + 0.15), 0.05), color=WHITE
    )
    head = rounded_box((-w / 2 + 0.05, 0.14 * d, bed - 0.01), (w / 2 - 0.05, d / 2 - 0.07, bed + 0.14), 0.05)
    parts += of("linen", turn(head, "x", 18, (0, 0.16 * d, bed)), color=WHITE)
    parts += of(
        "pillow",
        turn(puff((-0.28, 0.3 * d, bed + 0.12), (0.28, d / 2 - 0.08, bed + 0.26)), "x", 18, (0, 0.16 * d, bed)),
        color=WHITE,
    )
    parts += of(
        "blanket",
        rounded_box((-w / 2 + 0.04, -d / 2 + 0.055, bed + 0.08), (w / 2 - 0.04, 0.02 * d, bed + 0.18), 0.05),
        color=(0.55, 0.72, 0.78),
    )
    for s in (-1, 1):
        x = s * (w / 2 - 0.02)
        parts += of(
            "chrome",
            *(rod((x, -0.16 * d, z), (x, 0.3 * d, z), 0.013) for z in (bed + 0.14, bed + 0.3)),
            *(rod((x, y, bed - 0.03), (x, y, bed + 0.3), 0.012) for y in (-0.14 * d, 0.07 * d, 0.28 * d)),
        )
    return Model(parts)


def examination_table(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """A padded couch on a cabinet, its head end raised, a strip of paper over it."""
    w, d, h = size
    top = 0.76
    parts = of("appliance", box((-w / 2 + 0.06, -d / 2 + 0.1, 0.06), (w / 2 - 0.06, d / 2 - 0.1, top - 0.1)), color=WHITE)
    parts += of("dark_metal", box((-w / 2 + 0.09, -d / 2 + 0.14, 0.0), (w / 2 - 0.09, d / 2 - 0.14, 0.07)))
    for k in range(3):
        z = 0.1 + 0.18 * k
        parts += of(
            "appliance", box((w / 2 - 0.066, -0.3 * d, z), (w / 2 - 0.045, 0.1 * d, z + 0.16)), color=(0.84, 0.88, 0.89)
        ) + of("chrome", rod((w / 2 - 0.04, -0.14 * d, z + 0.11), (w / 2 - 0.04, -0.06 * d, z + 0.11), 0.008))
    pad = pick(rng, ((0.25, 0.45, 0.5), (0.3, 0.36, 0.5), (0.45, 0.3, 0.24)))
    parts += of(
        "leather",
        rounded_box((-w / 2, -d / 2, top - 0.11), (w / 2, 0.14 * d, top), 0.04),
        turn(rounded_box((-w / 2, 0.13 * d, top - 0.11), (w / 2, d / 2 - 0.02, top), 0.04), "x", 30, (0, 0.14 * d, top - 0.05)),
        color=pad,
    )
    return Model(
        parts
        + of("paper", box((-0.19, -d / 2 + 0.02, top - 0.01), (0.19, 0.12 * d, top + 0.006), 0.0))
        + of("chrome", rod((0, 0.3 * d, top - 0.15), (0, 0.38 * d, min(h, top + 0.2) - 0.06), 0.02))
    )


def drip_stand(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """A pole on five castors with a bag that hangs from its hook."""
    w, _, h = size
    parts = of(
        "chrome",
        rod((0, 0, 0.08), (0, 0, h - 0.03), 0.012),
        tube([(-0.12, 0, h - 0.06), (-0.1, 0, h - 0.015), (0.1, 0, h - 0.015), (0.12, 0, h - 0.06)], 0.008, 8),
    )
    for k in range(5):
        c, s = (float(f(2 * np.pi * k / 5)) * (w / 2 - 0.03) for f in (np.cos, np.sin))
        parts += of("chrome", rod((0, 0, 0.09), (c, s, 0.06), 0.014)) + of("dark_metal", wheel((c, s, 0.03), 0.03, 0.024))
    parts += of("glass", rounded_box((0.05, -0.03, h - 0.32), (0.17, 0.03, h - 0.08), 0.025), color=(0.8, 0.86, 0.88))
    return Model(
        parts
        + of("linen", tube([(0.11, 0, h - 0.32), (0.1, 0.01, 0.6 * h), (0.03, 0.02, 0.45 * h)], 0.004, 6, smooth=2), color=WHITE)
        + of("appliance", rounded_box((-0.06, -0.07, 0.55 * h), (0.06, 0.0, 0.55 * h + 0.16), 0.015, 1), color=(0.75, 0.8, 0.82))
    )


def barber_chair(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """A padded chair with head and foot rests on a chrome column."""
    w, d, h = size
    seat, pad = 0.56, pick(rng, ((0.5, 0.08, 0.08), (0.1, 0.1, 0.1), (0.45, 0.26, 0.14)))
    parts = of("chrome", lathe([(0.32, 0.0), (0.32, 0.03), (0.1, 0.08), (0.06, 0.1), (0.055, seat - 0.15)], 28))
    parts += of("leather", rounded_box((-w / 2 + 0.09, -0.3 * d, seat - 0.14), (w / 2 - 0.09, 0.24 * d, seat), 0.05), color=pad)
    parts += of(
        "leather",
        turn(
            rounded_box((-w / 2 + 0.09, 0.18 * d, seat - 0.04), (w / 2 - 0.09, 0.3 * d, h - 0.24), 0.05),
            "x",
            -12,
            (0, 0.2 * d, seat),
        ),
        color=pad,
    )
    y = 0.24 * d + (h - seat) * 0.2
    parts += of("leather", rounded_box((-0.13, y - 0.06, h - 0.2), (0.13, y + 0.04, h), 0.045), color=pad) + of(
        "chrome", rod((0, y, h - 0.34), (0, y, h - 0.1), 0.018)
    )
    for s in (-1, 1):
        x = s * (w / 2 - 0.05)
        parts += of(
            "chrome",
            tube(
                [(x, 0.2 * d, seat - 0.08), (x, 0.2 * d, seat + 0.16), (x, -0.26 * d, seat + 0.16), (x, -0.26 * d, seat - 0.08)],
                0.018,
                8,
            ),
        ) + of("leather", rounded_box((x - 0.045, -0.26 * d, seat + 0.16), (x + 0.045, 0.16 * d, seat + 0.22), 0.025), color=pad)
        parts += of("chrome", rod((s * 0.16, -0.26 * d, seat - 0.1), (s * 0.16, -0.46 * d, 0.2), 0.014))
    return Model(
        parts
        + of("chrome", box((-0.2, -d / 2, 0.17), (0.2, -0.42 * d, 0.21)))
        + of("leather", box((-0.18, -d / 2 + 0.01, 0.2), (0.18, -0.43 * d, 0.222)), color=BLACK)
    )


KINDS = {
    "hospital bed": FurnitureKind(hospital_bed, "floor", (0.95, 2.0, 1.0), (1.02, 2.12, 1.1), front=0.4),
    "examination table": FurnitureKind(examination_table, "floor", (0.64, 1.75, 1.05), (0.72, 1.9, 1.15)),
    "drip stand": FurnitureKind(drip_stand, "floor", (0.5, 0.5, 1.75), (0.56, 0.56, 1.95)),
    "barber chair": FurnitureKind(barber_chair, "floor", (0.64, 1.0, 1.15), (0.7, 1.15, 1.28), front=0.4),
}
