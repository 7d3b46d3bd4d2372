"""The targets of an export by name. A module of a target is imported when it is asked for, since it may need an extra.

It has

    write(run, folder)   writes the target's files into a folder, reads them back and compares; returns their paths
    check(run, folder)   proves files that are there with the tools of those who use them; returns `Check`s
"""

import dataclasses
import importlib
from collections.abc import Sequence
from pathlib import Path
from typing import Protocol, cast, runtime_checkable

from wm.export.records import Check
from wm.finished import FinishedRun


@runtime_checkable
class TargetModule(Protocol):
    """What a target's module must have."""

    def write(self, run: FinishedRun, folder: Path) -> Sequence[Path]: ...

    def check(self, run: FinishedRun, folder: Path) -> Sequence[Check]: ...


@dataclasses.dataclass(frozen=True)
class ExportTarget:
    """What a target writes, and what it needs for that."""

    module: str
    what: str  # in a few words, for --help and the docs
    extra: str | None = None  # of wm, which must be installed for it

    def load(self) -> TargetModule:
        return cast(TargetModule, importlib.import_module(self.module))


TARGETS: dict[str, ExportTarget] = {
    "mjcf": ExportTarget("wm.export.simulation.mjcf", "the house for MuJoCo, furniture as bodies", "simulation"),
    "urdf": ExportTarget("wm.export.simulation.urdf", "the house as a robot description", "simulation"),
    "usd": ExportTarget("wm.export.simulation.usd", "OpenUSD: scaffold, splats, colliders, masses, labels", "simulation"),
}
