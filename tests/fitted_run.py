"""A small run with gaussians, for tests of what is made of finished runs."""

from pathlib import Path

from wm.cli.composition import load_config
from wm.finished import FinishedRun, open_finished
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


def fitted_run(folder: Path) -> FinishedRun:
    """A living room and a bathroom, furnished, painted and fitted for a few steps."""
    told = ["+scene=scandinavian", "preset=draft", "scene.rooms=[living room,bathroom]"]
    run(load_config([*told, *(f"{name}={value}" for name, value in SMALL.items()), f"output={folder}"]), folder)
    return open_finished(folder)
