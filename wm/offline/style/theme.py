"""What a theme's words mean: family, surfaces, furniture finishes, shapes and light.

Words are matched whole and in lower case. Family words vote (ties go to the word that comes first in the theme); then
colour, material, time and mood words change what the family left open. A theme without a family word gets the neutral
family, its colours turned by a stable hash of the text, so that two unknown themes differ and one theme never does.
The vocabulary (MATERIALS, SLOTS) and the records live in wm.offline.style.finish.
"""

import colorsys
import dataclasses
import functools
import hashlib
import itertools
import math
import re

from wm.offline.style.families import FAMILIES
from wm.offline.style.finish import MATERIALS, SLOTS, Finish, Form, Light, Rgb, Style, Surfaces
from wm.offline.style.style_sheet import StyleSheet, build_style, mix_rgb, rgb

__all__ = ["MATERIALS", "SLOTS", "Finish", "Form", "Light", "Rgb", "Style", "Surfaces", "style_of"]

NEUTRAL = "modern"

COLOR_WORDS: dict[str, str] = {
    "red": "a82f2c", "crimson": "8a1f2c", "burgundy": "5f1f2c", "pink": "e89ab0", "orange": "d8782f", "yellow": "e0b83f",
    "gold": "c9a040", "golden": "c9a040", "green": "4a7a4a", "emerald": "1f7a5a", "olive": "6b6f3a", "teal": "2f7a7a",
    "turquoise": "3fb0b0", "blue": "3f6a9a", "navy": "24365a", "indigo": "3a3a7a", "purple": "6a3f8a", "violet": "7a4fa0",
    "lavender": "b0a0d0", "white": "efeeea", "ivory": "f0e8d6", "cream": "f0e6cc", "beige": "d8c8a8", "grey": "8f9194",
    "gray": "8f9194", "black": "2a2a2c", "brown": "6b4a32", "rose": "c97f86", "coral": "e5806a", "silver": "b8bcc0",
}  # fmt: skip

FLOOR_WORDS: dict[str, tuple[str, float, tuple[str, str, str]]] = {
    "marble": ("marble", 0.8, ("d3cabb", "8f8474", "b3a692")),
    "terracotta": ("terracotta", 0.3, ("b8683f", "80583f", "a05838")),
    "concrete": ("concrete", 1.2, ("a5a39e", "8a8883", "8a8883")),
    "mosaic": ("mosaic", 0.03, ("e0d6c0", "3f6a7a", "8a3f30")),
    "carpet": ("carpet", 0.01, ("8a7f78", "6f6660", "6f6660")),
    "carpeted": ("carpet", 0.01, ("8a7f78", "6f6660", "6f6660")),
    "herringbone": ("herringbone", 0.5, ("96693f", "503418", "ab7c4e")),
    "parquet": ("parquet", 0.4, ("96693f", "503418", "ab7c4e")),
    "tiled": ("checker_tiles", 0.35, ("e9e4d8", "5a5a5c", "a09c92")),
}
MADE_OF: dict[str, tuple[str, ...]] = {"marble": ("sectile",), "mosaic": ("sectile",)}
"""Floors that are of a word's material already, in a pattern of their own."""
WALL_WORDS: dict[str, tuple[str, float, tuple[str, str, str]]] = {
    "brick": ("brick", 0.24, ("a05a44", "b8ab9a", "834936")),
    "stone": ("stone_blocks", 0.6, ("a09787", "6a6152", "877e6e")),
    "wooden": ("wood_planks", 0.18, ("a5743f", "5a3a1c", "8a5c30")),
    "panelled": ("panelling", 0.5, ("6b4528", "3a2414", "855a38")),
    "wallpapered": ("wallpaper_damask", 0.6, ("8a9a8a", "a8b5a0", "c9b880")),
    "plaster": ("plaster", 1.0, ("e0d3bd", "c9b89c", "c9b89c")),
}
HINTS = frozenset({"brass", "copper", "clock"})
"""Words that say nothing of a family unless another of its words is there: a gothic hall may have brass lamps."""
OF_SURFACES = ("wall", "walls", "floor", "floors", "ceiling", "ceilings", "tile", "tiles", "board", "boards", "stone", "marble")
"""Nouns after which a colour word is of the building, not of its textiles."""
NIGHT = ("night", "nocturnal", "midnight", "moonlit", "moonlight")
DUSK = ("sunset", "dusk", "dawn", "sunrise", "evening", "twilight")
DIM = ("dark", "gloomy", "moody", "dim", "candlelit", "haunted", "shadowy")
BRIGHT = ("bright", "airy", "sunny", "sunlit", "light")
ORNATE = ("ornate", "elaborate", "lavish", "maximalist", "opulent", "decorated")
PLAIN = ("plain", "simple", "sparse", "austere", "minimalist", "minimal")


def words_of(text: str) -> list[str]:
    """Lower-case words of a text in their order: "Beach-house" gives beach, house."""
    return re.findall(r"[a-z0-9]+", text.lower())


@functools.lru_cache(maxsize=64)
def style_of(theme: str) -> Style:
    """What a theme's words mean; any text gives a style, the same text always the same one."""
    words = words_of(theme)
    family = family_of(words)
    sheet = FAMILIES[family or NEUTRAL]
    if family is None:
        sheet = turned(sheet, theme)
    style = build_style(theme, family or "neutral", tinted(sheet, words))
    return dataclasses.replace(
        style,
        rooms=tuple((kind, refinished_surfaces(surfaces, kind, words)) for kind, surfaces in style.rooms),
        light=relit(style.light, words),
        form=reshaped(style.form, words),
    )


def family_of(words: list[str]) -> str | None:
    """The family with most of its words in the theme, the earlier word deciding ties; None where none is.

    The neutral family's words ("modern", "apartment") only count where no other family has one: a modern beach house is
    a beach house.
    """
    votes = {name: [i for i, word in enumerate(words) if word in sheet.words] for name, sheet in FAMILIES.items()}
    votes = {name: found if any(words[i] not in HINTS for i in found) else [] for name, found in votes.items()}
    best = min(votes, key=lambda name: (name == NEUTRAL or not votes[name], -len(votes[name]), votes[name][:1]))
    best = best if votes[best] else NEUTRAL
    return best if votes[best] else None


def turned(sheet: StyleSheet, theme: str) -> StyleSheet:
    """The neutral sheet with its textiles and accents turned around the colour wheel by a hash of the theme."""
    digest = hashlib.sha256(" ".join(words_of(theme)).encode()).digest()
    turn = digest[0] / 256

    def around(code: str) -> str:
        hue, light, saturation = colorsys.rgb_to_hls(*rgb(code))
        return code_of(colorsys.hls_to_rgb((hue + turn) % 1.0, light, saturation))

    wall = dataclasses.replace(sheet.wall, colors=(mix_rgb(rgb("e6e1d8"), rgb(around("c9a878")), 0.35),))
    return dataclasses.replace(
        sheet, wall=wall, fabric=around("5f7a86"), accent=around(sheet.accent), rug=around("b89a80"),
        accents=tuple(around(c) for c in sheet.accents),
    )  # fmt: skip


def code_of(color: Rgb) -> str:
    """Six-digit hexadecimal code of a colour."""
    return "".join(f"{round(min(max(c, 0.0), 1.0) * 255):02x}" for c in color)


def tinted(sheet: StyleSheet, words: list[str]) -> StyleSheet:
    """Colour words dye the textiles (the first word) and the accents (the second); "dark wood" and "light wood" the wood.

    "white walls" says nothing of the textiles.
    """
    followed = zip(words, [*words[1:], ""])
    colors = [COLOR_WORDS[word] for word, noun in followed if word in COLOR_WORDS and noun not in OF_SURFACES]
    if colors:
        sheet = dataclasses.replace(
            sheet, fabric=colors[0], rug=colors[0], accents=(*colors, *sheet.accents)[: len(sheet.accents)]
        )
    if colors[1:]:
        sheet = dataclasses.replace(sheet, accent=colors[1], rug_border=colors[1])
    pairs = list(itertools.pairwise(words))
    if ("dark", "wood") in pairs:
        sheet = dataclasses.replace(sheet, wood=code_of(mix_rgb(rgb(sheet.wood), rgb("3a2216"), 0.5)))
    if ("light", "wood") in pairs or ("pale", "wood") in pairs:
        sheet = dataclasses.replace(sheet, wood=code_of(mix_rgb(rgb(sheet.wood), rgb("e0c8a0"), 0.7)))
    return sheet


def refinished_surfaces(surfaces: Surfaces, kind: str, words: list[str]) -> Surfaces:
    """The first material word of each sort chooses floors ("marble") and walls ("brick"); wet rooms keep their tiles."""
    if kind in ("bathroom", "kitchen"):
        return surfaces
    for material, scale, codes in [FLOOR_WORDS[word] for word in words if word in FLOOR_WORDS][:1]:
        if surfaces.floor.material in MADE_OF.get(material, ()):
            continue
        floor = Finish(material, tuple(rgb(c) for c in codes), scale, roughness=surfaces.floor.roughness)
        surfaces = dataclasses.replace(surfaces, floor=floor)
    for material, scale, codes in [WALL_WORDS[word] for word in words if word in WALL_WORDS][:1]:
        wall = Finish(material, tuple(rgb(c) for c in codes), scale, roughness=surfaces.wall.roughness)
        surfaces = dataclasses.replace(surfaces, wall=wall, wainscot=None, wainscot_height=0.0)
    return surfaces


def relit(light: Light, words: list[str]) -> Light:
    """Time and mood words: night and dusk, dim and bright."""
    if any(word in NIGHT for word in words):
        light = dataclasses.replace(light, sun_color=rgb("b8c8ff"), sun_strength=0.12, sky_color=rgb("3a4a78"), sky_strength=0.2,
                                    lamp_strength=1.0)  # fmt: skip
    elif any(word in DUSK for word in words):
        light = dataclasses.replace(
            light,
            sun_color=rgb("ffb070"),
            sun_elevation=math.radians(9),
            sky_color=rgb("e0a8a0"),
            sky_strength=light.sky_strength * 0.7,
            lamp_strength=max(light.lamp_strength, 0.8),
        )
    if any(word in DIM for word in words) and not any(pair == ("dark", "wood") for pair in itertools.pairwise(words)):
        light = dataclasses.replace(light, sun_strength=light.sun_strength * 0.6, sky_strength=light.sky_strength * 0.7)
    if any(word in BRIGHT for word in words):
        light = dataclasses.replace(
            light, sun_strength=min(light.sun_strength * 1.3, 1.0), sky_strength=min(light.sky_strength * 1.2, 1.0)
        )
    return light


def reshaped(form: Form, words: list[str]) -> Form:
    """ "ornate" adds finials, mouldings and clutter; "simple" takes them away."""
    if any(word in ORNATE for word in words):
        return dataclasses.replace(form, ornament=min(form.ornament + 0.3, 1.0))
    if any(word in PLAIN for word in words):
        return dataclasses.replace(form, ornament=form.ornament * 0.4)
    return form
