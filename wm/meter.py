"""Time and peak memory of each stage, for `timings.json`, the report and the summary."""

import contextlib
import threading
import time
from collections.abc import Callable, Iterator

from wm.artifacts.timings import Row, Rows
from wm.memory import MemoryProbe, resident_gib

SAMPLE_SECONDS = 0.05
"""Interval at which memory is read."""
KEEP_SECONDS = 5.0
"""Interval at which the times of an unfinished stage are saved, in case the process is killed."""


class StageMeter:
    """Seconds and peak resident memory of each stage. The seconds of an interrupted run add up over its parts.

    Args:
      earlier: the rows that an earlier part of the run has left; a row of None is that of a stage whose time was lost.
      keep: saves all rows. It is called from another thread every KEEP_SECONDS of a stage, and at the end of each stage.
    """

    def __init__(self, earlier: Rows | None = None, keep: Callable[[Rows], None] = lambda rows: None):
        self.stages: Rows = {name: dict(row) for name, row in (earlier or {}).items()}
        self.keep = keep
        self._outdated: set[str] = set()

    def outdate(self) -> None:
        """Declares the rows so far to be of another run: a stage's row is replaced as soon as it makes something anew."""
        self._outdated = set(self.stages)

    @contextlib.contextmanager
    def stage(self, name: str, made: Callable[[], bool] = lambda: True) -> Iterator[None]:
        """Measures the block as stage `name`, or as a further part of it.

        Args:
          name: the stage.
          made: whether the stage has made anything so far. A stage that finds everything done keeps the row that it has, and
            gets none if it has none: to find it done is not what it cost.
        """
        started, peak, done = time.perf_counter(), [resident_gib()], threading.Event()

        def rows() -> Rows:
            if not made():
                return self.stages
            peak[0] = max(peak[0], resident_gib())  # kept, so that no later row has less
            row: Row = {"seconds": time.perf_counter() - started, "peak_gib": peak[0]}
            return self.stages | {name: _together(self._known(name), row)}

        def watch() -> None:
            kept, probe = started, MemoryProbe()
            while not done.wait(SAMPLE_SECONDS):
                peak[0] = max(peak[0], probe.resident_gib())
                if time.perf_counter() - kept > KEEP_SECONDS:
                    with contextlib.suppress(OSError):  # of a full disk the stage itself complains
                        self.keep(rows())
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
            self.keep(self.stages)

    def knows(self, name: str) -> bool:
        """Whether a stage has a row of this run."""
        return name in self.stages and name not in self._outdated

    def forget(self, name: str) -> None:
        """Drops the row of a stage that this run does not have."""
        self.stages = {stage: row for stage, row in self.stages.items() if stage != name}

    def credit(self, name: str, row: Row) -> None:
        """Adds to stage `name` the time and memory that its result, or a part of it, has cost in the run it was copied from."""
        self.stages = self.stages | {name: _together(self._known(name), row)}
        self._outdated.discard(name)

    def _known(self, name: str) -> Row:
        nothing: Row = {"seconds": 0.0, "peak_gib": 0.0}
        return nothing if name in self._outdated else self.stages.get(name, nothing)

    @property
    def seconds(self) -> float | None:
        """Of all stages; None if that of one is not known."""
        values = [row["seconds"] for row in self.stages.values()]
        return None if None in values else round(sum(value for value in values if value is not None), 3)

    @property
    def peak_gib(self) -> float | None:
        """Of all stages; None if that of one is not known."""
        values = [row["peak_gib"] for row in self.stages.values()]
        return None if None in values else max((value for value in values if value is not None), default=0.0)


def _together(a: Row, b: Row) -> Row:
    """The row of two parts of a stage together: not known where one of them is not."""
    seconds, peaks = (a["seconds"], b["seconds"]), (a["peak_gib"], b["peak_gib"])
    return {
        "seconds": None if None in seconds else round(sum(value for value in seconds if value is not None), 3),
        "peak_gib": None if None in peaks else round(max(value for value in peaks if value is not None), 3),
    }
