"""A small finished run that the tests of a folder share."""

import pytest

from wm.cli.composition import load_config
from wm.finished import FinishedRun, open_finished
from wm.pipeline import run

SMALL = {
    "cameras.width": 64,
    "cameras.height": 36,
    "cameras.perimeter": 4,
    "cameras.overhead": 1,
    "cameras.heldout_per_room": 2,
    "texture.texel_size": 0.1,
    "report.enabled": "false",
}

OVERRIDES = [
    *("+scene=scandinavian", "preset=draft", "scene.rooms=[living room,bathroom]"),
    *(f"{name}={value}" for name, value in SMALL.items()),
]


@pytest.fixture(scope="session")
def finished(tmp_path_factory) -> FinishedRun:
    """A living room and a bathroom, furnished and painted. They are not fitted, which would take most of the time."""
    path = tmp_path_factory.mktemp("finished") / "run"
    run(load_config([*OVERRIDES, f"output={path}", "until=heldout"]), path)
    return open_finished(path)
