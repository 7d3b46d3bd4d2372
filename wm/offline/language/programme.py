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
    **dict.fromkeys(CONNECTING, CIRCULATION),
    **dict.fromkeys(("study", "bedroom", "nursery", "kids", "office"), PRIVATE),
    **dict.fromkeys(("bathroom", "wc", "sauna"), WET),
    **dict.fromkeys(("service", "pantry", "laundry", "closet", "cloakroom", "storage"), SERVICE),
}
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
        ("entrance", (9.0, 15.0), 0.0),
        ("throne room", (26.0, 42.0), 1.0),
        ("museum", (24.0, 40.0), 1.0),
        ("garden", (20.0, 36.0), 2.0),
        ("balcony", (9.0, 16.0), 2.5),
        ("tea room", (14.0, 22.0), 4.0),
        ("restaurant", (26.0, 44.0), 1.0),
        ("bar", (18.0, 30.0), 1.5),
        ("pantry", (5.0, 8.0), 3.5),
        ("bakery", (18.0, 28.0), 2.5),
        ("greenhouse", (16.0, 28.0), 3.0),
        ("aquarium", (16.0, 28.0), 2.0),
        ("music", (18.0, 28.0), 4.0),
        ("games", (18.0, 30.0), 4.0),
        ("billiard", (22.0, 34.0), 4.0),
        ("cinema", (20.0, 34.0), 4.5),
        ("gym", (18.0, 32.0), 4.5),
        ("yoga", (16.0, 28.0), 4.5),
        ("dance", (22.0, 36.0), 4.0),
        ("chapel", (22.0, 38.0), 4.0),
        ("crypt", (16.0, 26.0), 6.0),
        ("classroom", (26.0, 42.0), 3.0),
        ("forge", (16.0, 26.0), 5.0),
        ("garage", (24.0, 36.0), 3.0),
        ("boiler room", (12.0, 20.0), 6.0),
        ("atelier", (16.0, 28.0), 5.0),
        ("laboratory", (18.0, 30.0), 5.0),
        ("observatory", (16.0, 28.0), 5.0),
        ("office", (12.0, 22.0), 5.0),
        ("meeting", (16.0, 28.0), 4.0),
        ("control room", (18.0, 32.0), 4.0),
        ("server room", (12.0, 20.0), 6.0),
        ("reception", (16.0, 28.0), 0.5),
        ("shop", (20.0, 36.0), 1.0),
        ("barber", (14.0, 24.0), 2.0),
        ("dormitory", (18.0, 32.0), 7.0),
        ("nursery", (11.0, 17.0), 7.0),
        ("kids", (11.0, 18.0), 7.0),
        ("playroom", (14.0, 24.0), 5.0),
        ("hospital", (18.0, 32.0), 6.0),
        ("surgery", (13.0, 22.0), 5.5),
        ("cell", (8.0, 12.0), 7.0),
        ("wc", (5.0, 7.0), 8.0),
        ("sauna", (6.0, 10.0), 8.0),
        ("pool", (26.0, 42.0), 6.0),
        ("laundry", (6.0, 10.0), 3.5),
        ("closet", (5.0, 9.0), 7.5),
        ("cloakroom", (5.0, 8.0), 1.0),
        ("changing room", (12.0, 20.0), 6.0),
        ("storage", (6.0, 12.0), 5.0),
        ("cellar", (16.0, 26.0), 6.0),
        ("vault", (12.0, 20.0), 7.0),
        ("armoury", (14.0, 24.0), 5.0),
        ("stable", (28.0, 44.0), 5.0),
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
