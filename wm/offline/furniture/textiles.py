"""Cloth: rugs, runner, bath mat, curtains, tapestry."""

import numpy as np
import shapely

from wm.offline.furniture.outlines import circle, rounded
from wm.offline.furniture.piece import FurnitureKind, Model, Part, Size, of, pick
from wm.offline.furniture.solids import Real, Solid, box, extrude, lathe, rod, shift, turn
from wm.offline.style.finish import Style


def inlaid(
    outline: shapely.Polygon,
    widths: list[float],
    slots: list[str],
    low: Real,
    high: Real,
    axis: str,
) -> list[Part]:
    """A flat piece of nested bands from the border inwards. Each band is a solid of its own, so that faces do not overlap."""
    parts: list[Part] = []
    current = outline
    for width, slot in zip([*widths, 0.0], slots):
        inner = current.buffer(-width, join_style="mitre") if width else shapely.Polygon()
        band = current.difference(inner)
        if isinstance(band, shapely.Polygon) and not band.is_empty:
            parts += of(slot, extrude(band, low, high, axis))
        if inner.is_empty or not isinstance(inner, shapely.Polygon):
            break
        current = inner.buffer(-0.0005, join_style="mitre")
    return parts


def rug(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """A rectangular rug, 8 mm thick: border, stripe, field and (in rich styles) a medallion."""
    w, d, h = size
    outline = shapely.box(-w / 2, -d / 2, w / 2, d / 2)
    if style.form.ornament < 0.25 or min(w, d) < 1.0:  # too narrow for a medallion
        return Model(inlaid(outline, [0.06], ["rug_border", "rug"], 0.0, h, "z"))
    edge = min(0.16, 0.1 * min(w, d))
    border, field = outline, outline.buffer(-edge, join_style="mitre")
    parts = of("rug", extrude(border.difference(field), 0.0, h, "z"))
    stripe = field.buffer(-0.0005, join_style="mitre")
    inside = stripe.buffer(-0.05, join_style="mitre")
    parts += of("rug_border", extrude(stripe.difference(inside), 0.0, h, "z"))
    inside = inside.buffer(-0.0005, join_style="mitre")
    a, b = 0.3 * (w - 2 * edge), 0.3 * (d - 2 * edge)
    medallion = shapely.Polygon(
        [(a, 0), (0.5 * a, 0.5 * b), (0, b), (-0.5 * a, 0.5 * b), (-a, 0), (-0.5 * a, -0.5 * b), (0, -b), (0.5 * a, -0.5 * b)]
    )
    medallion = medallion.buffer(0.08, quad_segs=3)
    core = medallion.buffer(-0.06)
    tint = pick(rng, style.accents)
    parts += of("rug", extrude(inside.difference(medallion.buffer(0.0005)), 0.0, h, "z"), color=tint)
    parts += of("rug_border", extrude(medallion.difference(core.buffer(0.0005)), 0.0, h, "z"))
    return Model(parts + of("rug", extrude(core, 0.0, h, "z")))


def round_rug(style: Style, rng: np.random.Generator, size: Size) -> Model:
    w, _, h = size
    parts: list[Part] = []
    radii = [w / 2, 0.43 * w, 0.3 * w, 0.26 * w, 0.0]
    slots = ["rug_border", "rug", "rug_border", "rug"]
    for outer, inner, slot in zip(radii[:-1], radii[1:], slots):
        ring = circle(outer - 0.0004, segments=48)
        parts += of(slot, extrude(ring.difference(circle(inner, segments=48)) if inner else ring, 0.0, h, "z"))
    return Model(parts)


def bath_mat(style: Style, rng: np.random.Generator, size: Size) -> Model:
    w, d, h = size
    outline = rounded(w, d, 0.04, at=(0.0, -d / 2))
    return Model(inlaid(outline, [0.05], ["linen", "fabric_accent"], 0.0, h, "z"))


def drape(x0: Real, x1: Real, y: Real, low: Real, high: Real, folds: int, depth: Real, tie: Real | None) -> Solid:
    """A hanging cloth from x0 to x1 in deep folds around the plane y. Its lower part is gathered towards x = `tie`, if given."""
    n = folds * 8 + 1
    t = np.linspace(0.0, 1.0, n)
    wave = depth * np.sin(t * folds * 2 * np.pi)
    front = np.stack([x0 + (x1 - x0) * t, y + wave - 0.004], -1)
    back = np.stack([x0 + (x1 - x0) * t, y + wave + 0.004], -1)[::-1]
    solid = extrude([(float(a), float(b)) for a, b in np.concatenate([front, back])], low, high, "z")
    if tie is None:
        return solid
    levels = np.array([1.0, 0.93, 0.75, 0.6, 0.45, 0.3, 0.22, 0.12, 0.0])
    gather = np.array([0.0, 0.03, 0.15, 0.32, 0.55, 0.62, 0.55, 0.45, 0.42])
    ring = solid.vertices[: len(solid.vertices) // 2]
    m = len(ring)
    stack = []
    for level, g in zip(levels, gather):
        section = ring.copy()
        section[:, 0] += (tie - section[:, 0]) * g
        section[:, 2] = low + (high - low) * level
        stack.append(section)
    vertices = np.concatenate(stack)
    side = [f for f in solid.faces.tolist() if min(f) < m <= max(f)]
    cap = [f for f in solid.faces.tolist() if max(f) < m]
    faces: list[list[int]] = []
    for k in range(len(levels) - 1):  # level 0 is the top: a face's upper vertices are its ring k, its lower ring k + 1
        faces += [[v - m + k * m if v >= m else v + (k + 1) * m for v in f] for f in side]
    faces += [[v + (len(levels) - 1) * m for v in f] for f in cap]
    faces += [f[::-1] for f in cap]
    return Solid(vertices, np.asarray(faces, np.int32))


def curtains(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """A pair of curtains on a rod, drawn to the sides of a window. w is the length of the rod, h the height of the cloth."""
    w, d, h = size
    metal = "brass" if style.form.ornament > 0.3 else "dark_metal"
    z = h - 0.03
    parts = of(metal, turn(rod((0, 0, -w / 2 + 0.03), (0, 0, w / 2 - 0.03), 0.012), "y", 90))
    parts = [Part(p.slot, shift(p.solid, (0, 0, z)), p.color) for p in parts]
    for s in (-1.0, 1.0):
        end = lathe([(0.0, 0.0), (0.02, 0.008), (0.024, 0.02), (0.014, 0.032), (0.0, 0.036)], 12)
        parts += of(metal, shift(turn(end, "y", 90 * s), (s * (w / 2 - 0.036), 0, z)))
        parts += of(metal, box((s * (w / 2 - 0.09) - 0.008, 0.0, z - 0.012), (s * (w / 2 - 0.09) + 0.008, d / 2, z + 0.012)))
        panel = min(0.3 * w, 0.55)
        outer, inner = s * (w / 2 - 0.05), s * (w / 2 - 0.05 - panel)
        tied = style.form.ornament > 0.5
        folds = max(int(panel / 0.085), 3)
        parts += of(
            "curtain",
            drape(min(outer, inner), max(outer, inner), 0.0, 0.0, z - 0.016, folds, min(0.028, 0.4 * d), outer if tied else None),
        )
        if tied:
            at = outer + (inner - outer) * 0.2
            parts += of(
                "fabric_accent", box((at - 0.26 * panel, -0.42 * d, 0.285 * z), (at + 0.24 * panel, 0.3 * d, 0.32 * z), 0.012)
            )
    return Model(parts)


def tapestry(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """A tapestry on a rod with a border, an emblem and a pointed lower edge."""
    w, _d, h = size
    parts = of("dark_wood", shift(turn(rod((0, 0, -w / 2), (0, 0, w / 2), 0.016), "y", 90), (0, 0, h - 0.02)))
    n = 3
    low = [(w / 2 - 0.04 - (w - 0.08) * (k / (2 * n)), 0.1 if k % 2 == 0 else 0.0) for k in range(2 * n + 1)]
    outline = shapely.Polygon([(-w / 2 + 0.04, h - 0.02), *reversed(low), (w / 2 - 0.04, h - 0.02)])
    field = outline.buffer(-0.07, join_style="mitre")
    parts += of("rug_border", extrude(outline.difference(field), -0.006, 0.006, "y"))
    device = shapely.Point(0, 0.55 * h).buffer(0.28 * w, quad_segs=2)
    inner = device.buffer(-0.07 * w)
    parts += of("fabric", extrude(field.buffer(-0.0005).difference(device.buffer(0.0005)), -0.005, 0.005, "y"))
    parts += of("fabric_accent", extrude(device.difference(inner.buffer(0.0005)), -0.005, 0.005, "y"))
    return Model(parts + of("fabric", extrude(inner, -0.005, 0.005, "y"), color=pick(rng, style.accents)))


KINDS = {
    "rug": FurnitureKind(rug, "flat", (1.6, 1.1, 0.008), (2.8, 2.0, 0.008)),
    "round rug": FurnitureKind(round_rug, "flat", (1.4, 1.4, 0.008), (2.2, 2.2, 0.008)),
    "bath mat": FurnitureKind(bath_mat, "flat", (0.65, 0.42, 0.008), (0.8, 0.5, 0.008)),
    "curtains": FurnitureKind(curtains, "wall", (1.2, 0.08, 1.6), (2.6, 0.1, 2.6)),
    "tapestry": FurnitureKind(tapestry, "wall", (0.8, 0.032, 1.2), (1.1, 0.036, 1.6)),
}
