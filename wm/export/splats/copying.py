"""What targets of gaussians share: a copy in a format's axes and order is written, read back and held against the run."""

import dataclasses
from collections.abc import Callable
from pathlib import Path

import jax

from wm.artifacts.atomic import write_atomically
from wm.export.records import Check, ExportError
from wm.export.splats.comparing import Steps, as_checks, read_back, require_within
from wm.finished import FinishedRun
from wm.splat.formats import SplatFileError, to_y_up
from wm.splat.ply.standard import packable
from wm.types import Gaussians


@dataclasses.dataclass(frozen=True)
class SplatCopy:
    """How one format holds the gaussians of a run."""

    target: str
    file: str  # its name
    save: Callable[[Path, Gaussians], None]  # of gaussians in the order of the file
    steps: Callable[[Gaussians], Steps]  # of the format, for these gaussians
    order: Callable[[Gaussians], object] | None = None  # indices that bring gaussians into the order of the file

    def gaussians(self, run: FinishedRun) -> Gaussians:
        """What the file holds: the run's gaussians with y up, in the order of the file."""
        turned = packable(to_y_up(run.gaussians))
        if self.order is None:
            return turned
        order = self.order(turned)
        return jax.tree.map(lambda leaf: leaf[order], turned)

    def write(self, run: FinishedRun, folder: Path) -> list[Path]:
        """Writes the file and reads it back.

        Raises:
            ExportError: it cannot be written, or comes back otherwise.
        """
        path, gaussians = folder / self.file, self.gaussians(run)
        try:
            write_atomically(path, lambda part: self.save(part, gaussians))
        except SplatFileError as error:
            raise ExportError(f"target {self.target}: {error}") from None
        require_within(self.target, path, read_back(self.target, path, gaussians, self.steps(gaussians)))
        return [path]

    def check(self, run: FinishedRun, folder: Path) -> list[Check]:
        """How far the file's gaussians lie from the run's."""
        gaussians = self.gaussians(run)
        return as_checks(self.target, read_back(self.target, folder / self.file, gaussians, self.steps(gaussians)))
