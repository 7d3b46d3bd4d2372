"""What the README shows of wm in Python does what it says, on a small run."""

import pathlib
import re
import sys

import jax
import numpy as np
import pytest

from tests.test_pipeline import SMALL
from wm.geometry import make_camera
from wm.metric_table import METRICS
from wm.pipeline import run
from wm.run import load_config
from wm.synth.backends import Condition, ImageRequest
from wm.synth.registry import make_backend
from wm.types import View
from wm.validate import ConfigError

README = pathlib.Path(__file__).parents[1] / "README.md"


def python_blocks() -> list[str]:
    return re.findall(r"^```python\n(.*?)^```", README.read_text(), flags=re.MULTILINE | re.DOTALL)


@pytest.fixture
def beside_a_run(tmp_path, monkeypatch):
    """A working directory in which the folder that the README names is there, made by a small run."""
    folders = set(re.findall(r"outputs/\w+/\w+/\d+", "".join(python_blocks())))
    assert len(folders) == 1
    monkeypatch.chdir(tmp_path)
    run(load_config([*SMALL, "report.enabled=false"]), tmp_path / folders.pop())


@pytest.mark.slow
def test_the_python_part_runs_and_its_comments_hold(beside_a_run):
    block = python_blocks()[0]
    made: dict = {}
    exec(compile(block, str(README), "exec"), made)
    assert made["views"] and made["gbuffer"].hit.all()  # the scaffold is closed: every ray meets it
    leaves = jax.tree.leaves(made["gradient"])
    assert len(leaves) == 5 and all(np.isfinite(leaf).all() and np.any(leaf) for leaf in leaves)


def test_a_model_of_one_s_own_is_selected_as_the_readme_says(tmp_path, monkeypatch):
    block = python_blocks()[1]
    (line,) = re.findall(r"lab_conf/image/lab\.yaml the line  (.+)", block)
    (tmp_path / "lab_image.py").write_text(block)
    (tmp_path / "lab_conf/image").mkdir(parents=True)
    (tmp_path / "lab_conf/image/lab.yaml").write_text(f"{line}\n")
    monkeypatch.syspath_prepend(tmp_path)
    monkeypatch.delitem(sys.modules, "lab_image", raising=False)
    (command,) = re.findall(r"^python -m wm\.run --config-dir lab_conf (.+)$", README.read_text(), flags=re.MULTILINE)
    config = load_config(command.split(), config_dir=tmp_path / "lab_conf")
    assert config.image.strength == 0.5 and not config.verify.enabled
    model = make_backend("image", config.image)
    condition = Condition(rgb=np.full((2, 3, 3), 0.5, np.float32), known=np.zeros((2, 3)), depth=np.ones((2, 3)))
    view = View(make_camera(np.zeros(3), np.ones(3), width=3, height=2, fov_deg=60.0), 0, "bootstrap", "v")
    result = model.generate(ImageRequest(condition=condition, reference=None, prompt="", view=view, seed=0))
    assert result.rgb is condition.rgb
    with pytest.raises(ConfigError, match=r"image\.strength=2\.0: must be a number from 0 to 1"):
        load_config(["+scene=gothic", "image=lab", "image.strength=2"], config_dir=tmp_path / "lab_conf")


def test_figures_of_scenes_stand_under_labels_of_the_metric_table_in_its_units():
    lines = [line.strip("|").split("|") for line in README.read_text().splitlines() if line.startswith("| ")]
    start = next(k for k, cells in enumerate(lines) if "+scene=..." in cells[0])
    labels = [label.strip() for cell in lines[start][3:] for label in cell.split(",")]
    by_label = {metric.label: metric for metric in METRICS.values()}
    for cells in lines[start + 1 : start + 6]:
        values = [value.strip() for cell in cells[3:] for value in cell.split(",")]
        assert [re.sub(r"^[\d.]+ ?", "", value) for value in values] == [by_label[label].unit for label in labels]
