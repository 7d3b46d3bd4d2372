"""How single things that make a room what it is are placed: at walls, on them, in the middle, spread over the floor.

Each function places what finds room and is the same for every room; which room has what says rooms_equipped.py.
"""

import math

import numpy as np

from wm.geometry.placement.clearances import WALL_GAP
from wm.geometry.plan.site import Site
from wm.offline.arrangement.groups import rug_under
from wm.offline.arrangement.layout import Placed
from wm.offline.arrangement.room_arrangement import RoomArrangement
from wm.offline.furniture import KINDS, Piece


def long_way(site: Site) -> float:
    """Direction (radians) of the longest wall."""
    k = int(np.argmax(site.lengths))
    return math.atan2(float(site.directions[k, 1]), float(site.directions[k, 0]))


def sizes(room: RoomArrangement, kind: str) -> list[Piece]:
    """A piece of a kind in a size by chance, and as small as the kind is made."""
    return [room.piece(kind), room.piece(kind, KINDS[kind].low)]


def at_walls(room: RoomArrangement, *kinds: str, where: str = "any") -> None:
    """Pieces with their backs to walls, each in a smaller size, or free on the floor, where it finds no room otherwise."""
    for kind in kinds:
        at_a_wall(room, kind, where=where)


def at_a_wall(room: RoomArrangement, kind: str, *, where: str = "any") -> Placed | None:
    for piece in sizes(room, kind):
        for front in (KINDS[kind].front, 0.0):
            placed = room.layout.against_wall(piece, room.rng, front=front, where=where)
            if placed is not None:
                return room.dressed(placed)
    return in_the_middle(room, kind)


def in_the_middle(room: RoomArrangement, kind: str, *, rug: bool = False) -> Placed | None:
    """A piece free on the floor, as near to the middle as it may stand, along the room or across it."""
    for piece in sizes(room, kind):
        for yaw in (long_way(room.layout.site), long_way(room.layout.site) + math.pi / 2):
            placed = room.layout.on_floor(piece, room.rng, room.layout.site.centre, yaw=yaw)
            if placed is not None:
                if rug:
                    rug_under(room, placed.x, placed.y, yaw, float(piece.size[0]) + 1.2, float(piece.size[1]) + 1.2)
                return room.dressed(placed)
    return None


def spread_out(room: RoomArrangement, kind: str, *, every: float, most: int = 6) -> None:
    """Pieces free on the emptiest parts of the floor, one for `every` square metres of the room."""
    for _ in range(min(max(int(room.layout.site.polygon.area / every), 1), most)):
        x, y, _ = room.layout.emptiest()
        piece = room.piece(kind)
        yaw = long_way(room.layout.site) + (0.0 if piece.support == "flat" else float(room.rng.uniform(-0.4, 0.4)))
        if not _overlaps_flat(room, piece, x, y):
            room.layout.on_floor(piece, room.rng, (x, y), yaw=yaw, radius=1.5)


def _overlaps_flat(room: RoomArrangement, piece: Piece, x: float, y: float) -> bool:
    """Whether a thing that lies flat would lie on another."""
    reach = float(np.hypot(*piece.size[:2])) / 2
    return piece.support == "flat" and any(
        other.piece.support == "flat"
        and math.hypot(other.x - x, other.y - y) < reach + float(np.hypot(*other.piece.size[:2])) / 2
        for other in room.layout.placed
    )


def mats(room: RoomArrangement, kind: str, *, most: int = 6) -> None:
    """Mats side by side across the middle of the floor."""
    site, size = room.layout.site, KINDS[kind].high
    w, d = size[0] + 0.35, size[1] + 0.35
    yaw = long_way(site)
    c, s = math.cos(yaw), math.sin(yaw)
    count = 0
    for row in (0, 1, -1):
        for column in (0, 1, -1, 2, -2):
            dx, dy = column * w, row * d
            at = site.centre[0] + c * dx - s * dy, site.centre[1] + s * dx + c * dy
            if count < most:
                count += room.layout.try_at(room.piece(kind, size), *at, yaw) is not None


def on_the_wall(room: RoomArrangement, kind: str, middle: float, *, where: str = "centre") -> Placed | None:
    """A wall piece with its centre at a height, smaller where it finds no room otherwise."""
    for piece in sizes(room, kind):
        half = float(piece.size[2]) / 2
        z = min(middle, room.layout.site.ceiling - 0.06 - half) - half
        placed = room.layout.against_wall(piece, room.rng, gap=WALL_GAP, z=z, where=where)
        if placed is not None:
            return placed
    return None
