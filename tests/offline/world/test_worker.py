"""A world in another process is the same world, from any thread, and says so when it is gone."""

import dataclasses
import os
import signal
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

from tests.offline.world.boxes import COARSE, furnished
from wm.geometry.rays.pinhole import make_camera
from wm.offline.world.worker import Recipe, WorkerWorld

RECIPE = Recipe(furnished(), supersampling=1, settings=COARSE)


def camera(x):
    return make_camera(np.array([x, 0.5, 1.5]), np.array([2.4, 2.0, 0.9]), width=24, height=16, fov_deg=70.0)


@pytest.fixture(scope="module")
def worker():
    world = WorkerWorld(RECIPE, lanes=2)
    yield world
    world.close()


def test_its_shots_are_those_of_the_world_here(worker):
    here, cameras = RECIPE.make(), [camera(x) for x in (0.4, 0.5, 0.6, 0.7)]
    with ThreadPoolExecutor(4) as threads:
        for shot, expected in zip(threads.map(worker.shoot, cameras), map(here.shoot, cameras)):
            np.testing.assert_array_equal(shot.rgb, expected.rgb)
            np.testing.assert_array_equal(shot.object, expected.object)
            np.testing.assert_array_equal(shot.gbuffer.depth, expected.gbuffer.depth)
    assert worker.labels == here.labels


def test_what_goes_wrong_there_is_raised_here_and_it_goes_on(worker):
    with pytest.raises(Exception, match=r"shape|size|broadcast|index"):
        worker.shoot(dataclasses.replace(camera(0.4), T_cam_world=np.eye(3)))
    assert worker.shoot(camera(0.4)).rgb.shape == (16, 24, 3)


def test_why_no_world_could_be_made_is_raised_at_every_request():
    broken = dataclasses.replace(furnished().objects[1], faces=np.full((12, 3), 8, np.int32))  # of vertices 0..7
    context = dataclasses.replace(furnished(), objects=(furnished().objects[0], broken))
    world = WorkerWorld(dataclasses.replace(RECIPE, context=context), lanes=2)
    for _ in range(3):  # each lane, and one again
        with pytest.raises(ValueError, match=r"object 1 \(sofa\)") as raised:
            world.shoot(camera(0.4))
        assert any("in a process of its own" in note for note in raised.value.__notes__)
    world.close()


def test_a_worker_that_is_gone_is_named():
    world = WorkerWorld(RECIPE, lanes=1)
    world._process.popen.kill()
    with pytest.raises(RuntimeError, match=r"offline world ended \(exit code -9\)"):
        world.shoot(camera(0.4))
    world.close()


def test_ctrl_c_is_not_for_the_worker(worker):
    assert os.getsid(worker._process.popen.pid) == worker._process.popen.pid != os.getsid(0)


CALLER = """
import functools, signal, time, types
signal.signal(signal.SIGINT, signal.default_int_handler)  # a shell's background jobs, and what they start, ignore it otherwise
from wm.offline.world.worker import WorkerWorld
busy = types.SimpleNamespace(make=functools.partial(time.sleep, 3600), context=types.SimpleNamespace(objects=()))
world = WorkerWorld(busy, lanes=1)
world._start()
print("started", flush=True)
time.sleep(3600)
"""


@pytest.mark.parametrize("how", [signal.SIGKILL, signal.SIGTERM, signal.SIGINT])
def test_it_ends_with_its_caller_in_the_middle_of_its_work(how):
    """The worker holds the caller's standard output too: that ends when both have."""
    paths = os.environ | {"PYTHONPATH": os.pathsep.join(filter(None, sys.path))}
    caller = subprocess.Popen(
        [sys.executable, "-c", CALLER], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, env=paths, start_new_session=True
    )
    assert caller.stdout is not None and caller.stdout.readline() == b"started\n"
    os.killpg(caller.pid, how)
    caller.communicate(timeout=120)
    assert caller.returncode != 0
