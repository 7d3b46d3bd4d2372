"""What every stage needs besides its inputs: the configuration, the run folder, the clock."""

import dataclasses
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

from tqdm import tqdm

from wm.artifacts import RunFolder, digest, json_text, write_atomically
from wm.meter import StageMeter
from wm.schema import RunConfig

TIMINGS = "timings.json"


@dataclasses.dataclass(frozen=True, eq=False)
class Job:
    """One run under way."""

    config: RunConfig
    folder: RunFolder
    meter: StageMeter

    def key(self, stage: str, *inputs: Any) -> str:
        """The key of a stage's entry: what it is made from."""
        return digest(stage, self.config.seed, *inputs)

    @contextmanager
    def stage(self, name: str) -> Iterator[None]:
        """Measures a stage and keeps `timings.json` up to date, also when the stage fails or is interrupted."""
        try:
            with self.meter.stage(name):
                yield
        finally:
            write_atomically(self.folder.path / TIMINGS, json_text(self.meter.stages))

    def bar(self, name: str, total: int) -> tqdm:
        """A progress bar with rate and time left, on stderr."""
        return tqdm(total=total, desc=f"{name:>11}", dynamic_ncols=True, file=sys.stderr, mininterval=0.5)
