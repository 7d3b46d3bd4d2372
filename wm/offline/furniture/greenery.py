"""Plants in pots and cut flowers."""

import math

import numpy as np

from wm.offline.furniture.piece import FurnitureKind, Model, Part, Size, of, pick
from wm.offline.furniture.solids import Point3, Real, Solid, ball, box, closed, lathe, rod, shift, stretch, tube
from wm.offline.furniture.storage import vessel
from wm.offline.style.finish import Style


def leaf(root: Point3, azimuth: Real, rise: Real, length: Real, width: Real, droop: Real) -> Solid:
    """A leaf that grows from its root at an angle above the horizontal and bends down towards its tip."""
    c, s = math.cos(azimuth), math.sin(azimuth)
    points, slope, r, z = [], rise, 0.0, 0.0
    steps = 5
    for _ in range(steps + 1):
        points.append((root[0] + c * r, root[1] + s * r, root[2] + z))
        r, z = r + length / steps * math.cos(slope), z + length / steps * math.sin(slope)
        slope -= droop / steps
    widths = [0.12 * width, 0.6 * width, width, 0.85 * width, 0.45 * width, 0.04 * width]
    return blade(points, widths, (-s, c))


def blade(points: list[Point3], widths: list[float], across: tuple[Real, Real]) -> Solid:
    """A thin closed strip along points, folded along its middle. `widths` are its half widths in a horizontal direction."""
    rings = []
    for (x, y, z), half in zip(points, widths):
        ax, ay = across[0] * half, across[1] * half
        rings += [(x + ax, y + ay, z + 0.25 * half), (x, y, z + 0.0015), (x - ax, y - ay, z + 0.25 * half), (x, y, z - 0.0025)]
    faces = [(0, 1, 2), (0, 2, 3)]
    for k in range(len(points) - 1):
        for j in range(4):
            a, b, e, f = 4 * k + j, 4 * k + (j + 1) % 4, 4 * k + 4 + (j + 1) % 4, 4 * k + 4 + j
            faces += [(a, f, e), (a, e, b)]
    last = 4 * (len(points) - 1)
    faces += [(last, last + 2, last + 1), (last, last + 3, last + 2)]
    return closed(np.array(rings), faces)


def pot(style: Style, rng: np.random.Generator, radius: Real, height: Real) -> list[Part]:
    shapes = {
        "round": [(0.7, 0.0), (0.98, 0.5), (1.0, 0.75), (0.9, 1.0)],
        "cone": [(0.68, 0.0), (0.95, 0.86), (1.0, 0.86), (1.0, 1.0)],
        "box": [(0.95, 0.0), (1.0, 1.0)],
    }
    shape = shapes["round" if style.form.softness > 0.7 else ("cone" if style.form.ornament > 0.1 else "box")]
    slot, color = ("terracotta", None) if rng.random() < 0.5 else ("ceramic", pick(rng, style.accents))
    wall = [(r * radius, z * height) for r, z in shape]
    parts = of(slot, lathe([*wall, (0.86 * radius, height), (0.84 * radius, height - 0.03)], 24), color=color)
    return parts + of(
        "soil", lathe([(0.87 * radius, height - 0.05), (0.87 * radius, height - 0.018), (0.3 * radius, height - 0.008)], 20)
    )


def plant(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """A large plant in a pot: broad leaves on stems, a palm, or upright swords."""
    w, _, h = size
    base = min(0.34, 0.28 * h)
    parts = pot(style, rng, min(0.42 * w, 0.2), base)
    reach = w / 2
    sort = int(rng.integers(3))
    solids = []
    if sort == 0:  # a tree of broad leaves
        stems = [(0.0, 0.0)] + [(0.05 * math.cos(a), 0.05 * math.sin(a)) for a in (0.5, 2.6, 4.7)]
        count = 0
        for x, y in stems:
            top = base + (h - base) * float(rng.uniform(0.55, 0.85))
            lean = float(rng.uniform(0.5, 2.2))
            solids.append(
                tube(
                    [(x, y, base - 0.03), (x * lean, y * lean, 0.5 * (base + top)), (2 * x * lean, 2 * y * lean, top)],
                    [0.01, 0.008, 0.005],
                    6,
                    smooth=1,
                )
            )
            for k in range(9):
                share = 0.25 + 0.75 * (k + 1) / 9
                root = (2 * x * lean * share, 2 * y * lean * share, base + (top - base) * share)
                long = min(reach - 0.1, 0.3) * float(rng.uniform(0.7, 1.0))
                solids.append(
                    leaf(root, 2.4 * count + float(rng.uniform(-0.3, 0.3)), float(rng.uniform(0.5, 1.1)), long, 0.26 * long, 1.4)
                )
                count += 1
    elif sort == 1:  # a palm: fronds from one heart
        trunk = base + 0.3 * (h - base)
        parts += of("dark_wood", tube([(0, 0, base - 0.03), (0.02, 0, trunk)], [0.035, 0.025], 8))
        for k in range(16):
            long = 1.15 * reach * float(rng.uniform(0.85, 1.05))
            solids.append(
                leaf(
                    (0.02, 0, trunk - 0.01),
                    2.4 * k,
                    float(rng.uniform(0.75, 1.35)),
                    min(long, 0.75 * (h - trunk) + 0.1),
                    0.05 + 0.03 * reach,
                    1.9,
                )
            )
    else:  # swords
        for k in range(15):
            a, r = 2.4 * k, 0.07 * math.sqrt(k / 15)
            tall = (h - base) * float(rng.uniform(0.6, 1.0))
            lean = float(rng.uniform(0.02, 0.2)) * reach
            points = [
                (
                    r * math.cos(a) + lean * t * t * math.cos(a),
                    r * math.sin(a) + lean * t * t * math.sin(a),
                    base - 0.02 + tall * t,
                )
                for t in np.linspace(0, 1, 5)
            ]
            solids.append(blade(points, [0.02, 0.032, 0.034, 0.024, 0.002], (-math.sin(a), math.cos(a))))
    return Model(parts + of("leaf", *solids))


def small_plant(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """A pot plant for a table."""
    w, _, h = size
    base = 0.42 * h
    parts = pot(style, rng, 0.3 * w, base)
    solids = [leaf((0, 0, base - 0.01), 2.4 * k, 1.35 - 0.05 * k, 0.5 * w * (0.7 + 0.02 * k), 0.1 * w, 1.3) for k in range(14)]
    return Model(parts + of("leaf", *solids))


def flowers(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """Cut flowers in a vase."""
    w, _, h = size
    neck = 0.5 * h
    parts = vessel(style, rng, 0.0, 0.0, 0.0, neck)
    color = pick(rng, style.accents)
    for k in range(9):
        a, share = 2.4 * k, 0.25 + 0.75 * (k / 9)
        tip = (0.4 * w * share * math.cos(a), 0.4 * w * share * math.sin(a), h - 0.045 - 0.16 * h * share)
        parts += of(
            "leaf", tube([(0, 0, neck - 0.06), (0.4 * tip[0], 0.4 * tip[1], 0.5 * (neck + tip[2])), tip], 0.003, 5, smooth=1)
        )
        bloom = stretch(ball((0, 0, 0), 0.16 * w, 10), (1.0, 1.0, 0.7))
        parts += of("flower", shift(bloom, tip), color=color)
        parts += of("leaf", leaf((0.3 * tip[0], 0.3 * tip[1], 0.4 * neck + 0.6 * tip[2]), a + 1.0, 0.6, 0.3 * w, 0.05 * w, 1.0))
    return Model(parts)


def clipped(centre: Point3, radius: Real, rng: np.random.Generator, *, tall: Real = 1.0) -> Solid:
    """A ball of clipped foliage: a sphere with small bumps."""
    sphere = ball((0, 0, 0), 1.0, 26)
    at = sphere.vertices * 9.0
    phase = rng.uniform(0, 6, 3)
    bumps = np.sin(at[:, 0] + phase[0]) * np.sin(at[:, 1] + phase[1]) + np.sin(at[:, 2] * 1.3 + phase[2]) * np.sin(1.7 * at[:, 0])
    grown = sphere.vertices * (1 + 0.045 * bumps[:, None]) * [radius, radius, radius * tall]
    return Solid(grown + np.asarray(centre), sphere.faces)


def topiary(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """A clipped tree in a pot: balls on a stem, or a cone."""
    w, _, h = size
    base = 0.26 * h
    parts = pot(style, rng, min(0.4 * w, 0.2), base)
    trunk = rod((0, 0, base - 0.03), (0, 0, h - 0.1), 0.02, 8)
    if rng.random() < 0.6:
        r = 0.46 * w
        crown = [clipped((0, 0, h - r), r, rng), clipped((0, 0, h - 2.35 * r), 0.68 * r, rng)]
    else:
        tiers = 5
        crown = []
        for k in range(tiers):
            share = k / (tiers - 1)
            r = (0.46 - 0.3 * share) * w
            low = base + 0.05 + 0.85 * r
            crown.append(clipped((0, 0, low + share * (h - 0.55 * r - low)), r, rng, tall=0.75))
    parts += of("dark_wood", trunk)
    return Model(parts + of("foliage", *crown))


def wall_ivy(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """A climbing plant on a trellis in a shallow trough on the wall."""
    w, d, h = size
    back = d / 2 - 0.012
    slot = "brass" if style.form.ornament > 0.5 else "wood"
    parts = of(slot, box((-w / 2, -d / 2, 0.0), (w / 2, d / 2, 0.16), 0.01))
    parts += of("soil", box((-w / 2 + 0.015, -d / 2 + 0.015, 0.1), (w / 2 - 0.015, d / 2 - 0.015, 0.165), 0.0))
    for x in np.linspace(-0.42 * w, 0.42 * w, 4):
        parts += of(slot, rod((float(x), back, 0.14), (float(x), back, h - 0.25 * abs(float(x))), 0.006, 6))
    for z in np.linspace(0.32, h - 0.2, 5):
        parts += of(slot, rod((-0.45 * w, back - 0.004, float(z)), (0.45 * w, back - 0.004, float(z)), 0.005, 6))
    leaves = []
    for k in range(4):
        start = (k - 1.5) * 0.24 * w
        sway, top = float(rng.uniform(0.05, 0.12)) * w, h * float(rng.uniform(0.72, 0.98))
        t = np.linspace(0, 1, 13)
        path = np.stack([start + sway * np.sin(5 * t + 2.1 * k), back - 0.022 + 0 * t, 0.15 + t * (top - 0.15)], -1)
        leaves.append(tube(path, 0.006, 5))
        for j in range(34):
            x, y, z = (float(np.interp(j / 33, t, path[:, axis])) for axis in range(3))
            out = -math.pi / 2 + float(rng.uniform(-1.15, 1.15))
            long = float(rng.uniform(0.09, 0.15))
            leaves.append(ivy_leaf((x, y, z), out, long, float(rng.uniform(0.1, 0.9)), room=y + d / 2))
    return Model(parts + of("leaf", *leaves))


def ivy_leaf(root: Point3, azimuth: Real, length: Real, rise: Real, *, room: Real) -> Solid:
    """A broad hanging leaf of a climbing plant, which extends at most `room` metres towards -y."""
    c, s = math.cos(azimuth), math.sin(azimuth)
    reach = min(length, 0.95 * room / max(-s, 0.2))
    points: list[Point3] = [
        (root[0] + c * reach * q, root[1] + s * reach * q, root[2] + length * (0.5 * rise * q - 0.9 * q * q))
        for q in (0.0, 0.45, 1.0)
    ]
    return blade(points, [0.15 * length, 0.42 * length, 0.02 * length], (-s, c))


def planter(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """A long trough of ferns and grasses."""
    w, d, h = size
    rim = 0.42 * h
    slot = "brass" if style.form.ornament > 0.5 else "wood"
    parts = of(
        slot, box((-w / 2, -d / 2, 0.03), (w / 2, d / 2, rim), 0.01), box((-w / 2, -d / 2, rim - 0.04), (w / 2, d / 2, rim), 0.01)
    )
    parts += of(
        "dark_metal", *(box((s * 0.4 * w - 0.03, -0.4 * d, 0.0), (s * 0.4 * w + 0.03, 0.4 * d, 0.04), 0.004) for s in (-1.0, 1.0))
    )
    parts += of("soil", box((-w / 2 + 0.02, -d / 2 + 0.02, rim - 0.05), (w / 2 - 0.02, d / 2 - 0.02, rim + 0.006), 0.0))
    leaves = []
    for k in range(5):
        x = (k - 2) * 0.19 * w
        for j in range(12):
            long = min(float(rng.uniform(0.7, 1.0)) * (h - rim), 0.5)
            azimuth = 2.4 * j + k
            reach = long * (0.55 if abs(math.sin(azimuth)) > 0.6 else 0.9)
            leaves.append(leaf((x, 0.0, rim - 0.01), azimuth, float(rng.uniform(1.15, 1.5)), min(reach, 0.9 * d), 0.03, 1.3))
    return Model(parts + of("leaf", *leaves))


KINDS = {
    "topiary": FurnitureKind(topiary, "floor", (0.44, 0.44, 1.1), (0.54, 0.54, 1.5)),
    "planter": FurnitureKind(planter, "floor", (0.8, 0.32, 0.75), (1.1, 0.38, 0.95)),
    "wall ivy": FurnitureKind(wall_ivy, "wall", (0.7, 0.18, 1.5), (1.0, 0.22, 2.0)),
    "plant": FurnitureKind(plant, "floor", (0.55, 0.55, 1.0), (0.75, 0.75, 1.5)),
    "flowers": FurnitureKind(flowers, "object", (0.2, 0.2, 0.34), (0.26, 0.26, 0.44)),
    "potted plant": FurnitureKind(small_plant, "object", (0.22, 0.22, 0.26), (0.3, 0.3, 0.36)),
}
