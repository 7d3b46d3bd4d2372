"""Drawings of DXF (extra `dxf`): closed polylines on layers of rooms, named by the texts in them; openings by layer or block."""

import importlib
from typing import Any

import numpy as np
import shapely

from wm.geometry.plan.files.drawing import DrawnOpening, DrawnPlan, Outline, refused

ROOM_LAYERS = ("room", "space", "zone", "raum", "area")
"""Words in the name of a layer, or of a block, that say what is on it."""
HOLE_WORDS = {"door": "door", "window": "window", "glaz": "window", "passage": "passage"}


def read_dxf(path: str) -> DrawnPlan:
    """The rooms and openings of model space.

    Raises:
      PlanError: ezdxf is missing, the file cannot be read or says no unit, or no layer holds rooms.
    """
    try:
        filemanagement, const, units = (
            importlib.import_module(f"ezdxf.{name}") for name in ("filemanagement", "lldxf.const", "units")
        )
    except ImportError:
        raise refused(path, "DXF is read by ezdxf: pip install 'wm[dxf]'") from None
    try:
        drawing: Any = filemanagement.readfile(path)
    except (OSError, const.DXFError, UnicodeError) as error:
        raise refused(path, f"is not a DXF file that can be read: {error}") from None
    if not drawing.units:
        raise refused(
            path, "$INSUNITS is 0, which is no unit; set it to 6 for metres, 4 for millimetres, 1 for inches or 2 for feet"
        )
    scale = float(units.conversion_factor(drawing.units, units.M))
    space = list(drawing.modelspace())
    texts = [(np.array(one.dxf.insert)[:2] * scale, _text(one)) for one in space if one.dxftype() in ("TEXT", "MTEXT")]
    rooms, holes, notes = [], [], []
    for one in space:
        kind = _kind(one)
        if kind is not None and (points := _points(one)) is not None:
            holes.append(DrawnOpening(kind, f"{one.dxftype()} #{one.dxf.handle}", points * scale))
        elif kind is None and one.dxftype() in ("LWPOLYLINE", "POLYLINE") and _has(one.dxf.layer, ROOM_LAYERS):
            points = _points(one)
            area = None if points is None or len(points) < 3 or not one.is_closed else shapely.Polygon(points * scale)
            if area is None or not area.is_valid:
                notes.append(
                    f"{one.dxftype()} #{one.dxf.handle} on layer {one.dxf.layer!r} is left out: it is no closed simple polygon"
                )
                continue
            names = [text for at, text in texts if area.covers(shapely.Point(at))]
            rooms.append(Outline(names[0] if names else "room", area))
    if not rooms:
        layers = ", ".join(sorted({one.dxf.layer for one in space})[:12]) or "none"
        raise refused(path, f"no closed polyline on a layer whose name holds {', '.join(ROOM_LAYERS)}; its layers are {layers}")
    return DrawnPlan(tuple(rooms), tuple(holes), tuple(notes))


def _has(name: str, words: tuple[str, ...]) -> bool:
    return any(word in name.lower() for word in words)


def _kind(entity: Any) -> str | None:
    if entity.dxftype() in ("TEXT", "MTEXT"):
        return None
    name = f"{entity.dxf.layer} {entity.dxf.name if entity.dxftype() == 'INSERT' else ''}".lower()
    return next((kind for word, kind in HOLE_WORDS.items() if word in name), None)


def _text(entity: Any) -> str:
    return entity.plain_text() if entity.dxftype() == "MTEXT" else entity.dxf.text


def _points(entity: Any) -> np.ndarray | None:
    """[k, 2] in units of the drawing; of a block, its lines, since a door's arc shows where the leaf swings."""
    sort = entity.dxftype()
    if sort == "LWPOLYLINE":
        return np.array(entity.get_points("xy"), float)
    if sort == "POLYLINE":
        return np.array([tuple(point)[:2] for point in entity.points()], float)
    if sort == "LINE":
        return np.array([tuple(entity.dxf.start)[:2], tuple(entity.dxf.end)[:2]], float)
    if sort == "INSERT":
        parts = [points for part in entity.virtual_entities() if (points := _points(part)) is not None]
        return np.concatenate(parts) if parts else None
    return None
