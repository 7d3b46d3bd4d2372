"""What a room of each type may hold beyond its functional groups, and what each style family has or never has."""

import dataclasses

from wm.offline.style.finish import Style

AT_WALL: dict[str, tuple[str, ...]] = {
    "bedroom": ("wardrobe", "dresser", "armchair", "plant", "chest", "bookshelf", "floor lamp"),
    "living": ("bookshelf", "sideboard", "plant", "floor lamp", "console table", "bookshelf", "plant"),
    "dining": ("sideboard", "console table", "plant", "candelabra", "grandfather clock", "plant"),
    "kitchen": ("sideboard", "basket", "plant", "bookshelf"),
    "bathroom": ("stool", "basket", "plant"),
    "library": ("bookshelf", "bookshelf", "bookshelf", "globe", "bookshelf", "floor lamp", "lectern", "bookshelf", "plant"),
    "study": ("bookshelf", "armchair", "bookshelf", "floor lamp", "plant", "globe", "chest"),
    "hall": ("console table", "bench", "statue", "column", "plant", "grandfather clock", "armchair", "chest", "statue"),
    "gallery": ("statue", "column", "bench", "statue", "column", "plant", "bench", "console table"),
    "corridor": ("console table", "plant", "bench", "column", "chest", "floor lamp"),
}
"""What stands along the walls of a room, in the order in which it is tried, until the room holds enough."""

FLAVOUR: dict[str, tuple[tuple[str, str], ...]] = {
    "gothic": (
        ("suit of armour", "hall gallery corridor library"),
        ("candelabra", "dining hall living bedroom"),
        ("altar table", "hall gallery"),
    ),
    "roman": (("column", "hall living dining gallery bathroom study"), ("statue", "dining bathroom gallery")),
    "baroque": (("candelabra", "hall dining bedroom living"), ("statue", "hall gallery")),
    "surreal": (
        ("giant mushroom", "hall living bedroom corridor"),
        ("chess piece", "hall living dining library corridor gallery"),
        ("giant mushroom", "hall living"),
    ),
    "japanese": (("folding screen", "living bedroom dining hall"),),
    "moroccan": (("folding screen", "living bedroom"), ("candelabra", "hall living")),
    "clockwork": (
        ("gear sculpture", "hall living gallery workshop"),
        ("orrery", "hall living library study bedroom"),
        ("grandfather clock", "living dining bedroom corridor study"),
        ("topiary", "hall living dining gallery"),
        ("planter", "hall living kitchen dining workshop"),
    ),
    "victorian": (("grandfather clock", "hall living library study"), ("globe", "living study")),
}
"""Pieces that only some families have, and the room types they belong in."""

WALL_FEATURES: dict[str, tuple[tuple[str, float, str], ...]] = {
    "clockwork": (
        ("wall ivy", 1.25, "hall gallery living dining"),
        ("skeleton wall clock", 1.8, "hall workshop bedroom study library gallery dining kitchen corridor"),
        ("wall pipes", 1.2, "workshop utility kitchen bathroom"),
        ("wall gears", 1.75, "hall workshop utility living bedroom study corridor gallery"),
        ("wall ivy", 1.25, "hall gallery workshop utility"),
    ),
}
"""Large things on the walls that only some families have, the height of their middles, and the room types they belong in."""

OVER_FURNITURE: dict[str, tuple[str, ...]] = {"clockwork": ("skeleton wall clock", "wall gears")}
"""What hangs over the furniture of a room in place of pictures, in turn."""

LAMPS: dict[str, dict[str, tuple[str, ...]]] = {
    # family -> room type -> what Form.lamp may be there; "" is every other room
    "gothic": {
        "": ("candle",), "kitchen": ("lantern",), "corridor": ("lantern",), "bathroom": ("lantern",), "study": ("cone", "candle"),
        "utility": ("lantern",),
    },
    "roman": {
        "": ("tripod", "bowl"), "hall": ("tripod",), "dining": ("tripod",), "bedroom": ("bowl",), "bathroom": ("bowl",),
        "kitchen": ("lantern",), "corridor": ("lantern",), "library": ("bowl",),
    },
    "scandinavian": {
        "": ("drum", "paper"), "living": ("paper",), "kitchen": ("dome",), "dining": ("dome", "paper"), "bathroom": ("globe",),
    },
    "coastal": {
        "": ("rattan", "drum"), "living": ("rattan",), "bedroom": ("drum", "paper"), "bathroom": ("globe",),
        "kitchen": ("dome",), "corridor": ("lantern",), "hall": ("lantern",),
    },
    "clockwork": {
        "": ("cluster", "globe"), "hall": ("cluster",), "living": ("cluster",), "utility": ("dome",), "kitchen": ("dome",),
        "bedroom": ("globe",), "bathroom": ("globe",),
    },
    "victorian": {
        "": ("cone",), "kitchen": ("dome",), "corridor": ("lantern",), "bathroom": ("globe",), "bedroom": ("cone", "drum"),
    },
    "modern": {"": ("drum", "globe"), "kitchen": ("dome",), "dining": ("dome", "globe"), "bathroom": ("globe",)},
}  # fmt: skip
"""What lamps may be, by type of room: one sort to each type in a house; families that are not here have the one of their form."""

ABSENT: dict[str, frozenset[str]] = {
    "scandinavian": frozenset({"statue", "column", "candelabra", "grandfather clock", "chest", "lectern"}),
    "coastal": frozenset({"statue", "column", "candelabra", "grandfather clock", "lectern"}),
    "minimalist": frozenset({"candelabra", "grandfather clock", "chest", "lectern", "statue"}),
    "modern": frozenset({"statue", "candelabra", "grandfather clock", "lectern", "chest"}),
    "neutral": frozenset({"statue", "candelabra", "grandfather clock", "lectern"}),
    "industrial": frozenset({"statue", "candelabra", "grandfather clock", "lectern"}),
    "roman": frozenset({"grandfather clock"}),
    "clockwork": frozenset({"statue", "column", "candelabra", "lectern"}),
    "cyberpunk": frozenset({"candelabra", "grandfather clock", "lectern", "chest", "basket"}),
    "midcentury": frozenset({"statue", "candelabra", "lectern"}),
    "japanese": frozenset({"statue", "column", "candelabra", "grandfather clock", "globe", "lectern"}),
}
"""Pieces that rooms of a family never hold."""

ONCE = frozenset({"wardrobe", "dresser", "desk", "grandfather clock", "globe", "lectern", "suit of armour", "orrery",
                  "gear sculpture"})  # fmt: skip
"""Pieces of which a room holds one at most."""

CORNERS = frozenset(
    {"plant", "floor lamp", "candelabra", "statue", "column", "globe", "basket", "stool", "armchair", "suit of armour",
     "giant mushroom", "folding screen", "topiary"}
)  # fmt: skip
"""Pieces that are placed in corners first."""


def lamp_sorts(style: Style, kind: str | None = None) -> tuple[str, ...]:
    """What lamps may be in a type of room in a style, or in any of its rooms."""
    table = LAMPS.get(style.family, {"": (style.form.lamp,)})
    if kind is not None:
        return table.get(kind, table[""])
    return tuple(dict.fromkeys(sort for sorts in table.values() for sort in sorts))


def with_lamp(style: Style, sort: str) -> Style:
    """The style with lamps of one sort."""
    return dataclasses.replace(style, form=dataclasses.replace(style.form, lamp=sort))
