"""What every reader gives: outlines of rooms and shapes of openings on one storey, in metres, and the layout they make.

Files say where an opening is by a shape that lies in a wall, or across the gap between two rooms. The layout wants it on the
wall of a room: it is put on the edge that runs along it and is nearest, and as wide as the shape along that edge.
"""

import dataclasses
import itertools
import re
from typing import Any

import numpy as np
import shapely

from wm.geometry.plan.records import PlanError, Violation

REACH = 0.6  # metres at most between an opening and the edge that it is put on
DOOR_HEIGHT, WINDOW_HEIGHT, WINDOW_SILL = 2.0, 1.2, 0.9  # metres, where a file does not say


@dataclasses.dataclass(frozen=True, eq=False)
class Outline:
    """The floor of one room."""

    name: str
    area: shapely.Polygon
    storey: str = "0"
    height: float | None = None  # metres; None: the layout's default


@dataclasses.dataclass(frozen=True, eq=False)
class DrawnOpening:
    """A door, passage or window."""

    kind: str
    name: str  # as the file calls it
    points: np.ndarray  # [k, 2] metres, of the shape from above
    height: float | None = None
    sill: float | None = None
    storey: str = "0"


@dataclasses.dataclass(frozen=True, eq=False)
class DrawnPlan:
    """All that was read of a file, and what was left out, a sentence each."""

    rooms: tuple[Outline, ...]
    holes: tuple[DrawnOpening, ...]
    notes: tuple[str, ...] = ()


def refused(source: str, message: str) -> PlanError:
    """The error of a file that holds no plan that can be read."""
    return PlanError((Violation(None, "file", message),), source)


def layout(drawing: DrawnPlan, source: str, storey: str | None = None) -> tuple[dict[str, Any], tuple[str, ...]]:
    """The layout of one storey (the first that holds rooms, where none is chosen), and what is to be said of it.

    Raises:
      PlanError: there are no rooms, or no storey of that name or number.
    """
    if not drawing.rooms:
        raise refused(source, "holds no rooms; " + " ".join(drawing.notes))
    storeys = list(dict.fromkeys(room.storey for room in drawing.rooms))
    chosen = _storey(storeys, storey, source)
    notes = list(drawing.notes)
    if len(storeys) > 1:
        notes.append(f"storey {chosen!r} is read, of {', '.join(map(repr, storeys))}; plan.storey chooses another")
    outlines = [room for room in drawing.rooms if room.storey == chosen]
    ids: list[str] = []
    rooms = [_room(outline, ids) for outline in outlines]
    held = [hole for hole in drawing.holes if hole.storey == chosen]
    put = 0
    for hole in held:
        placed = _placed(hole, outlines)
        if placed is None:
            notes.append(f"{hole.kind} {hole.name!r} is left out: no wall of a room runs along it within {REACH} m")
            continue
        put += 1
        rooms[placed[0]]["openings"].append(placed[1])
    notes.insert(0, f"{len(rooms)} rooms and {put} of {len(held)} openings are read")
    return {"metadata": {"units": "meters", "coordinate_system": "z_up"}, "rooms": rooms}, tuple(notes)


def _storey(storeys: list[str], asked: str | None, source: str) -> str:
    if asked is None:
        return storeys[0]
    if asked in storeys:
        return asked
    if asked.isdecimal() and int(asked) < len(storeys):
        return storeys[int(asked)]
    raise refused(source, f"no storey {asked!r} with rooms; plan.storey is one of {', '.join(storeys)}, or its number from 0")


def _room(outline: Outline, ids: list[str]) -> dict[str, Any]:
    name = re.sub(r"[^0-9A-Za-z]+", "_", outline.name).strip("_").lower()[:48] or "room"
    count = sum(one == name or re.fullmatch(rf"{name}_\d+", one) is not None for one in ids)
    ids.append(name if not count else f"{name}_{count + 1}")
    ring, *holes = (np.asarray(one.coords)[:-1].round(6).tolist() for one in (outline.area.exterior, *outline.area.interiors))
    room: dict[str, Any] = {
        "id": ids[-1],
        "name": " ".join(outline.name.split())[:64] or name,
        "floor_polygon": ring,
        "openings": [],
    }
    if holes:
        room["holes"] = holes
    if outline.height is not None:
        room["ceiling_height"] = round(outline.height, 6)
    return room


def _placed(hole: DrawnOpening, outlines: list[Outline]) -> tuple[int, dict[str, Any]] | None:
    """The number of the room and the opening on its wall; None where no wall runs along it."""
    best: tuple[float, int, np.ndarray] | None = None
    for k, outline in enumerate(outlines):
        for ring in (outline.area.exterior, *outline.area.interiors):
            corners = np.asarray(ring.coords)
            for start, end in itertools.pairwise(corners):
                length = float(np.linalg.norm(end - start))
                if length < 1e-6:
                    continue
                along = (end - start) / length
                apart = np.abs((hole.points - start) @ np.array([-along[1], along[0]]))
                low, high = (float(x) for x in np.percentile((hole.points - start) @ along, [0, 100]))
                middle = (low + high) / 2
                if apart.min() > REACH or not 0 < middle < length or high - low < 0.1:
                    continue
                if best is None or apart.max() < best[0] - 1e-6:
                    best = (float(apart.max()), k, start + np.array([[low], [high]]) * along)
    if best is None:
        return None
    _, room, ends = best
    window = hole.kind == "window"
    height = hole.height if hole.height is not None else WINDOW_HEIGHT if window else DOOR_HEIGHT
    sill = hole.sill if hole.sill is not None else WINDOW_SILL if window else 0.0
    width = float(np.linalg.norm(ends[1] - ends[0]))
    return room, {
        "type": hole.kind, "wall_segment": ends.round(6).tolist(), "position": 0.0, "width": round(width, 5),
        "height": round(height, 6), "sill_height": round(max(sill, 0.0), 6),
    }  # fmt: skip
