"""What a theme asks of some kinds of furniture, done to the pieces of a furnished room: "a green sofa", "no curtains"."""

import dataclasses
import math

import numpy as np

from wm.color import LUMINANCE
from wm.offline.arrangement.layout import Placed
from wm.offline.furniture import Piece
from wm.offline.style.finish import Rgb, Style, Wish


def granted(placed: list[Placed], style: Style) -> list[Placed]:
    """The pieces as the theme wants them. No piece moves: what is not wanted is left out, with what stands on it."""
    for wish in style.wishes:
        if wish.absent:
            out = [one for one in placed if one.piece.label in wish.kinds]
            placed = [one for one in placed if one not in out and not any(_stands_on(one, other) for other in out)]
        else:
            placed = [_changed(one, wish, style) if one.piece.label in wish.kinds else one for one in placed]
    return placed


def _stands_on(one: Placed, other: Placed) -> bool:
    if one.piece.support != "object" or not other.piece.tops:
        return False
    c, s = math.cos(other.yaw), math.sin(other.yaw)
    dx, dy = one.x - other.x, one.y - other.y
    along, deep = abs(c * dx + s * dy), abs(c * dy - s * dx)
    return along <= float(other.piece.size[0]) / 2 and deep <= float(other.piece.size[1]) / 2


def _changed(one: Placed, wish: Wish, style: Style) -> Placed:
    return dataclasses.replace(one, piece=recolored(one.piece, wish, style))


def recolored(piece: Piece, wish: Wish, style: Style) -> Piece:
    """The piece with the slots of a wish in its colour and of its material, lighter and darker parts as they were."""
    chosen = [k for k, slot in enumerate(piece.slots) if slot in wish.slots]
    if not chosen:
        return piece
    slots, colors = list(piece.slots), piece.slot_colors.copy()
    for k in chosen:
        if wish.color is not None:
            own = style.slot(slots[k]).colors[0]
            colors[k] = np.clip(np.asarray(wish.color) * _shade(colors[k], own), 0, 1)
        slots[k] = wish.slot or slots[k]
    return dataclasses.replace(piece, slots=tuple(slots), slot_colors=colors)


def _shade(color: np.ndarray, own: Rgb) -> float:
    """How much lighter or darker a part is than its slot; 1 for parts in a colour of their own."""
    shade = float((color @ LUMINANCE + 0.02) / (np.asarray(own) @ LUMINANCE + 0.02))
    alike = np.abs(color / max(float(color.max()), 1e-3) - np.asarray(own) / max(max(own), 1e-3)).max() < 0.05
    return min(max(shade, 0.5), 1.3) if alike else 1.0
