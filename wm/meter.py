"""Time and peak memory of each stage, for `timings.json`, the report and the summary."""

import contextlib
import threading
import time
from collections.abc import Callable, Iterator

from wm.memory import MemoryProbe, resident_gib

SAMPLE_SECONDS = 0.05
"""Interval at which memory is read."""
KEEP_SECONDS = 5.0
"""Interval at which the times of an unfinished stage are saved, in case the process is killed."""

Rows = dict[str, dict[str, float]]


class StageMeter:
    """Seconds and peak resident memory of each stage. The seconds of an interrupted run add up over its parts.

    Args:
      earlier: the rows that an earlier part of the run has left.
      keep: saves all rows. It is called from another thread every KEEP_SECONDS of a stage, and at the end of each stage.
    """

    def __init__(self, earlier: Rows | None = None, keep: Callable[[Rows], None] = lambda rows: None):
        self.stages: Rows = {name: dict(row) for name, row in (earlier or {}).items()}
        self._keep = keep
        self._outdated: set[str] = set()

    def outdate(self) -> None:
        """Declares the rows so far to be of another run: a stage's row is replaced as soon as it makes something anew."""
        self._outdated = set(self.stages)

    @contextlib.contextmanager
    def stage(self, name: str, made: Callable[[], bool] = lambda: True) -> Iterator[None]:
        """Measures the block as stage `name`, or as a further part of it.

        Args:
          name: the stage.
          made: whether the stage has made anything so far. A stage that finds everything done keeps the row that it has.
        """
        started, peak, done = time.perf_counter(), [resident_gib()], threading.Event()

        def rows() -> Rows:
            if name in self.stages and not made():
                return self.stages
            row = {"seconds": time.perf_counter() - started, "peak_gib": max(peak[0], resident_gib())}
            return self.stages | {name: _together(self._known(name), row)}

        def watch() -> None:
            kept, probe = started, MemoryProbe()
            while not done.wait(SAMPLE_SECONDS):
                peak[0] = max(peak[0], probe.resident_gib())
                if time.perf_counter() - kept > KEEP_SECONDS:
                    with contextlib.suppress(OSError):  # of a full disk the stage itself complains
                        self._keep(rows())
                    kept = time.perf_counter()

        watcher = threading.Thread(target=watch, daemon=True)
        watcher.start()
        try:
            yield
        finally:
            done.set()
            watcher.join()
            self.stages = rows()
            self._outdated.discard(name)
            self._keep(self.stages)

    def credit(self, name: str, row: dict[str, float]) -> None:
        """Adds to stage `name` the time and memory that its result, or a part of it, has cost in the run it was copied from."""
        self.stages = self.stages | {name: _together(self._known(name), row)}
        self._outdated.discard(name)

    def _known(self, name: str) -> dict[str, float]:
        nothing = {"seconds": 0.0, "peak_gib": 0.0}
        return nothing if name in self._outdated else self.stages.get(name, nothing)

    @property
    def seconds(self) -> float:
        return round(sum(row["seconds"] for row in self.stages.values()), 3)

    @property
    def peak_gib(self) -> float:
        return max((row["peak_gib"] for row in self.stages.values()), default=0.0)


def _together(a: dict[str, float], b: dict[str, float]) -> dict[str, float]:
    """The row of two parts of a stage together."""
    seconds, peak = a["seconds"] + b["seconds"], max(a["peak_gib"], b["peak_gib"])
    return {"seconds": round(seconds, 3), "peak_gib": round(peak, 3)}
