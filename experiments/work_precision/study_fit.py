"""The fit of one furnished room: held-out error against wall-clock, over initialisation, weights, spacing and optimiser.

Every point is a whole fit of so many steps, because the learning rates fall to its end. Compilation is left out of the seconds (a
first fit of the same shapes is not timed), planning, projection and all else is in, on one core.
"""

import dataclasses
import pathlib
import time
from collections.abc import Iterator

import bench
import jax
import numpy as np

from wm.geometry.rays.raycast import cast
from wm.schema import FitSettings, RasterSettings
from wm.splat import fit, initial_gaussians, psnr, render
from wm.stages.evaluation import Seen, _alignment

STEPS = (30, 120)
STEPS_OF_DEFAULT = (30, 60, 120, 240)

VARIANTS: dict[str, dict] = {
    "default": {},
    "init isotropic": {"init": "isotropic"},
    "init random": {"init": "random"},
    "no depth, no normals": {"depth_weight": 0.0, "normal_weight": 0.0},
    "no normals": {"normal_weight": 0.0},
    "depth weight 0.7": {"depth_weight": 0.7},
    "depth weight 4": {"depth_weight": 4.0},
    "spacing x1.4": {"spacing": 0.077, "detail_spacing": 0.0385},
    "spacing x0.7": {"spacing": 0.0385, "detail_spacing": 0.01925},
    "rates x0.5": {"factor": 0.5},
    "rates x2": {"factor": 2.0},
    "rates not falling": {"lr_final": 1.0},
    "2 views a step": {"batch": 2},
    "refined": {"refine_every": 14},
    "as many without": {"spacing": 0.0513, "detail_spacing": 0.0256},
}
PANELS = [("seconds", "psnr", "linear"), ("seconds", "m_mae", "log"), ("seconds", "n_ang_deg", "linear")]


def rows(tiny: bool, world: pathlib.Path) -> Iterator[dict]:
    bench.prepare_one_core()
    room = bench.furnished_room(world, tiny=tiny)
    for name, changes in VARIANTS.items():
        steps = (2, 4) if tiny else STEPS_OF_DEFAULT if name == "default" else STEPS
        settings = settings_of(changes | ({"spacing": 0.25, "detail_spacing": 0.25} if tiny else {}))
        start = initial_gaussians(room.views, settings=settings, rng=np.random.default_rng(0))
        fitted(start, room, dataclasses.replace(settings, steps=1))
        for count in steps:
            result, seconds = fitted(start, room, dataclasses.replace(settings, steps=count))
            errors = heldout_errors(result.gaussians, room)
            labels = {"vary": name, "value": count, "default": name == "default" and count == FitSettings().steps}
            cost = {"gaussians": len(start.means), "seconds": seconds}
            yield labels | cost | errors | {"stopped": result.stopped or ""}


def settings_of(changes: dict) -> FitSettings:
    """The defaults with changes; `factor` multiplies every learning rate."""
    changes = dict(changes)
    factor = changes.pop("factor", 1.0)
    rates = {f.name for f in dataclasses.fields(FitSettings) if f.name.startswith("lr_")} - {"lr_final", "lr_exposure"}
    defaults = FitSettings(curve_points=0)
    return dataclasses.replace(defaults, **{name: factor * getattr(defaults, name) for name in rates} | changes)


def fitted(start, room: bench.Room, settings: FitSettings):
    """The fit, and its seconds."""
    started = time.perf_counter()
    result = fit(start, room.views, settings=settings, key=jax.random.key(0))
    return result, time.perf_counter() - started


def heldout_errors(gaussians, room: bench.Room) -> dict[str, float]:
    """Means over the held-out views: PSNR, M-MAE in metres, N-Ang in degrees (design.md section 6)."""
    rows = []
    for view, target in zip(room.cameras, room.heldout):
        image = jax.tree.map(np.asarray, render(gaussians, target.camera, settings=RasterSettings()))
        row = _alignment(room.scene, Seen(view=view, render=image, gbuffer=cast(room.scene.rays, view.camera)), depth=True)
        rows.append(row | {"psnr": psnr(image.rgb, target.rgb / np.float32(255))})
    return {name: float(np.mean([row[name] for row in rows])) for name in ("psnr", "m_mae", "n_ang_deg")}
