"""The type of a room, by which it is furnished, and the one by which it is finished.

Rooms that differ only in size or place are of one type: a great hall and a hall. Fewer types have finishes and lamps of their
own: a forge is finished like a utility room.
"""

from wm.synth.room_names import ROOM, SORTS, room_sort

_SHARED = {
    "great hall": "hall", "atrium": "hall", "leisure": "living", "tea room": "living", "studio": "study", "service": "utility",
    ROOM: "other",
}  # fmt: skip
ROOM_TYPES = {sort: _SHARED.get(sort, sort) for sort in SORTS}
"""The type of each sort of room (wm.synth.room_names)."""

FINISHES = {
    **dict.fromkeys(("wc", "sauna", "pool", "laundry", "surgery", "hospital", "laboratory", "changing room"), "bathroom"),
    **dict.fromkeys(("pantry", "bakery"), "kitchen"),
    **dict.fromkeys(("nursery", "kids", "dormitory"), "bedroom"),
    **dict.fromkeys(("restaurant", "bar"), "dining"),
    **dict.fromkeys(("classroom", "meeting"), "library"),
    **dict.fromkeys(("office", "observatory"), "study"),
    **dict.fromkeys(("entrance", "cloakroom", "throne room", "chapel", "ballroom", "reception", "dance"), "hall"),
    **dict.fromkeys(("museum", "crypt", "aquarium"), "gallery"),
    **dict.fromkeys(("conservatory", "music", "games", "billiard", "cinema", "playroom", "closet", "shop", "barber"), "living"),
    **dict.fromkeys(
        ("workshop", "forge", "garage", "boiler room", "server room", "control room", "storage", "cellar", "vault", "armoury",
         "stable", "cell", "gym", "garden", "balcony", "greenhouse", "atelier"), "utility",
    ),
    "yoga": "other",
}  # fmt: skip
"""The type whose floors, walls and lamps a type has that has none of its own."""


def room_type(name: str) -> str:
    """Type of the room called `name`: a value of ROOM_TYPES, "other" where no word tells."""
    return ROOM_TYPES[room_sort(name)]


def finish_type(kind: str) -> str:
    """The type that has floors, walls and lamps, for any type."""
    return FINISHES.get(kind, kind)
