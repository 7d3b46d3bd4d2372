"""The scene in memory is the one that a run of the same configuration furnishes."""

import pytest

from tests.synth.recording import recorded, with_recording
from wm.artifacts.run_folder import open_run_folder
from wm.codecs import encode_objects
from wm.geometry import plan_to_json
from wm.meter import StageMeter
from wm.run import load_config
from wm.stages.run_context import RunContext
from wm.stages.scene import build_scene
from wm.synth.furnished import furnished_context

CELL = ("scene.name=cell", "scene.theme='a plain cabin'", "scene.rooms=[bedroom]", "furnish.density=0.3")
LIFTED = (
    *("objects=lifted", "objects.image_width=80", "objects.image_height=60"),
    *("image.texel_size=0.2", "image.moved=1.0", "depth.noise=0.05"),
)


def built(folder, config):
    with open_run_folder(folder, {"seed": config.seed}) as store:
        return build_scene(RunContext(config=config, folder=store, meter=StageMeter()))


def assert_same(context, scene):
    assert (context.theme, context.seed) == (scene.context.theme, scene.context.seed)
    assert plan_to_json(context.plan) == plan_to_json(scene.plan)
    assert context.structure.vertices.tobytes() == scene.context.structure.vertices.tobytes()
    assert encode_objects(context.objects) == encode_objects(scene.objects)


@pytest.mark.parametrize("choices", [(), ("furnish.enabled=false",), LIFTED], ids=["generated", "bare", "lifted"])
def test_a_run_furnishes_the_same_scene(tmp_path, choices):
    config = load_config([*CELL, *choices])
    scene = built(tmp_path, config)
    assert bool(scene.objects) == config.furnish.enabled
    assert_same(furnished_context(config), scene)


def test_a_plan_of_the_user_s_own_is_the_plan(tmp_path):
    built(tmp_path / "first", load_config(CELL))
    config = load_config([*CELL, f"plan.file={tmp_path}/first/plan.json", "seed=4"])
    assert_same(furnished_context(config), built(tmp_path / "second", config))


@pytest.mark.parametrize("fails", [{}, {"depth": 1}], ids=["done", "failed"])
def test_the_models_that_furnished_are_closed(monkeypatch, fails):
    log = recorded(monkeypatch, "image", "depth", fails=fails)
    config = with_recording(load_config([*CELL, *LIFTED]), "image", "depth")
    if fails:
        with pytest.raises(MemoryError, match="depth"):
            furnished_context(config)
    else:
        furnished_context(config)
    assert log[-2:] == ["depth closed", "image closed"]
