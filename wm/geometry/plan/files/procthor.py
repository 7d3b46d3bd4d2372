"""Houses of ProcTHOR: rooms with `floorPolygon`, doors and windows with a `holePolygon` in the frame of `wall0`.

The format is that of allenai/procthor, procthor/generation/ (doors.py at commit 0b1d518): x and z lie in the
floor and y points up, in metres. A hole's two points are offsets along its wall from the wall's first point, and
heights. A wall that is `empty` is a passage.
"""

from typing import Any

import numpy as np
import shapely

from wm.geometry.plan.files.drawing import DrawnOpening, DrawnPlan, Outline


def is_procthor(document: Any) -> bool:
    rooms = document.get("rooms") if isinstance(document, dict) else None
    return isinstance(rooms, list) and bool(rooms) and isinstance(rooms[0], dict) and "floorPolygon" in rooms[0]


def read_procthor(document: Any) -> DrawnPlan:
    """The rooms and openings; KeyError, TypeError or ValueError where the document is not of this format."""
    walls = {
        wall["id"]: np.array([[p["x"], p["z"], p["y"]] for p in wall["polygon"]], float) for wall in document.get("walls", [])
    }
    ceiling = max((float(wall[:, 2].max()) for wall in walls.values()), default=None)
    rooms = tuple(
        Outline(
            room.get("roomType", room["id"]),
            shapely.Polygon([(p["x"], p["z"]) for p in room["floorPolygon"]]),
            height=ceiling,
        )
        for room in document["rooms"]
    )
    holes, notes = [], []
    for key, kind in (("doors", "door"), ("windows", "window")):
        for thing in document.get(key, []):
            if thing.get("wall0") not in walls or len(thing.get("holePolygon", ())) < 2:
                notes.append(f"{kind} {thing.get('id')!r} is left out: it has no wall0 that is listed, or no holePolygon")
                continue
            holes.append(_hole(kind, thing, walls[thing["wall0"]]))
    holes += _open_walls(document, walls)
    if document.get("objects"):
        notes.append(f"{len(document['objects'])} objects are left out: furniture is not read")
    return DrawnPlan(rooms, tuple(holes), tuple(notes))


def _hole(kind: str, thing: dict[str, Any], wall: np.ndarray) -> DrawnOpening:
    start = wall[0, :2]
    farthest = wall[np.argmax(np.linalg.norm(wall[:, :2] - start, axis=1)), :2]
    along = (farthest - start) / np.linalg.norm(farthest - start)
    offsets = [float(p["x"]) for p in thing["holePolygon"]]
    heights = [float(p["y"]) for p in thing["holePolygon"]]
    points = start + np.array([[min(offsets)], [max(offsets)]]) * along
    return DrawnOpening(kind, thing["id"], points, max(heights) - min(heights), min(heights))


def _open_walls(document: dict[str, Any], walls: dict[str, np.ndarray]) -> list[DrawnOpening]:
    """A passage for each wall that is empty, once where both rooms list it."""
    found: dict[tuple[float, ...], DrawnOpening] = {}
    for wall in document.get("walls", []):
        points = walls[wall["id"]]
        if wall.get("empty"):
            low, high = np.sort(np.array([points[:, :2].min(axis=0), points[:, :2].max(axis=0)]), axis=0)
            key = tuple(np.round([*low, *high], 3).tolist())
            found.setdefault(key, DrawnOpening("passage", wall["id"], points[:, :2], float(np.ptp(points[:, 2])), 0.0))
    return list(found.values())
