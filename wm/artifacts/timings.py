"""The times and peaks of a run's stages as they lie in `timings.json`. No digest guards them, so their form is checked."""

import json
import math
import pathlib
from typing import Any

TIMINGS = "timings.json"

Row = dict[str, float | None]
"""Of a stage: "seconds" and "peak_gib", both None where they are not known."""
Rows = dict[str, Row]
"""By the name of the stage."""

UNKNOWN: Row = {"seconds": None, "peak_gib": None}
"""Of a stage whose time was lost."""


def read_rows(file: pathlib.Path) -> Rows | None:
    """The rows that a finished or interrupted run has left: UNKNOWN for one that is damaged; None if the file is missing or is
    none of ours."""
    try:
        rows = json.loads(file.read_text(encoding="utf-8"))
    except (OSError, ValueError, RecursionError):
        return None
    if not isinstance(rows, dict) or not all(isinstance(row, dict) for row in rows.values()):
        return None
    return {name: _row(row) for name, row in rows.items()}


def _row(row: dict[str, Any]) -> Row:
    found = {key: row.get(key) for key in UNKNOWN}
    known = all(_is_measure(value) for value in found.values())
    return {key: float(value) for key, value in found.items() if value is not None} if known else dict(UNKNOWN)


def _is_measure(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool) and 0 <= value < 1e12 and math.isfinite(value)
