"""What a theme asks for particular things, done to a finished style: "yellow walls", "a green sofa", "no carpets"."""

import dataclasses

from wm.color import LUMINANCE
from wm.offline.style.finish import Finish, Rgb, Style, Surfaces, Wish
from wm.offline.style.reading import Request, ThemeReading
from wm.offline.style.style_sheet import TILES, mix_rgb, rgb, scaled_rgb
from wm.offline.style.vocabulary.materials import MATERIAL_WORDS, MaterialWord
from wm.offline.style.vocabulary.targets import SOFT, TARGETS, WOODEN, WordTarget

WET = ("bathroom", "kitchen")
"""Room types that keep the materials of their tiles, though not their colours."""
NEAR = 0.15
"""Distance in sRGB up to which a surface has a colour already."""

SORT_OF_MATERIAL: dict[str, str] = {
    "wood_planks": "wood", "herringbone": "wood", "parquet": "wood", "panelling": "wood", "wood": "wood", "painted_wood": "wood",
    "brick": "brick", "stone_blocks": "stone", "marble": "stone", "concrete": "stone", "rock": "stone", "sectile": "stone",
    "stone_tiles": "tile", "checker_tiles": "tile", "terracotta": "tile", "mosaic": "tile", "water_tiles": "tile",
    "carpet": "carpet", "leather": "leather", "metal": "metal", "riveted": "metal", "capsule": "plastic", "lacquer": "plastic",
    "wallpaper_damask": "paper", "wallpaper_stripe": "paper", "wallpaper_gears": "paper", "plaster": "plaster",
    "fresco": "plaster",
    "tatami": "cloth", "textile": "cloth", "velvet": "cloth", "woven": "cloth",
}  # fmt: skip
"""Sort of MATERIAL_WORDS that each material of finish.MATERIALS is of."""
LEFT_OUT: dict[str, tuple[str, ...]] = {"carpet": ("rug", "round rug", "bath mat")}
"""Pieces of furniture that are all of one sort of material."""


def granted(style: Style, reading: ThemeReading) -> Style:
    """The style with the theme's requests and without its unwanted materials."""
    for sort in reading.unwanted_materials:
        style = _without_material(style, sort)
    for request in reading.requests:
        style = _granted(style, request)
    return style


def surfaces_in(style: Style, sort: str, kind: str) -> Surfaces:
    """The surfaces of a room of this sort (wm.synth.room_names), which is finished like rooms of `kind`."""
    surfaces = style.surfaces(kind)
    for request in style.asked:
        if request.room == sort:
            surfaces = _resurfaced(surfaces, kind, TARGETS[request.target].surface, request, MATERIAL_WORDS.get(request.material))
    return surfaces


def _granted(style: Style, request: Request) -> Style:
    target, material = TARGETS[request.target], MATERIAL_WORDS.get(request.material)
    if request.absent:
        return _with_wish(style, Wish(target.kinds, absent=True)) if target.kinds else style
    if target.surface and request.room:
        return dataclasses.replace(style, asked=(*style.asked, request))
    if target.surface:
        rooms = tuple((kind, _resurfaced(surfaces, kind, target.surface, request, material)) for kind, surfaces in style.rooms)
        return dataclasses.replace(style, rooms=rooms)
    if target.kinds and request.target not in ("rug", "curtain", "flower", "candle", "plant"):
        return _with_wish(style, _wish(target, request, material))
    return _with_slots(style, target, request, material)


def _with_wish(style: Style, wish: Wish) -> Style:
    return dataclasses.replace(style, wishes=(*style.wishes, wish))


def _wish(target: WordTarget, request: Request, material: MaterialWord | None) -> Wish:
    color = rgb(request.color) if request.color else rgb(material.codes[0]) if material else None
    return Wish(kinds=target.kinds, slots=target.slots, slot=material.slot if material else "", color=color)


def _resurfaced(surfaces: Surfaces, kind: str, surface: str, request: Request, material: MaterialWord | None) -> Surfaces:
    own: Finish = getattr(surfaces, surface)
    named = material and (material.floor if surface == "floor" else material.wall)
    new, bare = own, {}
    if material and named and named != own.material and not (kind in WET and own.material in TILES):
        new = Finish(named, tuple(rgb(c) for c in material.codes), material.scale, roughness=material.roughness, wear=own.wear)
        bare = {"wainscot": None, "wainscot_height": 0.0} if surface == "wall" and kind not in WET else {}
    if request.color and not _has_color(new, rgb(request.color)):
        new = recolored(new, rgb(request.color))
    if request.second and len(new.colors) > 1:
        new = dataclasses.replace(new, colors=(new.colors[0], rgb(request.second), *new.colors[2:]))
    elif request.second:
        new = Finish("wallpaper_stripe", (rgb(request.color), rgb(request.second)), 0.2, roughness=own.roughness)
    return dataclasses.replace(surfaces, **{surface: new}, **bare)


def recolored(finish: Finish, color: Rgb) -> Finish:
    """The finish in a colour, its other colours as much lighter or darker than that as they were than its own."""
    base = _luminance(finish.colors[0])
    others = tuple(scaled_rgb(color, min(max((_luminance(c) + 0.05) / (base + 0.05), 0.55), 1.2)) for c in finish.colors[1:])
    return dataclasses.replace(finish, colors=(color, *others))


def _luminance(color: Rgb) -> float:
    return float(sum(float(weight) * part for weight, part in zip(LUMINANCE, color)))


def _has_color(finish: Finish, color: Rgb) -> bool:
    return sum((a - b) ** 2 for a, b in zip(finish.colors[0], color)) ** 0.5 < NEAR


def _with_slots(style: Style, target: WordTarget, request: Request, material: MaterialWord | None) -> Style:
    """Slots of all furniture in a colour or a material; "red lanterns" also tint what the lamps give."""
    if material and request.target == "wood" and request.material != "wood":
        colors = {
            "dark_wood": scaled_rgb(rgb(material.codes[0]), 0.7),
            "light_wood": mix_rgb(rgb(material.codes[0]), (1.0, 1.0, 1.0), 0.25),
        }
        slots = tuple(
            (name, recolored(f, colors.get(name, rgb(material.codes[0]))) if name in target.slots else f)
            for name, f in style.slots
        )
        return dataclasses.replace(style, slots=slots)
    color = rgb(request.color) if request.color else rgb(material.codes[0]) if material else None
    if color is None:
        return style
    change = {name: style.slot(material.slot) for name in target.slots} if material and material.slot else {}
    slots = tuple((name, recolored(change.get(name, f), color) if name in target.slots else f) for name, f in style.slots)
    style = dataclasses.replace(style, slots=slots)
    if request.target == "lamp":
        light = dataclasses.replace(style.light, lamp_color=mix_rgb(style.light.lamp_color, color, 0.6))
        style = dataclasses.replace(style, light=light)
    return style


def _without_material(style: Style, sort: str) -> Style:
    """Surfaces and slots of one sort of material replaced by another sort's, in a colour as light."""

    def other(finish: Finish | None, surface: str) -> Finish | None:
        if finish is None or SORT_OF_MATERIAL.get(finish.material) != sort:
            return finish
        name, scale = (
            ("plaster", 1.0) if surface != "floor" else ("wood_planks", 0.18) if sort != "wood" else ("stone_tiles", 0.5)
        )
        if sort == "plaster":
            name = "wood_planks"
        grey = mix_rgb(finish.colors[0], rgb("b8b2a8"), 0.6) if sort == "wood" else finish.colors[0]
        base = rgb("a87c4c") if name == "wood_planks" else grey
        return Finish(name, (base, scaled_rgb(base, 0.6), scaled_rgb(base, 0.85)), scale, roughness=finish.roughness)

    def room(own: Surfaces) -> Surfaces:
        changed = {name: other(getattr(own, name), name) for name in ("wall", "floor", "ceiling", "trim", "wainscot")}
        return dataclasses.replace(own, **changed)

    slots = style.slots
    painted = style.slot("painted_wood").colors[0]
    if sort == "wood":
        slots = tuple((n, Finish("lacquer", (painted, (1.0, 1.0, 1.0)), roughness=0.3) if n in WOODEN else f) for n, f in slots)
    if sort == "leather":
        slots = tuple((n, style.slot("linen") if n == "leather" else f) for n, f in slots)
    if sort == "metal":
        slots = tuple((n, style.slot("painted_wood") if f.material == "metal" else f) for n, f in slots)
    if sort == "cloth":
        slots = tuple((n, style.slot("leather") if n in SOFT else f) for n, f in slots)
    style = dataclasses.replace(style, slots=slots, rooms=tuple((kind, room(own)) for kind, own in style.rooms))
    return _with_wish(style, Wish(LEFT_OUT[sort], absent=True)) if sort in LEFT_OUT else style
