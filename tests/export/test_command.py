"""python -m wm.export: what is written, and what is said of words that it does not know."""

import pytest

from wm.export import __main__ as command
from wm.export import targets
from wm.export.exporting import export, exported_files
from wm.export.records import ExportError
from wm.export.targets import TARGETS, ExportTarget, TargetModule
from wm.export.words import listed


def test_it_writes_what_is_asked_for_and_says_where(finished, tmp_path, capsys):
    assert command.main([str(finished.folder), "to=[navmesh]", f"output={tmp_path}"]) == 0
    said = capsys.readouterr().out
    assert "navmesh.json, navmesh.glb" in said and f"results: {tmp_path}" in said
    assert sorted(path.name for path in tmp_path.iterdir()) == ["navmesh.glb", "navmesh.json", "targets.json"]
    export(finished, ["scaffold"], tmp_path)
    assert exported_files(tmp_path) == {"navmesh": ["navmesh.glb", "navmesh.json"], "scaffold": ["scaffold.glb"]}


@pytest.mark.parametrize(
    ("words", "message"),
    [
        ([], "give the folder of one run"),
        (["{run}", "{run}"], "give the folder of one run"),
        (["{run}", "to=[navmesh,bla]"], "there is no target 'bla'; targets are .*navmesh"),
        (["{run}", "tp=[navmesh]"], "there is no key 'tp'; keys are to, output"),
        (["{run}", "to=[]"], "names no target"),
        (["{run}", "to=navmesh", "to=navmesh"], "given twice"),
        (["{empty}"], "no run is there"),
        (["--to", "navmesh"], "give the folder of one run"),
    ],
)
def test_a_wrong_word_is_one_line(finished, tmp_path, capsys, words, message):
    told = [word.format(run=finished.folder, empty=tmp_path) for word in words]
    assert command.main(told) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert line.startswith("wm.export: ")
    with pytest.raises(ExportError, match=message):
        raise ExportError(line)
    assert list(tmp_path.iterdir()) == []


def test_every_target_has_what_a_target_must_have_and_is_in_the_help(capsys):
    assert command.main(["--help"]) == 0
    said = capsys.readouterr().out
    for name, target in TARGETS.items():
        assert f"  {name} " in said and target.what in said
        if target.installed:
            assert isinstance(target.load(), TargetModule)


def test_a_target_without_its_extra_names_it(finished, tmp_path, monkeypatch):
    monkeypatch.setitem(targets.EXTRAS, "nowhere", ("no_such_package",))
    monkeypatch.setitem(TARGETS, "mars", ExportTarget("wm.export.mars", "for Mars", "nowhere"))
    with pytest.raises(ExportError, match=r"target mars needs an extra .* pip install 'wm\[nowhere\]'"):
        export(finished, ["mars"], tmp_path)


def test_lists_are_read_with_and_without_brackets():
    assert listed("[glb, usd]") == listed("glb,usd") == listed("['glb','usd','glb']") == ["glb", "usd"]
