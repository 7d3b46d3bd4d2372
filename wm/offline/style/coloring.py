"""Colours of a theme in its style sheet: the palette dyes textiles, unwanted colours turn grey."""

import colorsys
import dataclasses
import hashlib

from wm.offline.style.finish import Finish, Rgb
from wm.offline.style.reading import ThemeReading
from wm.offline.style.style_sheet import StyleSheet, hex_code, mix_rgb, rgb

DYED: tuple[str, ...] = ("fabric", "accent", "leather", "rug", "rug_border", "painted", "shade", "ceramic")
"""Colours of a sheet that an unwanted colour is taken out of, besides walls, floors and accents."""
HUE_APART, LIGHT_APART = 0.09, 0.22
"""How near in hue (turns), or for greys in lightness, a colour is to be called by another's name."""
WALL_SHARE = 0.5
"""Share of the first colour of a palette in the walls of a theme that names no family."""


def dyed(sheet: StyleSheet, reading: ThemeReading) -> StyleSheet:
    """The first colour of the palette dyes textiles, the second the accents; "dark wood" and "light wood" stain the wood."""
    colors = reading.palette
    if colors:
        sheet = dataclasses.replace(
            sheet, fabric=colors[0], rug=colors[0], accents=(*colors, *sheet.accents)[: len(sheet.accents)]
        )
        if not reading.families:
            sheet = dataclasses.replace(sheet, wall=_mixed(sheet.wall, rgb(colors[-1]), WALL_SHARE), rooms=())
    if colors[1:]:
        sheet = dataclasses.replace(sheet, accent=colors[1], rug_border=colors[1])
    if reading.wood_tone == "dark":
        sheet = dataclasses.replace(sheet, wood=hex_code(mix_rgb(rgb(sheet.wood), rgb("3a2216"), 0.5)))
    if reading.wood_tone == "light":
        sheet = dataclasses.replace(sheet, wood=hex_code(mix_rgb(rgb(sheet.wood), rgb("e0c8a0"), 0.7)))
    for code in reading.unwanted_colors:
        sheet = _without(sheet, rgb(code))
    return sheet


def turned(sheet: StyleSheet, unknown: tuple[str, ...]) -> StyleSheet:
    """The neutral sheet with its textiles and accents turned around the colour wheel by the words that nobody knows.

    So two unknown themes differ, and words that are known, such as those of a sofa, do not turn the rest.
    """
    digest = hashlib.sha256(" ".join(sorted(unknown)).encode()).digest()
    turn = digest[0] / 256

    def around(code: str) -> str:
        hue, light, saturation = colorsys.rgb_to_hls(*rgb(code))
        return hex_code(colorsys.hls_to_rgb((hue + turn) % 1.0, light, saturation))

    wall = dataclasses.replace(sheet.wall, colors=(mix_rgb(rgb("e6e1d8"), rgb(around("c9a878")), 0.35),))
    return dataclasses.replace(
        sheet, wall=wall, fabric=around("5f7a86"), accent=around(sheet.accent), rug=around("b89a80"),
        accents=tuple(around(c) for c in sheet.accents),
    )  # fmt: skip


def same_name(a: Rgb, b: Rgb) -> bool:
    """Whether two colours would be called by one name: near in hue, or both grey and alike in lightness."""
    hue_a, light_a, _ = colorsys.rgb_to_hls(*a)
    hue_b, light_b, _ = colorsys.rgb_to_hls(*b)
    grey_a, grey_b = (max(color) - min(color) < 0.12 for color in (a, b))
    if grey_a or grey_b:
        return grey_a and grey_b and abs(light_a - light_b) < LIGHT_APART
    apart = abs(hue_a - hue_b) % 1.0
    return min(apart, 1 - apart) < HUE_APART


def _without(sheet: StyleSheet, color: Rgb) -> StyleSheet:
    def code(own: str) -> str:
        return hex_code(_other(rgb(own))) if same_name(rgb(own), color) else own

    def finish(own: Finish | None) -> Finish | None:
        if own is None or not same_name(own.colors[0], color):
            return own
        return dataclasses.replace(own, colors=tuple(_other(c) for c in own.colors))

    surfaces = {
        name: finish(getattr(sheet, name)) for name in ("wall", "floor", "ceiling", "trim", "wainscot", "wet_wall", "wet_floor")
    }
    rooms = tuple((kind, finish(wall) or wall, finish(floor) or floor) for kind, wall, floor in sheet.rooms)
    colors = {name: code(getattr(sheet, name)) for name in DYED}
    return dataclasses.replace(sheet, **surfaces, **colors, rooms=rooms, accents=tuple(code(c) for c in sheet.accents))


def _other(color: Rgb) -> Rgb:
    """What takes the place of an unwanted colour: a warm grey as light as it, or for greys a brown or a cream."""
    light = colorsys.rgb_to_hls(*color)[1]
    if max(color) - min(color) < 0.12:
        return mix_rgb(rgb("d9b88a"), rgb("8a6a48"), 0.0 if light > 0.5 else 1.0)
    return colorsys.hls_to_rgb(0.1, light, 0.08)


def _mixed(finish: Finish, color: Rgb, share: float) -> Finish:
    return dataclasses.replace(finish, colors=tuple(mix_rgb(c, color, share) for c in finish.colors))
