"""SAM 3 in a run: the furnish stage draws, stops for a person, goes on by itself, and is made again when clicks change."""

import json

import pytest

from tests.models import tiny
from wm.artifacts.digests import file_digest
from wm.pipeline import run
from wm.run import load_config
from wm.synth.lifting.clicks import ClickedImage, ClickedThing, ClicksError, read_clicks, save_clicks
from wm.synth.lifting.drawings import kept_drawings

pytest.importorskip("torch")
pytest.importorskip("transformers")


def config(folder, name, *more):
    checkpoint = tiny.checkpoint("sam3_tracker" if name == "sam3_clicks" else "sam3")
    small = ["objects.image_width=64", "objects.image_height=48", "image.texel_size=0.2", "until=furnish"]
    model = [f"segmentation={name}", f"segmentation.model={checkpoint}", "segmentation.device=cpu"]
    scene = ["+scene=scandinavian", "preset=draft", "scene.rooms=[bedroom]", "objects=lifted"]
    return load_config([*scene, *small, *model, f"answers.folder={folder / 'answers'}", *more])


def mark(folder, label, clicks):
    for drawing in kept_drawings(folder):
        save_clicks(folder, ClickedImage(drawing, (ClickedThing(label, read_clicks(clicks, drawing)),), finished=True))


def entry(folder):
    return json.loads((folder / "manifest.json").read_text())["entries"]["furnish"]


@pytest.mark.slow
def test_a_run_stops_for_a_person_once_and_then_goes_on(tmp_path):
    folder, asked = tmp_path / "run", config(tmp_path, "sam3_clicks")
    with pytest.raises(ClicksError) as caught:
        run(asked, folder)
    drawings = kept_drawings(folder)
    assert str(folder) in str(caught.value) and f"{len(drawings)} of {len(drawings)} images" in str(caught.value)
    assert len(drawings) >= 2 and not (folder / "objects.json").exists()
    drawn = {drawing.file: file_digest(folder / drawing.file) for drawing in drawings}
    mark(folder, "wardrobe", [[30, 30, "+"]])
    run(asked, folder)
    first = entry(folder)
    assert first["files"] | drawn == first["files"]  # the drawings are the same, and belong to the furniture
    run(asked, folder)
    assert entry(folder) == first
    mark(folder, "wardrobe", [[30, 30, "+"], [10, 40, "+"]])
    run(asked, folder)
    assert entry(folder)["key"] != first["key"]
    assert {file.name for file in (folder / "clicks").rglob("*.json")} == {"furnish0.json", "furnish1.json"}


@pytest.mark.slow
def test_a_run_by_names_needs_nobody(tmp_path):
    folder, asked = tmp_path / "run", config(tmp_path, "sam3_text", "segmentation.threshold=0.2")
    run(asked, folder)
    assert (folder / "objects.json").is_file() and len(kept_drawings(folder)) >= 2
    first = entry(folder)
    rows = [json.loads(line) for line in (folder / "requests.jsonl").read_text().splitlines()]
    assert [row["backend"] for row in rows] == ["wm.models.segmentation.sam3_text"] * len(kept_drawings(folder))
    assert not any(row["paid"] for row in rows)
    other = tmp_path / "again"
    run(config(tmp_path, "sam3_text", "segmentation.threshold=0.2", "answers.replay=only"), other)
    assert entry(other)["files"] == first["files"]
