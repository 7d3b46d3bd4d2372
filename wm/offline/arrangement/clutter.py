"""Small things on surfaces: what belongs on a nightstand, a mantel or a dining table, and where there is room for it."""

import math

import numpy as np

from wm.geometry.placement.clearances import LIFT
from wm.offline.arrangement.layout import Layout, Placed
from wm.offline.furniture import make_piece
from wm.offline.style.finish import PERIOD, Style

ON: dict[str, tuple[str, ...]] = {
    "nightstand": ("table lamp", "pile of books"),
    "console table": ("table lamp", "flowers", "candles", "vase", "bowl"),
    "sideboard": ("table lamp", "vase", "candles", "bowl", "pile of books", "potted plant"),
    "dresser": ("table lamp", "vase", "pile of books", "potted plant"),
    "coffee table": ("pile of books", "candles", "bowl", "flowers", "open book"),
    "side table": ("table lamp", "pile of books", "candlestick"),
    "round table": ("flowers", "bowl", "candles"),
    "fireplace": ("candlestick", "vase", "candlestick", "potted plant"),
    "kitchen counter": ("bowl", "potted plant", "tableware", "vase"),
    "kitchen island": ("bowl", "flowers", "tableware"),
    "altar table": ("candlestick", "flowers", "candlestick"),
    "media bench": ("potted plant", "pile of books"),
}
"""What may stand on a kind of furniture, in the order in which it is tried."""

HOW_MANY = {"nightstand": 2, "side table": 1, "coffee table": 2, "round table": 1, "dining table": 3, "desk": 3}
"""How many things stand on a kind; two where it is not listed."""


def things_for(kind: str, style: Style, rng: np.random.Generator) -> list[str]:
    """What to put on a surface of a kind of furniture."""
    if kind == "desk":
        if style.family in PERIOD:
            return ["open book", "candlestick" if style.form.lamp in ("candle", "tripod") else "table lamp", "pile of books"]
        return ["computer monitor", "table lamp", "pile of books"]
    if kind == "dining table":
        middle = ["candlestick", "flowers", "candlestick"] if style.form.ornament > 0.4 else ["flowers", "bowl"]
        return middle
    choices = list(ON.get(kind, ()))
    order = (
        rng.permutation(len(choices))
        if kind not in ("nightstand", "side table", "fireplace", "altar table")
        else range(len(choices))
    )
    return [choices[k] for k in order][: HOW_MANY.get(kind, 2 + int(style.form.ornament > 0.6))]


def add_clutter(layout: Layout, placed: Placed, style: Style, rng: np.random.Generator, *, density: float) -> None:
    """Puts things on a placed piece's surfaces, as many as find room."""
    for top in placed.piece.tops:
        things = [thing for thing in things_for(placed.piece.label, style, rng) if rng.random() < 0.35 + 0.65 * density]
        slots = len(things)
        for k, thing in enumerate(things):
            piece = make_piece(thing, style, rng)
            w, d, _ = piece.size.tolist()
            width, depth = top.x1 - top.x0, top.y1 - top.y0
            if w > width or d > depth:
                continue
            for _ in range(6):
                centre = (k + 0.5) / slots * width
                x = top.x0 + min(max(centre + float(rng.uniform(-0.15, 0.15)) * width / slots, w / 2), width - w / 2)
                y = top.y0 + d / 2 + float(rng.uniform(0.3, 0.7)) * (depth - d)
                if piece.label == "computer monitor":
                    y = top.y1 - d / 2
                if place_on(layout, placed, piece, x, y, top.z):
                    break


def place_on(layout: Layout, below: Placed, piece, x: float, y: float, z: float, *, turned: float = 0.0) -> Placed | None:
    """A small piece standing at (x, y, z) of another piece's frame."""
    c, s = math.cos(below.yaw), math.sin(below.yaw)
    return layout.try_at(piece, below.x + c * x - s * y, below.y + s * x + c * y, below.yaw + turned, z=below.z + z + LIFT)
