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
    "compressed_ply": ExportTarget("wm.export.splats.compressed_ply", "gaussians in PlayCanvas's compressed PLY, y up"),
    "gltf_splats": ExportTarget("wm.export.splats.gltf_splats", "scaffold and gaussians in one GLB (KHR_gaussian_splatting)"),
    "labelled_ply": ExportTarget("wm.export.splats.labelled_ply", "splats.ply with the room and the object of each gaussian"),
    "sog": ExportTarget("wm.export.splats.sog", "gaussians in PlayCanvas's SOG, y up", "splats"),
    "splat": ExportTarget("wm.export.splats.splat", "gaussians in antimatter15's .splat, y up"),
    "spz": ExportTarget("wm.export.splats.spz", "gaussians in Niantic's SPZ (version 3), y up", "splats"),
}
