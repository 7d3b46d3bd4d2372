"""python -m wm.annotate: which runs can be annotated, and what is said of the others."""

import pytest

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
