"""What a colour or a material may be asked for: surfaces, slots of furniture, and kinds of furniture."""

import dataclasses

SOFT: tuple[str, ...] = ("fabric", "velvet", "leather")
WOODEN: tuple[str, ...] = ("wood", "dark_wood", "light_wood", "panel_wood", "painted_wood", "lacquer")


@dataclasses.dataclass(frozen=True)
class WordTarget:
    """What a noun of a theme stands for: one of a surface, slots everywhere, or kinds of furniture."""

    surface: str = ""  # field of finish.Surfaces
    slots: tuple[str, ...] = ()  # slots of all furniture
    kinds: tuple[str, ...] = ()  # labels of pieces, of which `slots` change where they have them; they may be left out too


TARGETS: dict[str, WordTarget] = {
    "wall": WordTarget(surface="wall"),
    "floor": WordTarget(surface="floor"),
    "ceiling": WordTarget(surface="ceiling"),
    "trim": WordTarget(surface="trim"),
    "panel": WordTarget(surface="wall"),
    "sofa": WordTarget(kinds=("sofa",), slots=SOFT),
    "armchair": WordTarget(kinds=("armchair",), slots=SOFT),
    "chair": WordTarget(kinds=("chair", "office chair"), slots=(*SOFT, *WOODEN)),
    "stool": WordTarget(kinds=("stool", "ottoman"), slots=(*SOFT, *WOODEN)),
    "bench": WordTarget(kinds=("bench", "media bench"), slots=(*SOFT, *WOODEN)),
    "seat": WordTarget(kinds=("sofa", "armchair", "chair", "office chair", "stool", "bench", "ottoman"), slots=SOFT),
    "bed": WordTarget(kinds=("bed", "single bed", "four-poster bed"), slots=("blanket", *SOFT)),
    "table": WordTarget(
        kinds=("dining table", "coffee table", "side table", "console table", "round table", "altar table"),
        slots=(*WOODEN, "marble", "stone", "glass"),
    ),
    "desk": WordTarget(kinds=("desk",), slots=WOODEN),
    "wardrobe": WordTarget(kinds=("wardrobe",), slots=WOODEN),
    "dresser": WordTarget(kinds=("dresser", "nightstand"), slots=WOODEN),
    "chest": WordTarget(kinds=("chest", "blanket chest"), slots=WOODEN),
    "cupboard": WordTarget(
        kinds=("sideboard", "wall cupboard", "kitchen counter", "kitchen island", "sink counter", "wardrobe", "dresser"),
        slots=WOODEN,
    ),
    "counter": WordTarget(kinds=("kitchen counter", "kitchen island", "sink counter"), slots=WOODEN),
    "shelf": WordTarget(kinds=("bookshelf", "wall shelf"), slots=WOODEN),
    "bathtub": WordTarget(kinds=("bathtub",), slots=("ceramic",)),
    "fridge": WordTarget(kinds=("fridge",), slots=("appliance", "painted_wood", "metal")),
    "stove": WordTarget(kinds=("stove",), slots=("appliance", "dark_metal", "metal")),
    "fireplace": WordTarget(kinds=("fireplace",), slots=("stone", "marble", *WOODEN)),
    "rug": WordTarget(kinds=("rug", "round rug", "bath mat"), slots=("rug", "rug_border")),
    "curtain": WordTarget(kinds=("curtains",), slots=("curtain",)),
    "picture": WordTarget(kinds=("picture",), slots=()),
    "tapestry": WordTarget(kinds=("tapestry",), slots=SOFT),
    "clock": WordTarget(kinds=("wall clock", "grandfather clock", "skeleton wall clock"), slots=WOODEN),
    "plant": WordTarget(kinds=("plant", "potted plant", "planter", "topiary", "wall ivy"), slots=("leaf", "foliage")),
    "flower": WordTarget(kinds=("flowers",), slots=("flower",)),
    "statue": WordTarget(kinds=("statue", "column"), slots=("marble", "stone")),
    "candle": WordTarget(kinds=("candles", "candlestick", "candelabra"), slots=("wax",)),
    "mushroom": WordTarget(kinds=("giant mushroom",), slots=()),
    "vase": WordTarget(kinds=("vase",), slots=("ceramic", "terracotta")),
    "book": WordTarget(kinds=("pile of books", "open book"), slots=()),
    "mirror": WordTarget(kinds=("mirror",), slots=("mirror",)),
    "cushion": WordTarget(slots=("pillow", "fabric_accent")),
    "blanket": WordTarget(slots=("blanket",)),
    "sheet": WordTarget(slots=("linen", "pillow")),
    "textile": WordTarget(slots=(*SOFT, "fabric_accent", "curtain", "blanket")),
    "upholstery": WordTarget(slots=SOFT),
    "lamp": WordTarget(slots=("lamp_shade",)),
    "furniture": WordTarget(slots=WOODEN),
    "wood": WordTarget(slots=("wood", "dark_wood", "light_wood", "panel_wood")),
    "metal": WordTarget(slots=("metal", "dark_metal", "brass", "chrome")),
    "tile": WordTarget(slots=("tile",)),
    "glass": WordTarget(slots=("glass",)),
    "woven": WordTarget(slots=("woven",)),
}

TARGET_SYNONYMS: dict[str, str] = {
    "walling": "wall", "flooring": "floor", "floorboard": "floor", "ground": "floor", "roof": "ceiling", "vault": "ceiling",
    "skirting": "trim", "moulding": "trim", "molding": "trim", "frame": "trim", "doorframe": "trim", "cornice": "trim",
    "beam": "trim", "panel": "panel", "cladding": "panel", "board": "panel",
    "couch": "sofa", "settee": "sofa", "loveseat": "sofa", "divan": "sofa", "chesterfield": "sofa", "chaise": "sofa",
    "recliner": "armchair", "throne": "armchair", "seating": "seat", "barstool": "stool", "pouf": "stool", "pew": "bench",
    "bunk": "bed", "bedspread": "blanket", "duvet": "blanket", "quilt": "blanket", "throw": "blanket", "bedding": "sheet",
    "linens": "sheet", "pillow": "cushion", "fabric": "textile", "cloth": "textile", "drapery": "curtain", "drape": "curtain",
    "blind": "curtain", "closet": "wardrobe", "armoire": "wardrobe", "nightstand": "dresser", "drawers": "dresser",
    "trunk": "chest", "cabinet": "cupboard", "cabinetry": "cupboard", "sideboard": "cupboard", "worktop": "counter",
    "countertop": "counter", "bookshelf": "shelf", "bookcase": "shelf", "shelving": "shelf", "tub": "bathtub",
    "refrigerator": "fridge", "oven": "stove", "cooker": "stove", "hearth": "fireplace", "mantel": "fireplace", "mat": "rug",
    "painting": "picture", "poster": "picture", "portrait": "picture", "artwork": "picture", "houseplant": "plant",
    "fern-pot": "plant", "greenery": "plant", "foliage": "plant", "sculpture": "statue", "bust": "statue", "column": "statue",
    "candlestick": "candle", "candelabra": "candle", "lantern": "lamp", "lampshade": "lamp", "chandelier": "lamp",
    "sconce": "lamp", "bulb": "lamp", "lighting": "lamp", "furnishing": "furniture", "woodwork": "wood", "fitting": "metal",
    "fixture": "metal", "ceramics": "vase", "pottery": "vase", "toadstool": "mushroom",
    "chequer": "tile", "desktop": "desk",
}  # fmt: skip
