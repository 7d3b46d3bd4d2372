"""What a row of the table of rooms says (rooms_equipped.py): groups of equipment, waiting for a room."""

import dataclasses
from collections.abc import Callable
from typing import Any

from wm.offline.arrangement.assemblies import beds, counter, rows, stations, tables
from wm.offline.arrangement.equipment import at_walls, in_the_middle, mats, on_the_wall, spread_out
from wm.offline.arrangement.groups import rug_under
from wm.offline.arrangement.room_arrangement import RoomArrangement
from wm.offline.arrangement.writing import writing

Group = Callable[[RoomArrangement], Any]


@dataclasses.dataclass(frozen=True)
class Equipped:
    """A type of room: what makes it what it is, and what else it may have."""

    groups: tuple[Group, ...]
    walls: tuple[str, ...] = ()  # what may stand along its walls besides
    soft: bool = False  # curtains at its windows, pictures on its walls
    sparse: float = 0.5  # share of the usual number of pieces that it is filled up to


def walls(*kinds: str, where: str = "any") -> Group:
    return lambda room: at_walls(room, *kinds, where=where)


def middle(kind: str, *, rug: bool = False) -> Group:
    return lambda room: in_the_middle(room, kind, rug=rug)


def hung(kind: str, height: float) -> Group:
    return lambda room: on_the_wall(room, kind, height)


def some(kind: str, every: float) -> Group:
    return lambda room: spread_out(room, kind, every=every)


def row(kind: str, to: str, ahead: float, *, seat: str | None = None, most: int = 4) -> Group:
    return lambda room: rows(room, kind, to=to, ahead=ahead, seat=seat, most=most)


def served(kind: str, shelf: str, *, stools: str | None = None) -> Group:
    return lambda room: counter(room, kind, shelf=shelf, stools=stools)


def at(kind: str, seat: str, every: float = 99.0) -> Group:
    return lambda room: stations(room, kind, seat, every=every)


def asleep(kind: str, every: float, companion: str | None = None) -> Group:
    return lambda room: beds(room, kind, every=every, companion=companion)


def dining(every: float) -> Group:
    return lambda room: tables(room, every=every)


def laid(kind: str, most: int = 6) -> Group:
    return lambda room: mats(room, kind, most=most)


def carpet(room: RoomArrangement) -> None:
    rug_under(room, *room.layout.site.centre, 0.0, 2.0, 1.4)


def desk(room: RoomArrangement) -> None:
    writing(room, at_wall=True)


def desks(room: RoomArrangement) -> None:
    """Desks with chairs at the walls, one for five square metres, three at most."""
    for _ in range(min(max(int(room.layout.site.polygon.area / 5), 1), 3)):
        if writing(room, at_wall=True) is None:
            break
