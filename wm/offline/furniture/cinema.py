"""Things of a cinema: rows of folding seats, and the screen on the wall."""

import numpy as np

from wm.offline.furniture.piece import FurnitureKind, Model, Part, Size, of
from wm.offline.furniture.solids import box, rounded_box, turn
from wm.offline.style.finish import Style


def cinema_seats(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """A row of padded seats that share their arms, a cup in every other arm."""
    w, d, h = size
    count = max(round((w - 0.1) / 0.58), 2)
    pitch, seat = (w - 0.1) / count, 0.45
    parts: list[Part] = []
    for k in range(count + 1):
        x = -w / 2 + 0.05 + k * pitch
        parts += of("dark_metal", box((x - 0.03, -0.2, 0.0), (x + 0.03, d / 2 - 0.12, 0.56)))
        parts += of("leather", rounded_box((x - 0.05, -d / 2 + 0.06, 0.55), (x + 0.05, d / 2 - 0.14, 0.63), 0.03))
    for k in range(count):
        x0, x1 = -w / 2 + 0.05 + k * pitch + 0.045, -w / 2 + 0.05 + (k + 1) * pitch - 0.045
        parts += of("velvet", rounded_box((x0, -d / 2, seat - 0.14), (x1, d / 2 - 0.16, seat), 0.05))
        back = rounded_box((x0, d / 2 - 0.24, seat - 0.1), (x1, d / 2 - 0.11, h), 0.055)
        parts += of("velvet", turn(back, "x", -9, (0, d / 2 - 0.2, seat)))
    return Model(parts)


def wall_screen(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """A wide lit screen in a black frame."""
    w, d, h = size
    parts = of("dark_metal", box((-w / 2, -d / 2 + 0.01, 0.0), (w / 2, d / 2, h)))
    for lo, hi in (
        ((-w / 2, 0), (w / 2, 0.05)),
        ((-w / 2, h - 0.05), (w / 2, h)),
        ((-w / 2, 0.04), (-w / 2 + 0.05, h - 0.04)),
        ((w / 2 - 0.05, 0.04), (w / 2, h - 0.04)),
    ):
        parts += of(
            "leather",
            box((lo[0] + 0.001, -d / 2, lo[1] + 0.001), (hi[0] - 0.001, -d / 2 + 0.03, hi[1] - 0.001)),
            color=(0.04, 0.04, 0.05),
        )
    return Model(
        parts
        + of(
            "screen",
            box((-w / 2 + 0.04, -d / 2 + 0.004, 0.04), (w / 2 - 0.04, -d / 2 + 0.02, h - 0.04), 0.0),
            color=(0.8, 0.83, 0.88),
        )
    )


KINDS = {
    "cinema seats": FurnitureKind(cinema_seats, "floor", (1.26, 0.85, 1.0), (2.42, 0.95, 1.1), front=0.3),
    "wall screen": FurnitureKind(wall_screen, "wall", (1.7, 0.06, 0.95), (2.6, 0.08, 1.4)),
}
