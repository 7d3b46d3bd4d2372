"""Floor plans: the published WorldMesh layout JSON in and out.

Accepted beyond the published rules: concave and non-rectangular simple polygons, walls shared in part, several openings a
wall, ceilings of different heights, doors listed by one room or both, doors to the outside (closed), clockwise polygons
(reversed), a first point repeated at the end, lengths in other units, null for what has a default. What is read only in part
or changed is warned of: unknown keys, and walls of two rooms that nearly touch, which are made one. Everything else that a
plan can do wrong has a name in `wm.geometry.plan.rules.RULES`.
"""

import dataclasses
import os
import warnings
from pathlib import Path
from typing import Any

from wm.geometry.plan.layout_json import MAX_BYTES, Reader, decode, encode
from wm.geometry.plan.records import FloorPlan, Opening, PlanError, PlanWarning, Room, Violation
from wm.geometry.plan.rules import check_plan
from wm.geometry.plan.snapping import snapped

__all__ = [
    "FloorPlan", "Opening", "PlanError", "PlanReading", "PlanWarning", "Room", "Violation", "load_plan", "parse_plan",
    "plan_to_json", "read_plan", "read_plan_file",
]  # fmt: skip


@dataclasses.dataclass(frozen=True, eq=False)
class PlanReading:
    """A plan, and what was not read of its document or changed in it, a sentence each."""

    plan: FloorPlan
    notes: tuple[str, ...]


def load_plan(path: str | os.PathLike[str]) -> FloorPlan:
    """The floor plan in a JSON file.

    Raises:
      PlanError: the file cannot be read (rule "file"), or as `parse_plan`.

    Warns:
      PlanWarning: a key is not read, or walls were moved.
    """
    reading = read_plan_file(path)
    _warn(reading, os.fspath(path))
    return reading.plan


def read_plan_file(path: str | os.PathLike[str]) -> PlanReading:
    """`load_plan`, with what it would warn of as notes."""
    source = os.fspath(path)
    try:
        if Path(path).exists() and not Path(path).is_file():
            raise OSError("it is not a file")  # a pipe would be waited for
        with Path(path).open("rb") as file:
            data = file.read(MAX_BYTES + 1)
        if len(data) > MAX_BYTES:
            raise OSError(f"it is longer than {MAX_BYTES} bytes")
        text = data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise PlanError((Violation(None, "file", f"is not UTF-8 text (byte {error.start})"),), source) from None
    except (OSError, ValueError) as error:  # ValueError: a path with a null character
        reason = error.strerror if isinstance(error, OSError) and error.strerror else error
        raise PlanError((Violation(None, "file", f"cannot be read: {reason}"),), source) from None
    return read_plan(decode(text, source), source, Path(path).absolute().parent)


def parse_plan(text: str, source: str = "plan") -> FloorPlan:
    """The floor plan in a JSON text.

    Args:
      text: JSON as in design.md, "Floor plan JSON".
      source: what the error calls the plan.

    Raises:
      PlanError: with every violation at once, each with the room's id and the rule's name.

    Warns:
      PlanWarning: a key is not read, or walls were moved.
    """
    reading = read_plan(decode(text, source), source)
    _warn(reading, source)
    return reading.plan


def read_plan(document: Any, source: str, folder: Path | None = None) -> PlanReading:
    """The floor plan in a decoded JSON document, its walls snapped (wm.geometry.plan.snapping).

    Args:
      folder: where the mesh files lie that the plan names; without it, the working directory.

    Raises:
      PlanError: as `parse_plan`.
    """
    reader = Reader()
    plan = reader.plan(document)
    reader.blame_units(document)
    changes: tuple[str, ...] = ()
    violations: list[Violation] = []
    if plan is not None:
        rooms, changes = snapped(plan.rooms)
        plan = dataclasses.replace(plan, rooms=rooms)
        violations += check_plan(plan, rooms_missing=reader.rooms_missing, openings_missing=reader.openings_missing)
        if not violations and not reader.violations:
            plan = dataclasses.replace(plan, objects=reader.objects(document, rooms, folder))
    violations = [*reader.violations, *violations]
    if plan is None or violations:
        raise PlanError(tuple(violations), source)
    return PlanReading(plan, (*reader.notes, *changes))


def _warn(reading: PlanReading, source: str) -> None:
    for note in reading.notes:
        warnings.warn(f"{source}: {note}", PlanWarning, stacklevel=3)


def plan_to_json(plan: FloorPlan) -> str:
    """The plan as JSON text; `parse_plan` gives the same plan back, and the same plan always gives the same text."""
    return encode(plan)
