"""`stages/history.json`: the error curve of the fit.

It depends on the clock, so it is no part of an entry, and it holds the digest of its points itself.
"""

import json
import math
import pathlib
from collections.abc import Iterable
from typing import Any

from wm import console
from wm.artifacts.digests import digest, json_text
from wm.splat.optimization.curve import HELDOUT

HISTORY = "stages/history.json"


def history_text(points: Iterable[dict[str, Any]]) -> str:
    """The content of the file. NaN (no held-out views, no depth) becomes null, which JSON can say."""
    rows = [{name: _finite(value) for name, value in point.items()} for point in points]
    return json_text({"digest": digest(rows), "points": rows})


def read_history(file: pathlib.Path) -> tuple[dict[str, Any], ...]:
    """The points of the curve; none if there is no such file, or, with a line, if it is damaged."""
    try:
        match json.loads(file.read_text(encoding="utf-8")):
            case {"digest": str(expected), "points": list(points)} if digest(points) == expected and all(map(_is_point, points)):
                return tuple(points)
    except FileNotFoundError:
        return ()
    except (OSError, ValueError, RecursionError):
        pass
    console.say(f"{file}: damaged; the report goes without its curve")
    return ()


def _finite(value: Any) -> Any:
    return None if isinstance(value, float) and not math.isfinite(value) else value


def _is_point(point: Any) -> bool:
    match point:
        case {"room": int(), "seconds": float() | int()}:
            return all(isinstance(point.get(name), int | float | None) for name in HELDOUT)
    return False
