"""A run from the theme to the report with the paper's models: loopback services, checkpoints with random weights, a worker."""

import importlib.util
import json
import pathlib

import pytest

SCRIPT = pathlib.Path(__file__).parents[2] / "experiments/real_models/run.py"
SMALL = (
    "+scene=scandinavian", "scene.rooms=[bedroom,study]", "cameras.perimeter=2", "cameras.overhead=1",
    "cameras.heldout_per_room=1", "texture.texel_size=0.1", "fit.spacing=0.2", "fit.steps=4", "report.fps=2",
)  # fmt: skip

for package in ("torch", "transformers", "google.genai", "anthropic"):
    pytest.importorskip(package)


@pytest.mark.slow
def test_the_papers_models_make_a_scene_from_end_to_end(tmp_path, capfd):
    spec = importlib.util.spec_from_file_location("real_models", SCRIPT)
    assert spec is not None and spec.loader is not None
    experiment = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(experiment)
    folder = tmp_path / "run"
    asked = [*SMALL, f"output={folder}", f"answers.folder={tmp_path / 'answers'}"]
    assert experiment.run(asked) == 0
    said = capfd.readouterr()
    assert "before models are paid" in said.out and "not-a-key" not in said.out + said.err and "HTTP Request" not in said.err
    views = list((folder / "views").rglob("*[0-9].json"))
    made_by = json.loads(views[0].read_text())["painted"]["made_by"]
    assert made_by["model"] == made_by["model_version"] == "gemini-3-pro-image" and made_by["finish_reason"]
    timings = json.loads((folder / "timings.json").read_text())
    assert {name for name, row in timings.items() if "paid_requests" in row} == {"plan", "furnish", "paint"}
    assert timings["paint"]["usd"] > 0
    kept = [path for path in tmp_path.rglob("*") if path.is_file() and b"not-a-key" in path.read_bytes()]
    assert (folder / "report.html").is_file() and not kept
    requests = (folder / "requests.jsonl").read_text()
    assert experiment.run([*asked, "overwrite=true", "fit.steps=5", "answers.replay=only"]) == 0  # nothing is asked again
    assert (folder / "requests.jsonl").read_text() == requests
