"""How long each stage took and how much memory it held: `timings.json` and the summary."""

import contextlib
import os
import pathlib
import sys
import threading
import time
from collections.abc import Iterator

SAMPLE_SECONDS = 0.05


class StageMeter:
    """Seconds and peak resident memory of each stage; seconds add up over the parts of an interrupted run."""

    def __init__(self, earlier: dict[str, dict[str, float]] | None = None):
        self.stages: dict[str, dict[str, float]] = {name: dict(row) for name, row in (earlier or {}).items()}

    @contextlib.contextmanager
    def stage(self, name: str) -> Iterator[None]:
        """Measures the block as (a further part of) stage `name`."""
        started = time.perf_counter()
        peak = [resident_gib()]
        done = threading.Event()

        def watch() -> None:
            while not done.wait(SAMPLE_SECONDS):
                peak[0] = max(peak[0], resident_gib())

        watcher = threading.Thread(target=watch, daemon=True)
        watcher.start()
        try:
            yield
        finally:
            done.set()
            watcher.join()
            row = self.stages.setdefault(name, {"seconds": 0.0, "peak_gib": 0.0})
            row["seconds"] = round(row["seconds"] + time.perf_counter() - started, 3)
            row["peak_gib"] = round(max(row["peak_gib"], peak[0], resident_gib()), 3)

    def credit(self, name: str, row: dict[str, float]) -> None:
        """Adds what (a part of) stage `name` has cost elsewhere, where its result was taken from."""
        own = self.stages.setdefault(name, {"seconds": 0.0, "peak_gib": 0.0})
        own["seconds"] = round(own["seconds"] + row["seconds"], 3)
        own["peak_gib"] = max(own["peak_gib"], row["peak_gib"])

    @property
    def seconds(self) -> float:
        return round(sum(row["seconds"] for row in self.stages.values()), 3)

    @property
    def peak_gib(self) -> float:
        return max((row["peak_gib"] for row in self.stages.values()), default=0.0)


def resident_gib() -> float:
    """Resident memory of this process in GiB: now and with its workers on Linux, the highest so far elsewhere."""
    own = pathlib.Path("/proc/self")
    if (own / "statm").exists():
        return sum(map(_resident_pages, [own, *_children(own)])) * os.sysconf("SC_PAGE_SIZE") / 2**30
    import resource

    unit = 1 if sys.platform == "darwin" else 1024
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * unit / 2**30


def _children(process: pathlib.Path) -> list[pathlib.Path]:
    """Children of a process: each is listed with the thread that started it.

    One that goes by the parent's own command line has been forked and is no program of its own yet: its memory is the parent's.
    """
    pids = [pid for listed in process.glob("task/*/children") for pid in _read(listed).split()]
    children, command = [pathlib.Path("/proc") / pid for pid in pids], _read(process / "cmdline")
    return [child for child in children if _read(child / "cmdline") != command]


def _read(file: pathlib.Path) -> str:
    try:
        return file.read_text()
    except OSError:  # its thread or process has ended meanwhile
        return ""


def _resident_pages(process: pathlib.Path) -> int:
    pages = _read(process / "statm").split()
    return int(pages[1]) if pages else 0
