"""python -m wm.check: one table of what was exported, and an exit code that says whether all of it holds."""

import json
import shutil

import pytest

from wm.check import __main__ as command
from wm.export.exporting import export
from wm.finished import open_finished
from wm.stages.reconstruction import BY_ROOM


@pytest.fixture(scope="module")
def unfitted(finished, tmp_path_factory):
    """The run as it was before its gaussians, which few steps leave too far from the mesh to pass a check."""
    folder = shutil.copytree(finished.folder, tmp_path_factory.mktemp("unfitted") / "run")
    (folder / BY_ROOM).unlink()
    return open_finished(folder)


@pytest.fixture
def exported(unfitted, tmp_path):
    export(unfitted, ["navmesh", "scaffold"], tmp_path)
    return [str(unfitted.folder), f"folder={tmp_path}"]


def test_all_that_was_exported_is_checked(exported, capsys):
    assert command.main(exported) == 0
    said = capsys.readouterr().out
    assert "doors and passages that it leads through" in said and "objects against the run" in said
    assert said.splitlines()[-1].startswith("all 13 checks passed")


def test_one_check_that_fails_is_told_by_the_exit_code(exported, tmp_path, capsys):
    told = json.loads((tmp_path / "navmesh.json").read_text())
    told["vertices"][0][2] = 1.0
    (tmp_path / "navmesh.json").write_text(json.dumps(told))
    (tmp_path / "scaffold.glb").write_bytes(b"")
    assert command.main(exported) == 1
    said = capsys.readouterr().out
    assert said.count("FAILED") == 5 and "is no GLB file" in said and "5 of 9 checks failed" in said


def test_a_file_that_no_check_reads_closely_may_not_change_either(exported, tmp_path, capsys):
    path = tmp_path / "navmesh.json"
    path.write_text(path.read_text() + "\n")
    assert command.main(exported) == 1
    said = capsys.readouterr().out
    assert "changed: navmesh.json" in said and "1 of 13 checks failed" in said
    path.unlink()
    assert command.main(exported) == 1
    assert "gone: navmesh.json" in capsys.readouterr().out


def test_what_a_library_trips_over_is_a_row_and_no_traceback(exported, tmp_path, capsys):
    (tmp_path / "navmesh.glb").write_bytes(b"")  # trimesh: IndexError
    assert command.main(exported) == 1
    (row,) = [line for line in capsys.readouterr().out.splitlines() if "files can be read" in line]
    assert "navmesh" in row and row.endswith("FAILED")


def test_an_export_without_digests_is_checked_by_its_users_alone(exported, tmp_path, capsys):
    told = json.loads((tmp_path / "targets.json").read_text())
    del told["digests"]
    (tmp_path / "targets.json").write_text(json.dumps(told))
    assert command.main(exported) == 0
    assert "all 11 checks passed" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("words", "message"),
    [
        ([], "give the folder"),
        (["of=[usd]"], "usd was not exported there; there are navmesh, scaffold"),
        (["to=x"], "no key 'to'"),
    ],
)
def test_a_wrong_word_is_one_line(exported, capsys, words, message):
    assert command.main([*exported, *words] if words else []) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert message in line


def test_a_folder_without_exports_says_what_to_do(finished, tmp_path, capsys):
    assert command.main([str(finished.folder), f"folder={tmp_path}"]) == 2
    assert "nothing was exported there" in capsys.readouterr().err
