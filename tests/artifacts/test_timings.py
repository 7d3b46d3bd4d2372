"""Rows of timings.json are known, unknown or none, whatever stands in the file."""

import json

import pytest

from wm.artifacts.timings import UNKNOWN, read_rows

ROW = {"seconds": 2.5, "peak_gib": 1.0}


@pytest.mark.parametrize(
    "row",
    [
        {"seconds": float("nan"), "peak_gib": 1},
        {"seconds": -1, "peak_gib": 1},
        {"seconds": True, "peak_gib": 1},
        {"seconds": "1"},
        {},
        {"seconds": 1, "peak_gib": float("inf")},
        {"seconds": None, "peak_gib": None},
    ],
)
def test_a_row_that_is_no_time_is_unknown_and_the_others_are_kept(tmp_path, row):
    (tmp_path / "t.json").write_text(json.dumps({"plan": row, "paint": ROW}))
    assert read_rows(tmp_path / "t.json") == {"plan": UNKNOWN, "paint": ROW}


@pytest.mark.parametrize("text", ["", "[]", "3", '{"plan": 3}', "\xff", "[" * 100_000])
def test_another_file_has_none(tmp_path, text):
    (tmp_path / "t.json").write_text(text, encoding="latin-1")
    assert read_rows(tmp_path / "t.json") is None
    assert read_rows(tmp_path / "nowhere.json") is None


def test_no_rows_are_not_lost_rows(tmp_path):
    (tmp_path / "t.json").write_text("{}")
    assert read_rows(tmp_path / "t.json") == {}
