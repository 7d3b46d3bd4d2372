"""The furniture that rooms of a sort usually have, in words that a segmentation model understands.

Text-prompted segmentation looks for these where no language model names anything better, and wm.annotation suggests them. Rooms
of other sorts are looked through for what rooms in general have.
"""

from wm.geometry.placement.support import is_structure
from wm.synth.room_names import room_sort

IN_ALL_ROOMS = (
    "chair", "table", "cabinet", "bookshelf", "floor lamp", "chandelier", "rug", "curtains", "picture", "mirror", "plant", "vase",
)  # fmt: skip
"""What is looked for in every room, after what its sort usually has."""
_SEATING = ("sofa", "armchair", "coffee table", "side table", "ottoman", "bookshelf", "fireplace", "television", "media bench")
_DINING = ("dining table", "dining chair", "sideboard", "pendant lamp", "tableware")
_COOKING = ("kitchen counter", "kitchen island", "stove", "fridge", "range hood", "wall cupboard", "bar stool", "sink")
_SLEEPING = ("bed", "nightstand", "wardrobe", "dresser", "bench", "table lamp")
_WASHING = ("washbasin", "toilet", "bathtub", "shower", "towel rail", "bath mat")
_WORKING = ("desk", "office chair", "bookshelf", "filing cabinet", "computer monitor", "desk lamp")
_ENTERING = ("console table", "coat rack", "bench", "umbrella stand", "wall sconce")
_SHOWING = ("statue", "column", "display case", "bench", "wall sconce")
_SACRED = ("altar table", "pew", "candelabra", "candles", "lectern", "statue", "tapestry")
_STORING = ("storage rack", "chest", "barrel", "basket", "toy box")
_MAKING = ("workbench", "stool", "storage rack", "anvil", "barrel")
_MOVING = ("treadmill", "exercise bike", "weight bench", "dumbbell rack", "punching bag", "yoga mat")
_PLAYING = ("billiard table", "tennis table", "arcade machine", "sofa", "bar stool", "dartboard")
_SERVING = ("bar counter", "bar stool", "bottle shelf", "dining table", "dining chair", "shop counter")
_SMALL_CHILDREN = ("cot", "bunk bed", "changing table", "toy box", "play mat", "rocking horse", "desk", "wardrobe")
_CARING = ("hospital bed", "examination table", "drip stand", "desk", "cabinet")
_GROWING = ("planter", "potting bench", "topiary", "fountain", "bench", "deck chair")
_LEARNING = ("desk", "blackboard", "chair", "lab bench", "globe", "bookshelf", "easel")
_BY_SORT: dict[str, tuple[str, ...]] = {
    **dict.fromkeys(("living", "leisure", "tea room", "conservatory", "reception", "aquarium"), _SEATING),
    **dict.fromkeys(("dining",), _DINING), **dict.fromkeys(("kitchen", "pantry", "bakery"), (*_COOKING, *_DINING)),
    **dict.fromkeys(("bedroom", "dormitory", "cell"), _SLEEPING),
    **dict.fromkeys(("nursery", "kids", "playroom"), _SMALL_CHILDREN),
    **dict.fromkeys(("bathroom", "wc"), _WASHING), **dict.fromkeys(("study", "office", "meeting", "control room"), _WORKING),
    **dict.fromkeys(("library",), (*_WORKING, "armchair", "globe", "lectern", "pile of books")),
    **dict.fromkeys(("hall", "entrance", "corridor", "cloakroom"), _ENTERING),
    **dict.fromkeys(("great hall", "throne room", "ballroom"), (*_DINING, "throne", "bench", "suit of armour", "tapestry")),
    **dict.fromkeys(("gallery", "museum", "atrium"), _SHOWING), **dict.fromkeys(("chapel", "crypt"), _SACRED),
    **dict.fromkeys(("storage", "cellar", "vault"), (*_STORING, "safe", "bottle shelf")),
    **dict.fromkeys(("closet", "changing room"), ("wardrobe", "lockers", "clothes rack", "shoe rack", "bench")),
    **dict.fromkeys(("workshop", "forge", "garage", "boiler room"), (*_MAKING, "car", "bicycle", "boiler")),
    **dict.fromkeys(("armoury",), ("weapon rack", "suit of armour", "chest", "bench")),
    **dict.fromkeys(("gym", "yoga", "dance"), _MOVING), **dict.fromkeys(("games", "billiard"), _PLAYING),
    **dict.fromkeys(("restaurant", "bar", "shop"), (*_SERVING, "shop shelf", "display case")),
    **dict.fromkeys(("hospital", "surgery"), _CARING), **dict.fromkeys(("garden", "greenhouse", "balcony"), _GROWING),
    **dict.fromkeys(("classroom", "laboratory", "observatory", "studio", "atelier"), (*_LEARNING, "telescope")),
    **dict.fromkeys(("laundry", "service"), ("washing machine", "ironing board", "drying rack", "basket", "washbasin")),
    **dict.fromkeys(("sauna", "pool"), ("sauna bench", "sauna stove", "pool", "deck chair", "shower")),
    "music": ("piano", "drum kit", "music stand", "stool", "armchair"), "cinema": ("cinema seats", "wall screen", "sofa"),
    "server room": ("server rack", "desk", "office chair"), "barber": ("barber chair", "mirror", "washbasin", "bench"),
    "stable": ("horse stall", "hay bale", "trough", "barrel"),
}  # fmt: skip


def usual_things(room: str) -> tuple[str, ...]:
    """What usually stands in a room of this name: first what its sort has, then what all rooms have, each once."""
    return tuple(dict.fromkeys((*_BY_SORT.get(room_sort(room), ()), *IN_ALL_ROOMS)))


def searchable(names: list[str], *, most: int, longest: int = 60) -> list[str]:
    """Names that a segmentation model can look for: lower case, each once, without parts of the building, the first `most`.

    Args:
      names: as a language model or a user wrote them.
      longest: characters from which a name is a sentence, and left out.
    """
    plain = (" ".join(name.lower().split()).strip(" .,;:\"'-*") for name in names)
    return list(dict.fromkeys(name for name in plain if 0 < len(name) <= longest and not is_structure(name)))[:most]
