"""A whole run, small: its artifacts, and that interrupted or damaged runs end with the bytes of an undisturbed one."""

import json
import pathlib
import shutil

import pytest

from tests.synth.recording import recorded, with_recording
from wm import pipeline
from wm.artifacts.run_folder import RunFolder, open_run_folder
from wm.errors import ArtifactError
from wm.export.records import ExportError
from wm.geometry import PlanError
from wm.meter import StageMeter
from wm.metric_table import METRICS
from wm.pipeline import run
from wm.run import load_config
from wm.stages.history import read_history
from wm.stages.run_context import RunContext
from wm.stages.scene import build_scene

SMALL = (
    "scene.name=cell",
    "scene.theme='a plain cabin'",
    "scene.rooms=[bedroom]",
    "preset=draft",
    "cameras.width=96",
    "cameras.height=64",
    "cameras.perimeter=2",
    "cameras.overhead=1",
    "cameras.heldout_per_room=2",
    "texture.texel_size=0.1",
    "image.texel_size=0.1",
    "fit.spacing=0.2",
    "fit.steps=4",
    "fit.curve_points=2",
    "report.fps=1",
)
CLOCKED = {"timings.json", "layout.json", "metrics.json", "report.html", "history.json", ".lock"}
"""Files that say how long things took."""


def _bytes(folder: pathlib.Path) -> dict[str, bytes]:
    files = (path for path in sorted(folder.rglob("*")) if path.is_file() and path.name not in CLOCKED)
    return {str(path.relative_to(folder)): path.read_bytes() for path in files}


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    folder = tmp_path_factory.mktemp("whole")
    run(load_config(SMALL), folder)
    return folder


def test_everything_promised_is_there(whole):
    names = set(_bytes(whole)) | {path.name for path in whole.iterdir()}
    for name in ("plan.json", "scaffold.glb", "cameras.json", "splats.ply", "objects.json", "flythrough.mp4", "manifest.json"):
        assert name in names
    assert set(json.loads((whole / "metrics.json").read_text())) == set(METRICS)
    assert json.loads((whole / "metrics.json").read_text())["views"] == len(list((whole / "views").rglob("*.depth.png")))
    assert {"plan", "paint", "reconstruct", "evaluate", "report"} <= set(json.loads((whole / "timings.json").read_text()))


def test_a_run_exports_at_its_end_and_refuses_unknown_targets_at_its_beginning(whole, tmp_path, capsys):
    shutil.copytree(whole, tmp_path / "run")
    run(load_config([*SMALL, "export=[navmesh]"]), tmp_path / "run")
    assert (tmp_path / "run" / "export" / "navmesh.json").is_file()
    assert "nothing to do" in capsys.readouterr().out  # what is exported does not identify the run
    with pytest.raises(ExportError, match="no target 'bla'"):
        run(load_config([*SMALL, "export=[bla]"]), tmp_path / "refused")
    assert not (tmp_path / "refused").exists()
    assert "<svg" in (whole / "report.html").read_text()
    curve = read_history(whole / "stages/history.json")
    assert len(curve) == 2 and all(point[name] is not None for point in curve for name in ("psnr", "m_mae", "n_ang_deg"))
    assert not list(whole.rglob(".part-*"))


def test_an_interrupted_run_resumes_to_the_same_bytes(whole, tmp_path, monkeypatch):
    save, calls = RunFolder.save, []

    def save_until(limit):
        def interrupted(self, *arguments):
            calls.append(arguments[0])
            if len(calls) == limit:
                raise KeyboardInterrupt
            return save(self, *arguments)

        return interrupted

    for limit in (4, 6, 3):  # in the painting, in what follows, and near the end
        calls.clear()
        monkeypatch.setattr(RunFolder, "save", save_until(limit))
        with pytest.raises(KeyboardInterrupt):
            run(load_config(SMALL), tmp_path)
    calls.clear()
    monkeypatch.setattr(RunFolder, "save", save_until(-1))
    run(load_config(SMALL), tmp_path)
    assert "plan" not in calls  # finished stages were not done again
    assert _bytes(tmp_path) == _bytes(whole)


@pytest.mark.slow
def test_rooms_fitted_one_by_one_and_side_by_side_leave_the_same_bytes(tmp_path):
    for workers in (1, 2):
        config = load_config([*SMALL[:2], "scene.rooms=[bedroom,hall]", *SMALL[3:], f"workers={workers}"])
        run(config, tmp_path / str(workers))
    assert _bytes(tmp_path / "1") == _bytes(tmp_path / "2")


def test_damage_is_said_and_mended(whole, tmp_path, capsys):
    config = load_config(SMALL)
    for name, data in _bytes(whole).items():
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_bytes(data)
    view = next((tmp_path / "views").rglob("bootstrap0.png"))
    view.write_bytes(view.read_bytes()[:100])
    (tmp_path / "splats.ply").unlink()
    run(config, tmp_path)
    said = capsys.readouterr().out
    assert "bootstrap0.png: damaged" in said and "splats.ply: missing" in said
    assert _bytes(tmp_path) == _bytes(whole)


@pytest.mark.parametrize(
    "change",
    ["fit.depth_weight=0.4", pytest.param("variant=no_depth_loss", marks=pytest.mark.slow)],  # which compiles other steps
)
def test_what_a_neighbour_has_done_is_taken_over_and_accounted_for(change, whole, tmp_path, monkeypatch, capsys):
    save, made = RunFolder.save, []

    def listening(self, *arguments):
        made.append(arguments[0].partition("/")[0])
        return save(self, *arguments)

    monkeypatch.setattr(RunFolder, "save", listening)
    config = load_config([*SMALL, change])
    run(config, tmp_path / "borrowed", neighbours=[whole])
    assert "paint: taken from" in capsys.readouterr().out
    assert not {"plan", "furnish", "paint", "heldout"} & set(made) and "reconstruct" in made
    theirs, ours = (json.loads((folder / "timings.json").read_text()) for folder in (whole, tmp_path / "borrowed"))
    assert ours["paint"]["seconds"] >= theirs["paint"]["seconds"]
    run(config, tmp_path / "borrowed")  # finds all done, which costs nothing
    again = json.loads((tmp_path / "borrowed" / "timings.json").read_text())
    assert [again[stage] for stage in ("plan", "paint", "reconstruct", "report")] == [
        ours[stage] for stage in ("plan", "paint", "reconstruct", "report")
    ]
    run(config, tmp_path / "alone")
    assert _bytes(tmp_path / "borrowed") == _bytes(tmp_path / "alone")
    assert (tmp_path / "borrowed/layout.json").is_file()


def test_a_stopped_run_names_no_point_cloud_and_says_what_of_a_former_run_stays(whole, tmp_path, capsys):
    assert json.loads((whole / "cameras.json").read_text())["ply_file_path"] == "points.ply" and (whole / "points.ply").is_file()
    run(load_config([*SMALL, "until=cameras"]), tmp_path)
    assert "ply_file_path" not in json.loads((tmp_path / "cameras.json").read_text())
    assert "former run" not in capsys.readouterr().out
    run(load_config([*SMALL, "seed=1", "until=plan", "overwrite=true"]), tmp_path)
    assert "what the former run has left of later stages stays in the folder" in capsys.readouterr().out
    assert (tmp_path / "cameras.json").exists()


def test_furniture_of_the_plan_is_listed_where_nothing_else_is_furnished(tmp_path):
    room = {"id": "den", "name": "Den", "floor_polygon": [[0, 0], [4, 0], [4, 3], [0, 3]], "openings": []}
    bed = {"label": "bed", "room": "den", "position": [1.5, 1.5, 0], "size": [1.4, 2, 0.5]}
    (tmp_path / "own.json").write_text(json.dumps({"metadata": {}, "rooms": [room], "objects": [bed]}))
    config = [*SMALL, f"plan.file={tmp_path / 'own.json'}", "furnish.enabled=false", "until=furnish"]
    for _ in range(2):  # the second time they are read back
        run(load_config(config), tmp_path / "run")
        (row,) = json.loads((tmp_path / "run/objects.json").read_text())["objects"]
        assert (row["label"], row["room"], row["size"]) == ("bed", "den", [1.4, 2.0, 0.5])


def test_until_a_stage_stops_there_and_the_next_run_goes_on(tmp_path, capsys):
    assert run(load_config([*SMALL, "until=plan"]), tmp_path) == {}
    assert "stopped after plan; the same command without until=plan goes on" in capsys.readouterr().out
    plan = (tmp_path / "plan.json").read_bytes()
    assert not (tmp_path / "objects.json").exists()
    run(load_config([*SMALL, "until=cameras"]), tmp_path)
    times = json.loads((tmp_path / "timings.json").read_text())
    assert set(times) == {"plan", "structure", "furnish", "cameras"} and (tmp_path / "plan.json").read_bytes() == plan
    (tmp_path / "timings.json").unlink()
    run(load_config([*SMALL, "until=furnish"]), tmp_path)  # finds all done: it has not taken the time that this takes
    again = json.loads((tmp_path / "timings.json").read_text())
    assert again["plan"] == again["furnish"] == {"seconds": None, "peak_gib": None}
    said = capsys.readouterr().out
    assert "timings.json: missing or damaged; how long cameras, furnish, plan took is not known any more" in said


def test_another_configuration_does_not_share_the_folder(whole):
    before = _bytes(whole)
    with pytest.raises(ArtifactError, match=r"config\.fit\.steps=4 \(this one: 5\)"):
        run(load_config([*SMALL[:-3], "fit.steps=5", *SMALL[-2:]]), whole)
    assert _bytes(whole) == before


def test_a_plan_that_cannot_be_used_leaves_no_folder_behind(tmp_path):
    (tmp_path / "plan.json").write_text("{")
    with pytest.raises(PlanError, match=r"plan\.json"):
        run(load_config([*SMALL, f"plan.file={tmp_path / 'plan.json'}"]), tmp_path / "never")
    assert not (tmp_path / "never").exists()


def painted(folder):
    config = with_recording(load_config(SMALL), "image", "depth")
    with open_run_folder(folder, {"seed": config.seed}) as store:
        context = RunContext(config=config, folder=store, meter=StageMeter({}))
        return pipeline._painted(context, build_scene(context))


def test_the_models_that_paint_are_closed_when_all_is_painted(monkeypatch, tmp_path):
    log = recorded(monkeypatch, "image", "depth")
    result, heldout = painted(tmp_path)
    assert result.yield_share == 1.0 and not heldout.known  # a model that knows no world has no truth of held-out views
    assert log[:2] == ["image made", "depth made"] and log[-2:] == ["depth closed", "image closed"]
    assert {"image asked", "depth asked"} == set(log[2:-2])
    assert {request.task for request in log.requests} == {"paint"}
    assert any("In view: a window" in request.prompt for request in log.requests)


@pytest.mark.parametrize("group", ["image", "depth"])
def test_the_models_that_paint_are_closed_when_one_of_them_fails(monkeypatch, tmp_path, group):
    log = recorded(monkeypatch, "image", "depth", fails={group: 2})
    with pytest.raises(MemoryError, match=group):
        painted(tmp_path)
    assert log[-2:] == ["depth closed", "image closed"]
