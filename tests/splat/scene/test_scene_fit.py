"""Laws of the fit of a scene: rooms do not depend on which ran where or when, and a broken run ends in the same bytes."""

import dataclasses
import os
import signal
import subprocess
import sys
import time

import jax
import numpy as np
import pytest

from tests.splat.rooms import views_of
from wm.schema import FitSettings, RasterSettings
from wm.splat.optimization.checkpoint import from_arrays, to_arrays
from wm.splat.optimization.cloud import initial_gaussians
from wm.splat.optimization.divergence_monitor import start_monitor
from wm.splat.optimization.exposure import no_exposure
from wm.splat.optimization.refinement import no_residual, observe
from wm.splat.optimization.room_state import initial_state
from wm.splat.scene.scene_fit import fit_scene

ROOMS = 3
SETTINGS = FitSettings(spacing=0.6, detail_spacing=0.6, steps=4, rounds=2, curve_points=2)
RASTER = RasterSettings(chunk=1, block=16)
VIEWS = [views_of(room=room, rooms=ROOMS, count=3, width=24, height=16) for room in range(ROOMS)]
START = [initial_gaussians(views, settings=SETTINGS, rng=np.random.default_rng(0)) for views in VIEWS]


def run(start=START, views=VIEWS, devices=1, settings=SETTINGS, **kwargs):
    where = {"devices": [jax.devices()[0]] * devices, "workers": devices}
    return fit_scene(start, views.__getitem__, settings=settings, raster=RASTER, key=jax.random.key(0), **where | kwargs)


def raw(gaussians):
    return [leaf.tobytes() for leaf in jax.tree.leaves(gaussians)]


@pytest.fixture(scope="module")
def once():
    return run()


def test_scheduling_changes_no_byte(once):
    assert raw(run(devices=2).gaussians) == raw(once.gaussians)
    assert raw(run(devices=1, workers=None).gaussians) == raw(once.gaussians)


def test_devices_beyond_the_rooms_share_their_batches_and_change_no_byte():
    settings = dataclasses.replace(SETTINGS, batch=2)
    assert raw(run(devices=2 * ROOMS, settings=settings).gaussians) == raw(run(settings=settings).gaussians)


def test_every_room_is_fitted_and_reports_its_curve(once):
    for before, after in zip(START, once.gaussians):
        assert before.means.shape == after.means.shape and (before.sh != after.sh).any()
    assert [(point.room, point.step) for point in once.history] == [(room, step) for room in range(ROOMS) for step in (0, 4)]
    assert once.stopped == ()


def test_neighbours_matter_and_only_through_the_views_that_see_them(once):
    alone = [[dataclasses.replace(view, sees=()) for view in views] for views in VIEWS]
    without = run(views=alone)
    assert raw(without.gaussians[1]) != raw(once.gaussians[1])
    single = run(views=[alone[0], [], []])
    assert raw(single.gaussians[0]) == raw(without.gaussians[0])
    assert raw(single.gaussians[1]) == raw(jax.tree.map(np.asarray, START[1]))  # a room without views keeps its gaussians


def test_a_killed_run_resumes_and_ends_in_the_same_bytes(once):
    kept, steps = {}, []

    def store(round_, room, arrays):
        if round_ == 1 and room == 1:
            raise KeyboardInterrupt
        kept[round_, room] = arrays

    with pytest.raises(KeyboardInterrupt):
        run(store=store)
    assert {(0, room) for room in range(ROOMS)} <= kept.keys()
    resumed = run(
        load=lambda round_, room: kept.get((round_, room)), progress=lambda done, total, info: steps.append((done, total, info))
    )
    assert raw(resumed.gaussians) == raw(once.gaussians)
    assert steps[-1][:2] == (ROOMS * 4, ROOMS * 4) and sum(bool(info) for *_, info in steps) == 2 * (6 - len(kept))


@pytest.mark.parametrize(
    "extra",
    [{}, pytest.param({"exposure": True, "refine_every": 1}, marks=pytest.mark.slow)],
    ids=["plain", "exposure and refinement"],
)
def test_a_run_killed_within_a_round_resumes_in_the_middle_of_a_room_and_ends_in_the_same_bytes(extra):
    settings = dataclasses.replace(SETTINGS, steps=6, rounds=2, curve_points=3, **extra)
    undisturbed, kept, left, steps = run(settings=settings), {}, {}, []

    def progress(done, total, info):
        if done == 11:
            left.update(kept)  # what a kill at this moment leaves behind

    def store(round_, room, arrays):
        kept[round_, room] = {name: value.copy() for name, value in arrays.items()}

    run(settings=settings, store=store, progress=progress, checkpoint_seconds=0.0)
    assert [int(arrays["step"]) for (round_, _), arrays in left.items() if round_ == 1] == [4]
    resumed = run(
        settings=settings,
        load=lambda round_, room: left.get((round_, room)),
        progress=lambda done, total, info: steps.append((done, bool(info))),
    )
    assert raw(resumed.gaussians) == raw(undisturbed.gaussians)
    assert steps[-1][0] == ROOMS * 6 and sum(info for _, info in steps) == ROOMS * 6 - 10
    without_time = [dataclasses.replace(point, seconds=0.0) for point in resumed.history]
    assert repr(without_time) == repr([dataclasses.replace(point, seconds=0.0) for point in undisturbed.history])


@pytest.fixture
def ctrl_c():
    """As in a terminal: a process started in the background may be told to ignore it."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


def test_an_interrupt_ends_every_room_at_its_next_step_and_stores_it(once, ctrl_c):
    kept, steps = {}, []

    def progress(done, total, info):
        steps.append(done)
        if done == 1:
            os.kill(os.getpid(), signal.SIGINT)  # wakes the main thread, as Ctrl-C does
            time.sleep(1.0)

    with pytest.raises(KeyboardInterrupt):
        run(store=lambda round_, room, arrays: kept.update({(round_, room): arrays}), progress=progress)
    assert steps == [1] and [int(arrays["step"]) for arrays in kept.values()] == [1]
    resumed = run(load=lambda round_, room: kept.get((round_, room)))
    assert raw(resumed.gaussians) == raw(once.gaussians)


def test_a_state_survives_its_arrays():
    n = len(START[0].means)
    state = dataclasses.replace(
        initial_state(START[0]),
        step=3,
        since=np.ones((2, 4)),
        exposure=no_exposure(3),
        residual=observe(no_residual(n), np.ones((2, n), np.float32)),
        monitor=start_monitor(START[0], 1, 3, 4),
        stopped="why",
    )
    arrays = to_arrays(state)
    again = to_arrays(from_arrays(arrays))
    assert arrays.keys() == again.keys()
    assert all(arrays[name].tobytes() == again[name].tobytes() and arrays[name].dtype == again[name].dtype for name in arrays)
    assert {name.split(".")[0] for name in to_arrays(initial_state(START[0]))}.isdisjoint({"exposure", "residual", "monitor"})
    for name in ("mu.sh", "monitor.best.sh", "monitor.known", "residual.visits"):
        with pytest.raises(ValueError, match=rf"has no {name}:"):
            from_arrays({key: value for key, value in arrays.items() if key != name})


def test_an_error_of_a_room_reaches_the_caller():
    def views(room):
        if room == 2:
            raise OSError("views of room 2 are gone")
        return VIEWS[room]

    with pytest.raises(OSError, match="room 2"):
        fit_scene(START, views, settings=SETTINGS, raster=RASTER, key=jax.random.key(0), devices=[jax.devices()[0]])


def test_a_room_that_stops_keeps_its_last_good_state_and_the_others_go_on():
    bad = [dataclasses.replace(view, depth=np.full_like(view.depth, np.inf)) for view in VIEWS[1]]
    steps = []
    result = run(views=[VIEWS[0], bad, VIEWS[2]], progress=lambda done, total, info: steps.append((done, total)))
    assert steps[-1] == (ROOMS * SETTINGS.steps, ROOMS * SETTINGS.steps)
    assert len(result.stopped) == 1 and "room 1, step 0" in result.stopped[0]
    assert raw(result.gaussians[1]) == raw(jax.tree.map(np.asarray, START[1])) and (result.gaussians[0].sh != START[0].sh).any()


@pytest.mark.slow
def test_two_devices_give_the_bytes_of_one():
    code = (
        "import hashlib, jax; from tests.splat.scene import test_scene_fit as t; from wm.splat.scene.scene_fit import fit_scene;"
        "fit = fit_scene(t.START, t.VIEWS.__getitem__, settings=t.SETTINGS, raster=t.RASTER, key=jax.random.key(0));"
        "print(len(jax.devices()), hashlib.sha256(b''.join(b for g in fit.gaussians for b in t.raw(g))).hexdigest())"
    )
    outputs = {}
    for devices in ("1", "2"):
        env = os.environ | {"JAX_NUM_CPU_DEVICES": devices, "JAX_PLATFORMS": "cpu"}
        run_ = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, env=env, check=True)
        outputs[devices] = run_.stdout.split()
    assert outputs["1"][0] == "1" and outputs["2"][0] == "2"
    assert outputs["1"][1] == outputs["2"][1]


@pytest.mark.slow
@pytest.mark.skipif(not hasattr(os, "sched_getaffinity") or len(os.sched_getaffinity(0)) < 2, reason="needs several cores")
def test_one_core_gives_the_bytes_of_all():
    """Large enough that XLA would cut loops into a part a core, whose roundings differ (`UNPARTITIONED`)."""
    code = (
        "import os, sys; os.sched_setaffinity(0, set(map(int, sys.argv[1:])));"
        "import dataclasses, hashlib, numpy as np; from tests.splat.scene import test_scene_fit as t;"
        "settings = dataclasses.replace(t.SETTINGS, spacing=0.1, steps=2, rounds=1);"
        "views = [t.views_of(count=2, width=160, height=96)];"
        "start = [t.initial_gaussians(views[0], settings=settings, rng=np.random.default_rng(0))];"
        "fit = t.run(start, views, settings=settings);"
        "print(hashlib.sha256(b''.join(b for g in fit.gaussians for b in t.raw(g))).hexdigest())"
    )
    cores, printed = [str(core) for core in os.sched_getaffinity(0)], []
    for some in (cores[:1], cores):
        command = [sys.executable, "-c", code, *some]
        env = os.environ | {"JAX_PLATFORMS": "cpu"}
        printed.append(subprocess.run(command, capture_output=True, text=True, env=env, check=True).stdout)
    assert printed[0] == printed[1] != ""
