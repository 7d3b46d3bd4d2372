"""Floor plans: the published WorldMesh layout JSON in and out.

Accepted beyond the published rules: concave and non-rectangular simple polygons, walls shared in part, several openings a
wall, ceilings of different heights, doors listed by one room or both, doors to the outside (closed), holes, columns, clockwise
polygons (reversed), a first point repeated at the end, lengths in other units, null for what has a default. What is read only in
part or changed is warned of: unknown keys, walls of two rooms that nearly touch, which are made one, what is carried in another
form (`adapting`), and, where it is asked for, what was repaired (`repair`, `fitting`). Everything else that a plan can do wrong
has a name in `wm.geometry.plan.rules.RULES`. docs/plans.md says all of it for users.
"""

import dataclasses
import functools
import os
import warnings
from pathlib import Path
from typing import Any

from wm.geometry.plan.adapting import adapted, columns_for_holes, doubts
from wm.geometry.plan.connected import connected_parts
from wm.geometry.plan.files.choosing import drawn_document, drawn_file
from wm.geometry.plan.fitting import fitted
from wm.geometry.plan.layout_json import MAX_BYTES, Reader, decode, encode
from wm.geometry.plan.records import FloorPlan, Opening, PlanError, PlanWarning, Room, Violation
from wm.geometry.plan.repair import repaired
from wm.geometry.plan.rules import check_plan, is_sound
from wm.geometry.plan.snapping import snapped

__all__ = [
    "FloorPlan", "Opening", "PlanError", "PlanReading", "PlanWarning", "Room", "Violation", "load_plan", "parse_plan",
    "plan_to_json", "read_plan", "read_plan_file", "stored_plan",
]  # fmt: skip


@dataclasses.dataclass(frozen=True, eq=False)
class PlanReading:
    """A plan, and what was not read of its document or changed in it, a sentence each."""

    plan: FloorPlan
    notes: tuple[str, ...]


def load_plan(
    path: str | os.PathLike[str], *, repair: bool = False, unreachable: str = "warn", storey: str | None = None
) -> FloorPlan:
    """The floor plan in a file: a layout, or what `wm.geometry.plan.files` reads.

    Args:
      path: of the file.
      repair: whether walls drawn as gaps, overlapping rooms and openings that do not fit their walls are mended.
      unreachable: "warn" or "refuse", of rooms that no way leads to from the largest part of the plan or from outside.
      storey: its name or its number from the lowest; None for the lowest with rooms. A layout has one storey.

    Raises:
      PlanError: the file cannot be read (rule "file"), or as `parse_plan`.

    Warns:
      PlanWarning: a key is not read, or walls were moved.
    """
    reading = read_plan_file(path, repair=repair, unreachable=unreachable, storey=storey)
    _warn(reading, os.fspath(path))
    return reading.plan


def read_plan_file(
    path: str | os.PathLike[str], *, repair: bool = False, unreachable: str = "warn", storey: str | None = None
) -> PlanReading:
    """`load_plan`, with what it would warn of as notes."""
    source = os.fspath(path)
    drawn = drawn_file(path, storey)
    if drawn is None:
        drawn = drawn_document(decode(_text(path, source), source), source, storey)
    document, notes = drawn
    reading = read_plan(document, source, Path(path).absolute().parent, repair=repair, unreachable=unreachable)
    return dataclasses.replace(reading, notes=(*notes, *reading.notes))


def _text(path: str | os.PathLike[str], source: str) -> str:
    try:
        if Path(path).exists() and not Path(path).is_file():
            raise OSError("it is not a file")  # a pipe would be waited for
        with Path(path).open("rb") as file:
            data = file.read(MAX_BYTES + 1)
        if len(data) > MAX_BYTES:
            raise OSError(f"it is longer than {MAX_BYTES} bytes")
        return data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise PlanError((Violation(None, "file", f"is not UTF-8 text (byte {error.start})"),), source) from None
    except (OSError, ValueError) as error:  # ValueError: a path with a null character
        reason = error.strerror if isinstance(error, OSError) and error.strerror else error
        raise PlanError((Violation(None, "file", f"cannot be read: {reason}"),), source) from None


def stored_plan(path: str | os.PathLike[str]) -> FloorPlan:
    """The plan that a run has written; what is to be said of it was said when it was made, so nothing is warned of.

    Raises:
      PlanError: as `load_plan`.
    """
    return read_plan_file(path).plan


def parse_plan(text: str, source: str = "plan", *, repair: bool = False, unreachable: str = "warn") -> FloorPlan:
    """The floor plan in a JSON text.

    Args:
      text: JSON as in design.md, "Floor plan JSON".
      source: what the error calls the plan.
      repair, unreachable: as for `load_plan`.

    Raises:
      PlanError: with every violation at once, each with the room's id and the rule's name.

    Warns:
      PlanWarning: a key is not read, or walls were moved.
    """
    reading = read_plan(decode(text, source), source, repair=repair, unreachable=unreachable)
    _warn(reading, source)
    return reading.plan


def read_plan(
    document: Any, source: str, folder: Path | None = None, *, repair: bool = False, unreachable: str = "warn"
) -> PlanReading:
    """The floor plan in a decoded JSON document, its walls snapped (wm.geometry.plan.snapping).

    Args:
      folder: where the mesh files lie that the plan names; without it, the working directory.
      repair, unreachable: as for `load_plan`.

    Raises:
      PlanError: as `parse_plan`.
    """
    reader = Reader()
    plan = reader.plan(document)
    reader.blame_units(document)
    if plan is None:
        raise PlanError(tuple(reader.violations), source)
    missing = {"rooms_missing": reader.rooms_missing, "openings_missing": reader.openings_missing}
    settled = _settled(plan, repair=False, unreachable=unreachable == "refuse", **missing)
    if repair and (settled.violations or len(connected_parts(settled.plan)) > 1):
        mended = _settled(plan, repair=True, unreachable=unreachable == "refuse", **missing)
        settled = mended if settled.violations or not mended.violations else settled
    violations = [*reader.violations, *settled.violations]
    plan = settled.plan
    if not violations:
        plan = dataclasses.replace(plan, objects=reader.objects(document, plan.rooms, folder))
        violations = reader.violations
    if violations:
        raise PlanError(tuple(violations), source)
    return PlanReading(plan, (*reader.notes, *settled.notes, *doubts(plan)))


@dataclasses.dataclass(frozen=True, eq=False)
class _Settled:
    """A plan in the form in which it is built, what was changed for that, and what is wrong with it."""

    plan: FloorPlan
    notes: tuple[str, ...]
    violations: tuple[Violation, ...]


def _settled(plan: FloorPlan, *, repair: bool, unreachable: bool, rooms_missing: bool, openings_missing: bool) -> _Settled:
    rooms, notes = plan.rooms, ()
    if repair and is_sound(rooms):
        rooms, notes = repaired(rooms)
    rooms, joined = snapped(rooms)
    notes, sound = (*notes, *joined), is_sound(rooms)
    rooms, columns = columns_for_holes(rooms)
    notes, plan = (*notes, *columns), dataclasses.replace(plan, rooms=rooms)
    if sound:
        for change in (adapted, functools.partial(fitted, repair=repair), adapted):
            plan, more = change(plan)
            notes = (*notes, *more)
    violations = check_plan(plan, rooms_missing=rooms_missing, openings_missing=openings_missing, unreachable=unreachable)
    return _Settled(plan, notes, violations)


def _warn(reading: PlanReading, source: str) -> None:
    for note in reading.notes:
        warnings.warn(f"{source}: {note}", PlanWarning, stacklevel=3)


def plan_to_json(plan: FloorPlan) -> str:
    """The plan as JSON text; `parse_plan` gives the same plan back, and the same plan always gives the same text."""
    return encode(plan)
