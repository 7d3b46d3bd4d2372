"""Predefined floor plans of Infinigen Indoors: rooms, doors and windows as calls of shapely.

The format is that of princeton-vl/infinigen, core/constraints/example_solver/room/predefined.py at commit a1190ef: each entry has
an `operation` such as "shapely.box" with `args` and `kwargs`. Infinigen evaluates it; here only the shapes below are made. A room
is called TYPE_LEVEL/NUMBER. Lengths are metres.
"""

from typing import Any

import numpy as np
import shapely

from wm.geometry.plan.files.drawing import DrawnOpening, DrawnPlan, Outline

SHAPES = {"box": shapely.box, "Polygon": shapely.Polygon, "LineString": shapely.LineString}


def is_infinigen(document: Any) -> bool:
    rooms = document.get("rooms") if isinstance(document, dict) else None
    return isinstance(rooms, dict) and all(isinstance(room, dict) and "operation" in room for room in rooms.values())


def read_infinigen(document: Any) -> DrawnPlan:
    """The rooms and openings; KeyError, TypeError or ValueError where the document is not of this format."""
    rooms = tuple(
        Outline(name.split("/")[0].rsplit("_", 1)[0], shapely.Polygon(_shape(name, value)), _level(name))
        for name, value in document["rooms"].items()
    )
    holes = []
    for key, kind in (("doors", "door"), ("windows", "window")):
        for name, value in document.get(key, {}).items():
            shape = _shape(name, value)
            near = min(rooms, key=lambda room: (room.area.distance(shape), room.storey != _level(name)))
            holes.append(DrawnOpening(kind, name, np.asarray(shapely.get_coordinates(shape)), storey=near.storey))
    return DrawnPlan(rooms, tuple(holes))


def _level(name: str) -> str:
    level = name.split("/")[0].rsplit("_", 1)[-1]
    return level if level.isdecimal() else "0"


def _shape(name: str, value: dict[str, Any]) -> Any:
    operation = str(value["operation"]).rsplit(".", 1)[-1]
    if operation not in SHAPES:
        raise ValueError(f"{name!r}: operation {value['operation']!r} is not read; choices: {', '.join(SHAPES)}")
    return SHAPES[operation](*value.get("args", []), **value.get("kwargs", {}))
