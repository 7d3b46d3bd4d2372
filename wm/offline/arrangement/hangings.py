"""Things that hang: lamps from the ceiling, pictures, mirrors and cupboards on walls, curtains at windows."""

import math

import numpy as np

from wm.geometry.placement.clearances import LIFT, WALL_GAP
from wm.offline.arrangement.layout import Placed
from wm.offline.arrangement.room_arrangement import RoomArrangement
from wm.offline.furniture import KINDS

WIDE = {"paper": 1.3, "rattan": 1.25, "bowl": 1.15, "cluster": 1.4}
"""How much wider than other pendants these sorts of lamp are."""


def hang(room: RoomArrangement, x: float, y: float, *, low: float = 2.05) -> Placed | None:
    """A chandelier or pendant from the ceiling, its foot no lower than `low`."""
    ceiling = room.layout.site.ceiling
    kind = (
        "chandelier" if room.style.form.lamp in ("candle", "tripod", "cone") or room.style.family == "rustic" else "pendant lamp"
    )
    tallest = ceiling - 2 * LIFT - low
    w = float(room.rng.uniform(0.7, 0.95)) if kind == "chandelier" else float(room.rng.uniform(0.34, 0.48))
    w *= 1.0 if kind == "chandelier" else WIDE.get(room.style.form.lamp, 1.0)
    tall = min(tallest, float(room.rng.uniform(0.75, 1.0)) if low < 2.0 else float(room.rng.uniform(0.6, 0.8)))
    least = 0.5 if kind == "chandelier" else (1.3 if room.style.form.lamp == "globe" else 1.0) * w
    if tall < least:
        kind, w = "pendant lamp", max(min(0.34, 0.7 * tallest), 0.2)
        tall = tallest
    if tall < 0.22:
        return None
    piece = room.piece(kind, (w, w, tall))
    return room.layout.try_at(piece, x, y, float(room.rng.uniform(0, math.pi)), z=ceiling - LIFT - float(piece.size[2]))


def on_wall(
    room: RoomArrangement, kind: str, below: Placed, *, z: float, size: tuple[float, float, float] | None = None
) -> Placed | None:
    """A wall piece centred over a piece that stands with its back to a wall."""
    site = room.layout.site
    point = np.array([below.x, below.y])
    offset = ((point - site.starts) * site.normals).sum(-1)
    facing = site.normals @ np.array([math.sin(below.yaw), -math.cos(below.yaw)])
    along = ((point - site.starts) * site.directions).sum(-1)
    ok = (facing > 0.99) & (offset > 0) & (offset < float(below.piece.size[1]) / 2 + 0.12) & (along > 0) & (along < site.lengths)
    if not ok.any():
        return None
    wall = int(np.argmax(ok))
    piece = room.piece(kind, size)
    half = float(piece.size[0]) / 2 + 0.011
    span = (float(along[wall]) - half, float(along[wall]) + half)
    return room.layout.against_wall(piece, room.rng, gap=WALL_GAP, z=max(z, below.top + 0.08), walls=[wall], span=span)


def wall_piece(
    room: RoomArrangement, kind: str, middle: float, *, size: tuple[float, float, float] | None = None
) -> Placed | None:
    """A wall piece with its centre at a height, on any wall that has room for it; none where it is too tall for the room."""
    piece = room.piece(kind, size)
    z = min(middle, room.layout.site.ceiling - 0.08 - float(piece.size[2]) / 2) - float(piece.size[2]) / 2
    return room.layout.against_wall(piece, room.rng, gap=WALL_GAP, z=z, where="centre" if room.rng.random() < 0.6 else "any")


def above(room: RoomArrangement, kind: str, wall: int, middle: float, z: float, w: float) -> Placed | None:
    """A wall piece over a unit."""
    low = KINDS[kind].low
    piece = room.piece(kind, (w, low[1], min(low[2] + 0.05, room.layout.site.ceiling - z - 0.05)))
    half = float(piece.size[0]) / 2 + 0.011
    return room.layout.against_wall(piece, room.rng, gap=WALL_GAP, z=z, walls=[wall], span=(middle - half, middle + half))


def curtain_pairs(room: RoomArrangement) -> int:
    """Curtains at the windows, to the floor or just below the sill; how many windows got them."""
    site = room.layout.site
    long = room.rng.random() < 0.6
    hung = 0
    for k, window in site.openings:
        if window.kind != "window" or window.head - window.sill < 0.5:
            continue
        top = min(window.head + 0.16, site.ceiling - 0.04)
        for overhang, low in ((0.3, 0.02 if long else window.sill - 0.12), (0.18, window.sill - 0.12)):
            low = max(low, 0.02)
            span = (window.low - overhang, window.high + overhang)
            if span[0] < 0.0 or span[1] > float(site.lengths[k]):
                continue
            piece = room.piece("curtains", (span[1] - span[0] - 0.024, 0.09, top - low))
            middle = 0.5 * (span[0] + span[1])
            x, y = (
                site.starts[k] + middle * site.directions[k] + (WALL_GAP + float(piece.size[1]) / 2) * site.normals[k]
            ).tolist()
            if room.layout.try_at(piece, x, y, math.atan2(float(site.normals[k, 0]), -float(site.normals[k, 1])), z=low):
                hung += 1
                break
    return hung
