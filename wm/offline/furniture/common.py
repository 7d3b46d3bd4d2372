"""Parts that many kinds share: legs, cupboard fronts, knobs, finials, candles."""

import numpy as np
import shapely

from wm.offline.furniture.outlines import arch, rectangle
from wm.offline.furniture.piece import Part, of
from wm.offline.furniture.solids import Real, Solid, ball, box, extrude, lathe, rod, tube
from wm.offline.style.finish import Style
from wm.offline.style.style_sheet import scaled_rgb

TURNED = [
    (0.55, 0.0),
    (0.75, 0.03),
    (0.6, 0.07),
    (0.45, 0.1),
    (0.5, 0.16),
    (0.95, 0.34),
    (1.0, 0.42),
    (0.6, 0.55),
    (0.5, 0.62),
    (0.85, 0.66),
    (0.85, 0.7),
    (0.55, 0.73),
    (0.6, 0.8),
    (1.0, 0.82),
    (1.0, 1.0),
]
"""Profile of a turned leg: (radius as a share of the largest radius, height as a share of the length)."""

COLUMN = [
    (1.0, 0.0),
    (1.0, 0.07),
    (0.85, 0.09),
    (0.9, 0.12),
    (0.72, 0.15),
    (0.66, 0.5),
    (0.6, 0.82),
    (0.72, 0.84),
    (0.72, 0.87),
    (0.95, 0.93),
    (1.0, 0.94),
    (1.0, 1.0),
]
"""Profile of a small column with base and capital."""


def leg(kind: str, x: Real, y: Real, height: Real, thickness: Real, *, outward: tuple[Real, Real] = (0.0, 0.0)) -> list[Solid]:
    """One leg below (x, y, height); `outward` points away from the piece's centre, for splayed and curved legs."""
    ox, oy = outward
    r = thickness / 2
    if kind == "turned":
        return [lathe([(max(q * r, 0.004), h * height) for q, h in TURNED], 14, at=(x, y, 0.0))]
    if kind == "column":
        return [lathe([(max(q * r, 0.004), h * height) for q, h in COLUMN], 16, at=(x, y, 0.0))]
    if kind == "tapered":
        splay = 0.05 * min(height, 0.5)
        return [tube([(x + ox * splay, y + oy * splay, 0.0), (x, y, height)], [0.32 * thickness, 0.55 * thickness], 12)]
    if kind == "cabriole":
        knee, foot = 0.35 * thickness + 0.03 * height, 0.2 * thickness + 0.02 * height
        path = [
            (x + ox * foot * 1.3, y + oy * foot * 1.3, 0.012),
            (x + ox * foot * 0.6, y + oy * foot * 0.6, 0.1 * height),
            (x - ox * 0.01, y - oy * 0.01, 0.4 * height),
            (x + ox * knee, y + oy * knee, 0.78 * height),
            (x, y, height),
        ]
        return [tube(path, [0.55 * r, 0.42 * r, 0.5 * r, 0.95 * r, 1.0 * r], 10, smooth=2), ball(path[0], 0.012 + 0.1 * r, 8)]
    if kind == "hairpin":
        spread = min(0.35 * height, 0.08)
        return [
            rod((x, y, 0.0), (x - ox * spread, y, height), 0.006, 6),
            rod((x, y, 0.0), (x, y - oy * spread, height), 0.006, 6),
        ]
    wide = r if kind == "straight" else 1.25 * r
    return [box((x - wide, y - wide, 0.0), (x + wide, y + wide, height))]


def legs(
    style: Style, width: Real, depth: Real, height: Real, thickness: Real, *, slot: str, kind: str | None = None
) -> list[Part]:
    """Four legs under the corners of a footprint. They do not extend beyond it."""
    name = kind or style.form.legs
    margin = thickness * (0.9 if name in ("tapered", "cabriole") else 0.62) + (0.012 if name == "cabriole" else 0.0)
    solids = []
    for sx in (-1.0, 1.0):
        for sy in (-1.0, 1.0):
            solids += leg(name, sx * (width / 2 - margin), sy * (depth / 2 - margin), height, thickness, outward=(sx, sy))
    return of("dark_metal" if name == "hairpin" else slot, *solids)


def frame_wood(style: Style) -> str:
    """Slot of the wood of which a style builds frames."""
    if style.form.legs in ("tapered", "slab"):
        return "wood"
    if style.family in ("coastal", "minimalist"):
        return "painted_wood" if style.family == "minimalist" else "wood"
    return "dark_wood" if style.form.legs in ("turned", "cabriole") else "wood"


def front(style: Style, x0: Real, x1: Real, z0: Real, z1: Real, y: Real, *, slot: str, handle: str = "right") -> list[Part]:
    """One door or drawer front, which projects 2 cm from the plane y towards -y. The style decides the shape of its panel.

    Args:
      handle: "right" or "left" for a door's knob, "centre" for a drawer's, "none".
    """
    kind = style.form.panel
    width, height = x1 - x0, z1 - z0
    middle = (x0 + x1) / 2
    shade = scaled_rgb(style.slot(slot).colors[0], 0.8)
    recessed = kind in ("pointed", "arched", "raised") and min(width, height) > 0.12
    parts = of(slot, box((x0, y - 0.018, z0), (x1, y + 0.01, z1), 0.003), color=shade if recessed else None)
    rail = min(0.07, 0.2 * min(width, height))
    face = y - 0.018
    if recessed:
        opening = rectangle(width - 2 * rail, height - 2 * rail, at=(middle, z0 + rail))
        if height > 1.2 * width and kind != "raised":
            opening = arch(
                "pointed" if kind == "pointed" else "round", width - 2 * rail, height - 2 * rail, at=(middle, z0 + rail)
            )
        outer = rectangle(width - 0.004, height - 0.004, at=(middle, z0 + 0.002))
        parts += of(slot, extrude(outer.difference(opening), face - 0.015, face + 0.004, "y"))
        if kind == "raised" or height <= 1.2 * width:
            inner = opening.buffer(-0.35 * rail, join_style="mitre")
            if not inner.is_empty:
                parts += of(slot, extrude(inner, face - 0.008, face + 0.004, "y"))
        face -= 0.015
    elif kind == "slats" and min(width, height) > 0.12:
        count = max(int((width - 0.02) / 0.06), 2)
        pitch = (width - 0.02) / count
        for k in range(count):
            left = x0 + 0.01 + k * pitch
            parts += of(
                slot, box((left + 0.004, face - 0.008, z0 + 0.01), (left + pitch - 0.004, face + 0.004, z1 - 0.01), 0.003)
            )
        face -= 0.008
    if handle == "none":
        return parts
    metal = "brass" if style.form.ornament > 0.25 or style.form.panel != "flat" else "dark_metal"
    if kind == "flat":
        if handle == "centre":
            return parts + of(
                metal, box((middle - 0.06, face - 0.022, z1 - 0.045), (middle + 0.06, face + 0.004, z1 - 0.033), 0.003)
            )
        x = x1 - 0.045 if handle == "right" else x0 + 0.033
        centre = (z0 + z1) / 2
        return parts + of(metal, box((x, face - 0.022, centre - 0.07), (x + 0.012, face + 0.004, centre + 0.07), 0.003))
    x = {"right": x1 - 0.5 * rail, "left": x0 + 0.5 * rail}.get(handle, middle)
    return parts + of(
        metal,
        ball((x, face - 0.012, (z0 + z1) / 2), 0.015, 8),
        rod((x, face - 0.01, (z0 + z1) / 2), (x, face + 0.005, (z0 + z1) / 2), 0.006, 6),
    )


def tracery(width: Real, height: Real, border: Real, *, at: tuple[Real, Real], lancets: int = 2) -> shapely.Polygon:
    """Gothic tracery: a pointed frame with cut-out lancets and a round opening between them."""
    x, z = at
    outer = arch("pointed", width, height, at=at)
    inner = outer.buffer(-border)
    clear = (width - 2 * border - (lancets - 1) * border * 0.6) / lancets
    low = z + border
    tall = 0.62 * height
    cut: shapely.Geometry = shapely.Polygon()
    for k in range(lancets):
        centre = x - width / 2 + border + clear / 2 + k * (clear + border * 0.6)
        cut = cut.union(arch("pointed", clear, tall, at=(centre, low)))
    eye = shapely.Point(x, z + height * 0.735).buffer(0.16 * width, quad_segs=4)
    solid = outer.difference(cut.union(eye).intersection(inner))
    return solid if isinstance(solid, shapely.Polygon) else outer


def finial(x: Real, y: Real, z: Real, size: Real) -> Solid:
    """A small turned knob that ends a post."""
    profile = [(0.0, 0.0), (0.45, 0.0), (0.3, 0.2), (0.5, 0.45), (0.42, 0.65), (0.15, 0.8), (0.22, 0.88), (0.0, 1.0)]
    return lathe([(size * r, size * h) for r, h in profile], 10, at=(x, y, z), smooth=1)


def candle(x: Real, y: Real, z: Real, height: Real, *, radius: Real = 0.011) -> list[Part]:
    """A lit candle standing on (x, y, z)."""
    flame = [(0.0, 0.0), (0.55, 0.25), (0.6, 0.4), (0.25, 0.75), (0.0, 1.0)]
    tall = 0.035 + radius
    return [
        *of("wax", lathe([(radius, 0.0), (radius, height - 0.004), (0.7 * radius, height)], 10, at=(x, y, z))),
        *of("flame", lathe([(0.016 * r, tall * h) for r, h in flame], 8, at=(x, y, z + height + 0.002))),
    ]


def spread(rng: np.random.Generator, value: Real, share: Real = 0.1) -> float:
    """The value times a factor drawn uniformly from 1 - share to 1 + share."""
    return value * float(rng.uniform(1 - share, 1 + share))
