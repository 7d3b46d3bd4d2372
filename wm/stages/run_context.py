"""What every stage of a run needs besides its inputs: the configuration, the run folder and the meter."""

import dataclasses
import functools
import importlib.metadata
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

from tqdm import tqdm

import wm
from wm.artifacts import RunFolder, digest
from wm.meter import StageMeter
from wm.schema import RunConfig

TIMINGS = "timings.json"
_RECORDED = ("jax", "jaxlib", "numpy", "embreex", "manifold3d", "optax")
"""Libraries of which another version may give other bytes."""


@dataclasses.dataclass(frozen=True, eq=False)
class RunContext:
    """The configuration, the folder and the meter of one run."""

    config: RunConfig
    folder: RunFolder
    meter: StageMeter

    def key(self, stage: str, *inputs: Any) -> str:
        """The key of a stage's entry: what it is made from, and by which versions."""
        return digest(stage, self.config.seed, versions(), *inputs)

    @contextmanager
    def stage(self, name: str) -> Iterator[None]:
        """Measures a stage, unless it finds all that it would make."""
        before = self.folder.recorded
        with self.meter.stage(name, made=lambda: self.folder.recorded > before):
            yield

    def bar(self, name: str, total: int) -> tqdm:
        """A progress bar with rate and time left, on stderr."""
        return tqdm(total=total, desc=f"{name:>11}", dynamic_ncols=True, file=sys.stderr, mininterval=0.5)


@functools.cache
def versions() -> dict[str, str]:
    """Of this package and of the libraries whose results may differ between versions."""
    return {"wm": wm.__version__} | {name: importlib.metadata.version(name) for name in _RECORDED}
