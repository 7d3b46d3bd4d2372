"""A small finished run: two rooms, few steps."""

import pytest

from wm.cli.composition import load_config
from wm.pipeline import run


@pytest.fixture(scope="session")
def folder(tmp_path_factory):
    small = {"cameras.width": 128, "cameras.height": 72, "cameras.perimeter": 4, "cameras.overhead": 1, "fit.steps": 12}
    told = ["+scene=scandinavian", "preset=draft", "scene.rooms=[living room,bathroom]", "report.enabled=false"]
    told += [f"{name}={value}" for name, value in small.items()]
    path = tmp_path_factory.mktemp("viewed") / "run"
    run(load_config([*told, f"output={path}"]), path)
    return path
