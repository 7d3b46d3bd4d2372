"""What the labels of segments name, and how large such things usually are.

Labels come from any segmenter, in any words. Two labels name things of one sort if `sort_of` returns the same for both.
wm.geometry.placement.support decides which words of a label name the thing, and what such a thing rests on.
"""

import numpy as np
from jaxtyping import Float

from wm.geometry.placement.support import naming_words

LARGEST: dict[str, tuple[float, float, float]] = {
    "armchair": (0.92, 0.9, 1.05), "sofa": (2.2, 0.95, 0.95), "chair": (0.48, 0.52, 1.02), "office chair": (0.66, 0.66, 1.12),
    "stool": (0.4, 0.4, 0.5), "ottoman": (0.7, 0.55, 0.44), "bench": (1.4, 0.45, 0.48), "dining table": (2.2, 1.0, 0.77),
    "round table": (1.15, 1.15, 0.76), "coffee table": (1.2, 0.65, 0.44), "side table": (0.52, 0.52, 0.6),
    "console table": (1.3, 0.38, 0.88), "desk": (1.6, 0.72, 0.78), "nightstand": (0.5, 0.42, 0.58),
    "kitchen island": (1.6, 0.85, 0.92), "altar table": (1.7, 0.6, 0.95), "bed": (1.85, 2.15, 1.35),
    "single bed": (1.05, 2.1, 1.2), "four-poster bed": (1.95, 2.3, 2.25), "wardrobe": (1.7, 0.62, 2.15),
    "bookshelf": (1.5, 0.36, 2.2), "dresser": (1.25, 0.5, 0.9), "sideboard": (1.8, 0.46, 0.86), "media bench": (1.8, 0.44, 0.5),
    "chest": (1.05, 0.52, 0.58), "blanket chest": (1.3, 0.48, 0.5), "wall shelf": (1.1, 0.24, 0.42),
    "basket": (0.46, 0.46, 0.48), "floor lamp": (0.48, 0.48, 1.7), "candelabra": (0.5, 0.5, 1.7),
    "table lamp": (0.32, 0.32, 0.52), "candles": (0.22, 0.22, 0.26), "chandelier": (0.95, 0.95, 0.85),
    "pendant lamp": (0.5, 0.5, 0.8), "wall sconce": (0.18, 0.24, 0.38), "rug": (2.8, 2.0, 0.008),
    "round rug": (2.2, 2.2, 0.008), "bath mat": (0.8, 0.5, 0.008), "curtains": (2.6, 0.1, 2.6), "tapestry": (1.1, 0.036, 1.6),
    "picture": (0.9, 0.045, 0.7), "mirror": (0.7, 0.045, 1.1), "wall clock": (0.42, 0.04, 0.42), "fireplace": (1.7, 0.5, 1.3),
    "grandfather clock": (0.54, 0.32, 2.15), "folding screen": (1.6, 0.36, 1.8), "topiary": (0.54, 0.54, 1.5),
    "planter": (1.1, 0.38, 0.95), "wall ivy": (1.0, 0.22, 2.0), "plant": (0.75, 0.75, 1.5), "flowers": (0.26, 0.26, 0.44),
    "potted plant": (0.3, 0.3, 0.36), "statue": (0.54, 0.54, 1.85), "column": (0.42, 0.42, 1.6), "globe": (0.54, 0.54, 1.0),
    "suit of armour": (0.68, 0.55, 1.9), "lectern": (0.56, 0.46, 1.25), "chess piece": (0.55, 0.55, 1.6),
    "giant mushroom": (0.8, 0.8, 1.4), "vase": (0.2, 0.2, 0.32), "bowl": (0.3, 0.3, 0.16), "pile of books": (0.24, 0.3, 0.16),
    "open book": (0.36, 0.26, 0.04), "tableware": (0.34, 0.28, 0.09), "candlestick": (0.1, 0.1, 0.36),
    "television": (1.25, 0.24, 0.76), "computer monitor": (0.65, 0.46, 0.48), "kitchen counter": (1.6, 0.62, 0.92),
    "sink counter": (1.3, 0.62, 0.92), "stove": (0.66, 0.66, 0.92), "fridge": (0.72, 0.7, 1.85),
    "wall cupboard": (1.5, 0.36, 0.7), "range hood": (0.7, 0.48, 0.7), "bathtub": (1.75, 0.8, 0.62),
    "washbasin": (0.95, 0.5, 0.88), "toilet": (0.4, 0.7, 0.82), "shower": (0.95, 0.95, 2.05), "towel rail": (0.65, 0.12, 0.6),
    "wall gears": (1.3, 0.12, 1.0), "skeleton wall clock": (1.15, 0.12, 1.15), "wall pipes": (0.8, 0.2, 1.9),
    "orrery": (0.9, 0.9, 1.5), "gear sculpture": (0.95, 0.4, 1.7),
}  # fmt: skip
"""Width, depth and height in metres of the largest thing of each sort that homes usually have."""
UNKNOWN = (1.8, 0.95, 1.9)
"""The same for a thing of another sort. Nine tenths of the sorts that stand on the floor are no larger along any of the three."""
SYNONYMS = {
    "couch": "sofa", "settee": "sofa", "loveseat": "sofa", "carpet": "rug", "painting": "picture", "poster": "picture",
    "artwork": "picture", "drape": "curtains", "curtain": "curtains", "tv": "television", "refrigerator": "fridge",
    "bookcase": "bookshelf", "cupboard": "wardrobe", "closet": "wardrobe", "tub": "bathtub", "sink": "washbasin",
    "oven": "stove", "cooker": "stove", "monitor": "computer monitor", "lamp": "floor lamp", "table": "dining table",
    "cabinet": "sideboard", "tree": "plant", "mat": "bath mat", "pouffe": "ottoman", "book": "pile of books",
    "candle": "candles", "flower": "flowers", "bouquet": "flowers", "sconce": "wall sconce", "hood": "range hood",
    "stand": "media bench", "island": "kitchen island", "counter": "kitchen counter", "sculpture": "statue",
    "clock": "wall clock", "gear": "wall gears", "cog": "wall gears", "pipe": "wall pipes", "ivy": "wall ivy",
    "trellis": "wall ivy", "hedge": "topiary",
}  # fmt: skip
"""What else the sorts are called."""
_BY_WORDS = {tuple(naming_words(name)): sort for name, sort in (SYNONYMS | {sort: sort for sort in LARGEST}).items()}


def sort_of(label: str) -> str:
    """The sort of thing that a label names, by whole words.

    Returns:
      A key of LARGEST: the one whose name or synonym the label ends with, the longest if there are several. Of a label that names
      none of them its last naming word, so that a "striped zebra" is of one sort with a "zebra"; the whole label if it has no
      Latin letters.
    """
    words = tuple(naming_words(label))
    for start in range(len(words)):
        if words[start:] in _BY_WORDS:
            return _BY_WORDS[words[start:]]
    return words[-1] if words else label.strip()


def largest_size(label: str) -> Float[np.ndarray, "3"]:
    """Width, depth and height in metres of the largest usual thing that a label may name."""
    return np.array(LARGEST.get(sort_of(label), UNKNOWN))
