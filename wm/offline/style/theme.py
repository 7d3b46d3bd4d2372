"""What a theme's words mean: family, surfaces, furniture finishes, shapes and light.

    words -> ThemeReading (wm.offline.style.words) -> StyleSheet (blending, coloring) -> Style (requests, mood)

A theme without a family or a place gets the neutral family, its colours turned by the words that are not known, so that two
unknown themes differ and one theme never does.
"""

import functools

from wm.offline.style.blending import blended
from wm.offline.style.coloring import dyed, turned
from wm.offline.style.families import FAMILIES
from wm.offline.style.finish import Style
from wm.offline.style.mood import in_mood
from wm.offline.style.requests import granted
from wm.offline.style.style_sheet import build_style
from wm.offline.style.words import NEUTRAL, read_theme


@functools.lru_cache(maxsize=64)
def style_of(theme: str) -> Style:
    """What a theme's words mean; any text gives a style, the same text always the same one."""
    reading = read_theme(theme)
    if reading.families:
        sheet, family = blended(reading.families), ""
    else:
        sheet, family = turned(FAMILIES[NEUTRAL], reading.unknown), "neutral"
    style = build_style(theme, family or sheet.kin, dyed(sheet, reading))
    return in_mood(granted(style, reading), reading.moods)
