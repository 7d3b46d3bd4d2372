"""One small finished run for the tests of comparisons."""

import pathlib

import pytest

from wm.cli.composition import load_config
from wm.pipeline import run


@pytest.fixture(scope="package")
def run_folder(tmp_path_factory) -> pathlib.Path:
    small = {"cameras.width": 64, "cameras.height": 36, "cameras.perimeter": 4, "cameras.overhead": 1, "fit.steps": 4}
    told = ["+scene=scandinavian", "preset=draft", "scene.rooms=[living room,bedroom]", "until=reconstruct"]
    told += [f"{name}={value}" for name, value in small.items()]
    path = tmp_path_factory.mktemp("compare") / "run"
    run(load_config([*told, f"output={path}"]), path)
    return path
