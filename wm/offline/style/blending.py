"""Sheets of several families as one: a place in a style, or two styles side by side."""

import dataclasses

from wm.offline.style.families import FAMILIES
from wm.offline.style.finish import Finish, Light
from wm.offline.style.style_sheet import StyleSheet, hex_code, mix_rgb, rgb

TINT = 0.42
"""Share of a style's own surfaces in the colours of a place that is built in it."""
PATTERNLESS = frozenset({"glow", "glass", "mirror"})


def blended(families: tuple[tuple[str, float], ...]) -> StyleSheet:
    """The sheet of one or two families (reading.ThemeReading.families); its `kin` says whose furniture it takes."""
    (name, share), *others = families
    first = _named(name)
    if not others:
        return first
    second = _named(others[0][0])
    if first.place and not second.place:
        return in_style(first, second)
    return beside(first, second, 1 - share)


def _named(name: str) -> StyleSheet:
    sheet = FAMILIES[name]
    return sheet if sheet.kin else dataclasses.replace(sheet, kin=name)


def in_style(place: StyleSheet, style: StyleSheet) -> StyleSheet:
    """A place's surfaces in the colours of a style, with the style's furniture, trims and shapes: "gothic spaceship"."""
    tinted = {
        name: _toward(own, model, TINT)
        for name in ("wall", "floor", "ceiling", "wainscot", "wet_wall", "wet_floor")
        if (own := getattr(place, name)) is not None and (model := getattr(style, name) or style.wall) is not None
    }
    return dataclasses.replace(
        style,
        **{"wainscot": None, **tinted},
        wainscot_height=place.wainscot_height,
        rooms=(),
        place=True,
        without=place.without,
        light=_between(place.light, style.light, 0.5),
        accents=tuple(a if k % 2 else b for k, (a, b) in enumerate(zip(place.accents, style.accents))),
    )


def beside(first: StyleSheet, second: StyleSheet, share: float) -> StyleSheet:
    """Two styles: walls and shapes of the first; floors, woods and half of the textiles of the second; colours between."""

    def between(name: str) -> str:
        return hex_code(mix_rgb(rgb(getattr(first, name)), rgb(getattr(second, name)), share))

    return dataclasses.replace(
        first,
        wall=_toward(first.wall, second.wall, 0.5 * share),
        floor=second.floor,
        ceiling=_toward(first.ceiling, second.ceiling, share),
        trim=second.trim,
        rooms=(),
        wood=between("wood"),
        dark_wood=between("dark_wood"),
        painted=between("painted"),
        accent=second.fabric,
        rug=second.rug,
        rug_border=first.rug_border,
        shade=between("shade"),
        stone=between("stone"),
        accents=tuple(a if k % 2 else b for k, (a, b) in enumerate(zip(second.accents, first.accents))),
        light=_between(first.light, second.light, share),
        slots=first.slots or second.slots,
    )


def _toward(finish: Finish, model: Finish, share: float) -> Finish:
    """The finish with its colours moved toward the first colour of another."""
    if finish.material in PATTERNLESS or model.material in PATTERNLESS:
        return finish
    return dataclasses.replace(finish, colors=tuple(mix_rgb(color, model.colors[0], share) for color in finish.colors))


def _between(a: Light, b: Light, share: float) -> Light:
    def along(x: float, y: float) -> float:
        return x + (y - x) * share

    return Light(
        sun_color=mix_rgb(a.sun_color, b.sun_color, share),
        sun_strength=along(a.sun_strength, b.sun_strength),
        sun_elevation=along(a.sun_elevation, b.sun_elevation),
        sun_azimuth=a.sun_azimuth,
        sky_color=mix_rgb(a.sky_color, b.sky_color, share),
        sky_strength=along(a.sky_strength, b.sky_strength),
        lamp_color=mix_rgb(a.lamp_color, b.lamp_color, share),
        lamp_strength=along(a.lamp_strength, b.lamp_strength),
        fire_color=a.fire_color,
        outlook=b.outlook if a.outlook == "country" else a.outlook,
    )
