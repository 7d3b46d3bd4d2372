"""Files are written whole or not at all, and errors name the file that was wanted."""

import errno
import os

import pytest

from wm.artifacts import atomic
from wm.artifacts.atomic import TEMPORARY, discard_unfinished, is_temporary, write_atomically


def test_a_folder_of_that_name_is_said_and_stays(tmp_path):
    (tmp_path / "plan.json").mkdir()
    with pytest.raises(IsADirectoryError) as caught:
        write_atomically(tmp_path / "plan.json", "{}")
    assert caught.value.filename == str(tmp_path / "plan.json")
    assert list(tmp_path.iterdir()) == [tmp_path / "plan.json"]


@pytest.mark.parametrize("call", ["replace", "chmod"])
def test_an_error_of_the_temporary_file_names_the_wanted_one(tmp_path, monkeypatch, call):
    def fail(name, *others):
        raise OSError(errno.EPERM, "not permitted", name)

    monkeypatch.setattr(os, call, fail)
    with pytest.raises(OSError, match="not permitted") as caught:
        write_atomically(tmp_path / "plan.json", "{}")
    assert caught.value.filename == str(tmp_path / "plan.json") and caught.value.filename2 is None
    assert list(tmp_path.iterdir()) == []


def test_text_is_written_as_utf_8(tmp_path):
    write_atomically(tmp_path / "a.json", "Küche")
    assert (tmp_path / "a.json").read_bytes() == "Küche".encode()


def test_a_folder_is_brought_to_the_disk_after_a_rename_and_so_is_the_one_it_is_new_in(tmp_path, monkeypatch):
    synced = []
    monkeypatch.setattr(atomic, "_sync_folder", synced.append)
    write_atomically(tmp_path / "a/b/c.json", "{}")
    assert set(synced) == {tmp_path / "a/b", tmp_path / "a", tmp_path}
    synced.clear()
    write_atomically(tmp_path / "a/b/c.json", "[]")
    assert synced == [tmp_path / "a/b"]


def test_a_folder_that_cannot_be_synced_is_no_failure(tmp_path):
    atomic._sync_folder(tmp_path / "nowhere")


def test_what_is_being_written_when_the_process_ends_is_removed(tmp_path):
    def end(path):
        path.write_bytes(b"half")
        discard_unfinished()
        assert not path.exists()
        path.write_bytes(b"whole")

    write_atomically(tmp_path / "a.bin", end)
    discard_unfinished()  # a finished file is none of its business
    assert [path.name for path in tmp_path.iterdir()] == ["a.bin"]


def test_only_names_that_it_gives_are_temporary(tmp_path):
    names = []
    write_atomically(tmp_path / "a.png", lambda path: names.append(path.name) or path.write_bytes(b""))
    write_atomically(tmp_path / "b", lambda path: names.append(path.name) or path.write_bytes(b""))
    assert all(map(is_temporary, names))
    assert not any(map(is_temporary, (".part-thesis01.pdf", f"{TEMPORARY}thesis.pdf", f"a{TEMPORARY}abcdefgh", "plan.json")))
