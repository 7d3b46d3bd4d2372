"""Entries are taken over from runs beside this one only if they are the same and whole."""

import json

import pytest

from wm.artifacts.manifest import Loan
from wm.artifacts.neighbours import Neighbours
from wm.artifacts.run_folder import open_run_folder

HEADER = {"seed": 0}


@pytest.fixture
def other(tmp_path):
    """A finished run with one entry of two files."""
    with open_run_folder(tmp_path / "other", HEADER) as folder:
        folder.save("paint/hall", "k1", {"views/hall.png": b"picture", "views/hall.json": "{}"})
    return tmp_path / "other"


def neighbours(*folders):
    said, accounted = [], []
    lender = Neighbours(folders, say=said.append, account=lambda *call: accounted.append(call))
    return lender.lend, said, accounted


def test_what_is_the_same_is_copied_and_recorded(other, tmp_path):
    lend, said, accounted = neighbours(other)
    with open_run_folder(tmp_path / "mine", HEADER, lend=lend) as folder:
        assert folder.has("paint/hall", "k1")
    assert (tmp_path / "mine/views/hall.png").read_bytes() == b"picture"
    assert (tmp_path / "mine/views/hall.png").stat().st_ino != (other / "views/hall.png").stat().st_ino
    assert said == [f"paint: taken from {other}, where it is the same"]
    assert accounted == [("paint", other)]
    with open_run_folder(tmp_path / "mine", HEADER) as folder:  # now it is its own
        assert folder.has("paint/hall", "k1")


def test_another_key_or_name_is_not_lent(other, tmp_path):
    lend, said, _ = neighbours(other)
    with open_run_folder(tmp_path / "mine", HEADER, lend=lend) as folder:
        assert not folder.has("paint/hall", "k2")
        assert not folder.has("paint/attic", "k1")
    assert said == [] and not (tmp_path / "mine/views").exists()


@pytest.mark.parametrize("damage", ["flip", "remove", "not a file"])
def test_a_damaged_entry_is_not_lent(other, tmp_path, damage):
    file = other / "views/hall.png"
    if damage == "flip":
        file.write_bytes(b"pictura")
    else:
        file.unlink()
    if damage == "not a file":  # cannot be read, whoever runs this
        file.mkdir()
    lend, said, _ = neighbours(other)
    with open_run_folder(tmp_path / "mine", HEADER, lend=lend) as folder:
        assert not folder.has("paint/hall", "k1")
    assert said == []


def test_the_next_neighbour_is_asked(other, tmp_path):
    (other / "views/hall.png").unlink()
    with open_run_folder(tmp_path / "third", HEADER) as folder:
        folder.save("paint/hall", "k1", {"views/hall.png": b"picture"}, {"model": "m"})
    lend, _, accounted = neighbours(other, tmp_path / "third")
    assert lend("paint/hall", "k1", tmp_path / "mine") == Loan(("views/hall.png",), {"model": "m"})
    assert accounted == [("paint", tmp_path / "third")]


def test_folders_without_a_manifest_lend_nothing(other, tmp_path):
    (other / "manifest.json").write_text(json.dumps({"entries": 3}))
    for folder in (other, tmp_path / "nowhere"):
        assert neighbours(folder)[0]("paint/hall", "k1", tmp_path / "mine") is None
