"""Storage: wardrobe, bookshelf, dresser, chest, sideboard, media bench, wall shelf."""

import math

import numpy as np

from wm.offline.furniture.common import COLUMN, finial, frame_wood, front, legs
from wm.offline.furniture.outlines import arch, rectangle
from wm.offline.furniture.piece import FurnitureKind, Model, Part, Size, Top, of, pick
from wm.offline.furniture.solids import Real, box, extrude, lathe, puff, rounded_box, turn
from wm.offline.style.finish import Style


def plinth(style: Style, w: Real, d: Real, height: Real, slot: str) -> list[Part]:
    """The support of a cupboard: legs, or a recessed base."""
    if style.form.legs in ("tapered", "hairpin", "cabriole", "turned") and height > 0.07:
        return legs(style, w - 0.02, d - 0.02, height + 0.01, min(0.06, height), slot=slot)
    return of(slot, box((-w / 2 + 0.03, -d / 2 + 0.05, 0.0), (w / 2 - 0.03, d / 2 - 0.02, height + 0.01)))


def crown(style: Style, w: Real, d: Real, z: Real, slot: str) -> list[Part]:
    """The cornice of a tall piece, at most 12 cm high: mouldings, and a gable or arch in some styles."""
    if style.form.ornament < 0.3:
        return of(slot, box((-w / 2, -d / 2, z), (w / 2, d / 2, z + 0.025), 0.003))
    parts = of(slot, rounded_box((-w / 2 - 0.02, -d / 2 - 0.025, z), (w / 2 + 0.02, d / 2, z + 0.035), 0.012, 1))
    parts += of(slot, rounded_box((-w / 2 - 0.04, -d / 2 - 0.045, z + 0.03), (w / 2 + 0.04, d / 2, z + 0.065), 0.012, 1))
    if style.form.back == "pointed_arch":
        teeth = max(int(w / 0.14), 3)
        pitch = (w + 0.04) / teeth
        for k in range(teeth):
            x = -(w + 0.04) / 2 + (k + 0.5) * pitch
            parts += of(slot, extrude(arch("pointed", 0.7 * pitch, 0.11, at=(x, z + 0.055)), -d / 2 - 0.02, -d / 2 + 0.01, "y"))
        for s in (-1.0, 1.0):
            parts += of(slot, finial(s * (w / 2 + 0.005), -d / 2 + 0.0, z + 0.06, 0.13))
    elif style.form.ornament > 0.5:
        outline = arch("wave" if style.form.back == "wave" else "round", 0.7 * w, 0.16, at=(0.0, z + 0.055))
        parts += of(slot, extrude(outline, -d / 2 - 0.02, -d / 2 + 0.03, "y"))
    return parts


def carcass(w: Real, d: Real, z0: Real, z1: Real, thickness: Real = 0.025) -> list:
    """A box without a front: sides, back, bottom and top. Its front edge is at y = -d / 2."""
    t = thickness
    return [
        box((-w / 2, -d / 2, z0), (-w / 2 + t, d / 2, z1)),
        box((w / 2 - t, -d / 2, z0), (w / 2, d / 2, z1)),
        box((-w / 2 + t - 0.002, d / 2 - 0.015, z0 + 0.004), (w / 2 - t + 0.002, d / 2 - 0.004, z1 - 0.004), 0.0),
        box((-w / 2 + t - 0.003, -d / 2 + 0.004, z0 + 0.003), (w / 2 - t + 0.003, d / 2 - 0.006, z0 + t)),
        box((-w / 2 + t - 0.003, -d / 2 + 0.004, z1 - t), (w / 2 - t + 0.003, d / 2 - 0.006, z1 - 0.003)),
    ]


def books(
    style: Style,
    rng: np.random.Generator,
    x0: Real,
    x1: Real,
    y0: Real,
    y1: Real,
    z: Real,
    room: Real,
    *,
    fill: Real = 0.9,
) -> list[Part]:
    """A row of standing books from x0 to x1 on the height z, with their spines at y0 and below a clear height."""
    parts: list[Part] = []
    x = x0
    while x < x1 - 0.02:
        if rng.random() > fill:
            x += float(rng.uniform(0.04, 0.14))
            continue
        thick = float(rng.uniform(0.018, 0.052))
        tall = min(room - 0.02, float(rng.uniform(0.62, 0.95)) * min(room, 0.34))
        deep = min(y1 - y0 - 0.01, float(rng.uniform(0.13, 0.2)))
        if x + thick > x1:
            break
        color = pick(rng, style.accents)
        shade = float(rng.uniform(0.55, 1.0))
        tint = (color[0] * shade, color[1] * shade, color[2] * shade)
        parts += of(
            "book",
            box((x + 0.001, y0 + 0.002 + float(rng.uniform(0, 0.015)), z), (x + thick - 0.001, y0 + 0.01 + deep, z + tall), 0.0),
            color=tint,
        )
        x += thick
    return parts


def bookshelf(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """Shelves with books and gaps, under a cornice."""
    w, d, h = size
    wood = frame_wood(style)
    base = 0.08
    cap = 0.02 if style.form.ornament < 0.3 else 0.17
    top = h - cap
    parts = of(wood, *carcass(w, d, base, top)) + plinth(style, w, d, base, wood) + crown(style, w, d, top - 0.004, wood)
    inner = w / 2 - 0.03
    levels = max(int((top - base) / 0.36), 2)
    pitch = (top - base - 0.025) / levels
    bays = 2 if w > 1.15 else 1
    pier = 0.02
    if bays == 2:
        parts += of(wood, box((-pier / 2, -d / 2 + 0.006, base + 0.02), (pier / 2, d / 2 - 0.016, top - 0.02)))
    if style.form.legs == "column":
        for s in (-1.0, 1.0):
            parts += of(
                wood,
                lathe(
                    [(0.03 * r + 0.004, base + z * (top - base)) for r, z in COLUMN],
                    14,
                    at=(s * (w / 2 - 0.02), -d / 2 - 0.012, 0.0),
                ),
            )
    elif style.form.back in ("pointed_arch", "round_arch"):
        parts += of(wood, extrude(spandrel(style, w - 0.02, 0.2, bays, top - 0.2), -d / 2 - 0.012, -d / 2 + 0.012, "y"))
    for k in range(levels):
        z = base + 0.025 + k * pitch
        if k:
            parts += of(wood, box((-inner - 0.004, -d / 2 + 0.008, z - 0.022), (inner + 0.004, d / 2 - 0.016, z)))
        room = pitch - 0.03
        for b in range(bays):
            x0 = -inner + b * (inner + pier) if bays == 2 else -inner
            x1 = x0 + (inner - pier if bays == 2 else 2 * inner)
            if rng.random() < 0.85:
                parts += books(
                    style,
                    rng,
                    x0 + 0.01,
                    x1 - 0.01,
                    -d / 2 + 0.04,
                    d / 2 - 0.02,
                    z + 0.001,
                    room - (0.1 if k == levels - 1 and style.form.back in ("pointed_arch", "round_arch") else 0.0),
                )
            else:
                parts += vessel(
                    style, rng, float(rng.uniform(x0 + 0.12, x1 - 0.12)), -d / 2 + 0.14, z + 0.001, min(0.24, room - 0.08)
                )
    return Model(parts)


def spandrel(style: Style, w: Real, height: Real, bays: int, z: Real):
    """A board with one arched opening per bay, between z and z + height."""
    board = rectangle(w, height, at=(0.0, z))
    pitch = w / bays
    kind = "pointed" if style.form.back == "pointed_arch" else "round"
    for b in range(bays):
        board = board.difference(arch(kind, pitch - 0.05, height + 0.17, at=(-w / 2 + (b + 0.5) * pitch, z - 0.21)))
    return board


def vessel(style: Style, rng: np.random.Generator, x: Real, y: Real, z: Real, height: Real) -> list[Part]:
    """A vase or bowl."""
    shapes = (
        [(0.3, 0.0), (0.48, 0.25), (0.52, 0.45), (0.25, 0.75), (0.2, 0.85), (0.3, 1.0)],
        [(0.25, 0.0), (0.5, 0.5), (0.42, 0.8), (0.3, 0.92), (0.36, 1.0)],
        [(0.2, 0.0), (0.28, 0.1), (0.55, 0.7), (0.6, 1.0)],
    )
    shape = shapes[int(rng.integers(len(shapes)))]
    return of(
        "ceramic",
        lathe([(0.7 * r * height, z + q * height) for r, q in shape], 20, at=(x, y, 0.0), smooth=2),
        color=pick(rng, style.accents),
    )


def cupboard(
    style: Style, size: Size, columns: int, rows: int, *, slot: str, base: Real, handle: str, tall: bool = False
) -> Model:
    """A closed case with a grid of doors or drawers."""
    w, d, h = size
    cap = (0.03 if style.form.ornament < 0.3 else 0.17) if tall else 0.03
    parts = plinth(style, w, d, base, slot)
    parts += of(slot, box((-w / 2 + 0.005, -d / 2 + 0.03, base), (w / 2 - 0.005, d / 2, h - cap + 0.004)))
    if tall:
        parts += crown(style, w - 0.03, d - 0.03, h - cap, slot)
    else:
        top = "marble" if style.form.ornament > 0.75 else slot
        parts += of(top, rounded_box((-w / 2 - 0.008, -d / 2, h - cap), (w / 2 + 0.008, d / 2, h), 0.008, 1))
    xs = np.linspace(-w / 2 + 0.02, w / 2 - 0.02, columns + 1)
    zs = np.linspace(base + 0.02, h - cap - 0.015, rows + 1)
    for i in range(columns):
        side = handle if handle == "centre" else ("right" if i < columns / 2 else "left")
        for k in range(rows):
            parts += front(
                style, xs[i] + 0.004, xs[i + 1] - 0.004, zs[k] + 0.004, zs[k + 1] - 0.004, -d / 2 + 0.03, slot=slot, handle=side
            )
    tops = () if tall else (Top(h, -w / 2 + 0.02, -d / 2 + 0.02, w / 2 - 0.02, d / 2 - 0.02),)
    return Model(parts, tops)


def wardrobe(style: Style, rng: np.random.Generator, size: Size) -> Model:
    slot = (
        "painted_wood" if style.family in ("scandinavian", "coastal", "minimalist", "baroque", "surreal") else frame_wood(style)
    )
    return cupboard(style, size, 2 if size[0] < 1.3 else 3, 1, slot=slot, base=0.09, handle="right", tall=True)


def dresser(style: Style, rng: np.random.Generator, size: Size) -> Model:
    return cupboard(style, size, 2, 3, slot=frame_wood(style), base=0.12, handle="centre")


def sideboard(style: Style, rng: np.random.Generator, size: Size) -> Model:
    return cupboard(style, size, 4 if size[0] > 1.5 else 3, 1, slot=frame_wood(style), base=0.14, handle="right")


def media_bench(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """A low bench for a television."""
    return cupboard(style, size, 3, 1, slot=frame_wood(style), base=0.1, handle="right")


def chest(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """A trunk with a barrel lid and metal straps."""
    w, d, h = size
    wood = frame_wood(style)
    rim = 0.62 * h
    parts = of(wood, box((-w / 2 + 0.01, -d / 2 + 0.01, 0.02), (w / 2 - 0.01, d / 2 - 0.01, rim)))
    parts += of(wood, box((-w / 2, -d / 2, 0.0), (w / 2, d / 2, 0.06), 0.008))
    t = np.linspace(0, math.pi, 13)
    lid = [(d / 2 * math.cos(a), rim + 0.006 + (h - rim - 0.01) * math.sin(a)) for a in t]
    parts += of(wood, extrude(lid, -w / 2, w / 2, "x"))
    for x in (-0.32 * w, 0.32 * w):
        strap = [((d / 2 + 0.006) * math.cos(a), rim + 0.004 + (h - rim - 0.004) * math.sin(a)) for a in t]
        parts += of(
            "dark_metal",
            extrude(strap, x - 0.02, x + 0.02, "x"),
            box((x - 0.02, -d / 2 + 0.003, 0.06), (x + 0.02, -d / 2 + 0.03, rim), 0.002),
        )
    parts += of("brass", box((-0.045, -d / 2 - 0.008, rim - 0.09), (0.045, -d / 2 + 0.03, rim + 0.03), 0.004))
    return Model(parts)


def blanket_chest(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """A low flat chest with a cushion, for the foot of a bed."""
    w, d, h = size
    case = cupboard(style, (w, d, h - 0.06), 3, 1, slot=frame_wood(style), base=0.07, handle="none")
    return Model(
        [
            *case.parts,
            *of("fabric", rounded_box((-w / 2 + 0.01, -d / 2 + 0.01, h - 0.066), (w / 2 - 0.01, d / 2 - 0.01, h), 0.028)),
        ]
    )


def wall_shelf(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """A board on brackets with books and a vase."""
    w, d, h = size
    wood = frame_wood(style)
    parts = of(wood, box((-w / 2, -d / 2, 0.09), (w / 2, d / 2, 0.115)))
    for s in (-1.0, 1.0):
        x = s * (w / 2 - 0.12)
        parts += of(
            "dark_metal" if style.form.ornament < 0.3 else wood,
            extrude([(d / 2, 0.0), (d / 2, 0.094), (-d / 2 + 0.03, 0.094), (d / 2 - 0.03, 0.03)], x - 0.01, x + 0.01, "x"),
        )
    split = float(rng.uniform(0.45, 0.65))
    parts += books(style, rng, -w / 2 + 0.02, -w / 2 + split * w, -d / 2 + 0.02, d / 2 - 0.01, 0.116, h - 0.12, fill=0.97)
    return Model(parts + vessel(style, rng, w / 2 - 0.16, 0.0, 0.116, min(0.2, h - 0.13)))


def basket(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """A round woven basket with a folded blanket in it."""
    w, _, h = size
    r = w / 2
    rim = 0.8 * h
    rings = [(0.82 * r, 0.0)]
    for k in range(8):
        z = rim * (k + 1) / 8
        rings += [((0.86 + 0.13 * (k + 0.5) / 8) * r, z - rim / 16), ((0.84 + 0.12 * (k + 1) / 8) * r, z)]
    parts = of("woven", lathe([*rings, (0.86 * r, rim), (0.82 * r, rim - 0.03)], 24))
    return Model(
        parts + of("blanket", turn(puff((-0.75 * r, -0.75 * r, rim - 0.08), (0.75 * r, 0.75 * r, h), square=0.6), "z", 20))
    )


KINDS = {
    "wardrobe": FurnitureKind(wardrobe, "floor", (1.0, 0.56, 1.9), (1.7, 0.62, 2.15), front=0.6),
    "bookshelf": FurnitureKind(bookshelf, "floor", (0.85, 0.3, 1.7), (1.5, 0.36, 2.2), front=0.5),
    "dresser": FurnitureKind(dresser, "floor", (0.95, 0.44, 0.78), (1.25, 0.5, 0.9), front=0.5),
    "sideboard": FurnitureKind(sideboard, "floor", (1.3, 0.4, 0.74), (1.8, 0.46, 0.86), front=0.5),
    "media bench": FurnitureKind(media_bench, "floor", (1.3, 0.38, 0.42), (1.8, 0.44, 0.5), front=0.4),
    "chest": FurnitureKind(chest, "floor", (0.8, 0.45, 0.48), (1.05, 0.52, 0.58), front=0.3),
    "blanket chest": FurnitureKind(blanket_chest, "floor", (1.0, 0.42, 0.44), (1.3, 0.48, 0.5), front=0.2),
    "wall shelf": FurnitureKind(wall_shelf, "wall", (0.7, 0.2, 0.36), (1.1, 0.24, 0.42)),
    "basket": FurnitureKind(basket, "floor", (0.34, 0.34, 0.36), (0.46, 0.46, 0.48)),
}
