"""The room programme: what each named room is, how large, and how it likes to be reached."""

import dataclasses
import re
import unicodedata

import numpy as np

from wm.offline.language.building import Building
from wm.synth.room_names import CONNECTING, room_sort
from wm.synth.seeds import numbered_name

CIRCULATION, PUBLIC, PRIVATE, WET, SERVICE = "circulation", "public", "private", "wet", "service"


@dataclasses.dataclass(frozen=True)
class RoomKind:
    """A kind of room: floor area range in square metres, zone, and rank from the front of the house (0) to its back."""

    name: str  # a sort of wm.synth.room_names: there is one kind for each
    area: tuple[float, float]
    zone: str
    rank: float


_ZONES = {
    **dict.fromkeys(CONNECTING, CIRCULATION), "study": PRIVATE, "bedroom": PRIVATE, "bathroom": WET, "service": SERVICE,
}  # fmt: skip
"""Zones of sorts of rooms; the others are public."""
_KINDS = {
    name: RoomKind(name, area, _ZONES.get(name, PUBLIC), rank)
    for name, area, rank in (
        ("corridor", (6.0, 14.0), 5.0),
        ("hall", (14.0, 24.0), 0.0),
        ("great hall", (28.0, 45.0), 0.0),
        ("gallery", (18.0, 30.0), 1.0),
        ("atrium", (30.0, 48.0), 0.0),
        ("living", (22.0, 34.0), 1.0),
        ("dining", (15.0, 24.0), 2.0),
        ("kitchen", (12.0, 20.0), 3.0),
        ("conservatory", (16.0, 28.0), 2.0),
        ("leisure", (18.0, 28.0), 4.0),
        ("ballroom", (18.0, 28.0), 4.0),
        ("library", (18.0, 28.0), 5.0),
        ("workshop", (16.0, 26.0), 5.0),
        ("studio", (16.0, 26.0), 5.0),
        ("study", (10.0, 15.0), 6.0),
        ("bedroom", (12.0, 20.0), 7.0),
        ("bathroom", (5.0, 9.0), 8.0),
        ("service", (5.0, 8.0), 3.5),
        ("room", (14.0, 22.0), 4.0),
        ("other", (14.0, 22.0), 4.0),
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
    """The wanted rooms with unique ids and areas drawn from their kinds' ranges, each by its name, whatever the others are."""
    house = int(rng.integers(2**32))
    spaces: list[Space] = []
    for room in rooms:
        number = numbered_name(room, sum(_slug(space.name) == _slug(room) for space in spaces))
        add_space(spaces, room, building, np.random.default_rng(np.random.SeedSequence([house, number])))
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
