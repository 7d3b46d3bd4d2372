"""How heavy furniture is: a density for each material, and how thick furniture makers build with it.

A part of an object is a closed solid in the scaffold, and seldom one in a real room: a wardrobe is made of boards. So a part
weighs density x min(its volume, its surface x wall). The densities are rounded from common tables (upholstery and mattresses as
foam with a cover); the walls are ours.
"""

import dataclasses
import math
import re


@dataclasses.dataclass(frozen=True)
class Substance:
    """A material as the mass of a part goes by it."""

    density: float  # kg/m^3
    wall: float = math.inf  # metres: thicker parts are hollow with walls of this thickness


_BY_WORD: tuple[tuple[str, Substance], ...] = (
    ("flame|light|glow", Substance(1.0)),
    ("ember|soot|coal", Substance(400.0)),
    ("brass|bronze|copper|gold|silver", Substance(8500.0, 0.002)),
    ("chrome|steel|iron|metal|alumin|lacquer", Substance(7800.0, 0.0015)),
    ("appliance|machine|engine", Substance(150.0)),
    ("screen|monitor|television", Substance(400.0)),
    ("glass|bulb|mirror|crystal", Substance(2500.0, 0.004)),
    ("ceramic|porcelain|terracotta|clay|enamel|tile", Substance(2200.0, 0.006)),
    ("stone|marble|granite|concrete|plaster|brick|slate", Substance(2600.0, 0.03)),
    ("soil|earth|sand", Substance(1400.0)),
    ("water", Substance(1000.0)),
    ("wax|candle|soap", Substance(900.0)),
    ("book", Substance(700.0)),
    ("lamp_shade|shade|paper|card|painting|picture|canvas|print|poster", Substance(700.0, 0.002)),
    ("leaf|leaves|flower|petal|plant|grass|fern", Substance(150.0)),
    ("rug|carpet|curtain|drape|towel", Substance(250.0, 0.004)),
    ("fabric|linen|blanket|pillow|cushion|velvet|leather|mattress|foam|wool|cotton|silk|upholster", Substance(70.0)),
    ("woven|wicker|rattan|straw|basket|cork", Substance(300.0, 0.01)),
    ("plastic|rubber|vinyl", Substance(1100.0, 0.003)),
    ("wood|oak|pine|walnut|mahogany|bamboo|plywood|timber", Substance(600.0, 0.018)),
)
OTHER = Substance(500.0, 0.015)
"""Where neither the material's name nor the label says a thing."""
LIGHTEST = 0.01
"""Kilograms that an object weighs at least."""


def substance(*names: str) -> Substance:
    """What the first name with a known word is made of; `OTHER` where none has one. Names of materials first, then labels."""
    for name in names:
        for words, found in _BY_WORD:
            if re.search(words, name.lower()):
                return found
    return OTHER
