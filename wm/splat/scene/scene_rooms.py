"""The rooms of a scene in its rounds: a room's state becomes a task, an executor does the task, and its outcome is stored."""

import dataclasses
import queue
import time
from collections.abc import Callable, Sequence
from concurrent.futures import Executor, Future

from wm.schema import FitSettings, RasterSettings
from wm.splat.optimization.batch import Device
from wm.splat.optimization.checkpoint import from_arrays, to_arrays
from wm.splat.optimization.padding import Capacity, pad_gaussians
from wm.splat.optimization.room_state import RoomState
from wm.splat.optimization.training import TrainingView
from wm.splat.scene.room_task import FitContext, RoomOutcome, RoomTask, fit_room
from wm.splat.scene.scene_progress import Checkpoints, SceneProgress
from wm.types import Gaussians

BUCKET_RATIO = 8
"""Padding buckets are the count of the largest room divided by powers of this. Most scenes have one bucket: compiling a step
takes as long as fifty steps, and padding adds little to a step."""

RoomViews = Callable[[int], Sequence[TrainingView]]
"""The views of a room, by room index."""


class SceneRooms:
    """The states of all rooms as they stood when the round began, and what takes one of them through a round.

    Methods are called from several threads, one for each room under way.
    """

    def __init__(self, *, states, views, heldout, settings, raster, seed, report, checkpoints, capacity, shares) -> None:
        self.states: list[RoomState] = states
        self.views: RoomViews = views
        self.heldout: RoomViews = heldout
        self.settings: FitSettings = settings
        self.seed: tuple[int, ...] = seed
        self.report: SceneProgress = report
        self.checkpoints: Checkpoints = checkpoints
        self.raster: RasterSettings = raster
        self.capacity: Capacity = capacity
        self.shares: Sequence[Sequence[Device]] = shares  # the devices of each of the rooms that are under way at once
        self._started = time.perf_counter()
        self._submitted: set[Future[RoomOutcome]] = set()
        self._free: queue.SimpleQueue[Sequence[Device]] = queue.SimpleQueue()
        for share in shares:
            self._free.put(share)
        self._largest = max((self._count(room) for room in range(len(states))), default=0)

    def after_round(self, round_: int, room: int, executor: Executor) -> RoomState:
        """The state of a room after a round, as it was stored, or fitted by the executor and then stored."""
        state = self._stored(round_, room)
        if state is not None and self._has_ended(state, round_):
            return state
        devices = self._free.get()
        try:
            return self._fitted(round_, room, state or self.states[room], devices, executor)
        finally:
            self._free.put(devices)

    def halt(self) -> None:
        """Ends every room at its next step, and before its first if the executor has not begun it."""
        self.report.halt()
        for future in list(self._submitted):
            future.cancel()

    def _step_range(self, round_: int) -> tuple[int, int]:
        """First step of a round and one past its last."""
        steps, rounds = self.settings.steps, self.settings.rounds
        return steps * round_ // rounds, steps * (round_ + 1) // rounds

    def _stored(self, round_: int, room: int) -> RoomState | None:
        """The checkpoint of a room, whose steps count as done."""
        arrays = self.checkpoints.load(round_, room)
        if arrays is None:
            return None
        state, (first, last) = from_arrays(arrays), self._step_range(round_)
        self.report.skip((last if self._has_ended(state, round_) else state.step) - first)
        return state

    def _has_ended(self, state: RoomState, round_: int) -> bool:
        """Whether a checkpoint was stored after its round had ended, and not within the round after its last step."""
        return state.stopped is not None or (state.monitor is None and state.step >= self._step_range(round_)[1])

    def _fitted(self, round_: int, room: int, state: RoomState, devices: Sequence[Device], executor: Executor) -> RoomState:
        """The state of a room after a round, which is stored, as is what an exception leaves."""
        first, last = self._step_range(round_)
        task = self._task(room, state, last)
        if task is None:
            self.report.skip(last - max(first, state.step))
            state = dataclasses.replace(state, step=last)
            self.checkpoints.store(round_, room, to_arrays(state))
            return state
        done = state.step

        def report(step: int, info: dict) -> None:
            nonlocal done
            done = step
            self.report.step(info | {"room": room})

        keep = self.checkpoints.keeper(round_, room)
        context = FitContext(devices=devices, capacity=self.capacity, report=report, keep=keep)
        outcome = self._outcome(executor, task, context)
        if outcome.error is None and done < last:  # it stopped, and perhaps went back; or its steps were not told one by one
            self.report.skip(last - done)
        if outcome.error is None or outcome.resumable:
            self.checkpoints.store(round_, room, to_arrays(outcome.state))
        if outcome.error is not None:
            raise outcome.error
        return outcome.state

    def _outcome(self, executor: Executor, task: RoomTask, context: FitContext) -> RoomOutcome:
        self.report.raise_if_halted()
        future = executor.submit(fit_room, task, context)
        self._submitted.add(future)
        try:
            outcome = future.result()
        finally:
            self._submitted.discard(future)
        if outcome.entries is not None:
            self.capacity.grow(outcome.entries)
        return outcome

    def _task(self, room: int, state: RoomState, last: int) -> RoomTask | None:
        """The task of a room; None: there is nothing to fit."""
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
            rows=self._bucket(room),
            columns=0 if len(self.states) == 1 else max(self._largest, 1),
            seconds=time.perf_counter() - self._started,
        )

    def _neighbours(self, views: Sequence[TrainingView], room: int) -> dict[int, Gaussians]:
        others = sorted({other for view in views for other in view.sees if other != room and self._count(other) > 0})
        return {other: pad_gaussians(self.states[other].train.gaussians, self._bucket(other)) for other in others}

    def _count(self, room: int) -> int:
        return len(self.states[room].train.gaussians.opacity_logits)

    def _bucket(self, room: int) -> int:
        """The padded size of a room's gaussians: the smallest padding bucket that holds them."""
        size = self._largest
        while -(-size // BUCKET_RATIO) >= self._count(room) and size > 1:
            size = -(-size // BUCKET_RATIO)
        return size


def _read(views: Sequence[TrainingView]) -> list[TrainingView]:
    """Views without the arrays that only the initial cloud reads."""
    return [dataclasses.replace(view, own=None, normal=None, detailed=None) for view in views]
