"""What every adapter makes of a file: one scene with its axes, its scale, and how it wants to be drawn."""

import dataclasses
import pathlib
from typing import Any

import numpy as np

from wm.compare.painted_mesh import PaintedMesh
from wm.finished import FinishedRun
from wm.types import Camera, Gaussians


@dataclasses.dataclass(frozen=True, eq=False)
class Source:
    """What the command line says of one method."""

    method: str  # the name of its row
    adapter: str  # a key of ADAPTERS
    path: pathlib.Path
    up: str | None = None  # a key of UP; None: as the adapter knows it
    antialias: bool | None = None  # None: as the adapter or the file knows it
    cameras: pathlib.Path | None = None  # a transforms.json; None: the one beside the file, if there is one


@dataclasses.dataclass(frozen=True, eq=False)
class System:
    """Facts of a system's files, as its public code writes them: a row of docs/comparison.md, and part of comparison.json."""

    name: str
    file: str  # what is read
    up: str
    scale: str
    colors: str
    activations: str
    antialias: bool
    source: str  # where this was read; empty for formats of no one system
    commit: str
    options: tuple[str, ...] = ()  # of METHOD.option=value, those that its files leave open


@dataclasses.dataclass(frozen=True, eq=False)
class ComparedScene:
    """A scene of one method, in the file's own axes and unit; exactly one of `gaussians` and `mesh` is there.

    Attributes:
        method: the name of its row
        gaussians: on the host
        mesh: a painted mesh
        R_world_file: [3, 3] turns the file's axes so that z points up; cameras and `eye` are in that world, in the file's unit
        metric: whether the unit is the metre
        antialias: whether it was trained with opacities that fall with the blur
        eye: [3] where the system looked from as it made the scene; None where nothing says
        cameras: its own cameras, in the world
        run: the run of ours that it is; None for all others
    """

    method: str
    gaussians: Gaussians | None = None
    mesh: PaintedMesh | None = None
    R_world_file: Any = dataclasses.field(default_factory=lambda: np.eye(3))
    metric: bool = False
    antialias: bool = False
    eye: np.ndarray | None = None
    cameras: tuple[Camera, ...] = ()
    run: FinishedRun | None = None
