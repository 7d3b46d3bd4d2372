"""The rehearsal compiles what the fit runs, and decides nothing else."""

import dataclasses
import os

import jax
import pytest
import shapely

from tests.test_pipeline import SMALL
from wm.artifacts import open_run_folder
from wm.meter import StageMeter
from wm.run import load_config
from wm.splat.optimization.padding import Capacity
from wm.splat.optimization.step import view_gradient
from wm.splat.scene.scene_fit import fit_scene
from wm.stages.fitters import Fitters, fitters
from wm.stages.job import Job
from wm.stages.rehearsal import _blank_views, _cloud, contenders, rehearse
from wm.stages.scene import build_scene


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    config = load_config([*SMALL[:2], "scene.rooms=[bedroom,hall]", *SMALL[3:]])
    with open_run_folder(tmp_path_factory.mktemp("run"), {}, overwrite=False) as folder:
        job = Job(config=config, folder=folder, meter=StageMeter())
        yield job, build_scene(job)


def test_it_takes_one_step_and_one_render_and_sets_the_capacity(made):
    job, scene = made
    capacity = Capacity()
    jax.clear_caches()
    rehearse(job, scene, Fitters(capacity=capacity, workers=[]))
    assert view_gradient._cache_size() == 1
    assert capacity.entries is not None and capacity.entries > 0


def test_workers_compile_in_it_once_for_all_and_not_again_in_the_fit(made):
    job, scene = made
    settings = dataclasses.replace(job.config.fit, steps=2)
    rooms = range(len(scene.rooms))
    with fitters(dataclasses.replace(job.config, workers=2), scene) as some:
        assert len(some.workers) == 2
        rehearse(job, scene, some)
        entries = some.capacity.entries
        compiled = _compiled_by(some)
        assert len([name for name in compiled if "view_gradient" in name]) == 1
        fit_scene(
            [_cloud(scene, room, job.config) for room in rooms],
            lambda room: list(_blank_views(scene, room)),
            settings=settings,
            raster=job.config.raster,
            key=jax.random.key(0),
            capacity=some.capacity,
            workers=some.workers,
        )
        assert some.capacity.entries == entries and _compiled_by(some) == compiled


def _compiled_by(fitters):
    return sorted(os.listdir(fitters.workers[0]._environment["JAX_COMPILATION_CACHE_DIR"]))


def test_contenders_are_painted_rooms_and_the_largest_is_among_them(made):
    job, scene = made
    rooms = contenders(scene, job.config.fit)
    areas = [shapely.Polygon(room.polygon).area for room in scene.plan.rooms]
    assert rooms and set(rooms) <= {view.room for view in scene.views}
    assert areas.index(max(areas)) in rooms
