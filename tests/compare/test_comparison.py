"""The command line from first word to table, and that a second call renders nothing."""

import csv
import json
import shutil

import numpy as np
import pytest

from tests.compare import writers
from wm.compare import comparison
from wm.compare.__main__ import main
from wm.compare.adapters import splats
from wm.compare.errors import CompareError
from wm.compare.table import MethodRow, markdown, summary
from wm.compare.words import parse
from wm.study.__main__ import main as study_command
from wm.study.folder import Study, open_study
from wm.study.sessions import Trial
from wm.types import Gaussians

SMALL = ["frames=8", "size=64x36"]


def shell(n: int = 3000, degree: int = 0) -> Gaussians:
    """A round room of gaussians seen from its middle, striped."""
    random = np.random.default_rng(0)
    at = random.normal(size=(n, 3))
    at = 2 * at / np.linalg.norm(at, axis=1, keepdims=True)
    sh = np.zeros((n, (degree + 1) ** 2, 3))
    sh[:, 0] = np.sin(6 * at)
    quats = np.tile([1.0, 0, 0, 0], (n, 1))
    fields = {"means": at, "quats": quats, "log_scales": np.full((n, 3), -2.5), "opacity_logits": np.full(n, 4.0), "sh": sh}
    return Gaussians(**{name: value.astype(np.float32) for name, value in fields.items()})


def test_methods_become_a_table_videos_and_cameras_and_the_second_call_renders_nothing(run_folder, tmp_path, capsys, monkeypatch):
    writers.inria_ply(tmp_path / "pano/point_cloud/iteration_9/point_cloud.ply", shell(degree=3))
    words = [f"ours={run_folder}", f"dreamscene360={tmp_path / 'pano'}", "trajectories=[along,around]", *SMALL]
    out = tmp_path / "out"
    assert main([*words, f"output={out}"]) == 0
    table = (out / "comparison.md").read_text()
    assert table.strip() in capsys.readouterr().out
    assert "| *paper: dreamscene360* | 0.4336" in table and "0.1615" in table
    for method in ("ours", "dreamscene360"):
        for name in ("along1", "around1"):
            assert (out / f"videos/{method}/{name}.mp4").stat().st_size > 500
            assert len(json.loads((out / f"cameras/{method}/{name}.json").read_text())["frames"]) == 8
    rows = list(csv.DictReader((out / "comparison.csv").read_text().splitlines()))
    told = json.loads((out / "comparison.json").read_text())["methods"]
    assert [row["method"] for row in rows] == ["ours", "dreamscene360"]
    assert float(rows[0]["warp_explained"]) == told["ours"]["figures"]["warp_explained"]
    assert float(rows[1]["holes"]) < 0.05
    assert told["dreamscene360"]["system"]["scale"] == "the farthest point at 1.43"

    def refuse(*args):
        raise AssertionError("a scene was read again")

    monkeypatch.setattr(comparison, "read_scene", refuse)
    assert main([*words, f"output={out}"]) == 0
    assert (out / "comparison.md").read_text() == table


def test_only_what_changed_is_measured_again(tmp_path, monkeypatch):
    files = {name: tmp_path / f"{name}.ply" for name in ("a", "b")}
    for file in files.values():
        writers.inria_ply(file, shell())
    words = [*(f"{name}={file}" for name, file in files.items()), "trajectories=[along]", *SMALL, f"output={tmp_path / 'out'}"]
    read, known = [], comparison.read_scene
    monkeypatch.setattr(comparison, "read_scene", lambda source: read.append(source.method) or known(source))
    assert main(words) == 0
    writers.inria_ply(files["b"], shell(2000))
    assert main(words) == 0
    (tmp_path / "out/videos/a/along1.mp4").unlink()
    assert main(words) == 0
    assert read == ["a", "b", "b", "a"]


def test_one_path_of_cameras_is_rendered_of_all(tmp_path):
    for name in ("a", "b"):
        writers.inria_ply(tmp_path / f"{name}.ply", shell())
    words = [f"a={tmp_path / 'a.ply'}", f"b={tmp_path / 'b.ply'}", *SMALL, f"output={tmp_path / 'out'}"]
    assert main([*words, "trajectories=[around]"]) == 0
    shutil.copy(tmp_path / "out/cameras/a/around1.json", tmp_path / "path.json")
    assert main([*words, f"trajectories={tmp_path / 'path.json'}"]) == 0
    told = json.loads((tmp_path / "out/comparison.json").read_text())["methods"]
    assert list(told["a"]["trajectories"]) == ["path"]
    costs = ("seconds", "render_seconds", "peak_gib")
    first, second = ({k: v for k, v in told[m]["trajectories"]["path"].items() if k not in costs} for m in ("a", "b"))
    assert first == second


def test_a_path_that_a_scene_lacks_is_said_before_anything_is_rendered(run_folder, tmp_path, capsys):
    assert main([f"ours={run_folder}", "trajectories=[along1,door9]", *SMALL, f"output={tmp_path}"]) == 2
    assert "number 9 is none" in capsys.readouterr().err
    assert not list(tmp_path.rglob("*.mp4"))


def test_videos_of_a_comparison_become_a_study_and_its_answers_tables(tmp_path):
    for name, n in (("ours", 3000), ("other", 800)):
        writers.inria_ply(tmp_path / f"{name}.ply", shell(n))
    words = [f"{name}:splats={tmp_path / name}.ply" for name in ("ours", "other")]
    assert main([*words, "trajectories=[along,around]", *SMALL, f"output={tmp_path / 'out'}"]) == 0
    videos = [f"{name}={tmp_path / 'out/videos' / name}" for name in ("ours", "other")]
    assert study_command(["make", *videos, f"output={tmp_path / 'study'}", "participants=3"]) == 0
    study = open_study(tmp_path / "study")
    for slot, trials in enumerate(study.sessions):
        sheet = {"version": 1, "study": study.id, "participant": f"{slot:032x}", "slot": slot}
        sheet["answers"] = [_answer(study, trial) for trial in trials]
        (tmp_path / f"study/answers/{slot}.json").write_text(json.dumps(sheet))
    assert study_command(["analyse", str(tmp_path / "study")]) == 0
    rows = list(csv.DictReader((tmp_path / "study/results/ratings.csv").read_text().splitlines()))
    assert {row["method"]: float(row["mean"]) for row in rows} == {"ours": 5, "other": 2}
    (row,) = csv.DictReader((tmp_path / "study/results/preferences.csv").read_text().splitlines())
    assert (row["method"], row["against"], float(row["share"])) == ("ours", "other", 1)


def _answer(study: Study, trial: Trial) -> dict[str, object]:
    """What somebody answers who likes ours."""
    methods = [study.videos[name][0] for name in trial.videos]
    if trial.is_pair:
        return {"choice": trial.check or ("left" if methods[0] == "ours" else "right")}
    value = trial.check or (5 if methods[0] == "ours" else 2)
    return {"ratings": {question.id: value for question in study.questions.ratings}}


@pytest.mark.parametrize(
    ("words", "says"),
    [
        (["ours"], "no METHOD=PATH"),
        (["frames=9"], "no METHOD=PATH is given"),
        (["a:nobody=x"], "no adapter"),
        (["a=/nowhere/b.ply"], "a: /nowhere/b.ply is not there"),
        (["a=x.ply", "a=y.ply"], "given twice"),
        (["a=x.ply", "b.up=z"], "no method b"),
        (["a=x.ply", "a.up=w"], "a.up=w"),
        (["wonderworld=x.ply", "wonderworld.up=z"], "wonderworld.up: the files of wonderworld say so"),
        (["a=x.glb", "a.antialias=true"], "options of it: up, cameras"),
        (["a=x.ply", "frames=1"], "frames=1"),
        (["a=x.ply", "frames=8", "frames=9"], "frames= is given twice"),
        (["a=x.ply", "size=688"], "WIDTHxHEIGHT"),
        (["a=x.ply", "trajectories=[up]"], "no trajectory"),
        (["../a=x.ply"], "cannot name a method"),
        (["a=x.ply", "quality=/nowhere/weights"], "/nowhere/weights"),
    ],
)
def test_a_wrong_word_is_one_line(words, says, tmp_path, capsys):
    assert main([*words, f"output={tmp_path}"] if words != ["ours"] else words) == 2
    told = capsys.readouterr().err
    assert says in told and told.count("\n") == 1 and "Traceback" not in told


def test_words_of_a_comparison():
    request = parse(["Mine:splats=a.ply", "Mine.antialias=true", "Mine.up=-y", "fov=50", "trajectories=door2"])
    (source,) = request.sources
    assert (source.method, source.adapter, source.antialias, source.up) == ("Mine", "splats", True, "-y")
    assert (request.picture.fov, request.trajectories, request.shared) == (50, ("door2",), None)
    with pytest.raises(CompareError, match="is no list"):
        parse(["a=a.ply", "trajectories=[door,]"])


def test_absolute_errors_are_divided_by_one_scale_of_the_method():
    figures = [{"reproj_mae": 0.2, "reproj_depth": 2.0, "seconds": 1.0}, {"reproj_mae": 0.4, "reproj_depth": 4.0, "seconds": 2.0}]
    found = summary(figures)
    assert found["reproj_mae_norm"] == pytest.approx(0.3 / 3.0)
    assert found["seconds"] == 3.0
    assert summary([{"reproj_mae": None, "reproj_depth": None}])["reproj_mae_norm"] is None


def test_the_best_of_a_column_is_bold_and_what_is_missing_a_dash():
    told = {"a": {"holes": 0.5, "warp_explained": 0.5}, "b": {"holes": 0.25}}
    rows = [MethodRow(method, "splats", splats.SYSTEM, figures) for method, figures in told.items()]
    table = markdown(rows)
    assert "**25.00**" in table and "**50.0" not in table and "–" in table
