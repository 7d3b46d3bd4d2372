"""Many rooms: each is a fit of its own, beside neighbours held still.

Block Jacobi: in every round each room moves its own gaussians toward its own views, and what those views see of other rooms,
through doors, is frozen as it stood when the round began. So rooms are independent within a round: they run side by side, one to
a device and a Python thread, and the result does not depend on which ran where or when. Cost is linear in rooms; the images of a
room are in memory only while it is fitted. Rooms share compiled steps: their gaussians are padded to a few common sizes.
"""

import dataclasses
import queue
import time
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor

import jax

from wm.schema import FitSettings, RasterSettings
from wm.splat.batch import Compiled, Device
from wm.splat.checkpoint import from_arrays, to_arrays
from wm.splat.curve import FitPoint
from wm.splat.fit import DEFAULT_RASTER, Progress, see_views, seed_of
from wm.splat.padding import Capacity, pad_gaussians
from wm.splat.room_fit import Interrupted, RoomFit
from wm.splat.room_state import RoomState, initial_state
from wm.splat.scene_progress import Checkpoints, Load, SceneProgress, Store
from wm.splat.step import raster_for
from wm.splat.training import TrainingView
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
    raster: RasterSettings = DEFAULT_RASTER,
    key: jax.Array,
    heldout: RoomViews = lambda room: (),
    load: Load = lambda round_, room: None,
    store: Store = lambda round_, room, arrays: None,
    checkpoint_seconds: float = 60.0,
    progress: Progress | None = None,
    capacity: Capacity | None = None,
    devices: Sequence[Device] | None = None,
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
            same bytes. `store` is called from the threads of the devices, for one room at a time each.
        checkpoint_seconds: a room is stored when this long has passed since it began or was stored, and when its round ends.
        progress: called after every step of any room, one call at a time.
        capacity: of an earlier fit of the same shapes, to share what was compiled for it; None: a new one.
        devices: one room at a time each, or several for a room and its batches where there are fewer rooms; all CPU devices if
            None (`jax_num_cpu_devices` says how many), or all accelerators.

    Returns: the gaussians, the curves and what stopped early.
    Raises: the error of a room (of `views`, say) once all rooms ended their round. A KeyboardInterrupt as soon as every room
        under way has ended its step; all that was reached is stored.
    """
    scene = _Scene(
        states=[initial_state(start) for start in gaussians],
        views=views,
        heldout=heldout,
        settings=settings,
        raster=raster_for(settings, raster),
        seed=seed_of(key),
        report=SceneProgress(len(gaussians) * settings.steps, progress),
        checkpoints=Checkpoints(load, store, checkpoint_seconds),
        capacity=capacity or Capacity(),
    )
    devices = list(devices or jax.devices())
    side_by_side = max(min(len(devices), len(gaussians)), 1)
    free = queue.SimpleQueue()
    for first in range(side_by_side):
        free.put(devices[first::side_by_side])

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
    with ThreadPoolExecutor(max_workers=side_by_side, thread_name_prefix="wm-fit") as pool:
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
        self.compiled = Compiled(raster=raster, normals=settings.normal_weight > 0, capacity=capacity)
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

    def fit_room(self, round_: int, room: int, state: RoomState, devices: Sequence[Device]) -> RoomState:
        """The state of a room after a round, which is stored, as is what an exception leaves."""
        checkpoints = self.checkpoints
        try:
            state = self._fitted(room, state, self.stretch(round_), devices, checkpoints.keeper(round_, room))
        except Interrupted as interrupted:
            if interrupted.resumable:
                checkpoints.store(round_, room, to_arrays(interrupted.state))
            raise interrupted.__cause__ or interrupted from None
        checkpoints.store(round_, room, to_arrays(state))
        return state

    def _fitted(self, room: int, state: RoomState, stretch: tuple[int, int], devices: Sequence[Device], keep) -> RoomState:
        (first, last), views = stretch, list(self.views(room))
        if state.stopped or not views or self._count(room) == 0:
            self.report.skip(last - first)
            return dataclasses.replace(state, step=last)
        heldout = list(self.heldout(room))
        all_views = [*views, *heldout]
        neighbours = self._neighbours(all_views, room, devices[0])
        seen = see_views(all_views, neighbours, self.compiled.raster, devices[0], self._columns)
        room_fit = RoomFit(
            views=seen[: len(views)],
            heldout=seen[len(views) :],
            settings=self.settings,
            compiled=self.compiled,
            seed=(*self.seed, room),
            room=room,
            count=self._count(room),
            rows=self._rung(room),
            devices=devices,
            clock=lambda: time.perf_counter() - self.started,
        )
        return room_fit.run(state, last, lambda done, info: self.report.step(info | {"room": room}), keep)

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
