"""Rooms fitted in processes of their own: the same bytes, the same interruptions, and nothing is left running."""

import dataclasses
import os
import signal
import subprocess
import sys
import time

import pytest

from tests.splat.scene.test_scene_fit import ROOMS, SETTINGS, VIEWS, raw, run
from wm.splat.optimization.padding import Capacity
from wm.splat.scene.room_worker import WorkerClosed, room_workers

pytestmark = pytest.mark.skipif(os.name != "posix", reason="worker processes are for POSIX")
HELDOUT = [views[:1] for views in VIEWS]


@pytest.fixture(scope="module")
def workers():
    with room_workers(2) as some:
        yield some


@pytest.fixture(scope="module")
def here():
    return run(heldout=HELDOUT.__getitem__)


def test_the_bytes_and_the_curve_are_those_of_a_fit_here(workers, here):
    capacity, steps = Capacity(), []
    there = run(
        workers=workers,
        heldout=HELDOUT.__getitem__,
        capacity=capacity,
        progress=lambda done, total, info: steps.append((done, total, info["room"])),
    )
    assert raw(there.gaussians) == raw(here.gaussians)
    curves = [[dataclasses.replace(point, seconds=0.0) for point in fit.history] for fit in (there, here)]
    assert repr(curves[0]) == repr(curves[1])  # NaN and all
    assert all(0 < point.seconds < 600 for point in there.history)  # since the scene's beginning, not since the machine's
    total = ROOMS * SETTINGS.steps
    assert [done for done, *_ in steps] == list(range(1, total + 1)) and {room for *_, room in steps} == set(range(ROOMS))
    assert capacity.entries is not None and capacity.entries > 0


def test_a_fit_that_is_ended_on_the_way_is_stored_and_goes_on_to_the_same_bytes(workers, here):
    """By an error of the caller's: what a worker has reached comes back first, and the worker is of use afterwards."""
    kept = {}

    def progress(done, total, info):
        if done == 1:  # whichever room it is, it has a step of its round yet to go
            raise OSError("the disk is full")

    def store(round_, room, arrays):
        kept[round_, room] = arrays

    with pytest.raises(OSError, match="the disk is full"):
        run(workers=workers, store=store, progress=progress)
    assert any(int(arrays["step"]) == 1 for arrays in kept.values())
    again = run(workers=workers, heldout=HELDOUT.__getitem__, load=lambda round_, room: kept.get((round_, room)))
    assert raw(again.gaussians) == raw(here.gaussians)


def test_checkpoints_within_a_round_are_handed_over_and_bring_back_the_same_bytes(workers, here):
    kept = {}

    def store(round_, room, arrays):
        kept.setdefault((round_, room, int(arrays["step"])), arrays)

    run(workers=workers, store=store, checkpoint_seconds=0.0)
    assert {(0, room, 1) for room in range(ROOMS)} <= kept.keys()
    resumed = run(workers=workers, load=lambda round_, room: kept[round_, room, 1] if round_ == 0 else None)
    assert raw(resumed.gaussians) == raw(here.gaussians)


def test_an_interrupt_ends_every_room_at_its_next_step_and_stores_it(workers, here):
    kept, steps = {}, []
    before = signal.signal(signal.SIGINT, signal.default_int_handler)  # a process in the background may ignore it

    def progress(done, total, info):
        steps.append(done)
        if done == 1:
            os.kill(os.getpid(), signal.SIGINT)
            time.sleep(1.0)

    try:
        with pytest.raises(KeyboardInterrupt):
            run(workers=workers, store=lambda round_, room, arrays: kept.update({(round_, room): arrays}), progress=progress)
    finally:
        signal.signal(signal.SIGINT, before)
    assert steps in ([1], [1, 2]) and [int(arrays["step"]) for arrays in kept.values()] == [1] * len(steps)
    resumed = run(workers=workers, load=lambda round_, room: kept.get((round_, room)))
    assert raw(resumed.gaussians) == raw(here.gaussians)


def test_an_error_there_is_raised_here_as_it_was_and_the_worker_goes_on(workers, here):
    odd = dataclasses.replace(VIEWS[1][0], camera=dataclasses.replace(VIEWS[1][0].camera, T_cam_world=VIEWS[1][0].depth))
    with pytest.raises((TypeError, ValueError), match="shape") as caught:
        run(views=[VIEWS[0], [odd, *VIEWS[1][1:]], VIEWS[2]], workers=workers)
    assert any("in a process of its own" in note for note in caught.value.__notes__)
    assert raw(run(workers=workers).gaussians) == raw(here.gaussians)


def test_a_worker_that_dies_is_one_error_that_names_its_room_and_is_started_again(workers, here):
    def progress(done, total, info):
        if done == 1:
            workers[0]._process.popen.kill()

    with pytest.raises(RuntimeError, match=r"the process that fitted room \d has ended: killed, .* memory"):
        run(workers=workers[:1], progress=progress)
    assert raw(run(workers=workers[:1]).gaussians) == raw(here.gaussians)


def test_a_worker_is_started_when_it_is_needed_and_not_after_it_was_closed():
    with room_workers(2) as workers:
        run(views=[[], [], []], workers=workers)
        assert [worker._process for worker in workers] == [None, None]
    with pytest.raises(WorkerClosed):
        run(workers=workers)


def test_workers_are_held_to_a_core_each_and_hear_no_ctrl_c(workers):
    run(workers=workers)
    pids = [worker._process.popen.pid for worker in workers]
    assert all(os.getsid(pid) == pid for pid in pids)
    if hasattr(os, "sched_getaffinity"):
        held, ours = [os.sched_getaffinity(pid) for pid in pids], os.sched_getaffinity(0)
        assert all(len(cores) == 1 for cores in held) and len(set.union(*held)) == min(2, len(ours))


CALLER = """
import sys
from tests.splat import test_scene_fit as t
from wm.splat.scene.room_worker import RoomWorker

def progress(done, total, info):
    print("a step", flush=True)

workers = [RoomWorker(compiled=sys.argv[1], scratch=sys.argv[2])]
t.run(workers=workers, settings=t.dataclasses.replace(t.SETTINGS, steps=1_000_000), progress=progress)
"""


@pytest.mark.parametrize("how", [signal.SIGKILL, signal.SIGTERM, signal.SIGINT])
def test_it_ends_with_its_caller_in_the_middle_of_a_room(how, workers, tmp_path):
    """The worker holds the caller's standard output and error too: they end when both have. It says nothing when interrupted, and
    clears up."""
    (tmp_path / "scratch").mkdir()
    paths = os.environ | {"PYTHONPATH": os.pathsep.join(filter(None, sys.path)), "JAX_PLATFORMS": "cpu"}
    pipes = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE}
    run(workers=workers)
    command = [sys.executable, "-c", CALLER, workers[0]._environment["JAX_COMPILATION_CACHE_DIR"], str(tmp_path / "scratch")]
    caller = subprocess.Popen(command, env=paths, start_new_session=True, **pipes)
    assert caller.stdout is not None and caller.stdout.readline()
    os.killpg(caller.pid, how)
    _, said = caller.communicate(timeout=120)
    assert caller.returncode != 0
    assert said.count(b"Traceback") == (1 if how == signal.SIGINT else 0)
    # interrupted, a caller still ends its workers and clears up itself
    assert how == signal.SIGINT or not (tmp_path / "scratch").exists()


def test_a_worker_that_died_between_rooms_is_started_again(workers, here):
    run(workers=workers[:1])
    workers[0]._process.popen.kill()
    workers[0]._process.popen.wait()
    assert raw(run(workers=workers[:1]).gaussians) == raw(here.gaussians)


def test_what_workers_have_compiled_ends_with_them():
    with room_workers(1) as workers:
        folder = workers[0]._scratch
        assert os.path.isdir(folder)
    assert not os.path.exists(folder)
