"""What a room of each type may hold beyond its functional groups, and what each style family owns or would not own."""

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
    "utility": ("bookshelf", "chest", "desk", "stool", "basket", "bookshelf", "basket", "wardrobe"),
    "other": ("bookshelf", "armchair", "plant", "console table", "chest", "floor lamp", "bench"),
}
"""What stands along the walls of a room, in the order in which it is tried, until the room holds enough."""

FLAVOUR: dict[str, tuple[tuple[str, str], ...]] = {
    "gothic": (
        ("suit of armour", "hall gallery corridor library"),
        ("candelabra", "dining hall living bedroom"),
        ("altar table", "hall gallery"),
    ),
    "roman": (("column", "hall living dining gallery bathroom study"), ("statue", "hall dining bathroom gallery")),
    "baroque": (("candelabra", "hall dining bedroom living"), ("statue", "hall gallery")),
    "surreal": (
        ("giant mushroom", "hall living bedroom corridor other utility"),
        ("chess piece", "hall living dining library corridor gallery other utility"),
        ("giant mushroom", "hall living"),
    ),
    "japanese": (("folding screen", "living bedroom dining hall"),),
    "moroccan": (("folding screen", "living bedroom"), ("candelabra", "hall living")),
    "victorian": (("grandfather clock", "hall living library study"), ("globe", "living study")),
}
"""Pieces that only some families have, and the room types they belong in."""

ABSENT: dict[str, frozenset[str]] = {
    "scandinavian": frozenset({"statue", "column", "candelabra", "grandfather clock", "chest", "lectern"}),
    "coastal": frozenset({"statue", "column", "candelabra", "grandfather clock", "lectern"}),
    "minimalist": frozenset({"candelabra", "grandfather clock", "chest", "lectern", "statue"}),
    "modern": frozenset({"statue", "candelabra", "grandfather clock", "lectern", "chest"}),
    "neutral": frozenset({"statue", "candelabra", "grandfather clock", "lectern"}),
    "industrial": frozenset({"statue", "candelabra", "grandfather clock", "lectern"}),
    "cyberpunk": frozenset({"candelabra", "grandfather clock", "lectern", "chest", "basket"}),
    "midcentury": frozenset({"statue", "candelabra", "lectern"}),
    "japanese": frozenset({"statue", "column", "candelabra", "grandfather clock", "globe", "lectern"}),
}
"""What families would not own."""

ONCE = frozenset({"wardrobe", "dresser", "desk", "grandfather clock", "globe", "lectern", "suit of armour"})
"""Pieces of which a room holds one."""

CORNERS = frozenset(
    {"plant", "floor lamp", "candelabra", "statue", "column", "globe", "basket", "stool", "armchair", "suit of armour",
     "giant mushroom", "folding screen"}
)  # fmt: skip
"""Pieces that like corners."""
