"""Furniture of one's own in a plan's `objects`: read, every fault named, and written again.

    {"label": "piano", "position": [2.0, 3.1], "size": [1.5, 0.6, 1.2], "yaw": 90}
    {"label": "statue", "position": [4.0, 1.0, 0.4], "mesh": "statue.glb"}

`position` is the middle of the foot, with the height above the floor as an optional third number; `size` is width, depth and
height; `yaw` turns counter-clockwise seen from above, in degrees, and at 0 the front looks along -y. With `mesh` (a file, beside
the plan's) the thing has that shape, stretched to `size` where it is given; without, it is a box. `support` and `color` (three
numbers within 0..1) are optional, as is `room`, which the position decides.
"""

import math
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import shapely

from wm.geometry.plan.records import PlanObject, Room, Violation
from wm.geometry.plan.walls import room_polygon

MAX_OBJECTS = 4096
SUPPORTS = ("floor", "flat", "wall", "ceiling", "object")
KEYS = ("label", "type", "name", "position", "size", "yaw", "mesh", "support", "color", "room", "id")
_LARGEST = 50.0  # metres
_REACH = 0.01  # metres by which a thing may reach into its room's walls' middle


def read_objects(
    value: Any, rooms: Sequence[Room], *, scale: float, folder: Path | None
) -> tuple[tuple[PlanObject, ...], tuple[Violation, ...], tuple[str, ...]]:
    """The objects of a plan, the rules that others break, and a note for each that is left out.

    Args:
      value: the document's `objects`.
      rooms: of the plan, with simple polygons.
      scale: metres per unit of the document.
      folder: where relative mesh files lie.
    """
    if not isinstance(value, list) or len(value) > MAX_OBJECTS:
        found = f"{len(value)} long" if isinstance(value, list) else type(value).__name__
        message = f"'objects' is {found}; it must be a list of at most {MAX_OBJECTS} objects"
        return (), (Violation(None, "object", message),), ()
    read: list[PlanObject] = []
    faults: list[Violation] = []
    notes: list[str] = []
    for k, row in enumerate(value):
        name = f"objects[{k}]"
        try:
            name = f"{name} ({_label(row)})"
            if row.get("size") is None and row.get("mesh") is None:
                notes.append(f"{name} has neither 'size' (width, depth, height) nor 'mesh' (a file), and is left out")
                continue
            read.append(_object(row, rooms, scale, folder))
        except _Fault as fault:
            faults.append(Violation(fault.room, "object", f"{name}: {fault}"))
            continue
        unread = [repr(key) for key in row if key not in KEYS]
        if unread:
            notes.append(f"{name} says {', '.join(unread[:8])}, which is not read")
    return tuple(read), tuple(faults), tuple(notes)


def object_json(thing: PlanObject) -> dict[str, Any]:
    """One object as a plan's JSON has it."""
    row: dict[str, Any] = {"label": thing.label, "position": list(thing.position), "yaw": thing.yaw}
    for key, value in (("size", thing.size), ("mesh", thing.mesh), ("support", thing.support), ("color", thing.color)):
        if value is not None:
            row[key] = list(value) if isinstance(value, tuple) else value
    return row


class _Fault(Exception):
    """What is wrong with one object, and the id of the room that it stands in, if it stands in one."""

    def __init__(self, message: str, room: str | None = None):
        super().__init__(message)
        self.room = room


def _label(row: Any) -> str:
    if not isinstance(row, dict):
        raise _Fault(f"it is {row!r:.40}; it must be an object with label, position and size")
    label = next((row[key] for key in ("label", "type", "name") if row.get(key) is not None), None)
    if not isinstance(label, str) or not label.strip() or not label.isprintable() or len(label) > 200:
        raise _Fault(f"label is {label!r:.40}; it must be words such as 'armchair'")
    return label.strip()


def _object(row: dict[str, Any], rooms: Sequence[Room], scale: float, folder: Path | None) -> PlanObject:
    position = _numbers(row, "position", (2, 3), (-1e4, 1e4), "[x, y] or [x, y, z] in metres", scale)
    size = _numbers(row, "size", (3,), (1e-3, _LARGEST), "[width, depth, height] in metres", scale, optional=True)
    color = _numbers(row, "color", (3,), (0.0, 1.0), "[r, g, b], each from 0 to 1", optional=True)
    yaw = _numbers({"yaw": [row.get("yaw") or 0.0]}, "yaw", (1,), (-1e4, 1e4), "a number of degrees")
    support, mesh = row.get("support"), row.get("mesh")
    if support is not None and support not in SUPPORTS:
        raise _Fault(f"support is {support!r:.40}; choices: {', '.join(SUPPORTS)}")
    if mesh is not None and (not isinstance(mesh, str) or not mesh.strip() or "\0" in mesh):
        raise _Fault(f"mesh is {mesh!r:.40}; it must be the name of a mesh file")
    assert position is not None and yaw is not None
    thing = PlanObject(
        label=_label(row),
        room=_room(row.get("room"), position, rooms),
        position=(*position, 0.0)[:3],
        yaw=yaw[0],
        size=size,
        mesh=None if mesh is None else str((folder or Path()) / mesh),
        support=support,
        color=color,
    )
    _check_place(thing, rooms[thing.room])
    return thing


def _room(asked: Any, position: tuple[float, ...], rooms: Sequence[Room]) -> int:
    """The room that a position lies in."""
    place = shapely.Point(position[:2])
    room = next((k for k, room in enumerate(rooms) if room_polygon(room).covers(place)), None)
    at = f"position ({position[0]:g}, {position[1]:g})"
    if room is None:
        raise _Fault(f"{at} is in no room")
    if asked not in (None, rooms[room].id, rooms[room].name):
        raise _Fault(f"{at} is in room {rooms[room].id} and not in {asked!r:.40}", rooms[room].id)
    return room


def _check_place(thing: PlanObject, room: Room) -> None:
    """Refuses an object of known size that goes through the floor, the ceiling or a wall."""
    if thing.size is None:
        return
    (width, depth, height), low = thing.size, thing.position[2]
    if low < -1e-6 or low + height > room.ceiling_height + 1e-6:
        where = f"floor and ceiling of {room.id} are at 0 and {room.ceiling_height:g} m"
        raise _Fault(f"it reaches from {low:g} to {low + height:g} m; {where}", room.id)
    c, s = math.cos(math.radians(thing.yaw)), math.sin(math.radians(thing.yaw))
    corners = np.array([[-width, -depth], [width, -depth], [width, depth], [-width, depth]]) / 2 @ np.array([[c, s], [-s, c]])
    outline = shapely.Polygon(corners + thing.position[:2])
    if not room_polygon(room).buffer(_REACH).covers(outline):
        raise _Fault(f"it reaches out of the floor_polygon of {room.id}; move it in or make it smaller", room.id)


def _numbers(
    row: dict[str, Any], key: str, lengths: tuple[int, ...], bounds: tuple[float, float], wanted: str, scale: float = 1.0,
    *, optional: bool = False,
) -> tuple[float, ...] | None:  # fmt: skip
    """A list of numbers within bounds, in metres; None where it is left out and may be."""
    value = row.get(key)
    if value is None and optional:
        return None
    if isinstance(value, list) and len(value) in lengths and all(_within(x, bounds, scale) for x in value):
        return tuple(float(x) * scale for x in value)
    raise _Fault(f"{key} is {value!r:.40}; it must be {wanted}")


def _within(x: Any, bounds: tuple[float, float], scale: float) -> bool:
    return isinstance(x, (int, float)) and not isinstance(x, bool) and bounds[0] <= x * scale <= bounds[1]
