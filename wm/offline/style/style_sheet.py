"""The style sheet of a family: the choices that define it, and how a sheet is completed to a full style."""

import dataclasses
import math

from wm.offline.style.finish import SLOTS, Finish, Form, Light, Rgb, Style, Surfaces, Wish


def rgb(code: str) -> Rgb:
    """sRGB colour of a six-digit hexadecimal code."""
    return int(code[0:2], 16) / 255, int(code[2:4], 16) / 255, int(code[4:6], 16) / 255


def hex_code(color: Rgb) -> str:
    """Six-digit hexadecimal code of a colour, clipped to [0, 1]."""
    return "".join(f"{round(min(max(c, 0.0), 1.0) * 255):02x}" for c in color)


def mix_rgb(a: Rgb, b: Rgb, share: float) -> Rgb:
    """a with `share` of b."""
    return a[0] + (b[0] - a[0]) * share, a[1] + (b[1] - a[1]) * share, a[2] + (b[2] - a[2]) * share


def scaled_rgb(a: Rgb, factor: float) -> Rgb:
    """a made darker (factor below 1) or lighter, clipped to [0, 1]."""
    return min(a[0] * factor, 1.0), min(a[1] * factor, 1.0), min(a[2] * factor, 1.0)


TILES = ("stone_tiles", "water_tiles", "checker_tiles", "terracotta", "mosaic")
"""Materials that bathrooms are not clad in up to the ceiling."""


@dataclasses.dataclass(frozen=True)
class StyleSheet:
    """The choices that define a style family; colours are hexadecimal codes."""

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
    kin: str = ""  # family whose furniture a place takes; "" for its own
    place: bool = False  # whether the sheet is of a place, whose surfaces stay where a theme names a style beside it
    slots: tuple[tuple[str, Finish], ...] = ()  # furniture slots that differ from what the colours give
    without: tuple[str, ...] = ()  # kinds of furniture that the place has not


def finish(
    material: str,
    *codes: str,
    scale: float | int = 0.1,
    contrast: float | int = 1.0,
    roughness: float | int = 0.7,
    wear: float | int = 0.2,
) -> Finish:
    return Finish(material, tuple(rgb(c) for c in codes), scale, contrast, roughness, wear)


def light(
    sun: str,
    strength: float | int,
    elevation: float | int,
    azimuth: float | int,
    sky: str,
    sky_strength: float | int,
    lamp: str,
    lamps: float | int,
    outlook: str = "country",
) -> Light:
    """A Light from codes and degrees."""
    sun_at = (math.radians(elevation), math.radians(azimuth))
    return Light(rgb(sun), strength, *sun_at, rgb(sky), sky_strength, rgb(lamp), lamps, outlook=outlook)


def build_style(theme: str, family: str, sheet: StyleSheet) -> Style:
    """The full style of a sheet: one finish for every surface and every slot."""
    dry = Surfaces(sheet.wall, sheet.floor, sheet.ceiling, sheet.trim, sheet.wainscot, sheet.wainscot_height)
    rooms = {"other": dry}
    if sheet.wet_wall and sheet.wet_floor:
        rooms["bathroom"] = Surfaces(sheet.wet_wall, sheet.wet_floor, sheet.ceiling, sheet.trim)
        if sheet.wet_wall.material in TILES:  # tiled as high as it splashes
            rooms["bathroom"] = Surfaces(sheet.wall, sheet.wet_floor, sheet.ceiling, sheet.trim, sheet.wet_wall, 1.7)
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
    slots = slot_finishes(sheet) | dict(sheet.slots)
    wishes = (Wish(sheet.without, absent=True),) if sheet.without else ()
    return Style(theme, family, tuple(rooms.items()), tuple((s, slots[s]) for s in SLOTS), sheet.form, sheet.light,
                 tuple(rgb(c) for c in sheet.accents), wishes)  # fmt: skip


def slot_finishes(sheet: StyleSheet) -> dict[str, Finish]:
    """One finish for every furniture slot."""
    wood, dark, fabric, accent = rgb(sheet.wood), rgb(sheet.dark_wood), rgb(sheet.fabric), rgb(sheet.accent)
    linen, metal, brass, stone = rgb(sheet.linen), rgb(sheet.metal), rgb(sheet.brass), rgb(sheet.stone)
    painted, ceramic, lamp, leaf = rgb(sheet.painted), rgb(sheet.ceramic), sheet.light.lamp_color, rgb(sheet.leaf)
    white, black = (1.0, 1.0, 1.0), (0.0, 0.0, 0.0)

    def of(material: str, *colors: Rgb, scale: float = 0.01, roughness: float = 0.7, contrast: float = 1.0) -> Finish:
        return Finish(material, colors, scale, contrast, roughness, sheet.floor.wear)

    return {
        "wood": of("wood", wood, scaled_rgb(wood, 0.65), scale=0.03, roughness=0.5),
        "dark_wood": of("wood", dark, scaled_rgb(dark, 0.6), scale=0.03, roughness=0.4),
        "light_wood": of("wood", mix_rgb(wood, white, 0.3), scaled_rgb(wood, 0.9), scale=0.03, roughness=0.55),
        "panel_wood": of("wood", mix_rgb(dark, wood, 0.5), scaled_rgb(dark, 0.7), scale=0.04, roughness=0.45),
        "painted_wood": of("painted_wood", painted, wood, scale=0.04, roughness=0.5),
        "lacquer": of("lacquer", scaled_rgb(dark, 0.55), white, roughness=0.15),
        "fabric": of(sheet.upholstery, fabric, mix_rgb(fabric, white, 0.25), scale=0.004, roughness=0.9),
        "fabric_accent": of(sheet.upholstery, accent, mix_rgb(accent, white, 0.25), scale=0.004, roughness=0.9),
        "velvet": of("velvet", fabric, mix_rgb(fabric, white, 0.35), roughness=0.8),
        "leather": of("leather", rgb(sheet.leather), scaled_rgb(rgb(sheet.leather), 0.6), scale=0.01, roughness=0.5),
        "linen": of("textile", linen, scaled_rgb(linen, 0.92), scale=0.003, roughness=0.95),
        "pillow": of("textile", mix_rgb(linen, white, 0.4), linen, scale=0.003, roughness=0.95),
        "blanket": of("textile", mix_rgb(fabric, linen, 0.25), mix_rgb(fabric, linen, 0.45), scale=0.012, roughness=0.95),
        "curtain": of("textile", mix_rgb(fabric, linen, 0.3), mix_rgb(fabric, linen, 0.4), scale=0.004, roughness=0.9),
        "rug": of("carpet", rgb(sheet.rug), mix_rgb(rgb(sheet.rug), white, 0.2), scale=0.01, roughness=1.0),
        "rug_border": of("carpet", rgb(sheet.rug_border), scaled_rgb(rgb(sheet.rug_border), 0.8), scale=0.01, roughness=1.0),
        "woven": of("woven", mix_rgb(wood, linen, 0.4), scaled_rgb(wood, 0.6), scale=0.012, roughness=0.8),
        "metal": of("metal", metal, mix_rgb(metal, white, 0.4), scale=0.004, roughness=0.4),
        "dark_metal": of("metal", mix_rgb(metal, black, 0.6), mix_rgb(metal, white, 0.2), scale=0.004, roughness=0.5),
        "brass": of("metal", brass, mix_rgb(brass, white, 0.5), scale=0.004, roughness=0.25),
        "chrome": of("metal", rgb("c9cdd0"), white, scale=0.004, roughness=0.12),
        "steel": of("metal", rgb("757a80"), white, scale=0.004, roughness=0.3),
        "stone": of("stone_tiles", stone, scaled_rgb(stone, 0.7), scaled_rgb(stone, 0.88), scale=0.6, roughness=0.7),
        "marble": of(
            "marble", mix_rgb(stone, white, 0.2), scaled_rgb(stone, 0.6), scaled_rgb(stone, 0.85), scale=0.3, roughness=0.2
        ),
        "tile": of("stone_tiles", mix_rgb(ceramic, white, 0.3), scaled_rgb(ceramic, 0.7), ceramic, scale=0.1, roughness=0.2),
        "ceramic": of("ceramic", mix_rgb(ceramic, white, 0.2), roughness=0.15),
        "glass": of("glass", rgb("cfe0e2"), roughness=0.05),
        "mirror": of("mirror", rgb("dfe6e8"), sheet.light.sky_color, roughness=0.02),
        "water": of("glass", rgb("9fd0d8"), roughness=0.05),
        "paper": of("paper", rgb("efe8d8"), rgb("8a8274"), roughness=0.9),
        "book": of("paper", rgb(sheet.accents[0]), brass, roughness=0.7),
        "painting": of(
            "painting",
            rgb(sheet.accents[3]),
            rgb(sheet.accents[0]),
            rgb(sheet.accents[1]),
            scale=0.3,
            roughness=0.6,
            contrast=0.1,
        ),
        "leaf": of("leaf", leaf, mix_rgb(leaf, white, 0.3), scale=0.15, roughness=0.6),
        "flower": of("leaf", rgb(sheet.accents[1]), accent, scale=0.05, roughness=0.7),
        "soil": of("soil", rgb("4a3626"), rgb("2f2218"), roughness=1.0),
        "terracotta": of("plaster", mix_rgb(rgb("b9663f"), ceramic, 0.25), rgb("8f4c30"), scale=0.2, roughness=0.85),
        "wax": of("wax", rgb("f3e9d2"), roughness=0.6),
        "lamp_shade": of("textile", mix_rgb(rgb(sheet.shade), lamp, 0.2), lamp, scale=0.004, roughness=0.9),
        "bulb": of("glow", mix_rgb(lamp, white, 0.6)),
        "flame": of("glow", mix_rgb(sheet.light.fire_color, rgb("fff0b0"), 0.5)),
        "ember": of("glow", sheet.light.fire_color),
        "screen": of("lacquer", rgb("14161a"), rgb("5a6a78"), roughness=0.1),
        "appliance": of("metal", rgb("d5d8d9"), white, scale=0.004, roughness=0.3),
        "soot": of("stone_tiles", rgb("2a2522"), rgb("1a1614"), scale=0.2, roughness=0.95),
        "foliage": of("carpet", leaf, scaled_rgb(leaf, 0.1), scale=0.012),  # clipped: flecked as pile is
    }
