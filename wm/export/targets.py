"""The targets of an export by name. A module of a target is imported when it is asked for, since it may need an extra.

It has

    write(run, folder)   writes the target's files into a folder, reads them back and compares; returns their paths
    check(run, folder)   proves files that are there with the tools of those who use them; returns `Check`s
"""

import dataclasses
import importlib
import importlib.util
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Protocol, cast, runtime_checkable

from wm.export.records import Check, ExportError
from wm.finished import FinishedRun


@runtime_checkable
class TargetModule(Protocol):
    """What a target's module must have."""

    def write(self, run: FinishedRun, folder: Path) -> Sequence[Path]: ...

    def check(self, run: FinishedRun, folder: Path) -> Sequence[Check]: ...


EXTRAS: dict[str, tuple[str, ...]] = {
    "simulation": ("mujoco", "pxr", "yourdfpy"),
    "splats": ("gaussforge",),
}
"""By extra of wm, the modules that must be there for its targets."""


@dataclasses.dataclass(frozen=True)
class ExportTarget:
    """What a target writes, and what it needs for that."""

    module: str
    what: str  # in a few words, for --help and the docs
    extra: str | None = None  # of wm, which must be installed for it

    def load(self) -> TargetModule:
        return cast(TargetModule, importlib.import_module(self.module))

    @property
    def installed(self) -> bool:
        """Whether what it needs is there."""
        return self.extra is None or all(importlib.util.find_spec(name) for name in EXTRAS[self.extra])


TARGETS: dict[str, ExportTarget] = {
    "compressed_ply": ExportTarget("wm.export.splats.compressed_ply", "gaussians in PlayCanvas's compressed PLY, y up"),
    "gltf_splats": ExportTarget("wm.export.splats.gltf_splats", "scaffold and gaussians in one GLB (KHR_gaussian_splatting)"),
    "labelled_ply": ExportTarget("wm.export.splats.labelled_ply", "splats.ply with the room and the object of each gaussian"),
    "mjcf": ExportTarget("wm.export.simulation.mjcf", "the house for MuJoCo, furniture as bodies", "simulation"),
    "navmesh": ExportTarget("wm.export.navmesh", "where a body can walk, as triangles: JSON and GLB"),
    "scaffold": ExportTarget("wm.export.scaffold", "the textured building and its furniture: GLB with lights and cameras"),
    "sog": ExportTarget("wm.export.splats.sog", "gaussians in PlayCanvas's SOG, y up", "splats"),
    "splat": ExportTarget("wm.export.splats.splat", "gaussians in antimatter15's .splat, y up"),
    "spz": ExportTarget("wm.export.splats.spz", "gaussians in Niantic's SPZ (version 3), y up", "splats"),
    "urdf": ExportTarget("wm.export.simulation.urdf", "the house as a robot description", "simulation"),
    "usd": ExportTarget("wm.export.simulation.usd", "OpenUSD: scaffold, splats, colliders, masses, labels", "simulation"),
    "world": ExportTarget("wm.export.world", "rooms, openings, objects and spawn points: JSON with a schema"),
}


def installed_targets() -> list[str]:
    """The names of all targets whose extras are installed."""
    return [name for name, target in TARGETS.items() if target.installed]


def check_targets(names: Iterable[str]) -> None:
    """Raises: ExportError: a name is none of a target, or its extra is not installed; the message says what would be right."""
    for name in names:
        if name not in TARGETS:
            raise ExportError(f"there is no target {name!r}; targets are {', '.join(sorted(TARGETS))}")
        if not TARGETS[name].installed:
            raise ExportError(f"target {name} needs an extra that is not installed: pip install 'wm[{TARGETS[name].extra}]'")
