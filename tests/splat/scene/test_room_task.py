"""Rooms through executors: a room is one task a round, which crosses to another process and comes back with the same bytes."""

import concurrent.futures
import dataclasses
import multiprocessing
import os
import pickle
import signal
import threading
import time

import jax
import numpy as np
import pytest

from tests.splat.scene.test_scene_fit import ROOMS, SETTINGS, START, VIEWS, raw, run
from wm.splat.optimization.padding import Capacity
from wm.splat.optimization.room_state import initial_state
from wm.splat.scene.room_task import FitContext, RoomOutcome

HELDOUT = [views[:1] for views in VIEWS]


@pytest.fixture(scope="module")
def processes():
    with concurrent.futures.ProcessPoolExecutor(2, mp_context=multiprocessing.get_context("spawn")) as executor:
        yield executor


@pytest.fixture(scope="module")
def here():
    return run(heldout=HELDOUT.__getitem__)


class Recording(concurrent.futures.Executor):
    """An executor that records the tasks which another is given."""

    def __init__(self, inner):
        self._inner, self._counting = inner, threading.Lock()
        self.tasks, self._under_way, self.most = [], 0, 0

    def submit(self, fn, /, *args, **kwargs):
        with self._counting:
            self.tasks.append(args[0])
            self._under_way += 1
            self.most = max(self.most, self._under_way)
        future = self._inner.submit(fn, *args, **kwargs)
        future.add_done_callback(self._ended)
        return future

    def _ended(self, future):
        with self._counting:
            self._under_way -= 1


@pytest.mark.parametrize("workers", [1, 2])
def test_a_room_is_one_task_a_round_and_no_more_than_workers_are_submitted_at_once(here, workers):
    with concurrent.futures.ThreadPoolExecutor(ROOMS) as inner:
        executor = Recording(inner)
        result = run(executor=executor, workers=workers, heldout=HELDOUT.__getitem__)
        assert inner.submit(int).result() == 0  # it is the caller's, and was not shut down
    assert raw(result.gaussians) == raw(here.gaussians)
    assert sorted(task.room for task in executor.tasks) == sorted([*range(ROOMS)] * SETTINGS.rounds)
    assert executor.most <= workers


@pytest.mark.slow
def test_processes_give_the_bytes_and_the_curve_of_threads_and_tell_a_round_of_a_room_at_once(processes, here):
    capacity, told = Capacity(), []
    there = run(
        executor=processes,
        workers=2,
        heldout=HELDOUT.__getitem__,
        capacity=capacity,
        progress=lambda done, total, info: told.append((done, total)),
    )
    assert raw(there.gaussians) == raw(here.gaussians)
    curves = [[dataclasses.replace(point, seconds=0.0) for point in fit.history] for fit in (there, here)]
    assert repr(curves[0]) == repr(curves[1])  # NaN and all
    assert all(0 < point.seconds < 600 for point in there.history)  # since the scene's beginning, not since the machine's
    total, each = ROOMS * SETTINGS.steps, SETTINGS.steps // SETTINGS.rounds
    assert told == [(done, total) for done in range(each, total + 1, each)]
    assert capacity.entries is not None and capacity.entries > 0


def test_processes_leave_a_checkpoint_of_every_room_and_round_from_which_the_same_bytes_follow(processes, here):
    kept = []

    def store(round_, room, arrays):
        kept.append((round_, room, arrays))

    run(executor=processes, workers=2, store=store, checkpoint_seconds=0.0)
    every = [(round_, room) for round_ in range(SETTINGS.rounds) for room in range(ROOMS)]
    assert sorted((round_, room) for round_, room, _ in kept) == every
    first = {(round_, room): arrays for round_, room, arrays in kept if round_ == 0}
    resumed = run(executor=processes, load=lambda round_, room: first.get((round_, room)))
    assert raw(resumed.gaussians) == raw(here.gaussians)


def test_an_error_in_a_process_is_raised_here_and_the_executor_is_of_use_afterwards(processes, here):
    odd = dataclasses.replace(VIEWS[1][0], camera=dataclasses.replace(VIEWS[1][0].camera, T_cam_world=VIEWS[1][0].depth))
    with pytest.raises((TypeError, ValueError), match="shape"):
        run(views=[VIEWS[0], [odd, *VIEWS[1][1:]], VIEWS[2]], executor=processes, workers=2)
    assert raw(run(executor=processes, workers=2).gaussians) == raw(here.gaussians)


def test_an_interrupt_cancels_rooms_that_the_executor_has_not_begun(here):
    """Two rooms are submitted, and the executor has one thread."""
    kept, before = {}, signal.signal(signal.SIGINT, signal.default_int_handler)  # a process in the background may ignore it

    def progress(done, total, info):
        if done == 1:
            os.kill(os.getpid(), signal.SIGINT)
            time.sleep(1.0)

    def store(round_, room, arrays):
        kept[round_, room] = arrays

    try:
        with concurrent.futures.ThreadPoolExecutor(1) as executor, pytest.raises(KeyboardInterrupt):
            run(executor=executor, workers=2, store=store, progress=progress)
    finally:
        signal.signal(signal.SIGINT, before)
    assert [int(arrays["step"]) for arrays in kept.values()] == [1]
    resumed = run(load=lambda round_, room: kept.get((round_, room)))
    assert raw(resumed.gaussians) == raw(here.gaussians)


class Odd(Exception):
    """An error that does not pickle."""

    def __init__(self, what):
        super().__init__(what)
        self.what = lambda: what


@pytest.mark.parametrize("error", [None, OSError("disk full"), KeyboardInterrupt(), Odd("so odd")])
def test_an_outcome_crosses_with_the_state_that_was_reached_whatever_ended_it(error):
    sent = RoomOutcome(initial_state(START[0]), entries=7, error=error, resumable=False)
    came = pickle.loads(pickle.dumps(sent))
    assert raw(came.state.train) == raw(sent.state.train) and came.entries == 7 and not came.resumable
    if error is None:
        assert came.error is None
    else:
        assert str(error) in str(came.error) and any(type(error).__name__ in note for note in came.error.__notes__)
        assert type(came.error) is (RuntimeError if isinstance(error, Odd) else type(error))
        assert sent.error is error and not hasattr(error, "__notes__")


def test_a_context_that_is_unpickled_has_devices_and_a_capacity_and_calls_nobody():
    capacity, called = Capacity(), []
    capacity.grow(5)
    context = FitContext(devices=(), capacity=capacity, report=lambda step, info: called.append(step), keep=called.append)
    there = pickle.loads(pickle.dumps(context))
    assert there.devices == jax.devices()[:1] and there.capacity.entries == 5 and there.capacity is not capacity
    there.report(1, {})
    there.keep(lambda: initial_state(jax.tree.map(np.asarray, START[0])))
    assert called == []
