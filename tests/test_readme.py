"""What the README shows of wm in Python does what it says, on a small run."""

import pathlib
import re

import jax
import numpy as np
import pytest

from tests.test_pipeline import SMALL
from wm.metric_table import METRICS
from wm.pipeline import run
from wm.run import load_config

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
    (block,) = python_blocks()
    made: dict = {}
    exec(compile(block, str(README), "exec"), made)
    assert made["views"] and made["gbuffer"].hit.all()  # the scaffold is closed: every ray meets it
    leaves = jax.tree.leaves(made["gradient"])
    assert len(leaves) == 5 and all(np.isfinite(leaf).all() and np.any(leaf) for leaf in leaves)


def test_figures_of_scenes_stand_under_labels_of_the_metric_table_in_its_units():
    lines = [line.strip("|").split("|") for line in README.read_text().splitlines() if line.startswith("| ")]
    start = next(k for k, cells in enumerate(lines) if "+scene=..." in cells[0])
    labels = [label.strip() for cell in lines[start][3:] for label in cell.split(",")]
    by_label = {metric.label: metric for metric in METRICS.values()}
    for cells in lines[start + 1 : start + 6]:
        values = [value.strip() for cell in cells[3:] for value in cell.split(",")]
        assert [re.sub(r"^[\d.]+ ?", "", value) for value in values] == [by_label[label].unit for label in labels]
