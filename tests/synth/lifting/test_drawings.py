"""Drawings in the run folder: what is listed is there as it was drawn, and nothing of it can lead out of the folder."""

import json

import numpy as np
import pytest

from wm.errors import ArtifactError
from wm.synth.lifting.drawings import (
    INDEX,
    drawing_files,
    drop_drawings,
    keep_drawing,
    kept_drawings,
    pixel_digest,
    pixels,
    read_drawing,
)


def picture(seed=0, height=6, width=9):
    return np.random.default_rng(seed).random((height, width, 3)).astype(np.float32)


def test_a_drawing_comes_back_pixel_by_pixel(tmp_path):
    drawing = keep_drawing(tmp_path, "hall/furnish0", "great hall", picture())
    assert (drawing.room, drawing.width, drawing.height) == ("great hall", 9, 6)
    assert kept_drawings(tmp_path) == [drawing]
    np.testing.assert_array_equal(read_drawing(tmp_path, drawing), pixels(picture()))
    assert drawing.digest == pixel_digest(picture()) == pixel_digest(pixels(picture())) != pixel_digest(picture(1))


def test_one_pixel_or_another_shape_is_another_digest():
    image = pixels(picture())
    changed = image.copy()
    changed[3, 4, 1] ^= 1
    assert len({pixel_digest(image), pixel_digest(changed), pixel_digest(image.reshape(9, 6, 3))}) == 3


def test_drawing_again_replaces_and_others_stay(tmp_path):
    other = keep_drawing(tmp_path, "bath/furnish0", "bath", picture(1))
    keep_drawing(tmp_path, "hall/furnish0", "hall", picture(2))
    new = keep_drawing(tmp_path, "hall/furnish0", "hall", picture(3))
    assert kept_drawings(tmp_path) == [other, new]
    assert drawing_files(tmp_path) == [INDEX, "drawings/bath/furnish0.png", "drawings/hall/furnish0.png"]
    drop_drawings(tmp_path, lambda name: name.startswith("hall/"))
    assert kept_drawings(tmp_path) == [other]
    assert drawing_files(tmp_path) == [INDEX, "drawings/bath/furnish0.png"]
    assert not (tmp_path / "drawings/hall/furnish0.png").exists()


def test_a_file_that_was_changed_or_broken_is_refused(tmp_path):
    drawing = keep_drawing(tmp_path, "hall/furnish0", "hall", picture())
    other = keep_drawing(tmp_path, "hall/furnish1", "hall", picture(1))
    whole = (tmp_path / drawing.file).read_bytes()
    for content in ((tmp_path / other.file).read_bytes(), whole[:60], b"no picture"):
        (tmp_path / drawing.file).write_bytes(content)
        with pytest.raises(ArtifactError, match=r"hall/furnish0\.png"):
            read_drawing(tmp_path, drawing)
    (tmp_path / drawing.file).unlink()
    with pytest.raises(ArtifactError, match="draws it anew"):
        read_drawing(tmp_path, drawing)


@pytest.mark.parametrize("text", ["", "[]", '{"drawings": 3}', '{"drawings": [{"name": "a"}]}'])
def test_a_damaged_list_lists_nothing(tmp_path, text):
    keep_drawing(tmp_path, "hall/furnish0", "hall", picture())
    (tmp_path / INDEX).write_text(text)
    assert kept_drawings(tmp_path) == []


@pytest.mark.parametrize("name", ["../outside", "hall/../../outside", "/etc/passwd", 7])
def test_a_list_that_leads_out_of_the_folder_is_not_followed(tmp_path, name):
    item = {"name": name, "room": "hall", "width": 1, "height": 1, "digest": "0"}
    (tmp_path / "drawings").mkdir()
    (tmp_path / INDEX).write_text(json.dumps({"version": 1, "drawings": [item]}))
    assert kept_drawings(tmp_path) == []


def test_a_link_out_of_the_folder_is_not_written_through(tmp_path):
    (tmp_path / "run").mkdir()
    (tmp_path / "outside").mkdir()
    (tmp_path / "run/drawings").symlink_to(tmp_path / "outside")
    with pytest.raises(ArtifactError, match="link"):
        keep_drawing(tmp_path / "run", "hall/furnish0", "hall", picture())
    assert list((tmp_path / "outside").iterdir()) == []
