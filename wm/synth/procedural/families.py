"""The style families: palette, materials, furniture shapes and light of each, and the words of a theme that select it.

Each family is a short sheet of colours; `build` turns a sheet into the full table of surfaces and slots.
"""

import dataclasses
import math

from wm.synth.procedural.finish import SLOTS, Finish, Form, Light, Rgb, Style, Surfaces


def rgb(code: str) -> Rgb:
    """sRGB colour of a six-digit hexadecimal code."""
    return int(code[0:2], 16) / 255, int(code[2:4], 16) / 255, int(code[4:6], 16) / 255


def mix(a: Rgb, b: Rgb, share: float) -> Rgb:
    """a with `share` of b."""
    return a[0] + (b[0] - a[0]) * share, a[1] + (b[1] - a[1]) * share, a[2] + (b[2] - a[2]) * share


def scaled(a: Rgb, factor: float) -> Rgb:
    """a made darker (factor below 1) or lighter, clipped to [0, 1]."""
    return min(a[0] * factor, 1.0), min(a[1] * factor, 1.0), min(a[2] * factor, 1.0)


@dataclasses.dataclass(frozen=True)
class Sheet:
    """What has to be said about a family; colours are hexadecimal codes."""

    words: tuple[str, ...]
    form: Form
    wall: Finish
    floor: Finish
    ceiling: Finish
    trim: Finish
    wood: str
    dark_wood: str
    painted: str
    fabric: str
    accent: str
    leather: str
    linen: str
    rug: str
    rug_border: str
    metal: str
    brass: str
    stone: str
    ceramic: str
    shade: str
    accents: tuple[str, ...]
    light: Light
    wainscot: Finish | None = None
    wainscot_height: float = 0.0
    wet_wall: Finish | None = None
    wet_floor: Finish | None = None
    rooms: tuple[tuple[str, Finish, Finish], ...] = ()  # (room type, wall, floor) where they differ
    upholstery: str = "textile"
    leaf: str = "4e7a3a"


def finish(
    material: str, *codes: str, scale: float = 0.1, contrast: float = 1.0, roughness: float = 0.7, wear: float = 0.2
) -> Finish:
    return Finish(material, tuple(rgb(c) for c in codes), scale, contrast, roughness, wear)


def light(
    sun: str, strength: float, elevation: float, azimuth: float, sky: str, sky_strength: float, lamp: str, lamps: float
) -> Light:
    """A Light from codes and degrees."""
    return Light(rgb(sun), strength, math.radians(elevation), math.radians(azimuth), rgb(sky), sky_strength, rgb(lamp), lamps)


FAMILIES: dict[str, Sheet] = {
    "gothic": Sheet(
        words=("gothic", "medieval", "cathedral", "castle", "vampire", "dracula", "haunted", "monastery", "abbey", "knight"),
        form=Form("turned", "pointed_arch", "pointed", "candle", softness=0.6, ornament=0.9),
        wall=finish("wallpaper_damask", "5a2328", "7c3a36", "a5753f", scale=0.6, roughness=0.8),
        wainscot=finish("panelling", "4a2d1c", "24140c", "63402a", scale=0.5, roughness=0.45),
        wainscot_height=1.1,
        floor=finish("herringbone", "6b4126", "2c180d", "82532f", scale=0.45, roughness=0.4),
        ceiling=finish("plaster", "cfc3ac", "b3a58b", scale=1.2),
        trim=finish("wood", "3f2516", "24140c", scale=0.05, roughness=0.4),
        wet_wall=finish("stone_blocks", "8d8577", "5b5448", "76705f", scale=0.6),
        wet_floor=finish("checker_tiles", "c9c0ad", "33302d", "1d1b19", scale=0.3, roughness=0.3),
        rooms=(
            ("hall", finish("stone_blocks", "968d7d", "62594b", "7d7464", scale=0.7),
             finish("checker_tiles", "cdc3ae", "3a2f2b", "211c19", scale=0.45, roughness=0.3)),
            ("corridor", finish("wallpaper_damask", "2f4238", "476050", "a5874b", scale=0.6),
             finish("wood_planks", "5f3a22", "27160c", "7a4c2c", scale=0.14, roughness=0.4)),
            ("library", finish("wallpaper_damask", "27423a", "3d5d4f", "a5874b", scale=0.6),
             finish("parquet", "6a4227", "2c180d", "83562f", scale=0.4, roughness=0.4)),
            ("bedroom", finish("wallpaper_damask", "3b2b4d", "56426d", "a98a5a", scale=0.6),
             finish("wood_planks", "603b23", "27160c", "7a4c2c", scale=0.14, roughness=0.4)),
        ),
        wood="6d4226", dark_wood="41261a", painted="3d2b22", fabric="7d1f28", accent="b08d3f", leather="4e2417", linen="e6dcc6",
        rug="7a2029", rug_border="c2a05a", metal="3a3a3d", brass="b58a3c", stone="9c9484", ceramic="d9cfba", shade="e8cf9a",
        accents=("7d1f28", "2f4a3c", "33305c", "b08d3f", "5c3a24", "8a8172"), upholstery="velvet",
        light=light("ffd9a8", 0.55, 24, 200, "aebcd6", 0.45, "ffb566", 0.95),
    ),
    "victorian": Sheet(
        words=("victorian", "edwardian", "steampunk", "antique", "dickensian", "british", "english"),
        form=Form("turned", "spindle", "raised", "cone", softness=0.8, ornament=0.8),
        wall=finish("wallpaper_damask", "2f5a52", "4a776a", "c2a767", scale=0.5, roughness=0.8),
        wainscot=finish("panelling", "5f3b22", "2f1c10", "7a5030", scale=0.45, roughness=0.4),
        wainscot_height=0.95,
        floor=finish("parquet", "8a5a33", "3a2414", "a06e40", scale=0.4, roughness=0.4),
        ceiling=finish("plaster", "e8dfce", "d3c8b4", scale=1.0),
        trim=finish("wood", "5a3820", "2f1c10", scale=0.05, roughness=0.4),
        wet_wall=finish("stone_tiles", "e6e4d8", "b9b5a5", "d4d1c2", scale=0.15, roughness=0.25),
        wet_floor=finish("checker_tiles", "eae5d8", "2d2c2f", "19181a", scale=0.2, roughness=0.3),
        rooms=(("bedroom", finish("wallpaper_stripe", "c9b8a0", "a8876d", scale=0.08), finish("wood_planks", "7d5230",
            "35210f", "966540", scale=0.12)),),
        wood="7a4a28", dark_wood="4c2b18", painted="3f4a3c", fabric="8c3b3b", accent="c9a24f", leather="5a2d1b", linen="efe6d4",
        rug="7b2f34", rug_border="26424d", metal="47423d", brass="c0953f", stone="c8c0b0", ceramic="efe8da", shade="f0d6a0",
        accents=("8c3b3b", "2f5a52", "b58a3c", "44355e", "c9b8a0", "69442a"), upholstery="velvet",
        light=light("ffdfb0", 0.6, 30, 220, "bccbe0", 0.5, "ffbf74", 0.9),
    ),
    "baroque": Sheet(
        words=("baroque", "rococo", "palace", "versailles", "royal", "opulent", "renaissance", "regal", "louis", "imperial"),
        form=Form("cabriole", "round_arch", "arched", "candle", softness=0.9, ornament=1.0),
        wall=finish("wallpaper_damask", "d9c48f", "c2a35f", "f0e3bb", scale=0.7, roughness=0.6),
        wainscot=finish("panelling", "efe8d6", "c9a94f", "fffaf0", scale=0.7, roughness=0.5),
        wainscot_height=0.9,
        floor=finish("parquet", "9a6a3c", "4a2e16", "b58450", scale=0.6, roughness=0.3),
        ceiling=finish("plaster", "f4eddd", "e0d3b8", scale=1.5),
        trim=finish("metal", "c9a34a", "f5dfa0", scale=0.03, roughness=0.35),
        wet_wall=finish("marble", "efe9de", "b9a58a", "d6c9b3", scale=0.8, roughness=0.15),
        wet_floor=finish("checker_tiles", "f1ebe0", "7a5a4a", "c9b9a0", scale=0.4, roughness=0.15),
        rooms=(("hall", finish("marble", "efe6d8", "bfa88a", "d8c6a8", scale=1.0, roughness=0.2),
                finish("checker_tiles", "f1e9da", "4a3a38", "c9b9a0", scale=0.6, roughness=0.12)),),
        wood="8d5b30", dark_wood="5a3519", painted="f0e8d6", fabric="8a2a4a", accent="3d6a8a", leather="6b3320", linen="f6f0e2",
        rug="8a2f45", rug_border="d0b060", metal="c9a34a", brass="d4ad4e", stone="e6dccb", ceramic="f4efe6", shade="fbe7bf",
        accents=("8a2a4a", "3d6a8a", "d4ad4e", "4f7a5a", "f0e3c8", "6a3a6a"), upholstery="velvet",
        light=light("ffe8c0", 0.8, 35, 210, "c8d8f0", 0.6, "ffcf8a", 0.9),
    ),
    "roman": Sheet(
        words=("roman", "rome", "greek", "grecian", "pompeii", "pompeian", "classical", "temple", "villa", "byzantine",
            "mediterranean", "tuscan"),
        form=Form("column", "klismos", "arched", "tripod", softness=0.5, ornament=0.7, low=0.95),
        wall=finish("plaster", "c9a58a", "a67a5e", scale=0.9, roughness=0.8, wear=0.3),
        wainscot=finish("plaster", "8f2f23", "6d2119", scale=0.9, roughness=0.6),
        wainscot_height=0.9,
        floor=finish("mosaic", "e0d3b8", "7a3a2c", "2f3a40", scale=0.03, roughness=0.35),
        ceiling=finish("plaster", "eadfc8", "d5c5a5", scale=1.4),
        trim=finish("marble", "ebe4d6", "b8a890", scale=0.6, roughness=0.3),
        wet_wall=finish("marble", "e8dfd0", "b09a80", "cfc0a8", scale=0.9, roughness=0.2),
        wet_floor=finish("mosaic", "dfe6e0", "2f6a7a", "1f3f4f", scale=0.025, roughness=0.25),
        rooms=(
            ("hall", finish("marble", "eae2d4", "b8a68c", "d2c3aa", scale=1.2, roughness=0.25),
             finish("marble", "ddd2bf", "a08c70", "8a4a38", scale=0.9, roughness=0.15)),
            ("corridor", finish("plaster", "d8bd9a", "b8926c", scale=0.9), finish("terracotta", "b5694a", "7d5a45",
                "9a5238", scale=0.3)),
        ),
        wood="8a5c36", dark_wood="5b3720", painted="d8c8a8", fabric="a3352b", accent="d9b45a", leather="7a3f24", linen="f1e8d6",
        rug="9a3a2c", rug_border="e0c080", metal="8a6a3c", brass="b8893f", stone="ddd3c0", ceramic="b9633f", shade="f5dca8",
        accents=("a3352b", "2f6a7a", "d9b45a", "5a6b3a", "e5d8bd", "4a2c50"),
        light=light("ffe9c4", 1.0, 42, 225, "a8cbf0", 0.7, "ffc27a", 0.7),
    ),
    "scandinavian": Sheet(
        words=("scandinavian", "nordic", "scandi", "swedish", "danish", "norwegian", "finnish", "hygge", "ikea", "japandi"),
        form=Form("tapered", "slats", "flat", "drum", softness=0.6, ornament=0.15),
        wall=finish("paint", "f1efe9", scale=0.02, roughness=0.9),
        floor=finish("wood_planks", "d9bd93", "a58a63", "c7a878", scale=0.16, roughness=0.5, wear=0.1),
        ceiling=finish("paint", "fafaf7", scale=0.02, roughness=0.95),
        trim=finish("painted_wood", "f7f6f2", "d9bd93", scale=0.05, roughness=0.5, wear=0.05),
        wet_wall=finish("stone_tiles", "f2f4f3", "cfd6d4", "e6ebe9", scale=0.2, roughness=0.2),
        wet_floor=finish("stone_tiles", "a9adae", "84888a", "989c9e", scale=0.45, roughness=0.4),
        rooms=(("bedroom", finish("paint", "cdd8d6", scale=0.02), finish("wood_planks", "dcc19a", "a98e66",
            "cbae80", scale=0.16)),
               ("study", finish("paint", "e3ddd0", scale=0.02), finish("wood_planks", "d9bd93", "a58a63",
                   "c7a878", scale=0.16)),),
        wood="d2ac78", dark_wood="a67c4e", painted="f4f3ef", fabric="9aa5ab", accent="c99a4a", leather="b07a4c", linen="f5f3ee",
        rug="e3ddd0", rug_border="8a9298", metal="2f3133", brass="c2a46a", stone="c9c9c5", ceramic="f3f1ec", shade="fbf6ea",
        accents=("5f7f86", "d0a24c", "c47a5a", "e8e3d8", "7c8f78", "2f3a40"), leaf="5b8f54",
        light=light("fff1dc", 0.8, 32, 215, "cfe0f2", 0.85, "ffdcae", 0.6),
    ),
    "minimalist": Sheet(
        words=("minimalist", "minimal", "bauhaus", "monochrome", "zen", "clean", "museum"),
        form=Form("slab", "plain", "flat", "globe", softness=0.3, ornament=0.0),
        wall=finish("paint", "f3f3f1", scale=0.02, roughness=0.9, wear=0.0),
        floor=finish("concrete", "b9b8b4", "a3a29e", scale=1.2, roughness=0.35, wear=0.1),
        ceiling=finish("paint", "fbfbfa", scale=0.02, wear=0.0),
        trim=finish("painted_wood", "eaeae7", "c9c9c5", scale=0.05, wear=0.0),
        wet_wall=finish("stone_tiles", "e5e4e0", "c6c5c0", "d9d8d3", scale=0.6, roughness=0.3),
        wet_floor=finish("stone_tiles", "9f9e9a", "85847f", "94938f", scale=0.6, roughness=0.3),
        wood="c5a27a", dark_wood="4a3c31", painted="f0f0ee", fabric="c7c5bf", accent="2a2a2b", leather="2e2a28", linen="f7f6f3",
        rug="dbd8d0", rug_border="b5b2aa", metal="1f2022", brass="a8a59c", stone="d8d7d3", ceramic="f5f5f3", shade="fffaf0",
        accents=("2a2a2b", "8f8d87", "dcd9d2", "b5673f", "5f6b66", "e9e7e2"),
        light=light("fff6e8", 0.85, 40, 215, "dbe6f2", 0.9, "fff0d8", 0.55),
    ),
    "modern": Sheet(
        words=("modern", "contemporary", "sleek", "luxury", "penthouse", "apartment", "loft", "hotel", "urban", "office",
            "villa modern"),
        form=Form("straight", "plain", "flat", "drum", softness=0.6, ornament=0.2),
        wall=finish("paint", "e6e1d8", scale=0.02, roughness=0.85, wear=0.02),
        floor=finish("herringbone", "a98258", "6f5234", "bb9468", scale=0.6, roughness=0.35, wear=0.05),
        ceiling=finish("paint", "f8f7f4", scale=0.02, wear=0.0),
        trim=finish("painted_wood", "f2f0eb", "cfcac0", scale=0.05, wear=0.02),
        wet_wall=finish("marble", "ecebe8", "9a9a9c", "c6c6c6", scale=1.0, roughness=0.12),
        wet_floor=finish("stone_tiles", "77787a", "5d5e60", "6a6b6d", scale=0.6, roughness=0.3),
        rooms=(("living", finish("paint", "d8d4ca", scale=0.02), finish("herringbone", "a98258", "6f5234",
            "bb9468", scale=0.6, roughness=0.35)),
               ("bedroom", finish("paint", "b9bfb8", scale=0.02), finish("wood_planks", "a98258", "6f5234",
                   "bb9468", scale=0.18))),
        wood="8f6640", dark_wood="3f2f26", painted="ebe9e4", fabric="5f6a72", accent="c98a3a", leather="6b4630", linen="f3f1ec",
        rug="cfc8ba", rug_border="7f8488", metal="26272a", brass="b8955a", stone="cfcdc8", ceramic="efeeea", shade="faf3e3",
        accents=("c98a3a", "3f6f78", "a34a3a", "e2ddd2", "5a6a4a", "2b2c30"),
        light=light("fff0d8", 0.85, 36, 210, "cddff2", 0.75, "ffe0b0", 0.65),
    ),
    "midcentury": Sheet(
        words=("midcentury", "retro", "seventies", "sixties", "fifties", "70s", "60s", "50s", "eames", "vintage", "diner",
            "groovy", "disco"),
        form=Form("tapered", "spindle", "slats", "globe", softness=0.5, ornament=0.2),
        wall=finish("paint", "e9dcc0", scale=0.02),
        floor=finish("parquet", "a8713f", "6a4322", "bd864e", scale=0.3, roughness=0.4),
        ceiling=finish("paint", "f7f1e3", scale=0.02),
        trim=finish("wood", "9a6334", "6b4020", scale=0.05),
        wet_wall=finish("stone_tiles", "8fbcae", "d9e6dd", "7aa898", scale=0.12, roughness=0.2),
        wet_floor=finish("checker_tiles", "f0ead8", "d08a4a", "c9c0aa", scale=0.25, roughness=0.3),
        rooms=(("living", finish("wallpaper_stripe", "e5c98f", "d49a4f", scale=0.2), finish("carpet", "c4703a",
            "a8582a", scale=0.01)),),
        wood="a8693a", dark_wood="6b3f22", painted="e6d3a8", fabric="d0792f", accent="2f7f86", leather="8a4a24", linen="f5ecd8",
        rug="d0702f", rug_border="3a5a50", metal="2b2b2d", brass="c09a50", stone="cbbfa8", ceramic="e9dcc0", shade="ffe3b0",
        accents=("d0792f", "2f7f86", "c9a227", "8a3a2f", "5f7a3f", "f0e2c4"),
        light=light("ffe2b4", 0.8, 28, 230, "c5dcef", 0.65, "ffc880", 0.8),
    ),
    "art_deco": Sheet(
        words=("deco", "gatsby", "twenties", "jazz", "glamour", "glamorous", "casino", "theatre", "hollywood"),
        form=Form("tapered", "round_arch", "arched", "globe", softness=0.8, ornament=0.6),
        wall=finish("wallpaper_stripe", "1f4a4a", "2d6060", scale=0.3, roughness=0.6),
        wainscot=finish("panelling", "231f20", "c9a34a", "3a3536", scale=0.6, roughness=0.2),
        wainscot_height=0.8,
        floor=finish("checker_tiles", "efe9dc", "1b1b1d", "c9a34a", scale=0.5, roughness=0.15),
        ceiling=finish("paint", "f4ecd8", scale=0.02),
        trim=finish("metal", "c9a34a", "f0d890", scale=0.03, roughness=0.3),
        wet_wall=finish("marble", "e9efe9", "4a7a6a", "a0c0b0", scale=0.7, roughness=0.12),
        wet_floor=finish("checker_tiles", "f2efe6", "1b1b1d", "a0a0a0", scale=0.2, roughness=0.2),
        wood="6b3f22", dark_wood="2a1a14", painted="1f1f21", fabric="1f5f5a", accent="c9a34a", leather="3a1f18", linen="f4eee0",
        rug="1f3f4a", rug_border="c9a34a", metal="b8963f", brass="d0a84a", stone="d8d0c0", ceramic="1f4a4a", shade="fff0cc",
        accents=("1f5f5a", "c9a34a", "7a1f3a", "1b1b1d", "efe2c0", "3a4f7a"), upholstery="velvet",
        light=light("ffe4b8", 0.5, 25, 215, "b8cbe8", 0.45, "ffd08a", 0.95),
    ),
    "coastal": Sheet(
        words=("coastal", "beach", "seaside", "nautical", "ocean", "sea", "island", "hamptons", "marine", "surf", "tropical",
            "caribbean", "cottage"),
        form=Form("turned", "slats", "slats", "lantern", softness=0.8, ornament=0.3),
        wall=finish("panelling", "eef2f0", "cfd8d8", "ffffff", scale=0.2, contrast=0.5, roughness=0.7),
        floor=finish("wood_planks", "cdb898", "a08c70", "bca684", scale=0.18, roughness=0.6, wear=0.5),
        ceiling=finish("painted_wood", "f7f9f8", "dfe6e6", scale=0.12, wear=0.1),
        trim=finish("painted_wood", "ffffff", "cdb898", scale=0.05, wear=0.1),
        wet_wall=finish("water_tiles", "8ec9cf", "e6f2f0", "c8eef0", scale=0.12, roughness=0.15),
        wet_floor=finish("stone_tiles", "e0d6c2", "bcb09a", "d2c7b0", scale=0.4, roughness=0.5),
        rooms=(("bedroom", finish("paint", "bcd9e0", scale=0.02), finish("wood_planks", "d3bf9f", "a69276",
            "c2ad8a", scale=0.18, wear=0.5)),
               ("living", finish("panelling", "f2f3ee", "d3dada", "ffffff", scale=0.2, contrast=0.5), finish("wood_planks",
                   "cdb898", "a08c70", "bca684", scale=0.18, wear=0.5))),
        wood="c4a67c", dark_wood="8f7350", painted="f3f6f4", fabric="5f93ad", accent="e58a6a", leather="b58a5f", linen="fbfaf5",
        rug="d8cdb5", rug_border="4a7f9a", metal="7f8a8c", brass="c4a868", stone="e2dccf", ceramic="e9f2f2", shade="fbf3df",
        accents=("2f6f93", "e58a6a", "f0d28a", "7fb8b0", "f5f0e2", "3f5a6a"), leaf="5fa05a",
        light=light("fff2d8", 1.0, 48, 220, "9fd0f5", 0.95, "ffe0b0", 0.5),
    ),
    "rustic": Sheet(
        words=("rustic", "cabin", "farmhouse", "cozy", "cosy", "chalet", "barn", "country", "log", "alpine", "hobbit",
            "hunting", "lodge", "tavern", "viking", "western"),
        form=Form("straight", "slats", "slats", "lantern", softness=0.8, ornament=0.4),
        wall=finish("wood_planks", "a5743f", "5a3a1c", "8a5c30", scale=0.2, roughness=0.8, wear=0.4),
        floor=finish("wood_planks", "8a5f38", "402812", "704a28", scale=0.22, roughness=0.7, wear=0.5),
        ceiling=finish("wood_planks", "96683a", "4a2e14", "7d5430", scale=0.25, roughness=0.85, wear=0.3),
        trim=finish("wood", "6f4822", "402812", scale=0.06, wear=0.4),
        wet_wall=finish("stone_blocks", "a39a8a", "6f675a", "8d8474", scale=0.4),
        wet_floor=finish("stone_tiles", "9a8f7d", "6a6152", "857b69", scale=0.35, roughness=0.7),
        rooms=(("kitchen", finish("brick", "a8654a", "cbbfae", "8f4f38", scale=0.24), finish("terracotta", "b5714e", "8a6a52",
            "9e5c3e", scale=0.3)),),
        wood="97683a", dark_wood="5d3a1e", painted="5f7058", fabric="8a4a36", accent="d9b878", leather="6f4224", linen="ede2cc",
        rug="7f3b2c", rug_border="d9c49a", metal="333231", brass="9a7638", stone="a39a8b", ceramic="d8c8a8", shade="f5d9a0",
        accents=("8f3a2c", "4f6640", "d0a050", "6a4a2c", "e6d8b8", "3f4f60"), leaf="4f7038",
        light=light("ffd7a0", 0.6, 22, 225, "b8cce4", 0.5, "ffb866", 0.95),
    ),
    "industrial": Sheet(
        words=("industrial", "warehouse", "factory", "brutalist", "brutalism", "brooklyn", "bunker", "garage", "apocalyptic",
            "soviet"),
        form=Form("hairpin", "plain", "flat", "globe", softness=0.4, ornament=0.1),
        wall=finish("brick", "9a5a44", "b5a898", "7d4535", scale=0.24, roughness=0.85, wear=0.5),
        floor=finish("concrete", "8f8d88", "74726d", scale=1.5, roughness=0.5, wear=0.5),
        ceiling=finish("concrete", "a5a39e", "8a8883", scale=1.2, wear=0.4),
        trim=finish("metal", "2c2d2f", "4a4b4e", scale=0.05, roughness=0.5),
        wet_wall=finish("stone_tiles", "e2e2de", "3f3f3f", "d0d0cb", scale=0.2, roughness=0.25),
        wet_floor=finish("concrete", "6f6e6b", "5a5956", scale=1.0, roughness=0.4),
        wood="8a6238", dark_wood="4f3722", painted="3f4446", fabric="5c5f5f", accent="b5642f", leather="6b3c1f", linen="dfdad0",
        rug="6d6a66", rug_border="3a3a3a", metal="2a2b2d", brass="a8763f", stone="9a9894", ceramic="c9c5bd", shade="2f3032",
        accents=("b5642f", "3f5a66", "c9a24f", "7a2f28", "8f8d88", "2a2b2d"), upholstery="leather",
        light=light("ffe8cc", 0.7, 30, 215, "c4d2e2", 0.6, "ffb870", 0.85),
    ),
    "cyberpunk": Sheet(
        words=("cyberpunk", "futuristic", "future", "scifi", "sci", "spaceship", "space", "neon", "synthwave", "cyber",
            "robot", "alien", "vaporwave", "dystopian"),
        form=Form("slab", "plain", "flat", "globe", softness=0.3, ornament=0.3),
        wall=finish("panelling", "2b3040", "12e0d0", "3a4158", scale=0.9, contrast=0.6, roughness=0.35),
        floor=finish("stone_tiles", "23262f", "0f8f9a", "2f333f", scale=0.6, roughness=0.15),
        ceiling=finish("metal", "1c1f28", "3a4158", scale=0.1, roughness=0.4),
        trim=finish("glow", "d62fb0", scale=0.05),
        wet_wall=finish("water_tiles", "1f4f66", "0fd0d8", "5ae8f0", scale=0.2, roughness=0.1),
        wet_floor=finish("stone_tiles", "1d2028", "d62fb0", "2a2e3a", scale=0.4, roughness=0.15),
        wood="3d3a48", dark_wood="201f2a", painted="39405a", fabric="3a2f66", accent="e0309a", leather="1f1d26", linen="bfc8e6",
        rug="2a2050", rug_border="10d0d8", metal="5a6072", brass="10c8d0", stone="3a3f4c", ceramic="c9d6e8", shade="7af0ff",
        accents=("e0309a", "10d0d8", "7a3ff0", "f0d020", "2f6af0", "ff6a3a"), upholstery="leather", leaf="2fae8a",
        light=light("ff8ad0", 0.15, 12, 250, "5a4fd0", 0.45, "8ae8ff", 1.0),
    ),
    "japanese": Sheet(
        words=("japanese", "tea", "ryokan", "tatami", "kyoto", "samurai", "oriental", "shoji", "edo", "onsen"),
        form=Form("slab", "plain", "slats", "lantern", softness=0.4, ornament=0.2, low=0.72),
        wall=finish("panelling", "efe6d0", "5a3c24", "f7f0de", scale=0.6, contrast=0.7, roughness=0.9),
        floor=finish("tatami", "c9bd84", "3f4a36", scale=0.9, roughness=0.8, wear=0.1),
        ceiling=finish("wood_planks", "b58f5f", "6b4a2a", "a37d50", scale=0.3),
        trim=finish("wood", "5f4028", "3a2616", scale=0.04),
        wet_wall=finish("wood_planks", "c29a68", "7a5a38", "b08a58", scale=0.12),
        wet_floor=finish("stone_tiles", "6f7270", "4a4d4b", "5f6260", scale=0.35, roughness=0.4),
        wood="b08452", dark_wood="5c3c22", painted="2f2a26", fabric="5a6b4f", accent="a8382f", leather="5f4028", linen="f4eee0",
        rug="b8aa78", rug_border="3a4a3a", metal="2f2d2b", brass="a38a4f", stone="8f918d", ceramic="3f5a5f", shade="fbeed0",
        accents=("a8382f", "2f4a5f", "5f7a4a", "d9b45a", "efe4cc", "2b2724"), leaf="3f7a45",
        light=light("fff0d0", 0.7, 28, 215, "d8e6ea", 0.8, "ffdca0", 0.7),
    ),
    "moroccan": Sheet(
        words=("moroccan", "bohemian", "boho", "arabian", "ottoman", "persian", "indian", "riad", "marrakech", "turkish",
            "andalusian", "egyptian", "mexican"),
        form=Form("turned", "pointed_arch", "pointed", "lantern", softness=1.0, ornament=0.9, low=0.85),
        wall=finish("plaster", "d99a6c", "c07d50", scale=0.8, wear=0.4),
        wainscot=finish("mosaic", "2f6f8a", "e6d8b0", "c9702f", scale=0.04, roughness=0.3),
        wainscot_height=1.0,
        floor=finish("terracotta", "b8623f", "8a5238", "a04f30", scale=0.25, roughness=0.6, wear=0.4),
        ceiling=finish("wood_planks", "8a5a34", "4a2c14", "70462a", scale=0.2),
        trim=finish("wood", "6a3f22", "40240f", scale=0.05),
        wet_wall=finish("mosaic", "1f7f8f", "e8e0c0", "d0a030", scale=0.03, roughness=0.2),
        wet_floor=finish("mosaic", "e6dcc0", "1f6f8a", "a83f2f", scale=0.04, roughness=0.3),
        wood="96592f", dark_wood="5a3018", painted="2f7a86", fabric="b8422f", accent="e0a030", leather="9a5a30", linen="f4e6cc",
        rug="a82f2f", rug_border="2f4f7f", metal="6a4a2a", brass="cf9a3c", stone="d0b898", ceramic="1f6f9a", shade="ffb860",
        accents=("b8422f", "1f7f8f", "e0a030", "7a2f6a", "4f7a3a", "f0d8a8"),
        light=light("ffe0a8", 0.95, 45, 225, "9fc8f0", 0.65, "ffae58", 0.85),
    ),
    "surreal": Sheet(
        words=("surreal", "dream", "dreamlike", "dreamy", "fantasy", "psychedelic", "whimsical", "wonderland", "magical",
            "enchanted", "underwater", "candy", "fairy", "fairytale", "dali", "alice", "liminal"),
        form=Form("cabriole", "wave", "arched", "globe", softness=1.0, ornament=0.7),
        wall=finish("wallpaper_damask", "5f4fa0", "f08ac0", "ffd27a", scale=0.9, roughness=0.6),
        floor=finish("water_tiles", "2fa8b8", "f5e0f0", "9af0f0", scale=0.35, roughness=0.1),
        ceiling=finish("plaster", "f7b8d8", "9fd8f5", scale=2.0),
        trim=finish("lacquer", "ffcf5a", "fff2c0", scale=0.05, roughness=0.2),
        wet_wall=finish("water_tiles", "3f7fd0", "d8f0ff", "a0f0ff", scale=0.2, roughness=0.1),
        wet_floor=finish("checker_tiles", "ffd8ec", "5a3fb0", "ffffff", scale=0.3, roughness=0.15),
        rooms=(
            ("bedroom", finish("wallpaper_stripe", "f5a8c8", "8ac8f0", scale=0.25), finish("checker_tiles", "fff0d8",
                "e0609a", "ffffff", scale=0.4, roughness=0.2)),
            ("library", finish("wallpaper_damask", "1f6f6a", "f0b04a", "f5e0a0", scale=0.8), finish("checker_tiles", "f5ead0",
                "3f2f7a", "ffffff", scale=0.5, roughness=0.15)),
            ("hall", finish("wallpaper_stripe", "3f2f7a", "e0609a", scale=0.4), finish("checker_tiles", "fdf2e0", "2b1f4a",
                "c8a0ff", scale=0.7, roughness=0.12)),
            ("corridor", finish("wallpaper_stripe", "f0a83a", "e0609a", scale=0.3), finish("water_tiles", "2fa8b8", "f5e0f0",
                "9af0f0", scale=0.35, roughness=0.1)),
        ),
        wood="c26a4a", dark_wood="5a2f6a", painted="f2b84a", fabric="e0507f", accent="40b8c0", leather="7a2f8a", linen="fff0f5",
        rug="6a4fc0", rug_border="f5c04a", metal="c080e0", brass="f0b83f", stone="c8b8e6", ceramic="5fd0c8", shade="ffd8f0",
        accents=("e0507f", "40b8c0", "f5c04a", "7a5fe0", "6fd07a", "ff8a4a"), upholstery="velvet", leaf="3fc08a",
        light=light("ffd0b0", 0.7, 25, 200, "b8a8ff", 0.75, "ffc0e0", 0.8),
    ),
}  # fmt: skip
"""Every family of the offline world; "modern" is the neutral one."""


def build(theme: str, family: str, sheet: Sheet) -> Style:
    """The full style of a sheet: one finish for every surface and every slot."""
    dry = Surfaces(sheet.wall, sheet.floor, sheet.ceiling, sheet.trim, sheet.wainscot, sheet.wainscot_height)
    rooms = {"other": dry}
    if sheet.wet_wall and sheet.wet_floor:
        rooms["bathroom"] = Surfaces(sheet.wet_wall, sheet.wet_floor, sheet.ceiling, sheet.trim)
        rooms["kitchen"] = Surfaces(sheet.wall, sheet.wet_floor, sheet.ceiling, sheet.trim, sheet.wet_wall, 1.5)
    for kind, wall, floor in sheet.rooms:
        keep = wall.material not in ("stone_blocks", "marble", "brick")  # masonry needs no wainscot in front of it
        rooms[kind] = dataclasses.replace(
            dry,
            wall=wall,
            floor=floor,
            wainscot=sheet.wainscot if keep else None,
            wainscot_height=sheet.wainscot_height if keep else 0.0,
        )
    rooms.setdefault("study", rooms.get("library", dry))
    rooms.setdefault("gallery", rooms.get("hall", dry))
    slots = slot_finishes(sheet)
    return Style(theme, family, tuple(rooms.items()), tuple((s, slots[s]) for s in SLOTS), sheet.form, sheet.light,
                 tuple(rgb(c) for c in sheet.accents))  # fmt: skip


def slot_finishes(sheet: Sheet) -> dict[str, Finish]:
    """One finish for every furniture slot."""
    wood, dark, fabric, accent = rgb(sheet.wood), rgb(sheet.dark_wood), rgb(sheet.fabric), rgb(sheet.accent)
    linen, metal, brass, stone = rgb(sheet.linen), rgb(sheet.metal), rgb(sheet.brass), rgb(sheet.stone)
    painted, ceramic, lamp, leaf = rgb(sheet.painted), rgb(sheet.ceramic), sheet.light.lamp_color, rgb(sheet.leaf)
    white, black = (1.0, 1.0, 1.0), (0.0, 0.0, 0.0)

    def of(material: str, *colors: Rgb, scale: float = 0.01, roughness: float = 0.7, contrast: float = 1.0) -> Finish:
        return Finish(material, colors, scale, contrast, roughness, sheet.floor.wear)

    return {
        "wood": of("wood", wood, scaled(wood, 0.65), scale=0.03, roughness=0.5),
        "dark_wood": of("wood", dark, scaled(dark, 0.6), scale=0.03, roughness=0.4),
        "light_wood": of("wood", mix(wood, white, 0.3), scaled(wood, 0.9), scale=0.03, roughness=0.55),
        "panel_wood": of("wood", mix(dark, wood, 0.5), scaled(dark, 0.7), scale=0.04, roughness=0.45),
        "painted_wood": of("painted_wood", painted, wood, scale=0.04, roughness=0.5),
        "lacquer": of("lacquer", scaled(dark, 0.55), white, roughness=0.15),
        "fabric": of(sheet.upholstery, fabric, mix(fabric, white, 0.25), scale=0.004, roughness=0.9),
        "fabric_accent": of(sheet.upholstery, accent, mix(accent, white, 0.25), scale=0.004, roughness=0.9),
        "velvet": of("velvet", fabric, mix(fabric, white, 0.35), roughness=0.8),
        "leather": of("leather", rgb(sheet.leather), scaled(rgb(sheet.leather), 0.6), scale=0.01, roughness=0.5),
        "linen": of("textile", linen, scaled(linen, 0.92), scale=0.003, roughness=0.95),
        "pillow": of("textile", mix(linen, white, 0.4), linen, scale=0.003, roughness=0.95),
        "blanket": of("textile", mix(fabric, linen, 0.25), mix(fabric, linen, 0.45), scale=0.012, roughness=0.95),
        "curtain": of("textile", mix(fabric, linen, 0.3), mix(fabric, linen, 0.4), scale=0.004, roughness=0.9),
        "rug": of("carpet", rgb(sheet.rug), mix(rgb(sheet.rug), white, 0.2), scale=0.01, roughness=1.0),
        "rug_border": of("carpet", rgb(sheet.rug_border), scaled(rgb(sheet.rug_border), 0.8), scale=0.01, roughness=1.0),
        "woven": of("woven", mix(wood, linen, 0.4), scaled(wood, 0.6), scale=0.012, roughness=0.8),
        "metal": of("metal", metal, mix(metal, white, 0.4), scale=0.004, roughness=0.4),
        "dark_metal": of("metal", mix(metal, black, 0.6), mix(metal, white, 0.2), scale=0.004, roughness=0.5),
        "brass": of("metal", brass, mix(brass, white, 0.5), scale=0.004, roughness=0.25),
        "chrome": of("metal", rgb("c9cdd0"), white, scale=0.004, roughness=0.12),
        "stone": of("stone_tiles", stone, scaled(stone, 0.7), scaled(stone, 0.88), scale=0.6, roughness=0.7),
        "marble": of("marble", mix(stone, white, 0.45), scaled(stone, 0.75), stone, scale=0.3, roughness=0.2),
        "tile": of("stone_tiles", mix(ceramic, white, 0.3), scaled(ceramic, 0.7), ceramic, scale=0.1, roughness=0.2),
        "ceramic": of("ceramic", mix(ceramic, white, 0.2), roughness=0.15),
        "glass": of("glass", rgb("cfe0e2"), roughness=0.05),
        "mirror": of("mirror", rgb("dfe6e8"), sheet.light.sky_color, roughness=0.02),
        "water": of("glass", rgb("9fd0d8"), roughness=0.05),
        "paper": of("paper", rgb("efe8d8"), rgb("8a8274"), roughness=0.9),
        "book": of("paper", rgb(sheet.accents[0]), brass, roughness=0.7),
        "painting": of("painting", rgb(sheet.accents[3]), rgb(sheet.accents[0]), rgb(sheet.accents[1]), scale=0.3, roughness=0.6),
        "leaf": of("leaf", leaf, mix(leaf, white, 0.3), scale=0.15, roughness=0.6),
        "flower": of("leaf", rgb(sheet.accents[1]), accent, scale=0.05, roughness=0.7),
        "soil": of("soil", rgb("4a3626"), rgb("2f2218"), roughness=1.0),
        "terracotta": of("plaster", mix(rgb("b9663f"), ceramic, 0.25), rgb("8f4c30"), scale=0.2, roughness=0.85),
        "wax": of("wax", rgb("f3e9d2"), roughness=0.6),
        "lamp_shade": of("textile", mix(rgb(sheet.shade), lamp, 0.2), lamp, scale=0.004, roughness=0.9),
        "bulb": of("glow", mix(lamp, white, 0.6)),
        "flame": of("glow", mix(sheet.light.fire_color, rgb("fff0b0"), 0.5)),
        "ember": of("glow", sheet.light.fire_color),
        "screen": of("lacquer", rgb("14161a"), rgb("5a6a78"), roughness=0.1),
        "appliance": of("metal", rgb("d5d8d9"), white, scale=0.004, roughness=0.3),
        "soot": of("stone_tiles", rgb("2a2522"), rgb("1a1614"), scale=0.2, roughness=0.95),
    }
