"""Things that are there to be looked at: pictures, mirror, plants, statue, column, vase, books, clock, fireplace, globe, screen."""

import math

import numpy as np

from wm.synth.procedural.finish import Style
from wm.synth.procedural.furniture.common import COLUMN, candle, finial, frame_wood, tracery
from wm.synth.procedural.furniture.piece import Kind, Model, Part, Size, Top, of, pick
from wm.synth.procedural.furniture.storage import vessel
from wm.synth.procedural.outlines import arch, frame, rectangle, rounded
from wm.synth.procedural.solids import ball, box, extrude, lathe, puff, rod, rounded_box, shift, stretch, tube, turn


def framed(style: Style, outline, d: float, border: float, inside: str, *, wood: str, color=None) -> list[Part]:
    """A frame with something flat in it; its back lies at d / 2."""
    parts = of(wood, extrude(frame(outline, border), -d / 2 + 0.25 * d, d / 2, "y"))
    if style.form.ornament > 0.3:
        parts += of(wood, extrude(frame(outline.buffer(-0.3 * border, join_style="mitre"), 0.35 * border), -d / 2, d / 2 - 0.004, "y"))
    return parts + of(inside, extrude(outline.buffer(-0.9 * border, join_style="mitre"), 0.0, d / 2 - 0.003, "y"), color=color)


def frame_slot(style: Style) -> str:
    if style.form.ornament > 0.4:
        return "brass"
    return "dark_metal" if style.form.panel == "flat" and style.form.legs != "tapered" else "wood"


def picture(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """A framed painting: a passe-partout, and a simple composition of shapes in the accents."""
    w, d, h = size
    border = 0.07 if style.form.ornament > 0.4 else 0.025
    parts = framed(style, rectangle(w, h), d, border, "paper", wood=frame_slot(style))
    mat = border if style.form.ornament > 0.4 else border + 0.12 * min(w, h)
    x, low, high = w / 2 - mat, mat, h - mat
    face = -0.002
    ground, first, second = (style.accents[int(k)] for k in rng.permutation(len(style.accents))[:3])
    parts += of("painting", box((-x, face - 0.003, low), (x, 0.002, high), 0.0), color=ground)
    horizon = low + (high - low) * float(rng.uniform(0.3, 0.55))
    subject = int(rng.integers(3))
    if subject == 0:  # hills and a sun
        t = np.linspace(-x, x, 13)
        phase, rise = float(rng.uniform(0, 6)), 0.12 * (high - low)
        hill = [(-x, low), (x, low), *((float(a), float(horizon + rise * math.sin(5 * a / w + phase))) for a in t[::-1])]
        parts += of("painting", extrude(hill, face - 0.0055, face - 0.001, "y"), color=first)
        r = 0.11 * min(w, h)
        sun = lathe([(r, -0.0015), (r, 0.0015)], 20)
        parts += of("painting", shift(turn(sun, "x", 90), (float(rng.uniform(-0.5, 0.5)) * x, face - 0.0045, high - 1.8 * r)), color=second)
    elif subject == 1:  # a figure
        r = 0.15 * (high - low)
        bust = puff((-1.7 * r, -1.0, 0.0), (1.7 * r, 1.0, 2.4 * r), square=0.9)
        bust = stretch(bust, (1.0, 0.002, 1.0))
        head = shift(turn(lathe([(0.8 * r, -0.002), (0.8 * r, 0.002)], 20), "x", 90), (0, face - 0.005, low + 3.0 * r))
        shoulders = extrude(arch("round", min(3.6 * r, 1.9 * x), 2.2 * r, at=(0, low)), face - 0.006, face - 0.001, "y")
        del bust
        parts += [*of("painting", shoulders, color=first), *of("painting", head, color=second)]
    else:  # three blocks
        for k in range(3):
            a = -x + (0.1 + 0.27 * k) * 2 * x
            top = low + (high - low) * float(rng.uniform(0.3, 0.85))
            parts += of("painting", box((a, face - 0.0055 - 0.0015 * k, low + 0.08 * (high - low)), (a + 0.5 * x, face - 0.001, top), 0.0), color=(first, second, ground)[k] if k < 2 else style.accents[int(rng.integers(len(style.accents)))])
    return Model(parts)


def mirror(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """A looking glass in the style's outline."""
    w, d, h = size
    kind = {"pointed_arch": "pointed", "round_arch": "round", "wave": "wave"}.get(style.form.back, "")
    outline = arch(kind, w, h) if kind else rounded(w, h, 0.49 * w if style.form.softness > 0.5 else 0.02)
    return Model(framed(style, outline, d, 0.06 if style.form.ornament > 0.4 else 0.022, "mirror", wood=frame_slot(style)))


def leaf(root: tuple[float, float, float], azimuth: float, rise: float, length: float, width: float, droop: float):
    """A leaf that leaves its root at an angle above the horizon and bends down towards its tip."""
    c, s = math.cos(azimuth), math.sin(azimuth)
    points, slope, r, z = [], rise, 0.0, 0.0
    steps = 5
    for _ in range(steps + 1):
        points.append((root[0] + c * r, root[1] + s * r, root[2] + z))
        r, z = r + length / steps * math.cos(slope), z + length / steps * math.sin(slope)
        slope -= droop / steps
    widths = [0.12 * width, 0.6 * width, width, 0.85 * width, 0.45 * width, 0.04 * width]
    return blade(points, widths, (-s, c))


def blade(points: list[tuple[float, float, float]], widths: list[float], across: tuple[float, float]):
    """A thin closed strip along points, `widths` half-wide across a horizontal direction, folded along its middle."""
    from wm.synth.procedural.solids import closed

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


def pot(style: Style, rng: np.random.Generator, radius: float, height: float) -> list[Part]:
    shapes = {"round": [(0.7, 0.0), (0.98, 0.5), (1.0, 0.75), (0.9, 1.0)], "cone": [(0.68, 0.0), (0.95, 0.86), (1.0, 0.86), (1.0, 1.0)], "box": [(0.95, 0.0), (1.0, 1.0)]}
    shape = shapes["round" if style.form.softness > 0.7 else ("cone" if style.form.ornament > 0.1 else "box")]
    slot, color = ("terracotta", None) if rng.random() < 0.5 else ("ceramic", pick(rng, style.accents))
    wall = [(r * radius, z * height) for r, z in shape]
    parts = of(slot, lathe([*wall, (0.86 * radius, height), (0.84 * radius, height - 0.03)], 24), color=color)
    return parts + of("soil", lathe([(0.87 * radius, height - 0.05), (0.87 * radius, height - 0.018), (0.3 * radius, height - 0.008)], 20))


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
            solids.append(tube([(x, y, base - 0.03), (x * lean, y * lean, 0.5 * (base + top)), (2 * x * lean, 2 * y * lean, top)], [0.01, 0.008, 0.005], 6, smooth=1))
            for k in range(9):
                share = 0.25 + 0.75 * (k + 1) / 9
                root = (2 * x * lean * share, 2 * y * lean * share, base + (top - base) * share)
                long = min(reach - 0.1, 0.3) * float(rng.uniform(0.7, 1.0))
                solids.append(leaf(root, 2.4 * count + float(rng.uniform(-0.3, 0.3)), float(rng.uniform(0.5, 1.1)), long, 0.26 * long, 1.4))
                count += 1
    elif sort == 1:  # a palm: fronds from one heart
        trunk = base + 0.3 * (h - base)
        parts += of("dark_wood", tube([(0, 0, base - 0.03), (0.02, 0, trunk)], [0.035, 0.025], 8))
        for k in range(16):
            long = 1.15 * reach * float(rng.uniform(0.85, 1.05))
            solids.append(leaf((0.02, 0, trunk - 0.01), 2.4 * k, float(rng.uniform(0.75, 1.35)), min(long, 0.75 * (h - trunk) + 0.1), 0.05 + 0.03 * reach, 1.9))
    else:  # swords
        for k in range(15):
            a, r = 2.4 * k, 0.07 * math.sqrt(k / 15)
            tall = (h - base) * float(rng.uniform(0.6, 1.0))
            lean = float(rng.uniform(0.02, 0.2)) * reach
            points = [(r * math.cos(a) + lean * t * t * math.cos(a), r * math.sin(a) + lean * t * t * math.sin(a), base - 0.02 + tall * t) for t in np.linspace(0, 1, 5)]
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
        parts += of("leaf", tube([(0, 0, neck - 0.06), (0.4 * tip[0], 0.4 * tip[1], 0.5 * (neck + tip[2])), tip], 0.003, 5, smooth=1))
        bloom = stretch(ball((0, 0, 0), 0.16 * w, 10), (1.0, 1.0, 0.7))
        parts += of("flower", shift(bloom, tip), color=color)
        parts += of("leaf", leaf((0.3 * tip[0], 0.3 * tip[1], 0.4 * neck + 0.6 * tip[2]), a + 1.0, 0.6, 0.3 * w, 0.05 * w, 1.0))
    return Model(parts)


def statue(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """A draped figure on a pedestal."""
    w, _, h = size
    foot = 0.42 * h
    slot = "marble" if style.form.legs in ("column", "cabriole") else "stone"
    half = 0.42 * w
    parts = of(slot, box((-half - 0.03, -half - 0.03, 0.0), (half + 0.03, half + 0.03, 0.06), 0.01), box((-half, -half, 0.055), (half, half, foot - 0.05), 0.01))
    parts += of(slot, box((-half - 0.03, -half - 0.03, foot - 0.055), (half + 0.03, half + 0.03, foot), 0.012))
    tall = h - foot
    gown = [(0.150, 0.0), (0.155, 0.03), (0.118, 0.22), (0.1, 0.42), (0.112, 0.5), (0.085, 0.6), (0.1, 0.7), (0.112, 0.76), (0.05, 0.82), (0.034, 0.845), (0.036, 0.87)]
    body = lathe([(0.0, foot - 0.002), *((r * tall, foot - 0.002 + z * tall) for r, z in gown), (0.0, foot + 0.875 * tall)], 40, smooth=2)
    angle = np.arctan2(body.vertices[:, 1], body.vertices[:, 0])
    height = (body.vertices[:, 2] - foot) / tall
    folds = 1 + 0.09 * np.clip(0.6 - height, 0, 0.6) * np.sin(9 * angle + 5 * height)
    body = stretch(type(body)(body.vertices * np.stack([folds, folds, np.ones_like(folds)], -1), body.faces), (1.0, 0.75, 1.0))
    head = stretch(ball((0, 0, 0), 0.062 * tall, 16), (0.82, 0.95, 1.15))
    parts += of(slot, body, shift(head, (0, -0.008, foot + 0.925 * tall)))
    hair = stretch(ball((0, 0, 0), 0.064 * tall, 14), (0.9, 0.8, 0.9))
    parts += of(slot, shift(hair, (0, 0.02, foot + 0.94 * tall)))
    s = tall
    arm = [(0.1 * s, 0, foot + 0.765 * s), (0.155 * s, 0.0, foot + 0.62 * s), (0.1 * s, -0.09 * s, foot + 0.52 * s), (0.02 * s, -0.12 * s, foot + 0.56 * s)]
    down = [(-0.1 * s, 0, foot + 0.765 * s), (-0.145 * s, 0.01, foot + 0.62 * s), (-0.15 * s, -0.03 * s, foot + 0.48 * s), (-0.14 * s, -0.05 * s, foot + 0.4 * s)]
    return Model(parts + of(slot, *(tube(path, [0.036 * s, 0.03 * s, 0.024 * s, 0.02 * s], 10, smooth=2) for path in (arm, down))))


def column(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """A fluted column with a bust or an urn on it."""
    w, _, h = size
    slot = "marble" if style.form.ornament > 0.3 else "stone"
    shaft = 0.66 * h
    half = w / 2
    parts = of(slot, box((-half, -half, 0.0), (half, half, 0.07), 0.01), lathe([(0.95 * half, 0.068), (0.97 * half, 0.09), (0.72 * half, 0.12)], 28, smooth=1))
    flutes = 20
    t = np.arange(flutes * 4) * 2 * np.pi / (flutes * 4)
    radius = 0.68 * half * (1 - 0.07 * (np.arange(flutes * 4) % 4 == 2))
    parts += of(slot, extrude([(float(r * math.cos(a)), float(r * math.sin(a))) for r, a in zip(radius, t)], 0.11, shaft - 0.1, "z"))
    parts += of(slot, lathe([(0.66 * half, shaft - 0.105), (0.95 * half, shaft - 0.055), (0.97 * half, shaft - 0.045)], 28, smooth=1), box((-half, -half, shaft - 0.05), (half, half, shaft), 0.008))
    tall = h - shaft
    if rng.random() < 0.5:
        urn = [(0.16, 0.0), (0.16, 0.05), (0.07, 0.12), (0.09, 0.18), (0.3, 0.5), (0.3, 0.62), (0.14, 0.78), (0.22, 0.86), (0.16, 0.9), (0.0, 1.0)]
        return Model(parts + of("ceramic" if style.form.ornament > 0.6 else slot, lathe([(0.0, shaft - 0.002), *((0.75 * r * tall, shaft - 0.002 + z * tall) for r, z in urn)], 28, smooth=1)))
    parts += of(slot, lathe([(0.13 * tall, shaft - 0.002), (0.1 * tall, shaft + 0.12 * tall)], 20))
    chest = stretch(ball((0, 0, 0), 0.3 * tall, 18), (1.0, 0.6, 0.75))
    head = stretch(ball((0, 0, 0), 0.2 * tall, 18), (0.78, 0.9, 1.1))
    nose = lathe([(0.035 * tall, 0.0), (0.0, 0.1 * tall)], 6)
    parts += of(slot, shift(chest, (0, 0, shaft + 0.3 * tall)), lathe([(0.09 * tall, shaft + 0.4 * tall), (0.08 * tall, shaft + 0.66 * tall)], 16))
    return Model(parts + of(slot, shift(head, (0, -0.02 * tall, shaft + 0.77 * tall)), shift(nose, (0, -0.19 * tall, shaft + 0.7 * tall))))


def fireplace(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """A chimney piece with its fire lit: jambs, lintel, mantel, a dark firebox, logs, flames."""
    w, d, h = size
    stone = "marble" if style.form.legs in ("column", "cabriole") or style.form.ornament < 0.2 else "stone"
    opening_w, opening_h = 0.55 * w, 0.62 * h
    wall = rectangle(w - 0.12, h - 0.05)
    kind = {"pointed": "pointed", "arched": "round"}.get(style.form.panel, "")
    hole = arch(kind, opening_w, opening_h, at=(0.0, 0.04)) if kind else rectangle(opening_w, opening_h, at=(0.0, 0.04))
    face, back = -d / 2 + 0.09, d / 2
    parts = of(stone, extrude(wall.difference(hole), face, back - 0.02, "y"))
    parts += of("soot", box((-w / 2 + 0.075, back - 0.024, 0.002), (w / 2 - 0.075, back, h - 0.055), 0.0))
    parts += of(stone, rounded_box((-w / 2, -d / 2 + 0.02, h - 0.06), (w / 2, d / 2, h), 0.014, 1), rounded_box((-w / 2 + 0.03, -d / 2 + 0.045, h - 0.1), (w / 2 - 0.03, d / 2 - 0.004, h - 0.05), 0.014, 1))
    parts += of("soot", box((-opening_w / 2 - 0.04, -d / 2, 0.0), (opening_w / 2 + 0.04, back - 0.022, 0.036), 0.004))
    x = opening_w / 2 + (w - 0.12 - opening_w) / 4
    for s in (-1.0, 1.0):
        if style.form.legs == "column" or style.form.ornament > 0.6:
            parts += of(stone, lathe([(0.055 * r + 0.004, z * (h - 0.1)) for r, z in COLUMN], 18, at=(s * x, face - 0.012, 0.0)))
        elif style.form.ornament > 0.1:
            parts += of(stone, box((s * x - 0.06, face - 0.025, 0.0), (s * x + 0.06, face + 0.02, h - 0.1), 0.008))
    if kind:
        parts += of(stone, extrude(hole.buffer(0.045).difference(hole.buffer(0.003)).intersection(rectangle(w, h, at=(0, 0.05))), face - 0.02, face + 0.015, "y"))
    middle = 0.5 * (face + back) + 0.01
    for k, (dx, dy) in enumerate(((0.0, -0.05), (0.0, 0.06), (0.02, 0.0))):
        log = turn(lathe([(0.042, -0.17), (0.045, 0.17)], 10), "y", 90)
        parts += of("dark_wood", shift(turn(log, "z", (-14, 12, 50)[k]), (dx, middle + dy, 0.085 if k < 2 else 0.16)))
    parts += of("ember", shift(stretch(ball((0, 0, 0), 0.19, 12), (1.0, 0.45, 0.28)), (0, middle, 0.06)))
    for k in range(7):
        tall = float(rng.uniform(0.16, 0.34)) * min(1.0, opening_h / 0.55) * (1.0 - 0.09 * abs(k - 3))
        at = (float(k - 3) * 0.05, middle + float(rng.uniform(-0.05, 0.04)), 0.12)
        tongue = [(0.0, 0.0), (0.032, 0.12), (0.038, 0.3), (0.022, 0.6), (0.008, 0.85), (0.0, 1.0)]
        parts += of("flame", shift(lathe([(r, z * tall) for r, z in tongue], 9, smooth=1), at))
    return Model(parts, (Top(h, -w / 2 + 0.06, -d / 2 + 0.06, w / 2 - 0.06, d / 2 - 0.06),))


def clock(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """A longcase clock."""
    w, d, h = size
    wood = frame_wood(style)
    parts = of(wood, box((-w / 2, -d / 2, 0.0), (w / 2, d / 2, 0.09), 0.01), box((-w / 2 + 0.02, -d / 2 + 0.02, 0.085), (w / 2 - 0.02, d / 2, 0.45)))
    parts += of(wood, box((-w / 2 + 0.07, -d / 2 + 0.05, 0.44), (w / 2 - 0.07, d / 2, h - 0.5)))
    kind = "pointed" if style.form.back == "pointed_arch" else "round"
    hood = arch(kind, w - 0.02, 0.5 if kind == "round" else 0.52, at=(0.0, h - 0.52))
    parts += of(wood, extrude(hood, -d / 2 + 0.02, d / 2, "y"), rounded_box((-w / 2, -d / 2, h - 0.54), (w / 2, d / 2, h - 0.5), 0.012, 1))
    window = rectangle(w - 0.24, h - 1.15, at=(0.0, 0.52))
    parts += of("glass", extrude(window, -d / 2 + 0.043, -d / 2 + 0.06, "y")) + of("brass", extrude(window.buffer(0.015, join_style="mitre").difference(window), -d / 2 + 0.038, -d / 2 + 0.06, "y"))
    parts += of("brass", shift(turn(lathe([(0.055, -0.004), (0.055, 0.004)], 20), "x", 90), (0, -d / 2 + 0.038, 0.68)), rod((0, -d / 2 + 0.038, 0.7), (0, -d / 2 + 0.038, h - 0.66), 0.005, 6))
    return Model(parts + dial(0.34 * w, (0.0, -d / 2 + 0.02, h - 0.31)))


def dial(radius: float, at: tuple[float, float, float]) -> list[Part]:
    """A clock face towards -y: rim, dial, hour marks, hands."""
    x, y, z = at
    parts = of("brass", shift(turn(lathe([(radius, -0.012), (1.06 * radius, 0.0), (radius, 0.012)], 32), "x", 90), at))
    parts += of("paper", shift(turn(lathe([(0.93 * radius, -0.015), (0.93 * radius, 0.0)], 32), "x", -90), at)) if False else of("paper", shift(turn(lathe([(0.93 * radius, -0.015), (0.93 * radius, 0.015)], 32), "x", 90), at))
    for k in range(12):
        mark = box((-0.02 * radius, -0.004, 0.72 * radius), (0.02 * radius, 0.004, 0.88 * radius), 0.0)
        parts += of("dark_metal", shift(turn(mark, "y", 30.0 * k), (x, y - 0.016, z)))
    for angle, long in ((-52.0, 0.5), (63.0, 0.78)):
        hand = box((-0.025 * radius, -0.003, -0.08 * radius), (0.025 * radius, 0.003, long * radius), 0.0)
        parts += of("dark_metal", shift(turn(hand, "y", angle), (x, y - 0.02 - 0.001 * long, z)))
    return parts


def wall_clock(style: Style, rng: np.random.Generator, size: Size) -> Model:
    w, d, _ = size
    return Model([Part(p.slot, stretch(p.solid, (1.0, d / 0.035, 1.0)), p.color) for p in dial(w / 2.12, (0.0, 0.0, w / 2))])


def globe(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """A terrestrial globe in its stand."""
    w, _, h = size
    r = 0.44 * w
    z = h - 0.5 * w
    parts = of(frame_wood(style), lathe([(0.32 * w, 0.0), (0.3 * w, 0.02), (0.05 * w, 0.05), (0.04 * w, z - r - 0.01)], 20, smooth=1))
    parts += of("ceramic", ball((0, 0, z), r, 24), color=(0.33, 0.47, 0.55))
    arc = [(0.0, 1.1 * r * math.cos(a), z + 1.1 * r * math.sin(a)) for a in np.linspace(-1.9, 1.3, 15)]
    parts += of("brass", tube(arc, 0.012 * w + 0.003, 6))
    for k in range(6):
        a, b = 1.1 * k + float(rng.uniform(0, 0.5)), float(rng.uniform(-0.9, 0.9))
        at = (r * 0.94 * math.cos(a) * math.cos(b), r * 0.94 * math.sin(a) * math.cos(b), z + r * 0.94 * math.sin(b))
        parts += of("ceramic", ball(at, float(rng.uniform(0.2, 0.34)) * r, 10), color=(0.72, 0.62, 0.4))
    return Model(parts)


def vase(style: Style, rng: np.random.Generator, size: Size) -> Model:
    return Model(vessel(style, rng, 0.0, 0.0, 0.0, size[2]))


def bowl(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """A bowl of fruit."""
    w, _, h = size
    r = w / 2
    parts = of("ceramic", lathe([(0.4 * r, 0.0), (0.45 * r, 0.1 * h), (0.85 * r, 0.45 * h), (r, 0.7 * h), (0.94 * r, 0.7 * h), (0.7 * r, 0.4 * h)], 24), color=pick(rng, style.accents))
    for k in range(6):
        a = 2 * math.pi * k / 5
        at = (0.5 * r * math.cos(a), 0.5 * r * math.sin(a), 0.66 * h) if k < 5 else (0.0, 0.0, h - 0.3 * r)
        parts += of("flower", ball(at, 0.29 * r, 10), color=((0.75, 0.2, 0.15), (0.85, 0.55, 0.15), (0.5, 0.6, 0.2))[k % 3])
    return Model(parts)


def book_pile(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """A few books lying on each other, each a cover around its pages."""
    w, d, h = size
    count = max(int(h / 0.035), 2)
    z, parts = 0.0, []
    for k in range(count):
        thick = h / count
        wide, deep = w * float(rng.uniform(0.8, 0.95)), d * float(rng.uniform(0.8, 0.95))
        color = pick(rng, style.accents)
        angle = float(rng.uniform(-9, 9))
        pages = box((-wide / 2 + 0.006, -deep / 2 + 0.006, z + 0.003), (wide / 2 - 0.004, deep / 2 - 0.006, z + thick - 0.003), 0.0)
        covers = [box((-wide / 2, -deep / 2, z), (wide / 2, deep / 2, z + 0.0035), 0.0), box((-wide / 2, -deep / 2, z + thick - 0.0035), (wide / 2, deep / 2, z + thick), 0.0),
                  box((-wide / 2 - 0.003, -deep / 2 + 0.0005, z + 0.0005), (-wide / 2 + 0.004, deep / 2 - 0.0005, z + thick - 0.0005), 0.0)]  # fmt: skip
        parts += of("paper", turn(pages, "z", angle)) + of("book", *(turn(c, "z", angle) for c in covers), color=color)
        z += thick + 0.0006
    return Model(parts)


def open_book(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """A book lying open."""
    w, d, _ = size
    t = np.linspace(0, 1, 8)
    page = [(float(w / 2 * a), float(0.012 + 0.022 * math.sin(math.pi * min(1.0, 1.15 * (1 - a))) * (1 - 0.4 * a))) for a in t]
    parts = of("leather", box((-w / 2 - 0.006, -d / 2 - 0.006, 0.0), (w / 2 + 0.006, d / 2 + 0.006, 0.006), 0.0))
    for s in (-1.0, 1.0):
        outline = [(0.002 * s, 0.004), (s * w / 2, 0.004), *((s * x + (0.002 * s if x == 0 else 0.0), z) for x, z in reversed(page))]
        parts += of("paper", extrude(outline, -d / 2, d / 2, "y"))
    return Model(parts)


def tableware(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """A plate and a cup."""
    w, _, h = size
    r = 0.5 * (w - 0.08)
    parts = of("ceramic", lathe([(0.6 * r, 0.0), (r, 0.02), (r - 0.004, 0.023), (0.62 * r, 0.008)], 28))
    cup = shift(lathe([(0.022, 0.0), (0.036, 0.4 * h), (0.038, h), (0.034, h), (0.03, 0.5 * h)], 18, smooth=1), (r + 0.035, 0.3 * r, 0.0))
    return Model(parts + of("ceramic", cup, color=pick(rng, style.accents)))


def television(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """A flat screen on a foot."""
    w, d, h = size
    parts = of("dark_metal", rounded_box((-w / 2, -0.02, 0.07), (w / 2, 0.025, h), 0.008, 1))
    parts += of("screen", box((-w / 2 + 0.012, -0.0225, 0.085), (w / 2 - 0.012, 0.0, h - 0.012), 0.0))
    return Model(parts + of("dark_metal", box((-0.05, -0.01, 0.01), (0.05, 0.02, 0.09)), box((-0.22 * w, -d / 2, 0.0), (0.22 * w, d / 2, 0.014))))


def monitor(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """A computer screen with its keyboard before it."""
    w, d, h = size
    y = d / 2 - 0.1
    parts = of("dark_metal", rounded_box((-w / 2, y, 0.12), (w / 2, y + 0.03, h), 0.008, 1), box((-0.025, y + 0.02, 0.01), (0.025, y + 0.045, 0.24)), box((-0.11, y - 0.07, 0.0), (0.11, y + 0.1, 0.012)))
    parts += of("screen", box((-w / 2 + 0.01, y - 0.003, 0.132), (w / 2 - 0.01, y + 0.01, h - 0.01), 0.0))
    return Model(parts + of("appliance", rounded_box((-0.21, -d / 2, 0.0), (0.21, -d / 2 + 0.13, 0.018), 0.006, 1)))


def folding_screen(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """Three hinged panels standing in a zigzag."""
    w, d, h = size
    wood = frame_wood(style)
    pitch = w / 3
    parts: list[Part] = []
    kind = {"pointed_arch": "pointed", "round_arch": "round", "wave": "wave"}.get(style.form.back, "")
    slope = math.degrees(math.atan2(d - 0.03, pitch))
    for k in range(3):
        outline = arch(kind, pitch - 0.012, h) if kind else rectangle(pitch - 0.012, h)
        field = outline.buffer(-0.035, join_style="mitre")
        slot = "paper" if style.family == "japanese" else "fabric"
        panel = [*of(wood, extrude(outline.difference(field), -0.014, 0.014, "y")), *of(slot, extrude(field.buffer(0.004, join_style="mitre"), -0.005, 0.005, "y"))]
        if style.family == "japanese":
            for z in np.linspace(0.25, h - 0.25, 5):
                panel += of(wood, box((-pitch / 2 + 0.03, -0.009, z - 0.008), (pitch / 2 - 0.03, 0.009, z + 0.008), 0.0))
            panel += of(wood, box((-0.008, -0.0085, 0.03), (0.008, 0.0085, h - 0.03), 0.0))
        turned = [Part(p.slot, stretch(p.solid, (1 / math.cos(math.radians(slope)), 1, 1)), p.color) for p in panel]
        sign = 1 if k % 2 == 0 else -1
        parts += [Part(p.slot, shift(turn(p.solid, "z", sign * slope), ((k - 1) * pitch, 0.0, 0.0)), p.color) for p in turned]
    return Model(parts)


def armour(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """A suit of armour on a base, with a halberd."""
    w, d, h = size
    metal = "metal"
    parts = of("dark_wood", box((-0.4 * w, -0.4 * d, 0.0), (0.4 * w, 0.4 * d, 0.06), 0.008))
    s = (h - 0.06) / 1.8
    for side in (-1.0, 1.0):
        x = side * 0.1 * s
        parts += of(metal, tube([(x, 0, 0.08), (x, 0.01, 0.06 + 0.45 * s), (x * 0.9, 0, 0.06 + 0.86 * s)], [0.055 * s, 0.06 * s, 0.085 * s], 12, smooth=2))
        parts += of(metal, ball((x, -0.02, 0.06 + 0.47 * s), 0.066 * s, 10), rounded_box((x - 0.045 * s, -0.17 * s, 0.058), (x + 0.045 * s, 0.06 * s, 0.058 + 0.08 * s), 0.03))
        parts += of(metal, tube([(side * 0.22 * s, 0, 0.06 + 1.38 * s), (side * 0.27 * s, 0, 0.06 + 1.12 * s), (side * 0.25 * s, -0.1 * s, 0.06 + 0.9 * s)], [0.06 * s, 0.05 * s, 0.042 * s], 10, smooth=2))
        parts += of(metal, ball((side * 0.215 * s, 0, 0.06 + 1.4 * s), 0.085 * s, 12), ball((side * 0.25 * s, -0.11 * s, 0.06 + 0.87 * s), 0.052 * s, 10))
    torso = lathe([(0.19, 0.72), (0.17, 0.82), (0.135, 0.98), (0.17, 1.15), (0.185, 1.3), (0.12, 1.43), (0.07, 1.48)], 24, smooth=2)
    parts += of(metal, shift(stretch(torso, (1.15 * s, 0.85 * s, s)), (0, 0, 0.06)))
    helm = lathe([(0.085, 1.47), (0.1, 1.55), (0.105, 1.66), (0.07, 1.76), (0.0, 1.79)], 20, smooth=2)
    parts += of(metal, shift(stretch(helm, (s, 1.1 * s, s)), (0, 0, 0.06)))
    parts += of("soot", box((-0.07 * s, -0.128 * s, 0.06 + 1.635 * s), (0.07 * s, -0.06 * s, 0.06 + 1.65 * s), 0.0))
    x, y = 0.31 * s, -0.12 * s
    parts += of("dark_wood", rod((x, y, 0.05), (x, y, h + 0.1), 0.014))
    blade_ = [(x - 0.02, h - 0.14), (x + 0.1, h - 0.2), (x + 0.12, h - 0.02), (x - 0.02, h - 0.05)]
    return Model(parts + of(metal, extrude(blade_, y - 0.005, y + 0.005, "y"), lathe([(0.018, h + 0.09), (0.0, h + 0.24)], 8, at=(x, y, 0.0))))


def lectern(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """A reading stand with an open book."""
    w, d, h = size
    wood = frame_wood(style)
    parts = of(wood, box((-0.4 * w, -0.4 * d, 0.0), (0.4 * w, 0.4 * d, 0.05), 0.01), lathe([(0.03 * r + 0.015, 0.045 + z * (h - 0.25)) for r, z in COLUMN], 16))
    if style.form.back == "pointed_arch":
        parts += of(wood, extrude(tracery(0.5 * w, 0.42 * h, 0.035, at=(0.0, 0.28 * h)), -0.02, 0.02, "y"))
    board = of(wood, box((-w / 2, -d / 2, 0.0), (w / 2, d / 2, 0.025)), box((-w / 2, -d / 2, 0.02), (w / 2, -d / 2 + 0.02, 0.05)))
    book = open_book(style, rng, (0.82 * w, 0.7 * d, 0.05)).parts
    board += [Part(p.slot, shift(p.solid, (0, 0.01, 0.0255)), p.color) for p in book]
    return Model(parts + [Part(p.slot, shift(turn(p.solid, "x", 28), (0, 0, h - 0.22)), p.color) for p in board])


def urn_candle(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """A single candlestick."""
    _, _, h = size
    stem = 0.55 * h
    profile = [(0.05, 0.0), (0.048, 0.06), (0.015, 0.14), (0.022, 0.4), (0.012, 0.5), (0.016, 0.8), (0.03, 0.92), (0.03, 1.0)]
    parts = of("brass", lathe([(r, z * stem) for r, z in profile], 18, smooth=1))
    return Model(parts + candle(0, 0, stem - 0.002, h - stem - 0.05))


def trophy(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """A turned wooden chess piece, larger than life."""
    w, _, h = size
    r = w / 2
    profile = [(1.0, 0.0), (1.0, 0.06), (0.8, 0.1), (0.85, 0.13), (0.5, 0.22), (0.38, 0.45), (0.36, 0.6), (0.62, 0.64), (0.62, 0.67), (0.4, 0.7), (0.55, 0.82), (0.6, 0.88), (0.3, 0.92)]
    parts = of("lacquer", lathe([(r * q, z * h) for q, z in profile], 32, smooth=1), color=pick(rng, style.accents))
    return Model(parts + of("brass", finial(0.0, 0.0, 0.91 * h, 0.09 * h)))


def mushroom(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """A mushroom taller than a child, its cap glowing faintly."""
    w, _, h = size
    cap = 0.42 * h
    stem = [(0.16, 0.0), (0.12, 0.15), (0.09, 0.5), (0.1, 1.0)]
    parts = of("ceramic", lathe([(w * r, z * (h - 0.6 * cap)) for r, z in stem], 20, smooth=2))
    dome = [(0.1, 0.25), (0.44, 0.2), (0.5, 0.1), (0.49, 0.22), (0.42, 0.5), (0.26, 0.82), (0.0, 1.0)]
    parts += of("lamp_shade", lathe([(w * r, h - cap + z * cap) for r, z in dome], 28, smooth=2), color=pick(rng, style.accents))
    for k in range(9):
        a, t = 2.4 * k, 0.35 + 0.55 * (k / 9)
        at = (0.44 * w * (1 - 0.62 * t) * 1.05 * math.cos(a), 0.44 * w * (1 - 0.62 * t) * 1.05 * math.sin(a), h - cap + cap * (0.36 + 0.55 * t))
        parts += of("pillow", ball(at, 0.045 * w + 0.01, 8))
    return Model(parts)


KINDS = {
    "picture": Kind(picture, "wall", (0.45, 0.035, 0.4), (0.9, 0.045, 0.7)),
    "mirror": Kind(mirror, "wall", (0.5, 0.035, 0.8), (0.7, 0.045, 1.1)),
    "wall clock": Kind(wall_clock, "wall", (0.32, 0.035, 0.32), (0.42, 0.04, 0.42)),
    "plant": Kind(plant, "floor", (0.55, 0.55, 1.0), (0.75, 0.75, 1.5)),
    "statue": Kind(statue, "floor", (0.46, 0.46, 1.6), (0.54, 0.54, 1.85)),
    "column": Kind(column, "floor", (0.34, 0.34, 1.3), (0.42, 0.42, 1.6)),
    "fireplace": Kind(fireplace, "floor", (1.3, 0.42, 1.1), (1.7, 0.5, 1.3), front=0.9),
    "grandfather clock": Kind(clock, "floor", (0.46, 0.28, 1.95), (0.54, 0.32, 2.15), front=0.3),
    "globe": Kind(globe, "floor", (0.46, 0.46, 0.85), (0.54, 0.54, 1.0)),
    "folding screen": Kind(folding_screen, "floor", (1.3, 0.28, 1.6), (1.6, 0.36, 1.8)),
    "suit of armour": Kind(armour, "floor", (0.62, 0.5, 1.8), (0.68, 0.55, 1.9)),
    "lectern": Kind(lectern, "floor", (0.5, 0.42, 1.15), (0.56, 0.46, 1.25), front=0.5),
    "chess piece": Kind(trophy, "floor", (0.42, 0.42, 1.1), (0.55, 0.55, 1.6)),
    "giant mushroom": Kind(mushroom, "floor", (0.6, 0.6, 0.9), (0.8, 0.8, 1.4)),
    "vase": Kind(vase, "object", (0.14, 0.14, 0.2), (0.2, 0.2, 0.32)),
    "flowers": Kind(flowers, "object", (0.2, 0.2, 0.34), (0.26, 0.26, 0.44)),
    "potted plant": Kind(small_plant, "object", (0.22, 0.22, 0.26), (0.3, 0.3, 0.36)),
    "bowl": Kind(bowl, "object", (0.24, 0.24, 0.13), (0.3, 0.3, 0.16)),
    "pile of books": Kind(book_pile, "object", (0.2, 0.26, 0.08), (0.24, 0.3, 0.16)),
    "open book": Kind(open_book, "object", (0.3, 0.22, 0.04), (0.36, 0.26, 0.04)),
    "tableware": Kind(tableware, "object", (0.3, 0.26, 0.08), (0.34, 0.28, 0.09)),
    "candlestick": Kind(urn_candle, "object", (0.1, 0.1, 0.26), (0.1, 0.1, 0.36)),
    "television": Kind(television, "object", (1.0, 0.2, 0.64), (1.25, 0.24, 0.76)),
    "computer monitor": Kind(monitor, "object", (0.55, 0.42, 0.42), (0.65, 0.46, 0.48)),
}
