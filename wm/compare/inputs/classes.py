"""SpatialGen's classes of things, by ours: the label and the colour that its semantic layouts have.

Colours are facts of its format (manycore-research/SpatialGen, src/utils/layout_utils.py, commit 677c1168); the words are ours.
"""

import re

Color = tuple[int, int, int]

WALL: Color = (120, 120, 120)
FLOOR: Color = (80, 50, 50)
CEILING: Color = (120, 120, 80)
WINDOW: Color = (230, 230, 230)
OTHER: tuple[str, Color] = ("other", (100, 85, 144))

_CLASSES: dict[str, tuple[str, Color]] = {
    "lamp|lantern|candle|candlestick|candelabra": ("street lamp", (0, 71, 255)),
    "nightstand|bedside|bedside table": ("nightstand", (146, 111, 194)),
    "coffee table|side table|dining table|table": ("coffee table", (0, 255, 112)),
    "armchair": ("armchair", (8, 255, 214)),
    "wardrobe|closet": ("wardrobe, closet, press", (7, 255, 255)),
    "chest|dresser|drawers": ("chest of drawers, chest, bureau, dresser", (6, 51, 255)),
    "sofa|couch|settee": ("sofa", (11, 102, 255)),
    "desk": ("desk", (10, 255, 71)),
    "stool|ottoman|pouf": ("stool", (0, 214, 255)),
    "bench|pew": ("bench", (194, 255, 0)),
    "chair|throne": ("swivel chair", (10, 0, 255)),
    "bathtub|tub": ("tub", (102, 8, 255)),
    "bed|cot": ("bed", (204, 5, 255)),
    "curtain|drape": ("curtain", (255, 51, 7)),
    "painting|picture|print|poster|tapestry": ("painting, picture", (255, 6, 51)),
    "rug|carpet|mat|runner": ("rug", (255, 9, 92)),
    "mirror": ("mirror", (220, 220, 220)),
    "column|pillar": ("column, pillar", (255, 8, 41)),
    "sideboard|counter|buffet|worktop": ("buffet, counter, sideboard", (255, 112, 0)),
    "bookcase|bookshelf|shelf|shelves|rack": ("shelf", (255, 7, 71)),
    "hood": ("hood, exhaust hood", (0, 153, 255)),
    "chandelier|pendant": ("chandelier", (0, 31, 255)),
    "sconce": ("sconce", (0, 41, 255)),
    "shower": ("shower", (0, 133, 255)),
    "toilet": ("toilet, can, commode, crapper, pot, potty, stool, throne", (0, 255, 133)),
    "sink|basin|washbasin": ("sink", (0, 163, 255)),
    "refrigerator|fridge": ("refrigerator, icebox", (20, 255, 0)),
    "dishwasher": ("dishwasher", (214, 255, 0)),
    "kitchen island|island": ("kitchen island", (0, 255, 41)),
    "plant|tree|fern": ("plant", (204, 255, 4)),
    "screen|television|tv|monitor": ("crt screen", (122, 0, 255)),
    "cabinet|cupboard": ("cabinet", (224, 5, 255)),
}
_PATTERNS = {re.compile(rf"\b(?:{words})s?\b"): told for words, told in _CLASSES.items()}


def class_of(label: str) -> tuple[str, Color]:
    """The class and the colour of a thing by its everyday name; OTHER where no class has it. The first row that fits counts."""
    return next((told for pattern, told in _PATTERNS.items() if pattern.search(label.lower())), OTHER)
