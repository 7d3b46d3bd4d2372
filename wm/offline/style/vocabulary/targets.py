"""What a colour or a material may be asked for: surfaces, slots of furniture, and kinds of furniture."""

import dataclasses

SOFT: tuple[str, ...] = ("fabric", "velvet", "leather")
WOODEN: tuple[str, ...] = ("wood", "dark_wood", "light_wood", "panel_wood", "painted_wood", "lacquer")


@dataclasses.dataclass(frozen=True)
class Target:
    """What a noun of a theme stands for: one of a surface, slots everywhere, or kinds of furniture."""

    surface: str = ""  # field of finish.Surfaces
    slots: tuple[str, ...] = ()  # slots of all furniture
    kinds: tuple[str, ...] = ()  # labels of pieces, of which `slots` change where they have them; they may be left out too


TARGETS: dict[str, Target] = {
    "wall": Target(surface="wall"),
    "floor": Target(surface="floor"),
    "ceiling": Target(surface="ceiling"),
    "trim": Target(surface="trim"),
    "panel": Target(surface="wall"),
    "sofa": Target(kinds=("sofa",), slots=SOFT),
    "armchair": Target(kinds=("armchair",), slots=SOFT),
    "chair": Target(kinds=("chair", "office chair"), slots=(*SOFT, *WOODEN)),
    "stool": Target(kinds=("stool", "ottoman"), slots=(*SOFT, *WOODEN)),
    "bench": Target(kinds=("bench", "media bench"), slots=(*SOFT, *WOODEN)),
    "seat": Target(kinds=("sofa", "armchair", "chair", "office chair", "stool", "bench", "ottoman"), slots=SOFT),
    "bed": Target(kinds=("bed", "single bed", "four-poster bed"), slots=("blanket", *SOFT)),
    "table": Target(
        kinds=("dining table", "coffee table", "side table", "console table", "round table", "altar table"),
        slots=(*WOODEN, "marble", "stone", "glass"),
    ),
    "desk": Target(kinds=("desk",), slots=WOODEN),
    "wardrobe": Target(kinds=("wardrobe",), slots=WOODEN),
    "dresser": Target(kinds=("dresser", "nightstand"), slots=WOODEN),
    "chest": Target(kinds=("chest", "blanket chest"), slots=WOODEN),
    "cupboard": Target(
        kinds=("sideboard", "wall cupboard", "kitchen counter", "kitchen island", "sink counter", "wardrobe", "dresser"),
        slots=WOODEN,
    ),
    "counter": Target(kinds=("kitchen counter", "kitchen island", "sink counter"), slots=WOODEN),
    "shelf": Target(kinds=("bookshelf", "wall shelf"), slots=WOODEN),
    "bathtub": Target(kinds=("bathtub",), slots=("ceramic",)),
    "fridge": Target(kinds=("fridge",), slots=("appliance", "painted_wood", "metal")),
    "stove": Target(kinds=("stove",), slots=("appliance", "dark_metal", "metal")),
    "fireplace": Target(kinds=("fireplace",), slots=("stone", "marble", *WOODEN)),
    "rug": Target(kinds=("rug", "round rug", "bath mat"), slots=("rug", "rug_border")),
    "curtain": Target(kinds=("curtains",), slots=("curtain",)),
    "picture": Target(kinds=("picture",), slots=()),
    "tapestry": Target(kinds=("tapestry",), slots=SOFT),
    "clock": Target(kinds=("wall clock", "grandfather clock", "skeleton wall clock"), slots=WOODEN),
    "plant": Target(kinds=("plant", "potted plant", "planter", "topiary", "wall ivy"), slots=("leaf", "foliage")),
    "flower": Target(kinds=("flowers",), slots=("flower",)),
    "statue": Target(kinds=("statue", "column"), slots=("marble", "stone")),
    "candle": Target(kinds=("candles", "candlestick", "candelabra"), slots=("wax",)),
    "mushroom": Target(kinds=("giant mushroom",), slots=()),
    "vase": Target(kinds=("vase",), slots=("ceramic", "terracotta")),
    "book": Target(kinds=("pile of books", "open book"), slots=()),
    "mirror": Target(kinds=("mirror",), slots=("mirror",)),
    "cushion": Target(slots=("pillow", "fabric_accent")),
    "blanket": Target(slots=("blanket",)),
    "sheet": Target(slots=("linen", "pillow")),
    "textile": Target(slots=(*SOFT, "fabric_accent", "curtain", "blanket")),
    "upholstery": Target(slots=SOFT),
    "lamp": Target(slots=("lamp_shade",)),
    "furniture": Target(slots=WOODEN),
    "wood": Target(slots=("wood", "dark_wood", "light_wood", "panel_wood")),
    "metal": Target(slots=("metal", "dark_metal", "brass", "chrome")),
    "tile": Target(slots=("tile",)),
    "glass": Target(slots=("glass",)),
    "woven": Target(slots=("woven",)),
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
