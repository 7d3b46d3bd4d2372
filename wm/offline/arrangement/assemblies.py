"""Things of a room that go together: rows that face something, tables with chairs, a counter with its shelf and stools, beds."""

import math

import numpy as np

from wm.geometry.placement.clearances import LIFT, WALL_GAP
from wm.geometry.plan.site import Site
from wm.offline.arrangement.equipment import at_a_wall, at_walls, in_the_middle, long_way, sizes
from wm.offline.arrangement.groups import seat_around
from wm.offline.arrangement.hangings import hang
from wm.offline.arrangement.layout import Placed
from wm.offline.arrangement.room_arrangement import RoomArrangement, beside, local
from wm.offline.furniture import Piece

AISLE = 0.8
"""Metres between two columns of rows, and behind a counter: more than the 0.66 m that furniture leaves for ways."""
BETWEEN_ROWS = 0.42
"""Metres between two rows: enough for the knees, too little to be counted as floor that is closed off."""


def rows(room: RoomArrangement, kind: str, *, to: str, ahead: float, seat: str | None = None, most: int = 4) -> None:
    """Rows that face a thing at a wall: two columns or more, with an aisle between, where the room is wide enough.

    Args:
      to: what they face; a wall piece hangs with its middle at 1.5 m.
      ahead: metres between that thing and the first row.
      seat: a chair for every piece of the rows, which are then desks at which one looks the same way.
    """
    depths = {k: _depth(room.layout.site, k) for k in range(len(room.layout.site.lengths))}
    deepest = sorted(depths, key=lambda k: -depths[k])[:4]
    for least in (4, 2, 1):
        for piece in reversed(sizes(room, kind)):
            for wall in deepest:
                mark = room.layout.mark()
                focus = _focus(room, to, [wall])
                if focus is not None and _lay_rows(room, piece, focus, ahead=ahead, seat=seat, most=most) >= least:
                    return
                room.layout.back_to(mark)
    _focus(room, to, None)
    at_walls(room, kind)


def _depth(site: Site, wall: int) -> float:
    """Metres of room before a wall."""
    corners = np.asarray(site.polygon.exterior.coords)
    return float(((corners - site.starts[wall]) @ site.normals[wall]).max())


def _focus(room: RoomArrangement, kind: str, walls: list[int] | None) -> Placed | None:
    """What rows face, at the middle of one of these walls."""
    for piece in sizes(room, kind):
        half = float(piece.size[2]) / 2
        z = min(1.5, room.layout.site.ceiling - 0.06 - half) - half if piece.support == "wall" else LIFT
        gap = WALL_GAP if piece.support == "wall" else None
        placed = room.layout.against_wall(piece, room.rng, gap=gap, z=z, where="centre", walls=walls)
        if placed is not None:
            return room.dressed(placed)
    return None


def _lay_rows(room: RoomArrangement, piece: Piece, focus: Placed, *, ahead: float, seat: str | None, most: int) -> int:
    chair = room.piece(seat) if seat else None
    w, d = float(piece.size[0]), float(piece.size[1])
    behind = float(chair.size[1]) + 0.03 if chair is not None else 0.0
    corners = np.asarray(room.layout.site.polygon.exterior.coords)[:-1] - np.array([focus.x, focus.y])
    across = corners @ np.array([math.cos(focus.yaw), math.sin(focus.yaw)])
    low, high = float(across.min()), float(across.max())
    columns = max(int((high - low - 0.1) / (w + AISLE)), 1)
    laid = 0
    for row in range(most):
        dy = -(float(focus.piece.size[1]) / 2 + ahead + d / 2 + row * (d + behind + BETWEEN_ROWS))
        for column in range(columns):
            dx = (low + high) / 2 + (column - (columns - 1) / 2) * (w + AISLE)
            at = local(focus, dx, dy)
            mark = room.layout.mark()
            placed = room.layout.try_at(piece, *at, focus.yaw + (math.pi if chair is None else 0.0))
            if placed is None:
                continue
            if chair is not None:
                sat = room.layout.try_at(
                    chair, *local(placed, 0.0, -(d / 2 + 0.03 + float(chair.size[1]) / 2)), focus.yaw + math.pi
                )
                if sat is None:
                    room.layout.back_to(mark)
                    continue
            laid += 1
    return laid


def tables(room: RoomArrangement, *, every: float = 7.0, lamps: bool = True) -> None:
    """Round tables with chairs on the emptiest parts of the floor, one for `every` square metres."""
    for _ in range(min(max(int(room.layout.site.polygon.area / every), 2), 6)):
        x, y, _ = room.layout.emptiest()
        mark = room.layout.mark()
        table = room.layout.on_floor(room.piece("round table", (0.85, 0.85, 0.75)), room.rng, (x, y), yaw=0.0, radius=0.8)
        if table is None or seat_around(room, table, round_=True) < 2:
            room.layout.back_to(mark)
            return
        if lamps:
            hang(room, table.x, table.y, low=table.top + 0.8)
        room.dressed(table)


def counter(room: RoomArrangement, kind: str, *, shelf: str, stools: str | None = None) -> Placed | None:
    """A counter with a shelf at the wall behind whoever serves, and stools before it; at a wall where there is no such room."""
    placed = None
    for piece in sizes(room, kind):
        for behind in sizes(room, shelf):
            mark = room.layout.mark()
            back = room.layout.against_wall(behind, room.rng, where="centre") if placed is None else None
            if back is not None:
                away = (float(behind.size[1]) + float(piece.size[1])) / 2 + AISLE
                placed = room.layout.try_at(
                    piece, *local(back, 0.0, -away), back.yaw, front=0.55, mates=frozenset({stools or kind})
                )
                if placed is None:
                    room.layout.back_to(mark)
    if placed is None:
        at_walls(room, shelf)
        placed = in_the_middle(room, kind)
    if placed is None:
        return None
    room.dressed(placed)
    if stools is not None:
        seats_before(room, placed, stools)
    return placed


def seats_before(room: RoomArrangement, placed: Placed, kind: str) -> None:
    """Stools side by side before a counter, a bench or a piano."""
    w, d = float(placed.piece.size[0]), float(placed.piece.size[1])
    count = max(int(w / 0.62), 1)
    for k in range(count):
        stool = room.piece(kind)
        x = (k + 0.5 - count / 2) * w / count
        room.layout.try_at(stool, *local(placed, x, -(d + float(stool.size[1])) / 2 - 0.04), placed.yaw + math.pi)


def stations(room: RoomArrangement, kind: str, seat: str, *, every: float = 99.0) -> None:
    """Benches or instruments at walls with a seat before each, one for `every` square metres of the room and one at least."""
    for _ in range(max(int(room.layout.site.polygon.area / every), 1)):
        chair = room.piece(seat)
        for piece in sizes(room, kind):
            placed = room.layout.against_wall(piece, room.rng, front=0.7, mates=frozenset({seat}))
            if placed is not None:
                room.dressed(placed)
                away = (float(piece.size[1]) + float(chair.size[1])) / 2 + 0.04
                room.layout.try_at(chair, *local(placed, 0.0, -away), placed.yaw + math.pi)
                break
        else:
            at_a_wall(room, kind)
            return


def beds(room: RoomArrangement, kind: str, *, every: float, companion: str | None = None) -> None:
    """Beds with their heads to walls, one for `every` square metres of the room, something beside each."""
    for _ in range(min(max(int(room.layout.site.polygon.area / every), 1), 6)):
        placed = None
        for piece in sizes(room, kind):
            placed = placed or room.layout.against_wall(piece, room.rng, front=0.3, where="corner")
        if placed is not None and companion is not None:
            thing = room.piece(companion)
            _ = beside(room, placed, thing, 1.0, gap=0.08) or beside(room, placed, thing, -1.0, gap=0.08)


def conference(room: RoomArrangement) -> Placed | None:
    """A long table with chairs all around it."""
    for size in ((2.2, 1.0, 0.75), (1.75, 0.95, 0.75), (1.4, 0.88, 0.75)):
        yaw = long_way(room.layout.site)
        mark = room.layout.mark()
        table = room.layout.on_floor(room.piece("dining table", size), room.rng, room.layout.site.centre, yaw=yaw, radius=1.2)
        if table is not None and seat_around(room, table, round_=False) >= 3:
            hang(room, table.x, table.y, low=table.top + 1.0)
            return room.dressed(table)
        room.layout.back_to(mark)
    tables(room)
    return None
