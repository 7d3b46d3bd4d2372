"""The table of metrics: how values are written, and that what draws from it agrees with it."""

import pathlib
import re

import pytest

from wm.metric_table import METRICS, MISSING, metrics_page
from wm.report.paper import PAPER_ROWS, PAPER_SCENE
from wm.report.plots import CURVES
from wm.splat.optimization.curve import HELDOUT

ROOT = pathlib.Path(__file__).parents[1]


@pytest.mark.parametrize(
    ("key", "value", "number", "text"),
    [
        ("m_mae", 0.01963, "0.0196", "0.0196 m"),
        ("n_ang_deg", 7.487, "7.49", "7.49°"),
        ("yield", 0.86, "86.0", "86.0 %"),
        ("ssim", 0.89206, "0.8921", "0.8921"),
        ("gaussians", 136760, "136,760", "136,760"),
        ("psnr", None, MISSING, MISSING),
    ],
)
def test_a_value_is_written_with_and_without_its_unit(key, value, number, text):
    assert METRICS[key].number(value) == number
    assert METRICS[key].text(value) == text


def test_a_heading_names_the_unit_where_there_is_one():
    assert METRICS["m_mae"].heading == "M-MAE (m)" and METRICS["ssim"].heading == "SSIM"


def test_labels_tell_metrics_apart_and_every_definition_is_a_sentence():
    assert len({metric.label for metric in METRICS.values()}) == len(METRICS)
    assert all(re.fullmatch(r".+[^.]\.", metric.definition) for metric in METRICS.values())


def test_figures_of_the_paper_and_of_the_curve_go_by_keys_of_the_table():
    assert {key for row in PAPER_ROWS.values() for key in row} | set(PAPER_SCENE) <= set(METRICS)
    assert set(CURVES) == set(HELDOUT) <= set(METRICS)


def test_the_page_of_definitions_is_up_to_date():
    assert (ROOT / "docs/metrics.md").read_text(encoding="utf-8") == metrics_page()


def test_a_bar_in_a_definition_does_not_end_its_cell():
    rows = [line for line in metrics_page().splitlines() if line.startswith("|")]
    assert {len(re.findall(r"(?<!\\)\|", row)) for row in rows} == {6}
    assert any(r"\|" in row for row in rows)
