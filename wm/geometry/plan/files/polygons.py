"""Polygons by kind of room as in ResPlan, each GeoJSON or WKT: {"bedroom": "MULTIPOLYGON (...)", "door": {...}, ...}.

The kinds up to balcony are those of m-agour/ResPlan, resplan_utils.py at commit 4c7bc78. Its files are pickles, which run code as
they are read and are therefore not; `{key: shapely.to_wkt(value)}` of a plan writes this one. `meters_per_unit` says how long a
unit is.
"""

import json
from collections.abc import Mapping
from typing import Any

import numpy as np
import shapely

from wm.geometry.plan.files.drawing import DrawnOpening, DrawnPlan, Outline

ROOMS = ("living", "kitchen", "bedroom", "bathroom", "balcony", "storage", "stair", "veranda", "parking")
HOLES: Mapping[str, str] = {"door": "door", "front_door": "door", "window": "window"}
LARGEST = 100.0  # metres of a plan beyond which its unit is asked for


def is_polygons(document: Any) -> bool:
    return isinstance(document, dict) and "rooms" not in document and any(key in document for key in ROOMS)


def read_polygons(document: Any) -> DrawnPlan:
    """The rooms and openings; KeyError, TypeError or ValueError where the document is not of this format."""
    scale = float(document.get("meters_per_unit", 1.0))
    if not 0 < scale < np.inf:
        raise ValueError(f"meters_per_unit is {scale:g}; it must be a positive number")
    rooms, holes = [], []
    for key in ROOMS:
        for part in _parts(document.get(key), scale):
            if part.geom_type == "Polygon" and part.area > 0.01:
                rooms.append(Outline(key, part))
    for key, kind in HOLES.items():
        for number, part in enumerate(_parts(document.get(key), scale)):
            holes.append(DrawnOpening(kind, f"{key} {number}", np.asarray(shapely.get_coordinates(part))))
    if rooms and np.ptp(shapely.get_coordinates([room.area for room in rooms]), axis=0).max() > LARGEST:
        raise ValueError(f"it is larger than {LARGEST:g} m; say 'meters_per_unit': how many metres one of its units is")
    left = [key for key in document if key not in (*ROOMS, *HOLES, "meters_per_unit")]
    return DrawnPlan(tuple(rooms), tuple(holes), (f"left out: {', '.join(map(repr, left))}",) if left else ())


def _parts(value: Any, scale: float) -> list[Any]:
    if value is None:
        return []
    shape = shapely.from_wkt(value) if isinstance(value, str) else shapely.from_geojson(json.dumps(value))
    shape = shapely.transform(shape, lambda points: points * scale)
    return [part for part in shapely.get_parts(shape) if not part.is_empty]
