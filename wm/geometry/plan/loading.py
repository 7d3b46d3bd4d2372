"""Floor plans: the published WorldMesh layout JSON in and out.

Accepted beyond the published rules: concave and non-rectangular simple polygons, walls shared in part, several openings a
wall, ceilings of different heights, doors listed by one room or both, clockwise polygons (reversed), a first point repeated
at the end. Everything else that a plan can do wrong has a name in `wm.geometry.plan.rules.RULES`.
"""

import os
from pathlib import Path

from wm.geometry.plan.layout_json import MAX_BYTES, Reader, decode, encode
from wm.geometry.plan.records import FloorPlan, Opening, PlanError, Room, Violation
from wm.geometry.plan.rules import check_plan

__all__ = ["FloorPlan", "Opening", "PlanError", "Room", "Violation", "load_plan", "parse_plan", "plan_to_json"]


def load_plan(path: str | os.PathLike[str]) -> FloorPlan:
    """The floor plan in a JSON file.

    Raises:
      PlanError: the file cannot be read (rule "file"), or as `parse_plan`.
    """
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
    return parse_plan(text, source)


def parse_plan(text: str, source: str = "plan") -> FloorPlan:
    """The floor plan in a JSON text.

    Args:
      text: JSON as in design.md, "Floor plan JSON".
      source: what the error calls the plan.

    Raises:
      PlanError: with every violation at once, each with the room's id and the rule's name.
    """
    reader = Reader()
    plan = reader.plan(decode(text, source))
    violations = list(reader.violations)
    if plan is not None:
        violations += check_plan(plan, rooms_missing=reader.rooms_missing, openings_missing=reader.openings_missing)
    if plan is None or violations:
        raise PlanError(tuple(violations), source)
    return plan


def plan_to_json(plan: FloorPlan) -> str:
    """The plan as JSON text; `parse_plan` gives the same plan back, and the same plan always gives the same text."""
    return encode(plan)
