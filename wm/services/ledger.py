"""What a run has asked of models, a line of JSON a request, in `requests.jsonl` of the run folder.

Lines are only added. A last line that a killed process left unfinished is dropped when the file is read.
"""

import dataclasses
import json
import os
import pathlib
import threading
from typing import Any

REQUESTS = "requests.jsonl"


@dataclasses.dataclass(frozen=True)
class Spent:
    """Of a stage or of a run."""

    requests: int = 0  # paid
    usd: float = 0.0
    unpriced: int = 0  # paid requests whose price is not known, which `usd` leaves out


class Ledger:
    """The requests of a run, those of its earlier parts included. Several threads may add to it.

    Args:
      file: where the lines are; None keeps them in memory only.

    Raises:
      OSError: the file is there and cannot be read.
    """

    def __init__(self, file: pathlib.Path | None = None):
        self._file = file
        self._lock = threading.Lock()
        self.rows: list[dict[str, Any]] = _read(file) if file is not None else []

    def add(self, row: dict[str, Any]) -> None:
        """Adds a request: "key", "stage", "backend", "model", "usd" (None if not known), "paid", "seconds".

        Raises:
          OSError: the file cannot be written.
        """
        with self._lock:
            self.rows.append(row)
            if self._file is not None:
                _append(self._file, json.dumps(row, sort_keys=True, allow_nan=False))

    def holds(self, key: str) -> bool:
        """Whether a request is among those that this run has paid."""
        with self._lock:
            return any(row["key"] == key for row in self.rows)

    def spent(self, stage: str | None = None) -> Spent:
        """What a stage has spent; None for all stages."""
        with self._lock:
            rows = [row for row in self.rows if row["paid"] and stage in (None, row["stage"])]
        priced = [row["usd"] for row in rows if row["usd"] is not None]
        return Spent(len(rows), float(sum(priced)), len(rows) - len(priced))


def _append(file: pathlib.Path, line: str) -> None:
    file.parent.mkdir(parents=True, exist_ok=True)
    with file.open("ab+") as out:
        if out.tell() and not _ends_a_line(out.name):
            out.write(b"\n")  # a killed process left half a line
        out.write(line.encode() + b"\n")
        out.flush()
        os.fsync(out.fileno())


def _ends_a_line(name: str) -> bool:
    with open(name, "rb") as file:
        file.seek(-1, os.SEEK_END)
        return file.read(1) == b"\n"


def _read(file: pathlib.Path) -> list[dict[str, Any]]:
    try:
        lines = file.read_text(encoding="utf-8", errors="replace").splitlines()
    except FileNotFoundError:
        return []
    return [row for line in lines if (row := _row(line)) is not None]


def _row(line: str) -> dict[str, Any] | None:
    try:
        row = json.loads(line)
    except ValueError:
        return None
    wanted = {"key": str, "stage": str, "paid": bool, "usd": int | float | None}
    fits = isinstance(row, dict) and all(name in row and isinstance(row[name], kind) for name, kind in wanted.items())
    return row if fits else None
