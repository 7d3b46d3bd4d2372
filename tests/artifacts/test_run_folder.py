"""The run folder: atomic, resumable, honest about damage, never shared."""

import errno
import json
import multiprocessing

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from wm.artifacts.atomic import TEMPORARY, write_atomically
from wm.artifacts.digests import digest, identity
from wm.artifacts.run_folder import open_run_folder
from wm.errors import ArtifactError
from wm.offline.image.painter import Settings as ImageSettings
from wm.schema import ReportConfig, RunConfig

HEADER = {"seed": 0, "config": {"fit": {"steps": 10}}}


def test_an_entry_is_reused_only_for_its_own_key(tmp_path):
    with open_run_folder(tmp_path / "run", HEADER) as folder:
        assert not folder.has("plan", "k1")
        folder.save("plan", "k1", {"plan.json": "{}"})
        assert folder.has("plan", "k1")
        assert not folder.has("plan", "k2")


def test_entries_survive_reopening(tmp_path):
    with open_run_folder(tmp_path, HEADER) as folder:
        folder.save("plan", "k1", {"a/b.txt": b"x"})
    with open_run_folder(tmp_path, HEADER) as folder:
        assert folder.has("plan", "k1")


@pytest.mark.parametrize("damage", ["truncate", "delete", "flip"])
def test_a_damaged_file_is_noticed_and_said(tmp_path, damage):
    said = []
    with open_run_folder(tmp_path, HEADER) as folder:
        folder.save("view", "k", {"v.png": b"0123456789"})
    file = tmp_path / "v.png"
    if damage == "delete":
        file.unlink()
    else:
        file.write_bytes({"truncate": b"01234", "flip": b"0123x56789"}[damage])
    with open_run_folder(tmp_path, HEADER, say=said.append) as folder:
        assert not folder.has("view", "k")
    assert len(said) == 1 and "v.png" in said[0] and "view" in said[0]


@pytest.mark.parametrize("text", ["", "{", '{"header": {"seed": 0'])
def test_a_damaged_manifest_starts_over_with_a_line(tmp_path, text):
    (tmp_path / "manifest.json").write_text(text)
    said = []
    with open_run_folder(tmp_path, HEADER, say=said.append) as folder:
        assert not folder.has("plan", "k")
    assert "damaged" in said[0]
    assert json.loads((tmp_path / "manifest.json").read_text())["header"] == HEADER


@pytest.mark.parametrize(
    "text", ["[]", '{"name": "my web app"}', '{"header": {}, "entries": {"a": 1}}', '{"header": 3, "entries": {}}']
)
def test_a_manifest_of_somebody_else_is_left_alone(tmp_path, text):
    (tmp_path / "manifest.json").write_text(text)
    with pytest.raises(ArtifactError, match="holds no run"), open_run_folder(tmp_path, HEADER):
        pass
    assert [(file.name, file.read_text()) for file in tmp_path.iterdir()] == [("manifest.json", text)]
    with open_run_folder(tmp_path, HEADER, overwrite=True) as folder:
        assert not folder.has("plan", "k")


def test_another_configuration_is_refused_and_named(tmp_path):
    with open_run_folder(tmp_path, HEADER) as folder:
        folder.save("plan", "k", {"plan.json": "{}"})
    other = {"seed": 0, "config": {"fit": {"steps": 20}}}
    with pytest.raises(ArtifactError, match=r"config\.fit\.steps=10 \(this one: 20\)"), open_run_folder(tmp_path, other):
        pass
    with open_run_folder(tmp_path, other, overwrite=True) as folder:
        assert not folder.has("plan", "k2")


def test_a_folder_where_nothing_was_finished_is_anybodys(tmp_path):
    with open_run_folder(tmp_path, HEADER):
        pass
    with open_run_folder(tmp_path, {"seed": 1}) as folder:
        folder.save("plan", "k", {"plan.json": "{}"})
    assert json.loads((tmp_path / "manifest.json").read_text())["header"] == {"seed": 1}


def test_of_many_differences_the_preset_is_named_first(tmp_path):
    few = {f"a{k}": 1 for k in range(9)}
    with open_run_folder(tmp_path, {"config": few | {"preset": "draft"}}) as folder:
        folder.save("plan", "k", {"plan.json": "{}"})
    other = {"config": dict.fromkeys(few, 2) | {"preset": "standard"}}
    with pytest.raises(ArtifactError, match=r"a run with config\.preset=draft \(this one: standard\)"):
        open_run_folder(tmp_path, other).__enter__()


def test_a_folder_with_strangers_files_is_refused_and_left_as_it_was(tmp_path):
    files = [tmp_path / name for name in ("thesis.tex", ".part-of-a-download", "inner/.part-abc.png")]
    for file in files:
        file.parent.mkdir(exist_ok=True)
        file.write_text("years of work")
    with pytest.raises(ArtifactError, match="not empty"), open_run_folder(tmp_path, HEADER):
        pass
    assert sorted(file for file in tmp_path.rglob("*") if file.is_file()) == sorted(files)


def _try_to_open(path, queue):
    try:
        with open_run_folder(path, HEADER):
            queue.put("opened")
    except ArtifactError as error:
        queue.put(str(error))


def test_two_runs_never_share_a_folder(tmp_path):
    context = multiprocessing.get_context("spawn")
    queue = context.Queue()
    with open_run_folder(tmp_path, HEADER):
        other = context.Process(target=_try_to_open, args=(tmp_path, queue))
        other.start()
        message = queue.get(timeout=60)
        other.join()
    assert "in use by another run" in message


def test_a_failed_write_leaves_the_old_file_and_no_litter(tmp_path):
    target = tmp_path / "x.bin"
    write_atomically(target, b"old")

    def fill_the_disk(path):
        path.write_bytes(b"half")
        raise OSError(errno.ENOSPC, "No space left on device")

    with pytest.raises(OSError, match="No space") as caught:
        write_atomically(target, fill_the_disk)
    assert caught.value.filename == str(target)  # Python names no file here
    assert target.read_bytes() == b"old"
    assert [p.name for p in tmp_path.iterdir()] == ["x.bin"]


def test_litter_of_a_killed_run_is_swept(tmp_path):
    with open_run_folder(tmp_path, HEADER):
        pass
    (tmp_path / "views").mkdir()
    (tmp_path / "views" / f"{TEMPORARY}abcdefgh.png").write_bytes(b"half")
    (tmp_path / "views" / ".part-abcdefgh.pdf").write_bytes(b"another program's")
    with open_run_folder(tmp_path / "another" / "run", HEADER):
        at_work = tmp_path / "another" / "run" / f"{TEMPORARY}xyzxyzxy.png"
        at_work.write_bytes(b"half")
        with open_run_folder(tmp_path, HEADER):
            assert sorted(tmp_path.rglob(".part-*")) == [at_work, tmp_path / "views" / ".part-abcdefgh.pdf"]


def test_stale_entries_are_dropped_with_their_files(tmp_path):
    with open_run_folder(tmp_path, HEADER) as folder:
        folder.save("paint/a", "k", {"a.png": b"a"})
        folder.save("paint/b", "k", {"b.png": b"b"})
        folder.drop_others("paint/", {"paint/b"})
        assert not (tmp_path / "a.png").exists()
        assert folder.has("paint/b", "k")


@given(st.dictionaries(st.text(max_size=5), st.integers() | st.text(max_size=5), max_size=5))
def test_digest_depends_on_content_and_not_on_order(values):
    shuffled = dict(reversed(list(values.items())))
    assert digest(values) == digest(shuffled)
    assert digest(values) != digest({**values, "more": 1.5})


def test_digest_tells_arrays_apart_by_shape_and_type():
    flat = np.arange(6, dtype=np.float32)
    assert len({digest(flat), digest(flat.reshape(2, 3)), digest(flat.astype(np.float64)), digest(flat + 1)}) == 4


def test_what_changes_no_result_is_no_part_of_a_key():
    run = RunConfig(image=ImageSettings())
    parts = {"image": ImageSettings(worker=False), "report": ReportConfig(enabled=False)}
    beside = RunConfig(**parts, output="x", reuse=False, overwrite=True, workers=3, executor="x", until="plan", debug=True)
    assert digest(run) == digest(beside) != digest(RunConfig(image=ImageSettings(), seed=1))
    assert digest(ReportConfig()) != digest(ReportConfig(enabled=False))  # of the report itself it is
    assert "worker" not in identity(run)["image"] and identity(run)["fit"]["steps"] == run.fit.steps


def test_what_is_not_as_it_was_made_is_not_removed(tmp_path):
    said = []
    with open_run_folder(tmp_path, HEADER, say=said.append) as folder:
        folder.save("paint/a", "k", {"views/a.png": b"a"})
        (tmp_path / "views/a.png").write_bytes(b"touched up by hand")
        folder.drop_others("paint/", set())
    assert (tmp_path / "views/a.png").read_bytes() == b"touched up by hand"
    assert len(said) == 1 and "not as it was made" in said[0]


def test_entries_that_nobody_asks_for_are_dropped_with_their_files_and_empty_folders(tmp_path):
    with open_run_folder(tmp_path, HEADER) as folder:
        folder.save("plan", "k", {"plan.json": b"{}"})
        folder.save("evaluate/attic", "k", {"heldout/attic/a.png": b"a"})
    (tmp_path / "notes.txt").write_text("mine")
    with open_run_folder(tmp_path, HEADER) as folder:
        assert folder.has("plan", "k")
        folder.drop_unasked()
    assert {path.name for path in tmp_path.iterdir()} == {"plan.json", "manifest.json", ".lock", "notes.txt"}
    assert list(json.loads((tmp_path / "manifest.json").read_text())["entries"]) == ["plan"]


def test_files_that_an_entry_has_no_more_are_removed(tmp_path):
    with open_run_folder(tmp_path, HEADER) as folder:
        folder.save("furnish", "k", {"a": b"a", "b": b"b"})
        folder.save("cameras", "k", {"c": b"c"})
        folder.save("furnish", "l", {"a": b"A"})
    assert (tmp_path / "a").exists() and (tmp_path / "c").exists() and not (tmp_path / "b").exists()


@pytest.mark.parametrize("names", [(".lock",), (".lock", ".part-wm-abcdefgh.json"), (".lock", "timings.json")])
def test_what_only_wm_leaves_blocks_no_folder(tmp_path, names):
    for name in names:
        (tmp_path / name).write_text('{"plan": {"seconds": 1.0, "peak_gib": 1.0}}' if name == "timings.json" else "")
    with open_run_folder(tmp_path, HEADER):
        assert not list(tmp_path.glob(".part-*"))


@pytest.mark.parametrize("name", ["timings.json", ".part-abcdefgh.json", ".part-wm-thesis.pdf"])
def test_what_only_looks_like_it_is_somebody_elses(tmp_path, name):
    (tmp_path / name).write_text('{"lap": 3}')
    with pytest.raises(ArtifactError, match=f"holds no run .{name}"):
        open_run_folder(tmp_path, HEADER).__enter__()
    assert [(path.name, path.read_text()) for path in tmp_path.iterdir()] == [(name, '{"lap": 3}')]


def test_overwrite_sweeps_nothing_below_a_folder_that_held_no_run(tmp_path):
    foreign = tmp_path / "download/deep/.part-wm-abcdefgh.pdf"  # even of this name: it may be that of another run at work
    foreign.parent.mkdir(parents=True)
    foreign.write_text("half")
    with open_run_folder(tmp_path, HEADER, overwrite=True):
        assert foreign.exists()


def test_a_damaged_manifest_of_somebody_else_does_not_give_his_folder_away(tmp_path):
    for name, text in (("manifest.json", "name: my web app"), ("index.html", "<p>")):
        (tmp_path / name).write_text(text)
    with pytest.raises(ArtifactError, match="holds no run"):
        open_run_folder(tmp_path, HEADER).__enter__()
    assert (tmp_path / "manifest.json").read_text() == "name: my web app" and not (tmp_path / ".lock").exists()


def test_nothing_is_made_behind_links(tmp_path):
    run, outside = tmp_path / "run", tmp_path / "outside"
    outside.mkdir()
    with open_run_folder(run, HEADER) as folder:
        (run / "views").symlink_to(outside)
        with pytest.raises(ArtifactError, match="leads through a link"):
            folder.save("paint/a", "k", {"views/a.png": b"a"})
    (run / ".lock").unlink()
    (run / ".lock").symlink_to(outside / "lock")
    with pytest.raises(ArtifactError, match=r"\.lock is a link"):
        open_run_folder(run, HEADER).__enter__()
    assert list(outside.iterdir()) == []


@pytest.mark.parametrize("name", ["manifest.json", ".lock"])
def test_a_folder_where_a_file_is_needed_is_named(tmp_path, name):
    (tmp_path / name).mkdir()
    with pytest.raises(IsADirectoryError) as caught:
        open_run_folder(tmp_path, HEADER).__enter__()
    assert caught.value.filename == str(tmp_path / name)
