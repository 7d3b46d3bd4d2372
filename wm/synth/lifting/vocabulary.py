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
    "pool": (3.2, 2.2, 0.55), "sauna bench": (2.0, 1.15, 0.95), "sauna stove": (0.7, 0.7, 0.95), "fish tank": (1.5, 0.5, 1.45),
    "boiler": (1.1, 0.95, 2.1), "filing cabinet": (0.48, 0.6, 1.34), "lockers": (1.6, 0.5, 1.85),
    "server rack": (0.68, 0.95, 2.0), "display case": (1.3, 0.6, 1.35), "safe": (0.8, 0.7, 1.2),
    "arcade machine": (0.68, 0.82, 1.8), "pew": (2.2, 0.62, 1.02), "throne": (1.15, 1.05, 2.1), "cot": (1.32, 0.72, 1.0),
    "changing table": (1.0, 0.56, 1.06), "toy box": (0.9, 0.5, 0.7), "play mat": (1.9, 1.6, 0.008),
    "rocking horse": (0.42, 1.0, 0.9), "bunk bed": (2.08, 1.0, 1.7), "cinema seats": (2.42, 0.95, 1.1),
    "wall screen": (2.6, 0.08, 1.4), "hospital bed": (1.02, 2.12, 1.1), "examination table": (0.72, 1.9, 1.15),
    "drip stand": (0.56, 0.56, 1.95), "barber chair": (0.7, 1.15, 1.28), "bar counter": (2.4, 0.72, 1.38),
    "bar stool": (0.4, 0.4, 0.78), "shop counter": (1.7, 0.66, 1.28), "cake counter": (1.7, 0.76, 1.3),
    "billiard table": (2.5, 1.4, 0.86), "tennis table": (2.5, 1.4, 0.92), "dartboard": (0.46, 0.16, 0.46),
    "car": (1.72, 3.9, 1.5), "bicycle": (1.7, 0.52, 1.05), "pile of tyres": (0.64, 0.64, 0.8), "workbench": (1.9, 0.72, 1.7),
    "anvil": (0.8, 0.52, 0.88), "treadmill": (0.84, 1.75, 1.42), "exercise bike": (0.56, 1.15, 1.25),
    "weight bench": (1.7, 1.45, 1.3), "dumbbell rack": (1.6, 0.56, 0.92), "punching bag": (0.7, 0.9, 1.95),
    "yoga mat": (0.68, 1.85, 0.008), "coat rack": (0.54, 0.54, 1.8), "umbrella stand": (0.26, 0.26, 0.9),
    "washing machine": (0.62, 0.64, 0.88), "ironing board": (1.35, 0.4, 1.06), "drying rack": (1.2, 0.56, 1.0),
    "piano": (1.5, 0.62, 1.28), "drum kit": (1.6, 1.25, 1.3), "music stand": (0.52, 0.52, 1.3), "deck chair": (0.64, 1.1, 0.95),
    "railing planter": (1.4, 0.34, 1.2), "potting bench": (1.7, 0.64, 1.45), "fountain": (1.5, 1.5, 1.6),
    "pupil desk": (0.76, 0.54, 0.76), "blackboard": (2.6, 0.14, 1.2), "easel": (0.8, 0.8, 1.85), "lab bench": (2.0, 0.76, 1.32),
    "telescope": (0.95, 1.4, 1.75), "larder shelf": (1.2, 0.4, 2.0), "shop shelf": (1.3, 0.5, 1.7),
    "bottle shelf": (1.8, 0.36, 2.1), "storage rack": (1.4, 0.5, 1.9), "clothes rack": (1.5, 0.54, 1.75),
    "shoe rack": (0.95, 0.32, 0.52), "weapon rack": (1.4, 0.36, 2.0), "horse stall": (2.4, 2.5, 2.1),
    "hay bale": (1.0, 0.5, 0.46), "trough": (1.4, 0.5, 0.6), "barrel": (0.72, 0.95, 0.86),
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
