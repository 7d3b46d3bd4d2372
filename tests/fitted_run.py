"""A small run with gaussians, for tests of what is made of finished runs, made once for all processes of the suite."""

import fcntl
import os
from pathlib import Path

import pytest

from wm.cli.composition import load_config
from wm.pipeline import run

SMALL = {
    "cameras.width": 64,
    "cameras.height": 36,
    "cameras.perimeter": 4,
    "cameras.overhead": 1,
    "cameras.heldout_per_room": 2,
    "fit.steps": 4,
    "texture.texel_size": 0.1,
    "report.enabled": "false",
}


def shared_run(factory: pytest.TempPathFactory) -> Path:
    """The folder of a living room and a bathroom, furnished, painted and fitted for a few steps. Tests only read it.

    Processes of pytest-xdist have folders of their own in one that is new for each call of pytest. The first process that needs
    the run makes it there; another one waits until it is whole.
    """
    base = factory.getbasetemp()
    folder = (base.parent if "PYTEST_XDIST_WORKER" in os.environ else base) / "fitted_run"
    with open(folder.with_suffix(".lock"), "w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        if not folder.exists():
            part = folder.with_suffix(".part")
            told = ["+scene=scandinavian", "preset=draft", "scene.rooms=[living room,bathroom]"]
            run(load_config([*told, *(f"{name}={value}" for name, value in SMALL.items()), f"output={part}"]), part)
            part.rename(folder)
    return folder
