"""Names of materials: what surfaces and furniture look like in them, and what they are for where the theme does not say."""

import dataclasses


@dataclasses.dataclass(frozen=True)
class MaterialWord:
    """A material as themes name it. `wall`, `floor` and `slot` of "" mean that it is not used there."""

    sort: str  # what "no ..." of it takes away: one of SORTS
    codes: tuple[str, str, str]  # colours as the materials of finish.MATERIALS read them
    target: str  # key of targets.TARGETS that it is for where the theme does not say
    wall: str = ""  # material of finish.MATERIALS
    floor: str = ""
    scale: float = 0.3  # of the pattern on walls and floors, metres
    slot: str = ""  # furniture slot that shows it
    roughness: float = 0.6


SORTS: tuple[str, ...] = ("wood", "stone", "tile", "brick", "carpet", "cloth", "leather", "metal", "plastic", "paper", "plaster",
                          "glass", "ice", "earth")  # fmt: skip


def _wood(base: str, dark: str, grain: str, *, floor: str = "wood_planks", scale: float = 0.18) -> MaterialWord:
    return MaterialWord("wood", (base, dark, grain), "wood", "wood_planks", floor, scale, "wood", 0.5)


def _cloth(base: str, slot: str, target: str = "upholstery") -> MaterialWord:
    return MaterialWord("cloth", (base, base, base), target, "textile", "carpet", 0.01, slot, 0.9)


def _metal(base: str, slot: str = "metal", *, wall: str = "riveted") -> MaterialWord:
    return MaterialWord("metal", (base, "3a3c40", base), "metal", wall, "riveted", 0.9, slot, 0.35)


MATERIAL_WORDS: dict[str, MaterialWord] = {
    "wood": _wood("9a6b3f", "4a2e18", "7d5430"),
    "timber": _wood("96683a", "4a2e14", "7d5430", scale=0.22),
    "log": _wood("8a5c34", "3f2614", "6f4626", scale=0.26),
    "oak": _wood("b58a55", "6a4a28", "a0784a"),
    "pine": _wood("d2a566", "8a6234", "bd9052"),
    "birch": _wood("e0c79c", "a58a5c", "cdb288"),
    "ash-wood": _wood("d6c2a0", "9a8460", "c4ae8a"),
    "maple": _wood("d9b887", "94703f", "c7a472"),
    "beech": _wood("d8b083", "8f6a42", "c49c70"),
    "walnut": _wood("6b4529", "2e1a0e", "553520"),
    "mahogany": _wood("6a2f1f", "2f120b", "542417"),
    "rosewood": _wood("5a2a22", "280f0c", "46201a"),
    "teak": _wood("a06a34", "543416", "8a5828"),
    "cedar": _wood("a8623c", "5c301a", "904f2e"),
    "cherrywood": _wood("8f4a2c", "45200f", "783c22"),
    "ebony": _wood("2c2320", "0f0b0a", "231b18"),
    "bamboo": MaterialWord("wood", ("cdb06a", "7d6a34", "b89c58"), "wood", "panelling", "wood_planks", 0.08, "wood", 0.5),
    "driftwood": _wood("b5a58c", "7a6c56", "a3937a"),
    "plank": _wood("96683a", "4a2e14", "7d5430"),
    "parquet": MaterialWord("wood", ("96693f", "503418", "ab7c4e"), "floor", "panelling", "parquet", 0.4, "wood", 0.4),
    "herringbone": MaterialWord("wood", ("96693f", "503418", "ab7c4e"), "floor", "herringbone", "herringbone", 0.5, "wood", 0.4),
    "panelling": MaterialWord("wood", ("6b4528", "3a2414", "855a38"), "wall", "panelling", "wood_planks", 0.5,
        "panel_wood", 0.45),
    "plywood": _wood("dcbb86", "9a7a4a", "cba974", scale=0.6),
    "cork": MaterialWord("wood", ("b9854f", "7d5530", "b9854f"), "floor", "concrete", "concrete", 0.5, "wood", 0.9),
    "wicker": MaterialWord("wood", ("c29a62", "6a4a26", "c29a62"), "woven", "woven", "woven", 0.03, "woven", 0.8),
    "rope": MaterialWord("cloth", ("b89a68", "6a5230", "b89a68"), "woven", "woven", "woven", 0.04, "woven", 0.9),
    "straw": MaterialWord("cloth", ("d2b565", "8f7434", "d2b565"), "woven", "woven", "tatami", 0.05, "woven", 0.9),
    "tatami": MaterialWord("cloth", ("c9bd84", "3f4a36", "c9bd84"), "floor", "woven", "tatami", 0.9, "woven", 0.8),
    "brick": MaterialWord("brick", ("a05a44", "b8ab9a", "834936"), "wall", "brick", "brick", 0.24, "terracotta", 0.85),
    "stone": MaterialWord("stone", ("a09787", "6a6152", "877e6e"), "wall", "stone_blocks", "stone_tiles", 0.6, "stone", 0.75),
    "granite": MaterialWord("stone", ("77777a", "4a4a4c", "606062"), "floor", "stone_blocks", "stone_tiles", 0.6, "stone", 0.3),
    "slate": MaterialWord("stone", ("4f565c", "2f3438", "434a50"), "floor", "stone_tiles", "stone_tiles", 0.4, "stone", 0.5),
    "sandstone": MaterialWord("stone", ("d0ad78", "967647", "bd9a66"), "wall", "stone_blocks", "stone_tiles", 0.6, "stone", 0.8),
    "limestone": MaterialWord("stone", ("d6ccb4", "9f957e", "c4b99f"), "wall", "stone_blocks", "stone_tiles", 0.6, "stone", 0.7),
    "travertine": MaterialWord("stone", ("d8c8a8", "a5916f", "c6b492"), "floor", "stone_tiles", "stone_tiles", 0.6, "stone", 0.4),
    "cobblestone": MaterialWord("stone", ("857d72", "4f483f", "6f675c"), "floor", "stone_blocks", "stone_blocks", 0.22,
        "stone", 0.8),
    "flagstone": MaterialWord("stone", ("8f887b", "565047", "7a7266"), "floor", "stone_blocks", "stone_tiles", 0.7, "stone", 0.7),
    "rock": MaterialWord("stone", ("8a7a68", "4a3f34", "6b5d4e"), "wall", "rock", "rock", 1.0, "stone", 0.9),
    "marble": MaterialWord("stone", ("d3cabb", "8f8474", "b3a692"), "floor", "marble", "marble", 0.8, "marble", 0.15),
    "onyx": MaterialWord("stone", ("2c2a2a", "7a6a52", "4a4038"), "floor", "marble", "marble", 0.7, "marble", 0.1),
    "terrazzo": MaterialWord("stone", ("dcd6ca", "8a6a5a", "7f8f8a"), "floor", "mosaic", "mosaic", 0.03, "marble", 0.25),
    "concrete": MaterialWord("stone", ("a5a39e", "8a8883", "8a8883"), "floor", "concrete", "concrete", 1.2, "stone", 0.6),
    "cement": MaterialWord("stone", ("a09e98", "85837d", "85837d"), "floor", "concrete", "concrete", 1.2, "stone", 0.6),
    "terracotta": MaterialWord("tile", ("b8683f", "80583f", "a05838"), "floor", "terracotta", "terracotta", 0.3,
        "terracotta", 0.7),
    "mosaic": MaterialWord("tile", ("e0d6c0", "3f6a7a", "8a3f30"), "floor", "mosaic", "mosaic", 0.03, "tile", 0.3),
    "tile": MaterialWord("tile", ("e9e4d8", "9a968c", "d8d2c4"), "floor", "stone_tiles", "stone_tiles", 0.3, "tile", 0.2),
    "checkerboard": MaterialWord("tile", ("e9e4d8", "2a2a2c", "a09c92"), "floor", "checker_tiles", "checker_tiles",
        0.4, "tile", 0.2),
    "porcelain": MaterialWord("tile", ("f2f1ec", "c8ccd0", "e4e6e6"), "tile", "stone_tiles", "stone_tiles", 0.15,
        "ceramic", 0.15),
    "linoleum": MaterialWord("plastic", ("b9b39c", "a39d86", "aea892"), "floor", "stone_tiles", "stone_tiles", 1.5, "tile", 0.35),
    "plaster": MaterialWord("plaster", ("e0d3bd", "c9b89c", "c9b89c"), "wall", "plaster", "plaster", 1.0, "stone", 0.85),
    "stucco": MaterialWord("plaster", ("e6d8c0", "cdbb9c", "cdbb9c"), "wall", "plaster", "plaster", 0.5, "stone", 0.9),
    "adobe": MaterialWord("plaster", ("c98d5f", "a56a40", "a56a40"), "wall", "plaster", "plaster", 0.7, "terracotta", 0.9),
    "mud": MaterialWord("plaster", ("9a7450", "6f4f33", "6f4f33"), "wall", "plaster", "plaster", 0.5, "terracotta", 0.95),
    "fresco": MaterialWord("plaster", ("a8412f", "d0a24c", "efe2c0"), "wall", "fresco", "mosaic", 1.6, "stone", 0.8),
    "paint": MaterialWord("plaster", ("e6e1d8", "e6e1d8", "e6e1d8"), "wall", "paint", "paint", 0.02, "painted_wood", 0.85),
    "wallpaper": MaterialWord("paper", ("8a9a8a", "a8b5a0", "c9b880"), "wall", "wallpaper_damask", "", 0.6, "paper", 0.8),
    "damask": MaterialWord("paper", ("7a3a3f", "96555a", "c9b880"), "wall", "wallpaper_damask", "", 0.6, "velvet", 0.8),
    "stripe": MaterialWord("paper", ("e9e2d2", "b5534a", "b5534a"), "wall", "wallpaper_stripe", "", 0.2, "fabric", 0.8),
    "paper": MaterialWord("paper", ("f0e8d6", "5a3c24", "f7f0de"), "lamp", "panelling", "tatami", 0.6, "paper", 0.9),
    "carpet": MaterialWord("carpet", ("8a7f78", "6f6660", "6f6660"), "floor", "carpet", "carpet", 0.01, "rug", 1.0),
    "fur": MaterialWord("carpet", ("cfc3b2", "8f8272", "8f8272"), "rug", "carpet", "carpet", 0.02, "rug", 1.0),
    "velvet": _cloth("6a2f45", "velvet"),
    "silk": _cloth("c9b08a", "velvet"),
    "satin": _cloth("c0a0a8", "velvet"),
    "corduroy": _cloth("8a5a34", "velvet"),
    "linen": _cloth("e8dfcc", "linen"),
    "cotton": _cloth("ece6da", "linen"),
    "wool": _cloth("c9bfae", "blanket"),
    "felt": _cloth("8f9a94", "blanket"),
    "tweed": _cloth("7a6f5c", "fabric"),
    "tartan": _cloth("8a2f2a", "fabric"),
    "canvas": _cloth("d6c8a8", "linen"),
    "sailcloth": _cloth("e2d6ba", "linen", "curtain"),
    "lace": _cloth("f2ece0", "linen", "curtain"),
    "leather": MaterialWord("leather", ("6b4228", "3f2616", "3f2616"), "upholstery", "leather", "leather", 0.02, "leather", 0.5),
    "suede": MaterialWord("leather", ("9a7550", "6f5234", "6f5234"), "upholstery", "leather", "leather", 0.02, "leather", 0.85),
    "metal": _metal("8a8f94"),
    "steel": _metal("9aa0a5", "chrome"),
    "stainless": _metal("b5babd", "chrome"),
    "aluminium": _metal("b8bdc0", "chrome"),
    "chrome": _metal("c9cdd0", "chrome"),
    "iron": _metal("4a4b4e", "dark_metal"),
    "tin": _metal("a5a8a8"),
    "zinc": _metal("9fa6a8"),
    "brass": _metal("c0934a", "brass"),
    "copper": _metal("b56b42", "brass"),
    "bronze": _metal("8f6a3a", "brass"),
    "rivet": _metal("6f7678"),
    "plastic": MaterialWord("plastic", ("e6e4dc", "b5b3ac", "c9c7c0"), "furniture", "capsule", "lacquer", 1.1, "lacquer", 0.2),
    "fibreglass": MaterialWord("plastic", ("e2e0d6", "aeb0ac", "c9c7c0"), "furniture", "capsule", "lacquer", 1.1, "lacquer", 0.2),
    "vinyl": MaterialWord("plastic", ("a8322c", "6f1f1c", "6f1f1c"), "upholstery", "lacquer", "stone_tiles", 1.5, "leather", 0.3),
    "lacquer": MaterialWord("plastic", ("7a1f1c", "c9a34a", "7a1f1c"), "furniture", "lacquer", "lacquer", 0.2, "lacquer", 0.15),
    "rubber": MaterialWord("plastic", ("33343a", "222328", "222328"), "floor", "lacquer", "stone_tiles", 0.9, "dark_metal", 0.7),
    "glass": MaterialWord("glass", ("cfe0e2", "9fb8ba", "b5ccce"), "glass", "water_tiles", "water_tiles", 0.4, "glass", 0.05),
    "crystal": MaterialWord("glass", ("dfeaf2", "a5bccb", "c9dbe6"), "glass", "water_tiles", "marble", 0.4, "glass", 0.05),
    "mirrored": MaterialWord("glass", ("dfe6e8", "dfe6e8", "dfe6e8"), "mirror", "mirror", "mirror", 0.6, "mirror", 0.02),
    "ice": MaterialWord("ice", ("d3e7f2", "8fb4cc", "b3d2e4"), "wall", "stone_blocks", "marble", 0.55, "glass", 0.15),
    "snow": MaterialWord("ice", ("f2f6fa", "d8e4ee", "d8e4ee"), "floor", "plaster", "plaster", 0.8, "linen", 0.9),
    "earth": MaterialWord("earth", ("6f543a", "4a3626", "4a3626"), "floor", "plaster", "soil", 0.05, "soil", 1.0),
    "grass": MaterialWord("earth", ("5f8a3f", "3f6428", "3f6428"), "floor", "leaf", "carpet", 0.03, "leaf", 1.0),
    "ivy": MaterialWord("earth", ("3f6a34", "6f9a54", "3f6a34"), "wall", "leaf", "carpet", 0.2, "leaf", 0.8),
}  # fmt: skip

MATERIAL_SYNONYMS: dict[str, str] = {
    "wooden": "wood", "woody": "wood", "woodwork": "wood", "hardwood": "oak", "oaken": "oak", "boarding": "plank",
    "planked": "plank", "shiplap": "plank", "clapboard": "plank", "panelled": "panelling", "paneled": "panelling",
    "paneling": "panelling", "wainscot": "panelling", "boiserie": "panelling", "brickwork": "brick", "bricked": "brick",
    "stonework": "stone", "masonry": "stone", "ashlar": "stone", "cobbled": "cobblestone", "cobble": "cobblestone",
    "tiled": "tile", "tiling": "tile", "checkered": "checkerboard", "chequered": "checkerboard", "chequerboard": "checkerboard",
    "checked": "checkerboard", "carpeted": "carpet", "carpeting": "carpet", "furry": "fur", "sheepskin": "fur", "pelt": "fur",
    "woollen": "wool", "woolen": "wool", "woolly": "wool", "silken": "silk", "velvety": "velvet", "leathery": "leather",
    "metallic": "metal", "aluminum": "aluminium", "chromed": "chrome", "wrought": "iron", "riveted": "rivet", "bolted": "rivet",
    "fiberglass": "fibreglass", "lacquered": "lacquer", "enamel": "lacquer", "lino": "linoleum", "rattan": "wicker",
    "cane": "wicker", "raffia": "wicker", "thatch": "straw", "thatched": "straw", "rush": "straw", "reed": "straw",
    "frescoed": "fresco", "mural": "fresco", "painted": "paint", "papered": "wallpaper", "wallpapered": "wallpaper",
    "striped": "stripe", "stripy": "stripe", "plastered": "plaster", "stuccoed": "stucco", "icy": "ice", "frozen": "ice",
    "frosty": "ice", "snowy": "snow", "grassy": "grass", "rocky": "rock", "glassy": "glass", "marbled": "marble",
    "ceramic": "porcelain", "denim-cloth": "canvas", "sail": "sailcloth", "burlap": "canvas", "plaid": "tartan",
    "perspex": "plastic", "acrylic": "plastic", "soil": "earth", "dirt": "earth", "titanium": "steel", "mosaics": "mosaic",
}  # fmt: skip
