"""A run folder read back is what the run had."""

import json
import shutil

import numpy as np
import pytest

from wm.artifacts.atomic import write_atomically
from wm.finished import UnfinishedRunError, open_finished
from wm.splat import load_ply


@pytest.fixture
def folder(finished):
    return finished.folder


def test_gaussians_are_those_of_the_splat_file_with_their_rooms(folder):
    finished = open_finished(folder)
    told = load_ply(finished.splats_file)
    np.testing.assert_array_equal(finished.gaussians.means, told.means)
    assert len(finished.gaussian_room) == len(told.means)
    assert set(finished.gaussian_room.tolist()) == {0, 1}
    lengths = [len(gaussians.means) for gaussians in finished.gaussians_by_room]
    assert sum(lengths) >= len(told.means)


def test_views_and_objects_count_in_the_rooms_of_the_plan(folder):
    finished = open_finished(folder)
    frames = json.loads((folder / "cameras.json").read_text())["frames"]
    assert [finished.rooms[view.room] for view in finished.views] == [frame["room"] for frame in frames]
    assert {finished.rooms[view.room] for view in finished.heldout} == set(finished.rooms)
    rows = json.loads((folder / "objects.json").read_text())["objects"]
    assert [thing.id for thing in finished.objects] == [row["id"] for row in rows]
    assert finished.scaffold.face_object.max() == len(finished.objects) - 1


def test_settings_are_those_of_the_run(folder):
    finished = open_finished(folder)
    assert (finished.cameras.width, finished.cameras.perimeter) == (64, 4)
    assert finished.theme


def test_a_folder_without_a_run_is_refused_and_so_is_what_a_run_lacks(folder, tmp_path):
    with pytest.raises(UnfinishedRunError, match="no run is there"):
        open_finished(tmp_path)
    with pytest.raises(UnfinishedRunError, match=r"manifest\.json: is a file; give the folder of a run"):
        open_finished(folder / "manifest.json")
    copy = tmp_path / "copy"
    shutil.copytree(folder, copy)
    (copy / "splats.ply").unlink()
    with pytest.raises(UnfinishedRunError, match=r"no splats\.ply"):
        _ = open_finished(copy).splats_file
    write_atomically(copy / "manifest.json", b"{")
    with pytest.raises(UnfinishedRunError, match="damaged"):
        open_finished(copy)
