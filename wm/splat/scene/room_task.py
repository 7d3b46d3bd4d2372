"""The fit of one room in one round, in a form that any `concurrent.futures.Executor` can run: `executor.submit(fit_room, ...)`.

A `RoomTask` holds all data that the fit reads, and a `RoomOutcome` all that it leaves; both are plain NumPy records that pickle.
What cannot leave the process of the caller (its devices, and the callbacks for progress and checkpoints) is in a `FitContext`.
Threads of the caller's process use the context as it is. In another process the context that is unpickled is one of that process:
with its first device, and with callbacks that do nothing.
"""

import dataclasses
import time
from collections.abc import Callable, Mapping, Sequence

import jax

from wm.process import portable
from wm.schema import FitSettings, RasterSettings
from wm.splat.optimization.batch import Compiled, Device
from wm.splat.optimization.fitting import see_views
from wm.splat.optimization.padding import Capacity
from wm.splat.optimization.room_fit import Interrupted, RoomFit
from wm.splat.optimization.room_state import RoomState
from wm.splat.optimization.training import TrainingView
from wm.types import Gaussians

Report = Callable[[int, dict], None]
"""Called after every step with the number of the step and a dict of values worth showing."""

Keep = Callable[[Callable[[], RoomState]], None]
"""Called after every step with a function that returns the state on the host."""


@dataclasses.dataclass(frozen=True, eq=False)
class RoomTask:
    """A room, its state when the round begins, and what it is fitted to. NumPy throughout."""

    room: int
    state: RoomState
    last: int  # one past the last step of the round
    views: Sequence[TrainingView]
    heldout: Sequence[TrainingView]
    neighbours: Mapping[int, Gaussians]  # other rooms that the views see, as they stood when the round began, padded
    settings: FitSettings
    raster: RasterSettings  # of `raster_for`
    seed: tuple[int, ...]  # of the scene
    rows: int  # the number of rows to which the room's gaussians are padded
    columns: int  # the least number of columns to which neighbours are padded in a view; 0: a scene without neighbours
    seconds: float  # since the fit of the scene began, when the task was made


@dataclasses.dataclass(frozen=True, eq=False)
class RoomOutcome:
    """What the fit of a room in one round leaves behind."""

    state: RoomState
    entries: int | None  # of the capacity, by now
    error: BaseException | None = None  # what ended the round early, between two steps
    resumable: bool = True  # whether the state is the one of that step, so that the same bytes follow from it

    def __getstate__(self) -> dict:
        return vars(self) | {"error": None if self.error is None else portable(self.error)}


@dataclasses.dataclass(frozen=True, eq=False)
class FitContext:
    """What a room uses of the process in which it is fitted."""

    devices: Sequence[Device]  # the state lies on the first; batches are divided over all
    capacity: Capacity
    report: Report
    keep: Keep

    def __reduce__(self) -> tuple:
        return _context_elsewhere, (self.capacity.entries,)


def _context_elsewhere(entries: int | None) -> FitContext:
    """The context of a process that is not the caller's: it tells nothing before the round has ended."""
    capacity = Capacity()
    if entries is not None:
        capacity.grow(entries)
    return FitContext(devices=jax.devices()[:1], capacity=capacity, report=lambda step, info: None, keep=lambda state: None)


def fit_room(task: RoomTask, context: FitContext) -> RoomOutcome:
    """The room after its round, or as it stood when something ended the round early.

    Raises: what was wrong before the first step.
    """
    room_fit = _room_fit(task, context)
    try:
        state = room_fit.run(task.state, task.last, context.report, context.keep)
    except Interrupted as interrupted:
        error = interrupted.__cause__
        return RoomOutcome(interrupted.state, context.capacity.entries, error=error, resumable=interrupted.resumable)
    return RoomOutcome(state, context.capacity.entries)


def _room_fit(task: RoomTask, context: FitContext) -> RoomFit:
    """The views of the task on the device, with what they see of the neighbours."""
    began, all_views = time.perf_counter() - task.seconds, [*task.views, *task.heldout]
    others = jax.device_put(task.neighbours, context.devices[0])  # each once, however many views see it
    behind = [[others[room] for room in sorted(set(view.sees)) if room in others] for view in all_views]
    seen = see_views(all_views, behind, task.raster, context.devices[0], lambda most: _columns(task.columns, most))
    return RoomFit(
        views=seen[: len(task.views)],
        heldout=seen[len(task.views) :],
        settings=task.settings,
        compiled=Compiled(raster=task.raster, normals=task.settings.normal_weight > 0, capacity=context.capacity),
        seed=(*task.seed, task.room),
        room=task.room,
        count=len(task.state.train.gaussians.opacity_logits),
        rows=task.rows,
        devices=context.devices,
        clock=lambda: time.perf_counter() - began,
    )


def _columns(least: int, most: int) -> int:
    """The padded number of columns for neighbours: the same for all rooms if it suffices, else doubled until it does."""
    columns = least
    while 0 < columns < most:
        columns *= 2
    return columns
