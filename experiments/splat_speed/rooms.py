"""The cost of a step of `fit_scene` over the number of rooms, each like the other, on one core.

Rooms stand in a row, walls closed; each looks for what it sees of its neighbours, as a fit does, and renders columns kept for
them. The seconds are those of the whole call, divided by all steps of all rooms: setting up a room (its views, its neighbours as
they see them) is in, compilation is not. Images are small and steps few, so that what is not rendering weighs more than in a fit.
"""

import dataclasses
import functools
import os
import sys
from collections.abc import Iterator

os.sched_setaffinity(0, {min(os.sched_getaffinity(0))})  # before JAX counts the cores

import jax  # noqa: E402
import numpy as np  # noqa: E402
from bench_scene import exponential_ns, seconds  # noqa: E402
from records import Record, write  # noqa: E402

from tests.splat.rooms import SIZE, views_of  # noqa: E402
from wm.host import prepare_process  # noqa: E402
from wm.schema import FitSettings  # noqa: E402
from wm.splat import TrainingView, fit_scene, initial_gaussians  # noqa: E402
from wm.splat.optimization.padding import Capacity  # noqa: E402
from wm.types import Gaussians  # noqa: E402

COUNTS = (4, 8, 16, 32)
APART = SIZE[0] + 0.15
"""Metres from one room to the next: a wall between them."""

REPEATS, ALLOWED, MARGIN = 3, 0.15, 0.15
SETTINGS = FitSettings(spacing=0.08, detail_spacing=0.08, steps=24, curve_points=0)


def records(tiny: bool) -> Iterator[Record]:
    prepare_process()
    size, settings = ((32, 24), dataclasses.replace(SETTINGS, spacing=0.3, steps=2)) if tiny else ((172, 96), SETTINGS)
    exp_ns = exponential_ns(15)
    views = functools.partial(views_in, *size)
    first = initial_gaussians(views(1, 0), settings=settings, rng=np.random.default_rng(0))
    fit = functools.partial(fit_rooms, first, views, settings, Capacity())
    warm = [seconds(functools.partial(fit, 2)) for _ in range(2)]
    ms = dict.fromkeys(COUNTS, np.inf)
    for _ in range(1 if tiny else REPEATS):
        for count in COUNTS:
            ms[count] = min(ms[count], 1e3 * seconds(functools.partial(fit, count)) / (count * settings.steps))
    for count in COUNTS:
        record = functools.partial(Record, figure="rooms", case=f"{count} rooms of {len(first.means)}, {size[0]} x {size[1]}")
        yield record(key="time of a step", value=ms[count], unit="ms", better="lower")
        yield record(key="step", value=ms[count] / exp_ns, unit="ms per ns of exp", better="lower", margin=MARGIN)
        wanted = 1 + ALLOWED if count > COUNTS[0] else None
        yield record(key="against the fewest", value=ms[count] / ms[COUNTS[0]], unit="", better="lower", wanted=wanted)
        if count == COUNTS[0]:
            yield record(key="compilation, for all", value=warm[0] - warm[1], unit="s", better="lower")


def fit_rooms(first: Gaussians, views, settings: FitSettings, capacity: Capacity, count: int) -> tuple:
    """The fit of so many rooms, the first given."""
    start = [dataclasses.replace(first, means=first.means + np.float32([APART * room, 0, 0])) for room in range(count)]
    shared = {"settings": settings, "key": jax.random.key(0), "capacity": capacity, "devices": jax.devices()[:1], "workers": 1}
    result = fit_scene(start, functools.partial(views, count), **shared)
    assert not result.stopped, result.stopped
    return result.gaussians


def views_in(width: int, height: int, rooms: int, room: int) -> list[TrainingView]:
    """Eight views of one of `rooms` rooms at its place in the row."""
    to_first = np.eye(4)
    to_first[0, 3] = -APART * room
    return [
        dataclasses.replace(
            view,
            room=room,
            camera=dataclasses.replace(view.camera, T_cam_world=view.camera.T_cam_world @ to_first),
            sees=tuple(other for other in (room - 1, room + 1) if 0 <= other < rooms),
        )
        for view in views_of(count=8, width=width, height=height)
    ]


if __name__ == "__main__":
    write(records("--tiny" in sys.argv))
