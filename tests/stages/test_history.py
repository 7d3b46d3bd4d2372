"""The error curve is whole or left out, whatever has happened to its file."""

import json
import tempfile
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from wm.artifacts.digests import digest
from wm.stages.history import history_text, read_history
from wm.stages.reporting import _scene_curve

ROW = {"room": 0, "step": 0, "seconds": 1.5, "psnr": 20.0, "m_mae": float("nan"), "n_ang_deg": 9.0}
POINTS = [ROW, ROW | {"room": 1, "seconds": 2.0}]


def test_what_was_written_is_read_and_nan_is_none(tmp_path):
    (tmp_path / "h.json").write_text(history_text(POINTS))
    assert read_history(tmp_path / "h.json") == tuple(row | {"m_mae": None} for row in POINTS)
    assert read_history(tmp_path / "nowhere.json") == ()


@given(st.integers(0, 10**6), st.integers(1, 255))
def test_a_damaged_byte_leaves_the_curve_out_or_changes_nothing(place, change):
    text = bytearray(history_text(POINTS).encode())
    text[place % len(text)] ^= change
    with tempfile.TemporaryDirectory() as name:
        file = Path(name) / "h.json"
        file.write_bytes(history_text(POINTS).encode())
        whole = read_history(file)
        file.write_bytes(text)
        assert read_history(file) in (whole, ())


rows = st.dictionaries(st.sampled_from(list(ROW)), st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=2))


@given(st.lists(rows | st.text(max_size=2), max_size=3) | rows)
def test_points_of_another_form_are_left_out_even_with_their_digest(points):
    with tempfile.TemporaryDirectory() as name:
        file = Path(name) / "h.json"
        try:
            file.write_text(json.dumps({"digest": digest(points), "points": points}))
        except ValueError:  # NaN has no digest
            file.write_text(json.dumps({"digest": "", "points": points}))
        curve = _scene_curve(read_history(file))
        assert all(isinstance(point["seconds"], int | float) for point in curve)


def test_damage_is_said(tmp_path, capsys):
    (tmp_path / "h.json").write_text("[1")
    assert read_history(tmp_path / "h.json") == ()
    assert "h.json: damaged; the report goes without its curve" in capsys.readouterr().out


@pytest.mark.parametrize("kind", ["folder", "binary"])
def test_what_is_no_text_is_damage_too(tmp_path, kind):
    if kind == "folder":
        (tmp_path / "h.json").mkdir()
    else:
        (tmp_path / "h.json").write_bytes(b"\xff\xfe\x00")
    assert read_history(tmp_path / "h.json") == ()
