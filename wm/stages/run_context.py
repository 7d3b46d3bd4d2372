"""What every stage of a run needs besides its inputs: the configuration, the run folder and the meter."""

import dataclasses
import functools
import importlib.metadata
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import wm
from wm.artifacts.digests import digest
from wm.artifacts.run_folder import RunFolder
from wm.meter import StageMeter
from wm.schema import STAGES, RunConfig
from wm.services.services import Services
from wm.stages.progress import Progress, progress

_RECORDED = ("jax", "jaxlib", "numpy", "embreex", "manifold3d", "optax")
"""Libraries of which another version may give other bytes."""


class StoppedError(Exception):
    """The run has come to the end of the stage `until` and is complete as far as that."""


@dataclasses.dataclass(frozen=True, eq=False)
class RunContext:
    """The configuration, the folder and the meter of one run."""

    config: RunConfig
    folder: RunFolder
    meter: StageMeter
    services: Services = dataclasses.field(default_factory=Services)

    def key(self, stage: str, *inputs: Any) -> str:
        """The key of a stage's entry: what it is made from, and by which versions."""
        return digest(stage, self.config.seed, versions(), *inputs)

    @contextmanager
    def stage(self, name: str, *, stores: bool = True) -> Iterator[None]:
        """Measures a stage, unless it finds all that it would make.

        Args:
          name: the stage.
          stores: whether it keeps its result in entries of the folder. One that does not is measured the first time.

        Raises:
          StoppedError: at its end, if the run goes only until this stage.
        """
        self.services.stage = name
        recorded, found, known = self.folder.recorded, self.folder.found, self.meter.knows(name)

        def made() -> bool:
            return self.folder.recorded > recorded if stores else not known

        with self.meter.stage(name, made=made):
            yield
        if stores and (self.folder.recorded, self.folder.found) == (recorded, found):
            self.meter.forget(name)  # this run has nothing for it to do: a row is that of another run
        if name == self.config.until != STAGES[-1]:
            raise StoppedError

    def bar(self, name: str, total: int) -> Progress:
        """The progress of a stage on stderr: a bar on a terminal, else a line now and then."""
        return progress(name, total)


@functools.cache
def versions() -> dict[str, str]:
    """Of this package and of the libraries whose results may differ between versions."""
    return {"wm": wm.__version__} | {name: importlib.metadata.version(name) for name in _RECORDED}
