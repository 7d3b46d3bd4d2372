"""Views a second of a fit of two rooms with about 100k visible gaussians at 688 x 384 on all cores, all costs of a step included.

The rooms are those of tests/splat/rooms.py, one like the other. A first fit of one step a room compiles, and is a row of its own;
what counts is the whole second call, with all that it does before and after its steps.
"""

import dataclasses
import functools
import sys
from collections.abc import Iterator, Sequence

import jax
import numpy as np
from bench_scene import exponential_ns, seconds
from records import Record, write

from tests.splat.rooms import views_of
from wm.host import cores, prepare_process
from wm.schema import FitSettings, RasterSettings
from wm.splat import TrainingView, fit_scene, initial_gaussians, plan_tiles
from wm.splat.optimization.padding import Capacity
from wm.splat.optimization.step import project_view
from wm.types import Gaussians

ROOMS = 2
MARGIN = 0.15
FULL = FitSettings(spacing=0.0171, detail_spacing=0.0171, steps=60, curve_points=0)
TINY = dataclasses.replace(FULL, spacing=0.2, detail_spacing=0.2, steps=8)


def records(tiny: bool) -> Iterator[Record]:
    prepare_process()
    size, settings = ((64, 48), TINY) if tiny else ((688, 384), FULL)
    exp_ns = exponential_ns(15)
    views = functools.partial(views_in, *size)
    start = initial_gaussians(views(0), settings=settings, rng=np.random.default_rng(0))
    visible, pairs = seen(start, views(0))
    record = functools.partial(Record, figure="whole_fit", case="two rooms, 688 x 384, threads")
    yield record(key="cores", value=cores(), unit="")
    yield record(key="gaussians a room", value=len(start.means) / 1e3, unit="1e3")
    yield record(key="visible", value=visible / 1e3, unit="1e3")
    yield record(key="pairs a view", value=pairs / 1e6, unit="1e6")
    fit = functools.partial(fit_rooms, start, views, Capacity())
    first = seconds(functools.partial(fit, dataclasses.replace(settings, steps=1)))
    rate = ROOMS * settings.steps / seconds(functools.partial(fit, settings))
    yield record(key="rate", value=rate, unit="views/s", better="higher", wanted=20)
    yield record(key="a view", value=1e3 / rate / exp_ns, unit="ms per ns of exp", better="lower", margin=MARGIN)
    yield record(key="first step of each room", value=first, unit="s", better="lower")


def views_in(width: int, height: int, room: int) -> list[TrainingView]:
    """Sixteen views of a room, which see no other."""
    return [dataclasses.replace(view, room=room) for view in views_of(count=16, width=width, height=height)]


def seen(gaussians: Gaussians, views: Sequence[TrainingView]) -> tuple[float, float]:
    """How many gaussians a view sees, and how many (gaussian, pixel) pairs it lists, in the mean."""
    visible, pairs, settings = [], [], RasterSettings()
    for view in views:
        projected = project_view(gaussians, view.camera, raster=settings)
        plan = plan_tiles(projected, view.camera.width, view.camera.height, settings)
        visible.append((np.asarray(projected.opacity) > 0).sum())
        pairs.append(plan.count.sum() * settings.tile**2)
    return float(np.mean(visible)), float(np.mean(pairs))


def fit_rooms(start: Gaussians, views, capacity: Capacity, settings: FitSettings) -> tuple:
    """The fit of all rooms from the same start, one room per core on one device."""
    shared = {"key": jax.random.key(0), "capacity": capacity, "devices": jax.devices()[:1]}
    result = fit_scene([start] * ROOMS, views, settings=settings, **shared)
    assert not result.stopped, result.stopped
    return result.gaussians


if __name__ == "__main__":
    write(records("--tiny" in sys.argv))
