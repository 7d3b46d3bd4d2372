"""What a stage's key is made from."""

import importlib.metadata

import pytest

from wm.artifacts.run_folder import RunFolder
from wm.meter import StageMeter
from wm.schema import FitSettings, RunConfig
from wm.stages import run_context as module
from wm.stages.run_context import RunContext


@pytest.fixture
def key(tmp_path):
    def of(stage: str, *inputs, seed: int = 0) -> str:
        return RunContext(config=RunConfig(seed=seed), folder=RunFolder(tmp_path, print), meter=StageMeter()).key(stage, *inputs)

    return of


def test_a_key_tells_stage_seed_and_inputs_apart(key):
    keys = [key("fit"), key("paint"), key("fit", seed=1), key("fit", FitSettings()), key("fit", FitSettings(steps=7))]
    assert len(set(keys)) == len(keys) and keys[0] == key("fit")


def test_other_versions_of_the_libraries_make_everything_again(key, monkeypatch):
    before = key("fit")
    monkeypatch.setattr(importlib.metadata, "version", lambda name: "0.0")
    module.versions.cache_clear()
    try:
        assert key("fit") != before
    finally:
        module.versions.cache_clear()
