"""A run folder of wm, to its end or at least to its gaussians."""

import numpy as np

from wm.artifacts.digests import digest
from wm.compare.records import ComparedScene, Source, System
from wm.finished import open_finished

SYSTEM = System(
    name="ours",
    file="a run folder",
    up="z",
    scale="metres",
    colors="spherical harmonics",
    activations="exp, sigmoid",
    antialias=False,
    source="this repository",
    commit="",
    options=("antialias",),
)


def identity(source: Source) -> str:
    """A digest of what the run has made, of which the cameras depend on more than the gaussians."""
    run = open_finished(source.path)
    return digest("ours", run.key("plan", "furnish", "reconstruct"), run.config.get("raster"))


def read(source: Source) -> ComparedScene:
    """The run. Raises: UnfinishedRunError."""
    run = open_finished(source.path)
    _ = run.splats_file
    return ComparedScene(
        method=source.method,
        gaussians=run.gaussians,
        R_world_file=np.eye(3),
        metric=True,
        antialias=run.raster.antialias if source.antialias is None else source.antialias,
        run=run,
    )
