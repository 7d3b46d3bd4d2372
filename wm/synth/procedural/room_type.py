"""What kind of room a name means, by whole words: "Master Bedroom" is a bedroom, "Bathhouse" is no bathroom by accident."""

import re

ROOM_WORDS: dict[str, tuple[str, ...]] = {
    # the first type one of whose words occurs wins, so the more telling words come first ("dining hall" dines)
    "bathroom": ("bathroom", "bath", "washroom", "toilet", "wc", "powder", "shower", "ensuite", "lavatory", "restroom", "spa",
                 "thermae", "balneum", "sauna"),
    "kitchen": ("kitchen", "kitchenette", "pantry", "scullery", "culina", "galley"),
    "bedroom": ("bedroom", "bed", "guestroom", "nursery", "dormitory", "cubiculum", "chamber", "boudoir", "bunk", "suite"),
    "dining": ("dining", "diner", "triclinium", "banquet", "refectory", "breakfast"),
    "library": ("library", "reading", "bibliotheca", "archive", "scriptorium"),
    "study": ("study", "office", "workroom", "studio", "workspace", "tablinum", "laboratory", "lab", "den"),
    "gallery": ("gallery", "museum", "exhibition", "peristyle", "cloister"),
    "corridor": ("corridor", "hallway", "passage", "passageway", "landing", "walkway", "tunnel"),
    "hall": ("hall", "foyer", "entrance", "entry", "entryway", "vestibule", "lobby", "atrium", "rotunda", "ballroom", "throne",
             "chapel"),
    "utility": ("utility", "laundry", "storage", "closet", "store", "cellar", "attic", "garage", "workshop", "mudroom"),
    "living": ("living", "lounge", "sitting", "parlor", "parlour", "drawing", "salon", "family", "sunroom", "conservatory",
               "music", "exedra", "media", "veranda", "room"),
}  # fmt: skip


def room_type(name: str) -> str:
    """Type of the room called `name`: a key of ROOM_WORDS, or "other" where no word tells."""
    words = set(re.findall(r"[a-z]+", name.lower().replace("_", " ")))
    return next((kind for kind, known in ROOM_WORDS.items() if words.intersection(known)), "other")
