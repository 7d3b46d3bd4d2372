"""What a plan's document may say in other words: units of length, sorts of openings, and the keys that are read."""

import difflib
from collections.abc import Iterable, Mapping
from typing import Any

METRES: Mapping[str, float] = {
    **dict.fromkeys(("meters", "metres", "meter", "metre", "m"), 1.0),
    **dict.fromkeys(("centimeters", "centimetres", "cm"), 0.01),
    **dict.fromkeys(("millimeters", "millimetres", "mm"), 0.001),
    **dict.fromkeys(("feet", "foot", "ft"), 0.3048),
    **dict.fromkeys(("inches", "inch", "in"), 0.0254),
}
"""Metres per unit, for every word that `metadata.units` may be."""

OPENINGS: Mapping[str, str] = {
    **dict.fromkeys(
        (
            "door",
            "doors",
            "entrance",
            "entry",
            "front_door",
            "main_door",
            "entrance_door",
            "exterior_door",
            "external_door",
            "interior_door",
            "internal_door",
            "single_door",
            "double_door",
            "sliding_door",
            "pocket_door",
            "folding_door",
            "bifold_door",
            "swing_door",
            "hinged_door",
            "french_door",
            "patio_door",
            "balcony_door",
            "terrace_door",
            "garage_door",
            "gate",
        ),
        "door",
    ),
    **dict.fromkeys(
        (
            "passage",
            "opening",
            "archway",
            "arch",
            "doorway",
            "passageway",
            "open",
            "gap",
            "cased_opening",
            "wall_opening",
            "open_wall",
            "walkthrough",
            "open_connection",
        ),
        "passage",
    ),
    **dict.fromkeys(
        (
            "window",
            "windows",
            "fixed_window",
            "casement_window",
            "sash_window",
            "sliding_window",
            "bay_window",
            "corner_window",
            "picture_window",
            "french_window",
            "window_wall",
            "glazing",
            "curtain_wall",
        ),
        "window",
    ),
    **dict.fromkeys(
        (
            "hatch",
            "serving_hatch",
            "service_hatch",
            "pass_through",
            "servery",
            "internal_window",
            "interior_window",
        ),
        "hatch",
    ),
}
"""The sort that each word for an opening means."""

KEYS: Mapping[str, tuple[str, ...]] = {
    "plan": ("metadata", "rooms", "objects", "solids"),
    "metadata": ("units", "coordinate_system", "wall_thickness", "default_ceiling_height"),
    "room": ("id", "name", "floor_polygon", "holes", "columns", "wall_thickness", "walls", "ceiling_height", "openings"),
    "wall": ("segment", "thickness"),
    "opening": ("type", "wall_segment", "position", "width", "height", "sill_height"),
}
"""The keys that are read, by what they belong to."""


def opening_kind(word: Any) -> str | None:
    """door, window or passage, whichever case and word stand for it; None for other values."""
    return OPENINGS.get(word.strip().lower().replace(" ", "_").replace("-", "_")) if isinstance(word, str) else None


def metres_per(word: Any) -> float | None:
    """Metres per unit; None for what is no unit of length."""
    return METRES.get(word.strip().lower()) if isinstance(word, str) else None


def unread(keys: Iterable[Any], of: str) -> list[str]:
    """The keys that are not read, each with the one that may be meant: "ceilling_height (ceiling_height?)"."""
    named = []
    for key in keys:
        if key not in KEYS[of]:
            near = difflib.get_close_matches(str(key)[:64], KEYS[of], n=1, cutoff=0.75)
            named.append(f"{str(key)[:64]!r}" + (f" (is {near[0]!r} meant?)" if near else ""))
    return named
