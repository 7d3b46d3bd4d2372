"""The JSON schema of a floor plan, for language models whose answers a schema can constrain.

It says what the reader (layout_json) would refuse in a single value: missing fields, types, ranges, ids, sorts of openings. How
rooms fit together (rules) no schema can say. It is stricter than the reader where a file of a user's may leave something out or
write it in other words: every field is there, lengths are metres, an opening is a door, a passage or a window.

Only keywords that services and grammar engines know are used: every object lists all its fields as required and allows no
others, and no field has several types. Lists have no upper bound, since grammars unroll it.
"""

from typing import Any

from wm.geometry.plan.layout_json import CEILING, MAX_COORDINATE, WALL, WIDEST
from wm.schema import LONGEST_ROOM_NAME

STANDING = (1.8, CEILING[1])  # metres of ceiling: nobody can stand under a lower one
OPENING_SIZES = {"door": (0.5, 1.7), "passage": (0.5, 1.7), "window": (0.1, 0.1)}
"""Least width and height, metres; a body of 0.25 m radius passes a door without stooping."""


def layout_schema() -> dict[str, Any]:
    """The schema of a plan without furniture, in the keywords of JSON Schema 2020-12."""
    metadata = _object(
        units={"type": "string", "enum": ["meters"]},
        coordinate_system={"type": "string", "enum": ["z_up"]},
        wall_thickness=_number(*WALL),
        default_ceiling_height=_number(*STANDING),
    )
    room = _object(
        id={"type": "string", "pattern": "^[A-Za-z0-9][A-Za-z0-9_-]{0,63}$"},
        name={"type": "string", "minLength": 1, "maxLength": LONGEST_ROOM_NAME},
        floor_polygon=_list(_point(), 3),
        ceiling_height=_number(*STANDING),
        openings=_list({"anyOf": [_opening("door", "passage"), _opening("window")]}, 0),
    )
    return _object(metadata=metadata, rooms=_list(room, 1))


def _opening(*kinds: str) -> dict[str, Any]:
    width, height = OPENING_SIZES[kinds[0]]
    sill = _number(0.0, CEILING[1]) if kinds == ("window",) else {"type": "number", "enum": [0]}
    return _object(
        type={"type": "string", "enum": list(kinds)},
        wall_segment=_pair(_point()),
        position=_number(0.0, MAX_COORDINATE),
        width=_number(width, WIDEST),
        height=_number(height, CEILING[1]),
        sill_height=sill,
    )


def _point() -> dict[str, Any]:
    return _pair(_number(-MAX_COORDINATE, MAX_COORDINATE))


def _number(low: float, high: float) -> dict[str, Any]:
    return {"type": "number", "minimum": low, "maximum": high}


def _list(items: dict[str, Any], least: int) -> dict[str, Any]:
    return {"type": "array", "items": items, "minItems": least}


def _pair(items: dict[str, Any]) -> dict[str, Any]:
    return {**_list(items, 2), "maxItems": 2}


def _object(**properties: dict[str, Any]) -> dict[str, Any]:
    return {"type": "object", "properties": properties, "required": list(properties), "additionalProperties": False}
