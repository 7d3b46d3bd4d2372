"""Words of a capture, and refusals that name what would be right."""

import pathlib

import pytest

from wm.capture.__main__ import main
from wm.capture.request import CaptureError, parse_request


def test_what_is_not_told_is_the_walk_in_all_formats(tmp_path):
    request = parse_request([str(tmp_path)])
    assert request.trajectory == "walk" and request.formats == ("nerfstudio", "npz", "tum")
    assert request.folder == tmp_path / "capture" / "walk"


def test_words_are_read(tmp_path):
    words = ["trajectory=orbit", "format=[tum, npz]", "fps=4", "fov=70.5", "width=320", "output=there", "depth=splats"]
    request = parse_request([*words, str(tmp_path)])
    assert (request.formats, request.fps, request.fov, request.width) == (("npz", "tum"), 4, 70.5, 320)
    assert (request.folder, request.depth) == (pathlib.Path("there"), "splats")


@pytest.mark.parametrize(
    ("words", "says"),
    [
        ([], "give the folder of one run"),
        (["a", "b"], "give the folder of one run"),
        (["a", "path=walk"], "no key 'path'; keys are trajectory"),
        (["a", "trajectory=fly"], "walk, orbit, views, heldout or a JSON file"),
        (["a", "trajectory=none.json"], "no file of that name"),
        (["a", "format=[tum,kitti]"], "kitti: nerfstudio or npz or tum"),
        (["a", "format="], "nerfstudio or npz or tum"),
        (["a", "fps=0"], "a whole number from 1 to 240"),
        (["a", "fps=2.5"], "a whole number from 1 to 240"),
        (["a", "fov=wide"], r"a number from 5.0 to 150.0"),
        (["a", "fov=nan"], r"a number from 5.0 to 150.0"),
        (["a", "rgb=blue"], "splats or images"),
        (["a", "rgb=images"], "trajectory=views would be right"),
        (["a", "rgb=images", "trajectory=views", "width=64"], "leave out width"),
    ],
)
def test_refusals_name_what_would_be_right(words, says):
    with pytest.raises(CaptureError, match=says):
        parse_request(words)


def test_a_folder_without_a_run_ends_with_2_and_one_line(tmp_path, capsys):
    assert main([str(tmp_path)]) == 2
    shown = capsys.readouterr()
    assert shown.out == "" and shown.err.count("\n") == 1 and "no run is there" in shown.err


def test_help_names_every_key(capsys):
    assert main(["--help"]) == 0
    shown = capsys.readouterr().out
    assert all(key in shown for key in ("trajectory", "format", "fov", "depth"))
