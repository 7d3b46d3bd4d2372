"""Things of garages and workshops: car, bicycle, pile of tyres, workbench, anvil."""

import math

import numpy as np

from wm.offline.furniture.common import frame_wood
from wm.offline.furniture.joinery import BLACK, posts, wheel
from wm.offline.furniture.piece import FurnitureKind, Model, Part, Size, Top, of, pick
from wm.offline.furniture.solids import Point3, Real, box, extrude, lathe, rod, rounded_box, shift, tube, turn
from wm.offline.style.finish import Style

PAINTS = ((0.55, 0.05, 0.06), (0.06, 0.16, 0.36), (0.75, 0.76, 0.77), (0.1, 0.24, 0.16), (0.78, 0.66, 0.3))


def car(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """A small hatchback, its bonnet towards -y: body, glazed cabin, roof, lamps, bumpers, four wheels."""
    w, d, h = size
    paint, r, waist = pick(rng, PAINTS), 0.215 * h, 0.6 * h
    arch_front, arch_back = -0.31 * d, 0.3 * d

    def arch(y: Real) -> list[tuple[float, float]]:
        return [(y + 1.2 * r * math.cos(a), 0.17 * h + 1.2 * r * math.sin(a)) for a in np.linspace(math.pi, 0, 9)]

    body = [
        (-d / 2, 0.22 * h),
        *arch(arch_front),
        *arch(arch_back),
        (d / 2, 0.22 * h),
        (d / 2, waist - 0.05),
        (d / 2 - 0.06, waist),
        (-0.18 * d, waist),
        (-0.46 * d, 0.52 * h),
        (-d / 2, 0.45 * h),
    ]
    parts = of("lacquer", extrude(body, -w / 2 + 0.02, w / 2 - 0.02, "x"), color=paint)
    glass = [(-0.2 * d, waist - 0.01), (-0.06 * d, h - 0.045), (0.34 * d, h - 0.045), (0.46 * d, waist - 0.01)]
    parts += of("glass", extrude(glass, -w / 2 + 0.1, w / 2 - 0.1, "x"), color=(0.1, 0.13, 0.15))
    roof = [(-0.07 * d, h - 0.06), (-0.04 * d, h - 0.01), (0.0, h), (0.3 * d, h), (0.36 * d, h - 0.06)]
    parts += of("lacquer", extrude(roof, -w / 2 + 0.09, w / 2 - 0.09, "x"), color=paint)
    for s in (-1, 1):
        x = s * (w / 2 - 0.1)
        for a, b in (
            ((-0.2 * d, waist - 0.01), (-0.06 * d, h - 0.04)),
            ((0.11 * d, waist - 0.01), (0.12 * d, h - 0.04)),
            ((0.45 * d, waist - 0.01), (0.34 * d, h - 0.04)),
        ):
            parts += of("lacquer", tube([(x, *a), (x, *b)], 0.03, 8), color=paint)
        parts += of("chrome", box((s * (w / 2 - 0.03), 0.0, waist - 0.1), (s * (w / 2 - 0.005), 0.14, waist - 0.075)))
        parts += of(
            "lacquer",
            rounded_box(
                (s * (w / 2 - 0.04), -0.15 * d - 0.06, waist + 0.01), (s * (w / 2 + 0.06), -0.15 * d + 0.06, waist + 0.11), 0.03
            ),
            color=paint,
        )
        parts += of("bulb", wheel((s * (w / 2 - 0.24), -d / 2 + 0.01, 0.4 * h), 0.085, 0.05, "y"), color=(0.95, 0.95, 0.9))
        parts += of(
            "lacquer",
            box((s * (w / 2 - 0.04), d / 2 - 0.02, 0.42 * h), (s * (w / 2 - 0.26), d / 2 + 0.01, 0.5 * h)),
            color=(0.6, 0.04, 0.04),
        )
        for y in (arch_front, arch_back):
            parts += of("leather", wheel((s * (w / 2 - 0.1), y, r), r, 0.19, segments=28), color=BLACK)
            parts += of("chrome", wheel((s * (w / 2 - 0.1), y, r), 0.6 * r, 0.2, segments=20))
    for y, out in ((-d / 2, -0.02), (d / 2, 0.02)):
        parts += of(
            "dark_metal", rounded_box((-w / 2 + 0.04, y - 0.05 + out, 0.22 * h), (w / 2 - 0.04, y + 0.05 + out, 0.32 * h), 0.03)
        )
    parts += of("dark_metal", box((-0.3, -d / 2 - 0.01, 0.35 * h), (0.3, -d / 2 + 0.03, 0.43 * h)))
    return Model(parts + of("paper", box((-0.26, -d / 2 - 0.075, 0.235 * h), (0.26, -d / 2 - 0.03, 0.3 * h))))


def ring(at: Point3, radius: Real, thick: Real) -> list[Part]:
    """A tyre whose axle lies along x."""
    angle = np.linspace(0.0, 2 * math.pi, 25)[:-1]
    loop = [(at[0], at[1] + radius * math.cos(a), at[2] + radius * math.sin(a)) for a in angle]
    return of("leather", tube([*loop, loop[0]], thick, 8), color=BLACK)


def bicycle(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """A bicycle on its stand, seen from the side: it stands along a wall."""
    w, d, h = size
    r, paint = 0.33 * h, pick(rng, PAINTS)
    back, front = (-w / 2 + r, 0.0, r), (w / 2 - r, 0.0, r)
    parts: list[Part] = []
    for x, _, z in (back, front):
        parts += [Part(p.slot, shift(turn(p.solid, "z", 90), (x, 0, z)), p.color) for p in ring((0, 0, 0), r - 0.02, 0.02)]
        for k in range(6):
            a = math.pi * k / 6
            c, s = (r - 0.02) * math.cos(a), (r - 0.02) * math.sin(a)
            parts += of("chrome", rod((x - c, 0, z - s), (x + c, 0, z + s), 0.003, 5))
    crank, seat, head = (-0.06, 0.0, r - 0.03), (-0.14 * w, 0.0, 0.78 * h), (0.22 * w, 0.0, 0.8 * h)
    for a, b in ((back, crank), (back, seat), (seat, crank), (crank, head), (seat, head), (head, front)):
        parts += of("lacquer", rod(a, b, 0.016), color=paint)
    parts += of("chrome", rod(seat, (seat[0] - 0.02, 0, 0.9 * h), 0.012), rod(head, (head[0] - 0.02, 0, 0.97 * h), 0.013))
    parts += of("leather", rounded_box((seat[0] - 0.15, -0.06, 0.89 * h), (seat[0] + 0.1, 0.06, 0.94 * h), 0.02), color=BLACK)
    bar = [
        (head[0] - 0.1, -d / 2, 0.95 * h),
        (head[0] + 0.02, -0.3 * d, h - 0.015),
        (head[0] + 0.02, 0.3 * d, h - 0.015),
        (head[0] - 0.1, d / 2, 0.95 * h),
    ]
    parts += of("chrome", tube(bar, 0.012, 8)) + of(
        "dark_metal", wheel(crank, 0.09, 0.02, "y"), rod((crank[0] - 0.1, -0.2, 0.0), (crank[0], 0, crank[2]), 0.01)
    )
    for s in (-1, 1):
        parts += of(
            "dark_metal",
            rod((crank[0], 0, crank[2]), (crank[0] + s * 0.15, s * 0.06, crank[2] - s * 0.04), 0.009),
            box(
                (crank[0] + s * 0.15 - 0.04, s * 0.05, crank[2] - s * 0.04 - 0.012),
                (crank[0] + s * 0.15 + 0.04, s * 0.13, crank[2] - s * 0.04 + 0.012),
            ),
        )
    return Model(parts)


def tyres(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """Tyres lying on each other."""
    w, _, h = size
    count = max(round(h / 0.2), 2)
    tall = h / count
    parts: list[Part] = []
    for k in range(count):
        z, off = k * tall, float(rng.uniform(-0.015, 0.015))
        r = w / 2 - 0.02
        wall = [
            (0.5 * r, 0.1 * tall),
            (0.8 * r, 0.0),
            (0.95 * r, 0.04 * tall),
            (r, 0.2 * tall),
            (r, 0.5 * tall - 0.006),
            (0.97 * r, 0.5 * tall),
            (r, 0.5 * tall + 0.006),
            (r, 0.8 * tall),
            (0.95 * r, 0.96 * tall),
            (0.8 * r, tall),
            (0.5 * r, 0.9 * tall),
        ]
        profile = [*wall, (0.45 * r, 0.75 * tall), (0.3 * r, 0.5 * tall)]
        parts += of("leather", lathe(profile, 28, at=(off, -off, z)), color=BLACK)
        parts += of("dark_metal", lathe([(0.46 * r, 0.9 * tall), (0.46 * r, 0.93 * tall)], 20, at=(off, -off, z)))
    return Model(parts)


def workbench(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """A thick top on stout legs with a vice, and a board of tools behind it."""
    w, d, h = size
    wood, top = frame_wood(style), 0.88
    xs, ys = (-w / 2 + 0.07, w / 2 - 0.07), (-d / 2 + 0.08, d / 2 - 0.08)
    parts = of(wood, *posts(xs, ys, 0.0, top - 0.05, 0.09), box((-w / 2, -d / 2, top - 0.06), (w / 2, d / 2 - 0.006, top)))
    parts += of(wood, box((-w / 2 + 0.05, -d / 2 + 0.1, 0.22), (w / 2 - 0.05, d / 2 - 0.06, 0.25)))
    parts += of("light_wood", box((-w / 2 + 0.01, d / 2 - 0.03, top - 0.04), (w / 2 - 0.01, d / 2, h)))
    parts += of(
        "metal",
        box((-w / 2 + 0.12, -d / 2 - 0.02, top), (-w / 2 + 0.3, -d / 2 + 0.12, top + 0.05)),
        box((-w / 2 + 0.12, -d / 2 - 0.06, top + 0.02), (-w / 2 + 0.3, -d / 2 - 0.025, top + 0.12)),
        box((-w / 2 + 0.12, -d / 2 + 0.02, top + 0.03), (-w / 2 + 0.3, -d / 2 + 0.06, top + 0.121)),
    )
    parts += of(
        "chrome",
        rod((-w / 2 + 0.21, -d / 2 - 0.12, top + 0.03), (-w / 2 + 0.21, -d / 2 + 0.0, top + 0.03), 0.014),
        rod((-w / 2 + 0.14, -d / 2 - 0.11, top + 0.03), (-w / 2 + 0.28, -d / 2 - 0.11, top + 0.03), 0.007),
    )
    parts += tool_board(style, rng, w - 0.16, top + 0.2, h - 0.06, d / 2 - 0.045)
    for k in range(2):
        x = 0.1 * w + k * 0.34
        parts += of("painted_wood", box((x, -0.1, 0.25), (x + 0.3, 0.14, 0.42)), color=pick(rng, style.accents))
    return Model(parts, (Top(top, -w / 2 + 0.36, -d / 2 + 0.05, w / 2 - 0.06, d / 2 - 0.08),))


def tool_board(style: Style, rng: np.random.Generator, w: Real, low: Real, high: Real, y: Real) -> list[Part]:
    """Hammers, saws, wrenches and screwdrivers that hang before a board."""
    parts: list[Part] = []
    count = max(int(w / 0.17), 4)
    for k in range(count):
        x, tall, sort = -w / 2 + (k + 0.5) * w / count, float(rng.uniform(0.7, 1.0)) * (high - low), k % 4
        z = high - tall
        if sort == 0:  # hammer
            parts += of("wood", rod((x, y, z), (x, y, high), 0.011)) + of(
                "dark_metal", box((x - 0.06, y - 0.014, high - 0.05), (x + 0.06, y + 0.014, high - 0.015))
            )
        elif sort == 1:  # saw
            blade = [(x - 0.02, z), (x + 0.02, z), (x + 0.06, high - 0.1), (x - 0.06, high - 0.1)]
            parts += of("metal", extrude(blade, y - 0.004, y + 0.004, "y")) + of(
                "wood", rounded_box((x - 0.06, y - 0.014, high - 0.12), (x + 0.06, y + 0.014, high), 0.012, 1)
            )
        elif sort == 2:  # wrench
            parts += of(
                "chrome",
                box((x - 0.012, y - 0.006, z + 0.03), (x + 0.012, y + 0.006, high - 0.03)),
                *(wheel((x, y, at), 0.032, 0.016, "y", 12) for at in (z + 0.03, high - 0.035)),
            )
        else:  # screwdriver
            parts += of("metal", rod((x, y, z), (x, y, high - 0.1), 0.006)) + of(
                "fabric_accent",
                lathe([(0.012, 0), (0.02, 0.03), (0.018, 0.1)], 10, at=(x, y, high - 0.11)),
                color=pick(rng, style.accents),
            )
    return parts


def anvil(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """An anvil on a block of wood, a hammer beside its horn."""
    w, d, h = size
    block = 0.62 * h
    parts = of("dark_wood", lathe([(0.5 * d, 0.0), (0.46 * d, 0.04), (0.46 * d, block)], 16))
    parts += of(
        "dark_metal",
        box((-0.16, -0.11, block - 0.01), (0.16, 0.11, block + 0.06), 0.015),
        box((-0.09, -0.06, block + 0.05), (0.09, 0.06, h - 0.1), 0.01),
        box((-0.2, -0.075, h - 0.13), (0.14, 0.075, h), 0.008),
    )
    horn = shift(turn(lathe([(0.07, 0.0), (0.055, 0.1), (0.0, w / 2 - 0.13)], 14), "y", 90), (0.13, 0.0, h - 0.075))
    return Model(parts + of("dark_metal", horn) + of("dark_metal", box((-w / 2, -0.05, h - 0.08), (-0.18, 0.05, h - 0.002))))


KINDS = {
    "car": FurnitureKind(car, "floor", (1.5, 3.0, 1.35), (1.72, 3.9, 1.5)),
    "bicycle": FurnitureKind(bicycle, "floor", (1.55, 0.46, 0.98), (1.7, 0.52, 1.05)),
    "pile of tyres": FurnitureKind(tyres, "floor", (0.58, 0.58, 0.4), (0.64, 0.64, 0.8)),
    "workbench": FurnitureKind(workbench, "floor", (1.3, 0.6, 1.5), (1.9, 0.72, 1.7), front=0.6),
    "anvil": FurnitureKind(anvil, "floor", (0.7, 0.46, 0.78), (0.8, 0.52, 0.88)),
}
