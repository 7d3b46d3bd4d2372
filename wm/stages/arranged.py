"""Furniture as a user has rearranged it: rows of an `objects.json` applied to the objects that a run furnished.

A row is found by its id. An object without a row is removed; a row whose matrix, size, room, label or support differs from what
the run wrote moves, turns, stretches or renames its object. Rows that were left as they are leave their object bit for bit.
"""

import dataclasses
import json
import math
from collections.abc import Sequence
from typing import Any

import numpy as np
import shapely
from jaxtyping import Float

from wm.codecs import object_summary
from wm.errors import InputError
from wm.geometry import FloorPlan
from wm.geometry.plan.walls import room_polygon
from wm.types import SceneObject

SUPPORTS = ("floor", "flat", "wall", "ceiling", "object")
_RIGID = 1e-3
"""How far the axes of a matrix may be from unit length and right angles: people write cosines with three digits."""
_LARGEST = 50.0
"""Metres of an object's extent at most, as for mesh files."""


class ArrangementError(InputError):
    """An objects.json that cannot be used; the message names file, row and what would be right."""


def is_json(data: bytes) -> bool:
    """Whether a file holds JSON at all; one that does not was damaged, not edited."""
    try:
        json.loads(data.decode("utf-8-sig"))
    except (ValueError, RecursionError):
        return False
    return True


def arranged(objects: Sequence[SceneObject], data: bytes, plan: FloorPlan, source: str) -> tuple[SceneObject, ...]:
    """The objects as the rows of an objects.json say, in the order of the rows.

    Args:
      objects: as they were furnished, with ids.
      data: the file; either what `object_summary` gives or its list alone.
      source: what errors call the file.

    Raises:
      ArrangementError: the file is no list of rows, or a row names no object, names one twice or holds a wrong value.
    """
    by_id = {thing.id: thing for thing in objects}
    made = {row["id"]: row for row in object_summary(objects, [room.id for room in plan.rooms])["objects"]}
    result, seen = [], set()
    for k, row in enumerate(_rows(data, source)):
        name = row.get("id") if isinstance(row, dict) else None
        if not isinstance(name, str) or name not in by_id:
            raise ArrangementError(
                f"{source}: objects[{k}].id is {_show(name)}; it must be the id of an object that the run has furnished. "
                "Furniture of your own goes into the plan's 'objects'"
            )
        if name in seen:
            raise ArrangementError(f"{source}: objects[{k}].id {name!r} appears twice; each object has one row")
        seen.add(name)
        result.append(_changed(by_id[name], row, made[name], plan, f"{source}: objects[{k}] ({name})"))
    return tuple(result)


def _rows(data: bytes, source: str) -> list[Any]:
    try:
        document = json.loads(data.decode("utf-8-sig"))
    except (ValueError, RecursionError) as error:
        raise ArrangementError(f"{source}: not JSON: {error}") from None
    rows = document.get("objects") if isinstance(document, dict) else document
    if not isinstance(rows, list):
        raise ArrangementError(f"{source}: 'objects' must be a list of rows, each with an id, as a run writes them")
    return rows


def _changed(thing: SceneObject, row: dict[str, Any], made: dict[str, Any], plan: FloorPlan, where: str) -> SceneObject:
    row = made | row  # what a row leaves out stays as it is
    if {name: row[name] for name in made} == made:
        return thing
    label, support = row["label"], row["support"]
    if not isinstance(label, str) or not label.strip():
        raise ArrangementError(f"{where}: label is {_show(label)}; it must be words")
    if support not in SUPPORTS:
        raise ArrangementError(f"{where}: support is {_show(support)}; choices: {', '.join(SUPPORTS)}")
    size = _array(row["size"], (3,), f"{where}: size", "three extents in metres")
    if not ((size > 0) & (size <= _LARGEST)).all():
        raise ArrangementError(f"{where}: size is {size.tolist()}; extents are above 0 and at most {_LARGEST:g} m")
    stretch = size / np.array(made["size"]) if row["size"] != made["size"] else np.ones(3)
    moved = row["T_world_object"] != made["T_world_object"]
    matrix = _pose(row["T_world_object"], f"{where}: T_world_object") if moved else thing.T_world_object
    local = (thing.vertices - thing.T_world_object[:3, 3]) @ thing.T_world_object[:3, :3] * stretch
    return dataclasses.replace(
        thing,
        label=label,
        support=support,
        room=_room(thing, row, made, plan, matrix, where),
        vertices=local @ matrix[:3, :3].T + matrix[:3, 3],
        T_world_object=matrix,
        size=thing.size * stretch,
    )


def _room(thing: SceneObject, row: dict, made: dict, plan: FloorPlan, matrix: Float[np.ndarray, "4 4"], where: str) -> int:
    """The room that a row says or, where only the place has changed, the room that the object now stands in."""
    rooms = [room.id for room in plan.rooms]
    if row["room"] != made["room"]:
        if row["room"] not in rooms:
            raise ArrangementError(f"{where}: room is {_show(row['room'])}; choices: {', '.join(rooms)}")
        return rooms.index(row["room"])
    place = shapely.Point(matrix[:2, 3])
    holding = [k for k, room in enumerate(plan.rooms) if room_polygon(room).covers(place)]
    return thing.room if thing.room in holding or not holding else holding[0]


def _pose(value: Any, where: str) -> Float[np.ndarray, "4 4"]:
    """A rigid motion; axes that are nearly at right angles are set right."""
    matrix = _array(value, (4, 4), where, "a 4 x 4 matrix of numbers")
    axes = matrix[:3, :3]
    long = np.abs(axes).max() > 1 + _RIGID  # first, since the squares of larger numbers may overflow
    off = math.inf if long else float(np.abs(axes @ axes.T - np.eye(3)).max())
    if off > _RIGID or np.linalg.det(axes) < 0 or np.abs(matrix[3] - [0, 0, 0, 1]).max() > 1e-9:
        raise ArrangementError(f"{where} is no rigid motion: its upper left 3 x 3 is a rotation, its last row 0 0 0 1")
    if np.abs(matrix[:3, 3]).max() > 1e5:
        raise ArrangementError(f"{where} moves the object more than 100 km away")
    u, _, v = np.linalg.svd(axes)
    return np.block([[u @ v, matrix[:3, 3:]], [np.zeros((1, 3)), np.ones((1, 1))]])


def _show(value: Any) -> str:
    """A value as a message quotes it, cut short where it is long."""
    text = json.dumps(value)
    return text if len(text) <= 80 else f"{text[:77]}..."


def _array(value: Any, shape: tuple[int, ...], where: str, wanted: str) -> np.ndarray:
    try:
        array = np.array(value, np.float64)
    except (TypeError, ValueError, OverflowError):
        array = np.full(1, math.nan)
    if array.shape != shape or not np.isfinite(array).all():
        raise ArrangementError(f"{where} must be {wanted}")
    return array
