"""Weights by what they contain: what their name depends on, and what is no weights."""

import pytest

from wm.errors import InputError
from wm.models.weights import find_weights


def folder_of(path, **files):
    path.mkdir(parents=True)
    for name, text in files.items():
        (path / name).write_text(text)
    return path


def test_a_commit_of_the_hub_is_its_own_name():
    weights = find_weights("lab/rooms-2.1@0123abc", "depth")
    assert (weights.source, weights.revision, weights.local) == ("lab/rooms-2.1", "0123abc", False)
    assert weights.name == "lab/rooms-2.1@0123abc"


def test_a_folder_is_named_by_its_name_and_content_and_not_by_its_place(tmp_path):
    here = folder_of(tmp_path / "a" / "rooms", config="{}", weights="12")
    there = folder_of(tmp_path / "b" / "rooms", config="{}", weights="12")
    assert find_weights(str(here), "depth").name == find_weights(str(there), "depth").name
    assert find_weights(str(here), "depth").local
    hidden = folder_of(tmp_path / "c" / "rooms", config="{}", weights="12")
    (hidden / ".cache").mkdir()
    (hidden / ".cache" / "download").write_text("yesterday")
    assert find_weights(str(hidden), "depth").name == find_weights(str(here), "depth").name


@pytest.mark.parametrize("files", [{"config": "{}", "weights": "21"}, {"config": "{}"}, {"config": "{}", "weight": "12"}])
def test_other_files_are_other_weights(tmp_path, files):
    first = folder_of(tmp_path / "a" / "rooms", config="{}", weights="12")
    second = folder_of(tmp_path / "b" / "rooms", **files)
    assert find_weights(str(first), "depth").name != find_weights(str(second), "depth").name


def test_a_folder_below_the_users_home(tmp_path, monkeypatch):
    monkeypatch.setenv("HOME", str(tmp_path))
    folder_of(tmp_path / "rooms", config="{}")
    assert find_weights("~/rooms", "depth").local


@pytest.mark.parametrize("model", ["", "rooms", "/no/such/folder", "a/b/c", "lab/rooms@", "https://huggingface.co/lab/rooms"])
def test_what_is_neither_a_folder_nor_a_name_of_the_hub_is_refused(model):
    with pytest.raises(InputError, match=r"is no folder here; .* OWNER/NAME@COMMIT"):
        find_weights(model, "depth")
