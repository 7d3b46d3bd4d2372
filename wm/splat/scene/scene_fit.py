"""Many rooms: each is a fit of its own, beside neighbours held still.

Block Jacobi: in every round each room moves its own gaussians toward its own views, and what those views see of other rooms,
through doors, is frozen as it stood when the round began. So rooms are independent within a round: they run side by side, one to
a device and a Python thread, or to a process of its own (room_worker.py), and the result does not depend on which ran where or
when. Cost is linear in rooms; the images of a room are in memory only while it is fitted. Rooms share compiled steps: their
gaussians are padded to a few common sizes.
"""

import dataclasses
import queue
import time
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor

import jax

from wm.schema import FitSettings, RasterSettings
from wm.splat.optimization.batch import Device
from wm.splat.optimization.checkpoint import from_arrays, to_arrays
from wm.splat.optimization.checks import check_fit
from wm.splat.optimization.curve import FitPoint
from wm.splat.optimization.fitting import Progress, seed_of
from wm.splat.optimization.padding import Capacity, pad_gaussians
from wm.splat.optimization.room_fit import Interrupted
from wm.splat.optimization.room_state import RoomState, initial_state
from wm.splat.optimization.step import raster_for
from wm.splat.optimization.training import TrainingView
from wm.splat.rasterizer.checks import check_raster
from wm.splat.rasterizer.projection import DEFAULTS
from wm.splat.scene.room_task import Here, Place, RoomTask
from wm.splat.scene.room_worker import RoomWorker
from wm.splat.scene.scene_progress import Checkpoints, Load, SceneProgress, Store
from wm.types import Gaussians

RUNG = 8
"""Padded sizes are the largest room's count over powers of this. One rung is usual: compiling a step takes as long as fifty of
them, and what padding adds to a step is little."""

RoomViews = Callable[[int], Sequence[TrainingView]]


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
    raster: RasterSettings = DEFAULTS,
    key: jax.Array,
    heldout: RoomViews = lambda room: (),
    load: Load = lambda round_, room: None,
    store: Store = lambda round_, room, arrays: None,
    checkpoint_seconds: float = 60.0,
    progress: Progress | None = None,
    capacity: Capacity | None = None,
    devices: Sequence[Device] | None = None,
    workers: Sequence[RoomWorker] = (),
) -> SceneFit:
    """The gaussians of every room, fitted to its views.

    Args:
        gaussians: where each room starts, by room index; not changed. A room may have none.
        views: the training views of a room, asked for in every round (so they may come from disk). `TrainingView.sees` names the
            other rooms whose gaussians a view is rendered with. A room without views keeps its gaussians.
        settings: `steps` per room in all, divided over `rounds`.
        raster: the rasterizer's constants; `depth` is set here.
        key: a JAX key. Same arguments and key, same bytes, on any number of devices.
        heldout: a few views of a room to measure its curve on; never trained on.
        load, store: checkpoints by (round, room), the last of each counts: what was stored is not computed again, and ends in the
            same bytes. `store` is called from threads, one for each room under way.
        checkpoint_seconds: a room is stored when this long has passed since it began or was stored, and when its round ends.
        progress: called after every step of any room, one call at a time.
        capacity: of an earlier fit of the same shapes, to share what was compiled for it; None: a new one.
        devices: one room at a time each, or several for a room and its batches where there are fewer rooms; all CPU devices if
            None (`jax_num_cpu_devices` says how many), or all accelerators.
        workers: processes (`room_workers`) that fit one room at a time each, instead of devices of this one. Same bytes as on
            the CPU here, if no `jax.config.update` of the caller decides them: workers have its environment only.

    Returns: the gaussians, the curves and what stopped early.
    Raises: TypeError or ValueError naming what is wrong with an argument, as `fit`. The error of a room (of `views`, say) once
        all rooms ended their round; a RuntimeError that names the room if the process that fitted it has died, WorkerClosed if it
        was closed. A KeyboardInterrupt as soon as every room under way has ended its step; all that was reached is stored.
    """
    check_fit(settings)
    check_raster(raster)
    scene = _Scene(
        states=[initial_state(start, f"gaussians[{room}]") for room, start in enumerate(gaussians)],
        views=views,
        heldout=heldout,
        settings=settings,
        raster=raster_for(settings, raster),
        seed=seed_of(key),
        report=SceneProgress(len(gaussians) * settings.steps, progress),
        checkpoints=Checkpoints(load, store, checkpoint_seconds),
        capacity=capacity or Capacity(),
    )
    places: Sequence[Place] = workers or _places(list(devices or jax.devices()), len(gaussians))
    free: queue.SimpleQueue[Place] = queue.SimpleQueue()
    for place in places:
        free.put(place)

    def one_room(round_: int, room: int) -> RoomState:
        state = scene.stored(round_, room)
        if state is not None and scene.has_ended(state, round_):
            return state
        mine = free.get()
        try:
            return scene.fit_room(round_, room, state or scene.states[room], mine)
        finally:
            free.put(mine)

    largest_first = sorted(range(len(gaussians)), key=lambda room: -len(gaussians[room].opacity_logits))
    with ThreadPoolExecutor(max_workers=min(len(places), max(len(gaussians), 1)), thread_name_prefix="wm-fit") as pool:
        for round_ in range(settings.rounds):
            running = {room: pool.submit(one_room, round_, room) for room in largest_first}
            try:
                scene.states = [running[room].result() for room in range(len(gaussians))]
            except KeyboardInterrupt:
                scene.report.halt()
                pool.shutdown(cancel_futures=True)
                raise
    return SceneFit(
        gaussians=tuple(state.train.gaussians for state in scene.states),
        history=tuple(point for state in scene.states for point in state.history),
        stopped=tuple(state.stopped for state in scene.states if state.stopped),
    )


def _places(devices: list[Device], rooms: int) -> list[Here]:
    side_by_side = max(min(len(devices), rooms), 1)
    return [Here(devices[first::side_by_side]) for first in range(side_by_side)]


class _Scene:
    """The states of all rooms as they stood when the round began, and all that the fit of one of them reads."""

    def __init__(self, *, states, views, heldout, settings, raster, seed, report, checkpoints, capacity) -> None:
        self.states: list[RoomState] = states
        self.views: RoomViews = views
        self.heldout: RoomViews = heldout
        self.settings: FitSettings = settings
        self.seed: tuple[int, ...] = seed
        self.report: SceneProgress = report
        self.checkpoints: Checkpoints = checkpoints
        self.raster: RasterSettings = raster
        self.capacity: Capacity = capacity
        self.started = time.perf_counter()
        self.largest = max((self._count(room) for room in range(len(states))), default=0)

    def stretch(self, round_: int) -> tuple[int, int]:
        """First step of a round and one past its last."""
        steps, rounds = self.settings.steps, self.settings.rounds
        return steps * round_ // rounds, steps * (round_ + 1) // rounds

    def stored(self, round_: int, room: int) -> RoomState | None:
        """The checkpoint of a room, whose steps count as done."""
        arrays = self.checkpoints.load(round_, room)
        if arrays is None:
            return None
        state, (first, last) = from_arrays(arrays), self.stretch(round_)
        self.report.skip((last if self.has_ended(state, round_) else state.step) - first)
        return state

    def has_ended(self, state: RoomState, round_: int) -> bool:
        """Whether a checkpoint is that of the end of a round, and not of its last step: then the round is still to be judged."""
        return state.stopped is not None or (state.watch is None and state.step >= self.stretch(round_)[1])

    def fit_room(self, round_: int, room: int, state: RoomState, place: Place) -> RoomState:
        """The state of a room after a round, which is stored, as is what an exception leaves."""
        checkpoints, (first, last) = self.checkpoints, self.stretch(round_)
        task = self._task(room, state, last)
        try:
            if task is None:
                self.report.skip(last - max(first, state.step))
                state = dataclasses.replace(state, step=last)
            else:
                done = state.step

                def report(step: int, info: dict) -> None:
                    nonlocal done
                    done = step
                    self.report.step(info | {"room": room})

                state = place.fit(task, self.capacity, report, checkpoints.keeper(round_, room))
                if done < last:  # it stopped, and perhaps went back
                    self.report.skip(last - done)
        except Interrupted as interrupted:
            if interrupted.resumable:
                checkpoints.store(round_, room, to_arrays(interrupted.state))
            raise interrupted.__cause__ or interrupted from None
        checkpoints.store(round_, room, to_arrays(state))
        return state

    def _task(self, room: int, state: RoomState, last: int) -> RoomTask | None:
        """What the fit of a room reads; None: there is nothing to fit."""
        views = [] if state.stopped or self._count(room) == 0 else _read(self.views(room))
        if not views:
            return None
        heldout = _read(self.heldout(room))
        return RoomTask(
            room=room,
            state=state,
            last=last,
            views=views,
            heldout=heldout,
            neighbours=self._neighbours([*views, *heldout], room),
            settings=self.settings,
            raster=self.raster,
            seed=self.seed,
            rows=self._rung(room),
            columns=0 if len(self.states) == 1 else max(self.largest, 1),
            seconds=time.perf_counter() - self.started,
        )

    def _neighbours(self, views: Sequence[TrainingView], room: int) -> dict[int, Gaussians]:
        others = sorted({other for view in views for other in view.sees if other != room and self._count(other) > 0})
        return {other: pad_gaussians(self.states[other].train.gaussians, self._rung(other)) for other in others}

    def _count(self, room: int) -> int:
        return len(self.states[room].train.gaussians.opacity_logits)

    def _rung(self, room: int) -> int:
        """The padded size of a room's gaussians."""
        size = self.largest
        while -(-size // RUNG) >= self._count(room) and size > 1:
            size = -(-size // RUNG)
        return size


def _read(views: Sequence[TrainingView]) -> list[TrainingView]:
    """Views without what only the initial cloud reads."""
    return [dataclasses.replace(view, own=None, normal=None, detailed=None) for view in views]
