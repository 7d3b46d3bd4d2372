"""The warm-up compiles what the fit runs, and decides nothing else."""

import jax
import pytest

from tests.test_pipeline import SMALL
from wm.artifacts.run_folder import open_run_folder
from wm.meter import StageMeter
from wm.run import load_config
from wm.splat.optimization.padding import Capacity
from wm.splat.optimization.step import view_gradient
from wm.stages.run_context import RunContext
from wm.stages.scene import build_scene
from wm.stages.warm_up import _cloud, contenders, warm_up


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    config = load_config([*SMALL[:2], "scene.rooms=[bedroom,hall]", *SMALL[3:]])
    with open_run_folder(tmp_path_factory.mktemp("run"), {}, overwrite=False) as folder:
        context = RunContext(config=config, folder=folder, meter=StageMeter())
        yield context, build_scene(context)


def test_it_takes_one_step_and_one_render_and_sets_the_capacity(made):
    context, scene = made
    capacity = Capacity()
    jax.clear_caches()
    warm_up(context, scene, capacity)
    assert view_gradient._cache_size() == 1
    assert capacity.entries is not None and capacity.entries > 0


def test_contenders_are_painted_rooms_and_the_largest_is_among_them(made):
    context, scene = made
    rooms = contenders(scene, context.config.fit)
    sizes = {room: len(_cloud(scene, room, context.config).opacity_logits) for room in range(len(scene.rooms))}
    assert rooms and set(rooms) <= {view.room for view in scene.views}
    assert max(sizes, key=lambda room: sizes[room]) in rooms
