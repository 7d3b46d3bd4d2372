"""python -m wm.annotate: which runs can be annotated, and what is said of the others."""

import os
import re
import signal
import subprocess
import sys
import urllib.request
from pathlib import Path

import pytest

import wm
from tests.annotation.discs import drawn_run
from wm.annotate import main, opened
from wm.errors import InputError
from wm.models.segmentation.sam3_clicks import Sam3Clicks

CLICKS = {"backend": "wm.models.segmentation.sam3_clicks", "model": "somewhere/sam3", "dtype": "bfloat16"}


def test_the_model_is_that_of_the_run(tmp_path):
    drawn_run(tmp_path, CLICKS, {"backend": "wm.synth.lifting.lifted", "min_area": 0.01})
    backend, min_area = opened(tmp_path)
    assert isinstance(backend, Sam3Clicks) and min_area == 0.01
    assert (backend.config.model, backend.config.dtype) == ("somewhere/sam3", "bfloat16")
    assert opened(tmp_path, model="other/sam3")[0].config.model == "other/sam3"


def test_runs_that_cannot_be_annotated_are_told_from_each_other(tmp_path, capsys):
    (tmp_path / "empty").mkdir()
    (tmp_path / "damaged").mkdir()
    (tmp_path / "damaged/manifest.json").write_text("{")
    drawn_run(tmp_path / "drawn", {"backend": "wm.offline.segmentation.drawn"})
    drawn_run(tmp_path / "newer", CLICKS | {"unheard": 1})
    drawn_run(tmp_path / "undrawn", CLICKS)
    (tmp_path / "undrawn/drawings/index.json").unlink()
    said = {
        "absent": "no run is there",
        "empty": "no run is there",
        "damaged": "no run is there",
        "drawn": "segmentation=sam3_clicks does",
        "newer": "does not know its settings",
        "undrawn": "no room is drawn yet",
    }
    for name, words in said.items():
        with pytest.raises(InputError, match=words):
            opened(tmp_path / name)
        assert main([str(tmp_path / name), "--no-browser"]) == 2
        out, err = capsys.readouterr()
        assert out == "" and err.startswith("wm.annotate: ") and words in err and err.count("\n") == 1


def test_it_prints_its_address_serves_the_page_and_ends_at_ctrl_c(tmp_path):
    """Neither torch nor a checkpoint is needed before the first click."""
    drawn_run(tmp_path, CLICKS)
    command = [sys.executable, "-m", "wm.annotate", str(tmp_path), "--no-browser"]
    env = os.environ | {"PYTHONPATH": str(Path(wm.__file__).parents[1])}
    with subprocess.Popen(command, env=env, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
        try:
            address = re.search(r"http://127\.0\.0\.1:\d+/[\w-]{32}/", process.stdout.readline())[0]
            with urllib.request.urlopen(address, timeout=30) as page:
                assert b"page.js" in page.read()
            with urllib.request.urlopen(f"{address}images", timeout=30) as page:
                assert b"hall/furnish0" in page.read()
            process.send_signal(signal.SIGINT)
            assert process.wait(30) == 0 and process.stderr.read() == ""
        finally:
            process.kill()
