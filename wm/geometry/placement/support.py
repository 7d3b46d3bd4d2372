"""What a thing rests on, told by the words of its label: the floor, a wall, the ceiling, another thing, or flat on the floor.

Words are compared whole, so that a "large indoor plant" is no door. The last word names the thing ("tv stand" is a stand), the
words before it say which ("floor lamp", "wall clock"); of "X of Y" it is X that is meant ("painting of flowers"), unless X only
counts ("pile of books"). Where no word tells, the shape does.
Source: WorldMesh, supplement, "Object Placement" (class from label and aspect ratio); the vocabulary and its rules are ours.
"""

import re
from collections.abc import Sequence

_MODIFIERS = {
    "floor": "floor", "standing": "floor", "freestanding": "floor", "wall": "wall", "mounted": "wall", "ceiling": "ceiling",
    "pendant": "ceiling", "hanging": "ceiling",
}  # fmt: skip
_NOUNS: dict[str, tuple[str, ...]] = {
    "flat": ("rug", "carpet", "mat", "bathmat", "doormat", "runner"),
    "wall": (
        "picture", "painting", "poster", "mirror", "curtain", "drape", "tapestry", "sconce", "cupboard", "hood", "rail",
        "artwork", "banner", "blind", "print", "blackboard", "dartboard",
    ),
    "ceiling": ("chandelier", "pendant", "fan"),
    "object": (
        "vase", "bowl", "book", "candle", "candlestick", "flower", "bouquet", "tableware", "television", "tv", "monitor",
        "laptop", "cup", "mug", "plate", "bottle", "jar", "tray", "figurine", "pillow", "cushion", "lantern",
    ),
    "floor": (
        "stand", "table", "chair", "armchair", "sofa", "couch", "bed", "bench", "stool", "ottoman", "desk", "shelf", "bookshelf",
        "cabinet", "wardrobe", "dresser", "nightstand", "sideboard", "chest", "basket", "lamp", "candelabra", "plant", "tree",
        "statue", "column", "globe", "fireplace", "counter", "island", "fridge", "refrigerator", "stove", "oven", "bathtub",
        "tub", "toilet", "washbasin", "sink", "shower", "screen", "lectern", "piano", "clock", "armour", "bookcase", "console",
        "orrery", "sculpture", "topiary", "planter",
    ),
}  # fmt: skip
_SUPPORT = {noun: support for support, nouns in _NOUNS.items() for noun in nouns}
_STRUCTURE = frozenset(
    ("wall", "floor", "ceiling", "door", "doorway", "window", "archway", "passage", "skirting", "baseboard", "room")
)
_ON_TABLES = frozenset(("table", "desk", "potted", "small", "tabletop"))
_COUNTS = frozenset(
    ("pile", "stack", "heap", "set", "pair", "couple", "bunch", "bundle", "group", "cluster", "row", "collection", "suit")
)
"""Words before an "of" that say how many, and not what."""
_F_PLURALS = {"shelves": "shelf", "leaves": "leaf", "knives": "knife", "scarves": "scarf", "halves": "half", "loaves": "loaf"}
"""Ends of plurals in -ves whose singular is not in -ve: stoves and sleeves are the rule."""
_COVERS_WINDOWS = frozenset(("curtain", "drape", "blind"))
_FLAT_SHARE = 0.04
"""Height over the smaller side of the footprint below which a thing without a telling word lies flat."""
_THIN_SHARE = 0.15
"""Depth over height below which such a thing hangs on a wall, if it is above the floor."""
_RAISED = 0.35
"""Metres above the floor from which such a thing is held by something."""
_SMALL_PLANT = 0.6
"""Metres of height below which a plant stands on furniture, if it is above the floor."""


def singular_words(label: str) -> list[str]:
    """The words of a label in lower case and singular: "Two Flower-pots" gives two, flower, pot."""
    return [_singular(word) for word in _words(label)]


def naming_words(label: str) -> list[str]:
    """The words that name the thing, in lower case and singular: picture of "a picture of a window", book of "pile of books"."""
    return [_singular(word) for word in _naming(_words(label))]


def support_of(label: str, size: Sequence[float], low: float = 0.0) -> str:
    """What a thing rests on: floor, flat, wall, ceiling or object.

    Args:
      label: what a person would call it.
      size: its width, depth and height, metres; used where the label does not tell.
      low: height of its lowest point above the floor as it was seen, metres.
    """
    words = naming_words(label)
    named = [_MODIFIERS[word] for word in words[:-1] if word in _MODIFIERS]
    if named:
        return named[0]
    if words and words[-1] in ("lamp", "plant", "clock", "lantern") and _ON_TABLES.intersection(words[:-1]):
        return "object"
    if words and words[-1] == "plant" and float(size[2]) < _SMALL_PLANT and low > _RAISED:
        return "object"
    if words and words[-1] in _SUPPORT:
        return _SUPPORT[words[-1]]
    return _support_by_shape(size, low)


def is_structure(label: str) -> bool:
    """Whether a label names a part of the building: "wooden door", not "floor lamp" and not "photo of a door"."""
    words = naming_words(label)
    return bool(words) and words[-1] in _STRUCTURE


def is_plural(label: str) -> bool:
    """Whether a label names several things that go as one: "curtains", "pile of books", not "vase of flowers"."""
    last = _naming(_words(label))[-1:]
    return bool(last) and _singular(last[0]) != last[0]


def covers_windows(label: str) -> bool:
    """Whether a thing belongs before windows."""
    return bool(_COVERS_WINDOWS.intersection(singular_words(label)))


def _support_by_shape(size: Sequence[float], low: float) -> str:
    width, depth, height = (float(side) for side in size)
    if height < _FLAT_SHARE * min(width, depth) and low < _RAISED:
        return "flat"
    if low > _RAISED:
        return "wall" if min(width, depth) < _THIN_SHARE * height else "object"
    return "floor"


def _words(label: str) -> list[str]:
    return re.findall(r"[a-z]+", label.lower())


def _naming(words: list[str]) -> list[str]:
    """Of words with "of" among them, those before it, or those behind it where the one before it only counts."""
    while "of" in words[1:]:
        k = words.index("of", 1)
        counts = _singular(words[k - 1]) in _COUNTS and k + 1 < len(words)
        words = words[k + 1 :] if counts else words[:k]
    return words


def _singular(word: str) -> str:
    for plural, singular in _F_PLURALS.items():
        if word.endswith(plural):
            return word.removesuffix(plural) + singular
    if word.endswith("ies") and len(word) > 4:  # tapestries, and not ties
        return word[:-3] + "y"
    if word.endswith(("ches", "shes", "xes", "sses")):
        return word[:-2]
    if word.endswith("s") and not word.endswith("ss"):
        return word[:-1]
    return word
