"""Many rooms: each is a fit of its own, beside neighbours held still.

Block Jacobi: in every round each room moves its own gaussians toward its own views, and what those views see of other rooms,
through doors, is frozen as it stood when the round began. So rooms are independent within a round: they run side by side, one to
a device and a Python thread, and the result does not depend on which ran where or when. Cost is linear in rooms; the images of a
room are in memory only while it is fitted. Rooms share compiled steps: their gaussians are padded to a few common sizes.
"""

import dataclasses
import queue
import threading
import time
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor

import jax
import numpy as np

from wm.schema import FitSettings, RasterSettings
from wm.splat.checkpoint import RoomState, from_arrays, initial_state, to_arrays
from wm.splat.fit import DEFAULT_RASTER, Progress, see_views, seed_of
from wm.splat.room_fit import Capacity, Device, FitPoint, RoomFit, pad_gaussians, pad_rows, unpad_rows
from wm.splat.step import raster_for
from wm.splat.training import TrainingView
from wm.types import Gaussians

RUNG = 8
"""Padded sizes are the largest room's count over powers of this. One rung is usual: compiling a step takes as long as fifty of
them, and what padding adds to a step is little."""

RoomViews = Callable[[int], Sequence[TrainingView]]
Arrays = Mapping[str, np.ndarray]


@dataclasses.dataclass(frozen=True, eq=False)
class SceneFit:
    """What the fit of a scene came to."""

    gaussians: tuple[Gaussians, ...]  # by room, NumPy float32 leaves, each in the order it started in
    history: tuple[FitPoint, ...]  # by room, then step
    stopped: tuple[str, ...]  # one sentence for each room that ended early


def fit_scene(
    gaussians: Sequence[Gaussians],
    views: RoomViews,
    *,
    settings: FitSettings,
    raster: RasterSettings = DEFAULT_RASTER,
    key: jax.Array,
    heldout: RoomViews = lambda room: (),
    load: Callable[[int, int], Arrays | None] = lambda round_, room: None,
    store: Callable[[int, int, Arrays], None] = lambda round_, room, arrays: None,
    progress: Progress | None = None,
    devices: Sequence[Device] | None = None,
) -> SceneFit:
    """The gaussians of every room, fitted to its views.

    Args:
        gaussians: where each room starts, by room index; not changed. A room may have none.
        views: the training views of a room, asked for in every round (so they may come from disk). `TrainingView.sees` names the
            other rooms whose gaussians a view is rendered with. A room without views keeps its gaussians.
        settings: `steps` per room in all, divided over `rounds`; a checkpoint lies at the end of each round.
        raster: the rasterizer's constants; `depth` is set here.
        key: a JAX key. Same arguments and key, same bytes, on any number of devices.
        heldout: a few views of a room to measure its curve on; never trained on.
        load, store: checkpoints by (round, room): what was stored is not computed again, and ends in the same bytes. `store` is
            called from the threads of the devices, for one room at a time each.
        progress: called after every step of any room, one call at a time.
        devices: one room at a time each; all CPU devices if None (`jax_num_cpu_devices` says how many), or all accelerators.

    Returns: the gaussians, the curves and what stopped early. Errors of a room (of `views`, say) are raised once all rooms ended.
    """
    scene = _Scene(
        states=[initial_state(start) for start in gaussians],
        views=views,
        heldout=heldout,
        settings=settings,
        raster=raster_for(settings, raster),
        seed=seed_of(key),
        report=_Report(len(gaussians) * settings.steps, progress),
    )
    devices = list(devices or jax.devices())
    free = queue.SimpleQueue()
    for device in devices:
        free.put(device)

    def one_room(round_: int, room: int) -> RoomState:
        stored = load(round_, room)
        if stored is not None:
            first, last = scene.stretch(round_)
            scene.report.skip(last - first)
            return from_arrays(stored)
        device = free.get()
        try:
            state = scene.fit_room(round_, room, device)
        finally:
            free.put(device)
        store(round_, room, to_arrays(state))
        return state

    largest_first = sorted(range(len(gaussians)), key=lambda room: -len(gaussians[room].opacity_logits))
    with ThreadPoolExecutor(max_workers=len(devices), thread_name_prefix="wm-fit") as pool:
        for round_ in range(settings.rounds):
            running = {room: pool.submit(one_room, round_, room) for room in largest_first}
            scene.states = [running[room].result() for room in range(len(gaussians))]
    return SceneFit(
        gaussians=tuple(state.train.gaussians for state in scene.states),
        history=tuple(point for state in scene.states for point in state.history),
        stopped=tuple(state.stopped for state in scene.states if state.stopped),
    )


class _Report:
    """Steps done over all rooms, told to `progress` one call at a time."""

    def __init__(self, total: int, progress: Progress | None) -> None:
        self._done, self._total, self._progress, self._lock = 0, total, progress, threading.Lock()

    def step(self, info: dict) -> None:
        self._add(1, info)

    def skip(self, steps: int) -> None:
        self._add(steps, {})

    def _add(self, steps: int, info: dict) -> None:
        with self._lock:
            self._done += steps
            if self._progress is not None:
                self._progress(self._done, self._total, info)


class _Scene:
    """The states of all rooms as they stood when the round began, and all that the fit of one of them reads."""

    def __init__(self, *, states, views, heldout, settings, raster, seed, report) -> None:
        self.states: list[RoomState] = states
        self.views: RoomViews = views
        self.heldout: RoomViews = heldout
        self.settings: FitSettings = settings
        self.raster: RasterSettings = raster
        self.seed: tuple[int, ...] = seed
        self.report: _Report = report
        self.capacity = Capacity()
        self.started = time.perf_counter()
        self.largest = max((self._count(room) for room in range(len(states))), default=0)

    def stretch(self, round_: int) -> tuple[int, int]:
        """First step of a round and one past its last."""
        steps, rounds = self.settings.steps, self.settings.rounds
        return steps * round_ // rounds, steps * (round_ + 1) // rounds

    def fit_room(self, round_: int, room: int, device: Device) -> RoomState:
        """The state of a room after a round."""
        state, (first, last) = self.states[room], self.stretch(round_)
        views = list(self.views(room))
        if state.stopped or not views or self._count(room) == 0:
            self.report.skip(last - first)
            return state
        heldout = list(self.heldout(room))
        all_views = [*views, *heldout]
        seen = see_views(all_views, self._neighbours(all_views, room, device), self.raster, device, self._columns)
        room_fit = RoomFit(
            views=seen[: len(views)],
            heldout=seen[len(views) :],
            settings=self.settings,
            raster=self.raster,
            seed=(*self.seed, room),
            room=room,
            capacity=self.capacity,
            clock=lambda: time.perf_counter() - self.started,
        )
        train = pad_rows(state.train, self._rung(room))
        culled = pad_gaussians(state.train.gaussians, self._rung(room))
        train = jax.device_put(dataclasses.replace(train, gaussians=culled), device)
        train, points, stopped = room_fit.run(train, first, last, lambda done, info: self.report.step(info | {"room": room}))
        return RoomState(train=unpad_rows(train, self._count(room)), history=(*state.history, *points), stopped=stopped)

    def _neighbours(self, views: Sequence[TrainingView], room: int, device: Device) -> list[list[Gaussians]]:
        """What each view may see of other rooms, on the device, each room once."""
        others = sorted({other for view in views for other in view.sees if other != room and self._count(other) > 0})
        padded = {other: pad_gaussians(self.states[other].train.gaussians, self._rung(other)) for other in others}
        on_device = jax.device_put(padded, device)
        return [[on_device[other] for other in sorted(set(view.sees)) if other in on_device] for view in views]

    def _columns(self, most: int) -> int:
        """Columns for neighbours, the same for all rooms if they suffice: none in a scene of one room."""
        if len(self.states) == 1:
            return 0
        columns = max(self.largest, 1)
        while columns < most:
            columns *= 2
        return columns

    def _count(self, room: int) -> int:
        return len(self.states[room].train.gaussians.opacity_logits)

    def _rung(self, room: int) -> int:
        """The padded size of a room's gaussians."""
        size = self.largest
        while -(-size // RUNG) >= self._count(room) and size > 1:
            size = -(-size // RUNG)
        return size
