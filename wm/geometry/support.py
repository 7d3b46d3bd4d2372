"""What a thing rests on, told by the words of its label: the floor, a wall, the ceiling, another thing, or flat on the floor.

Words are compared whole, so that a "large indoor plant" is no door. The last word names the thing ("tv stand" is a stand), the
words before it say which ("floor lamp", "wall clock"); where no word tells, the shape does.
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
        "artwork", "banner", "blind", "print",
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
_ON_TABLES = frozenset(("table", "desk", "potted", "small", "tabletop", "pile", "stack"))
_COVERS_WINDOWS = frozenset(("curtain", "drape", "blind"))
_FLAT_SHARE = 0.04
"""Height over the smaller side of the footprint below which a thing without a telling word lies flat."""
_THIN_SHARE = 0.15
"""Depth over height below which such a thing hangs on a wall, if it is above the floor."""
_RAISED = 0.35
"""Metres above the floor from which such a thing is held by something."""
_SMALL_PLANT = 0.6
"""Metres of height below which a plant stands on furniture, if it is above the floor."""


def words_of(label: str) -> list[str]:
    """The words of a label in lower case and singular: "Two Flower-pots" gives two, flower, pot."""
    return [_singular(word) for word in re.findall(r"[a-z]+", label.lower())]


def support_of(label: str, size: Sequence[float], low: float = 0.0) -> str:
    """What a thing rests on: floor, flat, wall, ceiling or object.

    Args:
      label: what a person would call it.
      size: its width, depth and height, metres; used where the label does not tell.
      low: height of its lowest point above the floor as it was seen, metres.
    """
    words = words_of(label)
    named = [_MODIFIERS[word] for word in words[:-1] if word in _MODIFIERS]
    if named:
        return named[0]
    if words and words[-1] in ("lamp", "plant", "clock", "lantern") and _ON_TABLES.intersection(words[:-1]):
        return "object"
    if words and words[-1] == "plant" and float(size[2]) < _SMALL_PLANT and low > _RAISED:
        return "object"
    if "of" in words[:-1]:  # a pile of books, a vase of flowers
        words = [word for word in words if word != "of"]
    if words and words[-1] in _SUPPORT:
        return _SUPPORT[words[-1]]
    return _support_by_shape(size, low)


def is_structure(label: str) -> bool:
    """Whether a label names a part of the building: "wooden door", not "floor lamp" and not "large indoor plant"."""
    words = words_of(label)
    return bool(words) and words[-1] in _STRUCTURE


def is_plural(label: str) -> bool:
    """Whether a label names several things that go as one: "curtains", "candles", "flowers"."""
    last = label.lower().split()[-1:]
    return bool(last) and _singular(last[0]) != last[0]


def covers_windows(label: str) -> bool:
    """Whether a thing belongs before windows."""
    return bool(_COVERS_WINDOWS.intersection(words_of(label)))


def _support_by_shape(size: Sequence[float], low: float) -> str:
    width, depth, height = (float(side) for side in size)
    if height < _FLAT_SHARE * min(width, depth) and low < _RAISED:
        return "flat"
    if low > _RAISED:
        return "wall" if min(width, depth) < _THIN_SHARE * height else "object"
    return "floor"


def _singular(word: str) -> str:
    if word.endswith("ves"):
        return word[:-3] + "f"
    if word.endswith("s") and not word.endswith("ss"):
        return word[:-1]
    return word
