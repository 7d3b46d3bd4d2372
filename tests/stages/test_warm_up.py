"""The warm-up compiles what the fit runs, and decides nothing else."""

import jax
import pytest
import shapely

from tests.test_pipeline import SMALL
from wm.artifacts import open_run_folder
from wm.meter import StageMeter
from wm.run import load_config
from wm.splat.optimization.padding import Capacity
from wm.splat.optimization.step import view_gradient
from wm.stages.job import Job
from wm.stages.scene import build_scene
from wm.stages.warm_up import contenders, warm_up


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
    warm_up(job, scene, capacity)
    assert view_gradient._cache_size() == 1
    assert capacity.entries is not None and capacity.entries > 0


def test_contenders_are_painted_rooms_and_the_largest_is_among_them(made):
    job, scene = made
    rooms = contenders(scene, job.config.fit)
    areas = [shapely.Polygon(room.polygon).area for room in scene.plan.rooms]
    assert rooms and set(rooms) <= {view.room for view in scene.views}
    assert areas.index(max(areas)) in rooms
