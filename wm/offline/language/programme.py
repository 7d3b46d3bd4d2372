"""The room programme: what each named room is, how large, and how it likes to be reached."""

import dataclasses
import re
import unicodedata

import numpy as np

from wm.offline.language.building import Building
from wm.synth.room_names import room_sort

CIRCULATION, PUBLIC, PRIVATE, WET, SERVICE = "circulation", "public", "private", "wet", "service"


@dataclasses.dataclass(frozen=True)
class RoomKind:
    """A kind of room: floor area range in square metres, zone, and rank from the front of the house (0) to its back."""

    name: str  # a sort of wm.synth.room_names: there is one kind for each
    area: tuple[float, float]
    zone: str
    rank: float


_KINDS = {
    kind.name: kind
    for kind in (
        RoomKind("corridor", (6.0, 14.0), CIRCULATION, 5.0),
        RoomKind("hall", (14.0, 24.0), CIRCULATION, 0.0),
        RoomKind("great hall", (28.0, 45.0), CIRCULATION, 0.0),
        RoomKind("gallery", (18.0, 30.0), CIRCULATION, 1.0),
        RoomKind("atrium", (30.0, 48.0), CIRCULATION, 0.0),
        RoomKind("living", (22.0, 34.0), PUBLIC, 1.0),
        RoomKind("dining", (15.0, 24.0), PUBLIC, 2.0),
        RoomKind("kitchen", (12.0, 20.0), PUBLIC, 3.0),
        RoomKind("conservatory", (16.0, 28.0), PUBLIC, 2.0),
        RoomKind("leisure", (18.0, 28.0), PUBLIC, 4.0),
        RoomKind("ballroom", (18.0, 28.0), PUBLIC, 4.0),
        RoomKind("library", (18.0, 28.0), PUBLIC, 5.0),
        RoomKind("workshop", (16.0, 26.0), PUBLIC, 5.0),
        RoomKind("studio", (16.0, 26.0), PUBLIC, 5.0),
        RoomKind("study", (10.0, 15.0), PRIVATE, 6.0),
        RoomKind("bedroom", (12.0, 20.0), PRIVATE, 7.0),
        RoomKind("bathroom", (5.0, 9.0), WET, 8.0),
        RoomKind("service", (5.0, 8.0), SERVICE, 3.5),
        RoomKind("room", (14.0, 22.0), PUBLIC, 4.0),
        RoomKind("other", (14.0, 22.0), PUBLIC, 4.0),
    )
}


@dataclasses.dataclass(frozen=True)
class Space:
    """One room that is wanted."""

    id: str
    name: str
    kind: RoomKind
    area: float  # square metres to aim for


def room_kind_of(room: str) -> RoomKind:
    """The kind a room's name speaks of; a public room of middling size where it speaks of none."""
    return _KINDS[room_sort(room)]


def read_programme(rooms: list[str], building: Building, rng: np.random.Generator) -> list[Space]:
    """The wanted rooms with unique ids and areas drawn from their kinds' ranges."""
    spaces: list[Space] = []
    for room in rooms:
        add_space(spaces, room, building, rng)
    return spaces


def add_space(spaces: list[Space], room: str, building: Building, rng: np.random.Generator) -> int:
    """Appends one more room to the programme and returns its index."""
    kind = room_kind_of(room)
    share = float(rng.uniform(*building.share))
    area = kind.area[0] + share * (kind.area[1] - kind.area[0])
    same = sum(_slug(space.name) == _slug(room) for space in spaces)
    taken = {space.id for space in spaces}
    room_id, count = _slug(room), same + 1
    while room_id in taken:
        room_id, count = f"{_slug(room)}_{count}", count + 1
    name = " ".join(room.split())
    spaces.append(Space(id=room_id, name=name, kind=kind, area=area))
    return len(spaces) - 1


def _slug(room: str) -> str:
    plain = unicodedata.normalize("NFKD", room).encode("ascii", "ignore").decode().lower()
    return re.sub(r"[^a-z0-9]+", "_", plain).strip("_")[:40] or "room"
