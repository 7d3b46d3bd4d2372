"""Things for children: cot, changing table, toy box, play mat, rocking horse, bunk bed."""

import numpy as np

from wm.offline.furniture.common import frame_wood, front
from wm.offline.furniture.joinery import WHITE, posts
from wm.offline.furniture.piece import FurnitureKind, Model, Part, Size, of, pick
from wm.offline.furniture.solids import Real, ball, box, lathe, puff, rod, rounded_box, shift, stretch, tube, turn
from wm.offline.style.finish import Style

BRIGHT = ((0.86, 0.2, 0.18), (0.96, 0.75, 0.2), (0.2, 0.5, 0.82), (0.3, 0.66, 0.34), (0.92, 0.5, 0.6))


def bears(rng: np.random.Generator, x: Real, y: Real, z: Real, tall: Real) -> list[Part]:
    """A sitting teddy bear."""
    fur = pick(rng, ((0.55, 0.36, 0.2), (0.75, 0.6, 0.42), (0.45, 0.3, 0.22)))
    r = 0.3 * tall
    solids = [ball((x, y, z + 0.9 * r), r, 12), ball((x, y - 0.1 * r, z + 2.3 * r), 0.75 * r, 12)]
    solids += [ball((x + s * 0.6 * r, y, z + 2.9 * r), 0.3 * r, 8) for s in (-1, 1)]
    solids += [ball((x + s * 0.8 * r, y - 0.8 * r, z + 0.42 * r), 0.42 * r, 8) for s in (-1, 1)]
    return of("blanket", *solids, color=fur) + of("dark_metal", ball((x, y - 0.84 * r, z + 2.3 * r), 0.14 * r, 6))


def cot(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """A bed with bars all around, a mattress, a blanket and a bear."""
    w, d, h = size
    slot, xs, ys = "painted_wood", (-w / 2 + 0.025, w / 2 - 0.025), (-d / 2 + 0.025, d / 2 - 0.025)
    parts = of(slot, *posts(xs, ys, 0.0, h, 0.05))
    for z in (0.28, h - 0.04):
        parts += of(slot, *(box((-w / 2 + 0.03, y - 0.018, z), (w / 2 - 0.03, y + 0.018, z + 0.035)) for y in ys))
        parts += of(slot, *(box((x - 0.017, -d / 2 + 0.03, z + 0.001), (x + 0.017, d / 2 - 0.03, z + 0.034)) for x in xs))
    for y in ys:
        parts += of(
            slot, *(rod((x, y, 0.3), (x, y, h - 0.03), 0.009, 6) for x in np.arange(-w / 2 + 0.11, w / 2 - 0.06, 0.085).tolist())
        )
    for x in xs:
        parts += of(
            slot, *(rod((x, y, 0.3), (x, y, h - 0.03), 0.009, 6) for y in np.arange(-d / 2 + 0.11, d / 2 - 0.06, 0.085).tolist())
        )
    parts += of(
        "linen", rounded_box((-w / 2 + 0.045, -d / 2 + 0.045, 0.3), (w / 2 - 0.045, d / 2 - 0.045, 0.44), 0.03), color=WHITE
    )
    parts += of(
        "blanket",
        rounded_box((-0.1 * w, -d / 2 + 0.05, 0.4), (w / 2 - 0.05, d / 2 - 0.05, 0.47), 0.025),
        color=pick(rng, style.accents),
    )
    parts += of("pillow", puff((-w / 2 + 0.08, -0.16, 0.43), (-w / 2 + 0.34, 0.16, 0.51)))
    return Model(parts + bears(rng, -0.18 * w, 0.1, 0.44, 0.24))


def changing_table(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """A chest of drawers with a padded tray on it, folded cloths beside the pad."""
    w, d, h = size
    top = h - 0.12
    parts = of(
        "painted_wood",
        box((-w / 2 + 0.01, -d / 2 + 0.03, 0.06), (w / 2 - 0.01, d / 2, top)),
        *posts((-w / 2 + 0.05, w / 2 - 0.05), (-d / 2 + 0.07, d / 2 - 0.05), 0.0, 0.1, 0.06),
    )
    for k in range(3):
        z0, z1 = (0.08 + (top - 0.1) * (k + e) / 3 for e in (0, 1))
        parts += front(
            style, -w / 2 + 0.025, w / 2 - 0.025, z0 + 0.004, z1 - 0.008, -d / 2 + 0.03, slot="painted_wood", handle="centre"
        )
    parts += of(
        "painted_wood",
        box((-w / 2, d / 2 - 0.025, top - 0.02), (w / 2, d / 2, h)),
        *(box((s * w / 2, -d / 2, top - 0.02), (s * (w / 2 - 0.025), d / 2 - 0.01, h - 0.01)) for s in (-1, 1)),
    )
    parts += of(
        "fabric",
        puff((-w / 2 + 0.04, -d / 2 + 0.02, top - 0.02), (0.2 * w, d / 2 - 0.04, top + 0.08), square=0.2),
        color=(0.85, 0.9, 0.93),
    )
    for k in range(3):
        parts += of(
            "linen",
            rounded_box((0.26 * w, -0.14, top + 0.001 + 0.035 * k), (0.46 * w, 0.14, top + 0.034 + 0.035 * k), 0.014, 1),
            color=pick(rng, (WHITE, *style.accents)),
        )
    return Model(parts)


def toy_box(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """An open box in bright boards, toys looking out of it."""
    w, d, h = size
    rim, t = 0.62 * h, 0.025
    colors = [BRIGHT[int(k)] for k in rng.permutation(len(BRIGHT))]
    parts = of("painted_wood", box((-w / 2, -d / 2, 0), (w / 2, -d / 2 + t, rim)), color=colors[0])
    parts += of("painted_wood", box((-w / 2, d / 2 - t, 0), (w / 2, d / 2, rim + 0.04)), color=colors[1])
    parts += of(
        "painted_wood",
        *(box((s * w / 2, -d / 2 + t - 0.004, 0.004), (s * (w / 2 - t), d / 2 - t + 0.004, rim - 0.01)) for s in (-1, 1)),
        color=colors[2],
    )
    parts += of("wood", box((-w / 2 + 0.01, -d / 2 + 0.01, 0.01), (w / 2 - 0.01, d / 2 - 0.01, 0.5 * rim)))
    parts += of("painted_wood", ball((0.28 * w, 0.0, rim), 0.11, 16), color=colors[3]) + bears(
        rng, -0.22 * w, 0.02, rim - 0.2, h - rim + 0.19
    )
    cubes = [
        shift(
            turn(box((-0.06, -0.06, -0.06), (0.06, 0.06, 0.06)), "z", 30.0 + 20 * k),
            (0.03 + 0.09 * k, -0.07 + 0.1 * k, rim - 0.02),
        )
        for k in range(2)
    ]
    return Model(parts + of("painted_wood", cubes[0], color=colors[4]) + of("painted_wood", cubes[1], color=colors[0]))


def play_mat(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """Squares of foam in bright colours."""
    w, d, h = size
    nx, ny = max(round(w / 0.45), 2), max(round(d / 0.45), 2)
    parts: list[Part] = []
    for i in range(nx):
        for j in range(ny):
            x, y = -w / 2 + i * w / nx, -d / 2 + j * d / ny
            parts += of(
                "rug",
                box((x + 0.003, y + 0.003, 0.0), (x + w / nx - 0.003, y + d / ny - 0.003, h), 0.002),
                color=BRIGHT[(i + 2 * j) % len(BRIGHT)],
            )
    return Model(parts)


def rocking_horse(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """A wooden horse on two rockers."""
    w, d, h = size
    wood, y0 = frame_wood(style), -d / 2
    parts: list[Part] = []
    for s in (-1, 1):
        x = s * (w / 2 - 0.02)
        path = [(x, y0 + t * d, 0.02 + 0.5 * (2 * t - 1) ** 2 * 0.26) for t in np.linspace(0, 1, 9)]
        parts += of("painted_wood", tube(path, 0.022, 8), color=BRIGHT[0])
        parts += of(wood, *(rod((x * 0.95, s2 * 0.24 * d, 0.05), (s * 0.07, s2 * 0.16 * d, 0.5 * h), 0.022) for s2 in (-1, 1)))
    parts += of(
        wood,
        rod((-w / 2 + 0.02, -0.2 * d, 0.06), (w / 2 - 0.02, -0.2 * d, 0.06), 0.014),
        rod((-w / 2 + 0.02, 0.2 * d, 0.06), (w / 2 - 0.02, 0.2 * d, 0.06), 0.014),
    )
    parts += of(wood, shift(stretch(ball((0, 0, 0), 1.0, 16), (0.11, 0.27 * d, 0.12)), (0, 0, 0.55 * h)))
    parts += of(
        wood,
        tube([(0, -0.18 * d, 0.58 * h), (0, -0.3 * d, 0.86 * h)], [0.085, 0.06], 12),
        tube([(0, -0.28 * d, 0.9 * h), (0, -0.44 * d, 0.76 * h)], [0.065, 0.045], 12),
    )
    parts += of(
        "soot",
        tube([(0, -0.14 * d, 0.68 * h), (0, -0.24 * d, 0.96 * h)], [0.03, 0.02], 8, flatten=0.5),
        tube([(0, 0.24 * d, 0.6 * h), (0, 0.4 * d, 0.36 * h)], [0.02, 0.035], 8),
    )
    parts += of("leather", rounded_box((-0.12, -0.07, 0.62 * h), (0.12, 0.12, 0.7 * h), 0.03)) + of(
        wood, rod((-0.13, -0.27 * d, 0.82 * h), (0.13, -0.27 * d, 0.82 * h), 0.013)
    )
    return Model(parts + of(wood, *(lathe([(0.018, 0), (0.0, 0.06)], 8, at=(s * 0.03, -0.29 * d, 0.94 * h)) for s in (-1, 1))))


def bunk_bed(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """Two beds, one above the other, with a rail and a ladder."""
    w, d, h = size
    wood, xs, ys = frame_wood(style), (-w / 2 + 0.035, w / 2 - 0.035), (-d / 2 + 0.035, d / 2 - 0.035)
    parts = of(wood, *posts(xs, ys, 0.0, h, 0.07))
    for base in (0.28, 0.28 + 0.56 * h):
        for y in ys:
            parts += of(wood, box((-w / 2 + 0.05, y - 0.018, base - 0.1), (w / 2 - 0.05, y + 0.018, base + 0.03)))
        for x in xs:
            parts += of(wood, box((x - 0.017, -d / 2 + 0.05, base - 0.099), (x + 0.017, d / 2 - 0.05, base + 0.24)))
        parts += of(
            "linen",
            rounded_box((-w / 2 + 0.06, -d / 2 + 0.06, base - 0.04), (w / 2 - 0.06, d / 2 - 0.06, base + 0.12), 0.04),
            color=WHITE,
        )
        parts += of(
            "blanket",
            rounded_box((-w / 2 + 0.055, -d / 2 + 0.055, base + 0.06), (0.42 * w - 0.3, d / 2 - 0.055, base + 0.15), 0.035),
            color=pick(rng, style.accents),
        )
        parts += of("pillow", puff((w / 2 - 0.42, -0.24, base + 0.1), (w / 2 - 0.1, 0.24, base + 0.23)))
    rail = 0.28 + 0.56 * h + 0.26
    parts += of(
        wood,
        box((-0.2 * w, -d / 2 + 0.018, rail - 0.05), (w / 2 - 0.05, -d / 2 + 0.05, rail + 0.03)),
        box((-w / 2 + 0.05, d / 2 - 0.05, rail - 0.05), (w / 2 - 0.05, d / 2 - 0.018, rail + 0.03)),
    )
    x0, x1 = -w / 2 + 0.1, -w / 2 + 0.46
    parts += of(wood, *(box((x - 0.02, -d / 2 - 0.03, 0.0), (x + 0.02, -d / 2 + 0.012, rail)) for x in (x0, x1)))
    return Model(
        parts
        + of(
            wood,
            *(rod((x0, -d / 2 - 0.01, z), (x1, -d / 2 - 0.01, z), 0.015) for z in np.arange(0.26, rail - 0.1, 0.25).tolist()),
        )
    )


KINDS = {
    "cot": FurnitureKind(cot, "floor", (1.2, 0.66, 0.9), (1.32, 0.72, 1.0), front=0.4),
    "changing table": FurnitureKind(changing_table, "floor", (0.85, 0.5, 0.98), (1.0, 0.56, 1.06), front=0.5),
    "toy box": FurnitureKind(toy_box, "floor", (0.7, 0.42, 0.62), (0.9, 0.5, 0.7), front=0.3),
    "play mat": FurnitureKind(play_mat, "flat", (1.35, 1.35, 0.008), (1.9, 1.6, 0.008)),
    "rocking horse": FurnitureKind(rocking_horse, "floor", (0.36, 0.85, 0.75), (0.42, 1.0, 0.9)),
    "bunk bed": FurnitureKind(bunk_bed, "floor", (1.95, 0.92, 1.55), (2.08, 1.0, 1.7), front=0.4),
}
