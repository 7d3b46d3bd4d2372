"""Clicks in the run folder: what is saved is read again, for the image that was clicked at and no other."""

import dataclasses
import json

import pytest
from hypothesis import given
from hypothesis import strategies as st

from wm.errors import ArtifactError
from wm.synth.backends import Click
from wm.synth.lifting.clicks import (
    ClickedImage,
    ClickedThing,
    ClicksError,
    clicks_file,
    clicks_state,
    load_clicks,
    read_clicks,
    read_label,
    read_thing,
    save_clicks,
    thing_as_json,
)
from wm.synth.lifting.drawings import KeptDrawing

DRAWING = KeptDrawing("hall/furnish0", "great hall", 640, 480, "0" * 20)
SOFA = ClickedThing("sofa", (Click(212.5, 301.0), Click(180.25, 260.5, on=False)))


def test_what_is_saved_is_read_again_and_looks_as_documented(tmp_path):
    marked = ClickedImage(DRAWING, (SOFA, ClickedThing("lamp", (Click(0.0, 480.0),))), finished=True)
    save_clicks(tmp_path, marked)
    assert load_clicks(tmp_path, DRAWING) == marked
    assert json.loads((tmp_path / "clicks/hall/furnish0.json").read_text()) == {
        "version": 1,
        "image": {"name": "hall/furnish0", "width": 640, "height": 480, "digest": "0" * 20},
        "finished": True,
        "instances": [
            {"label": "sofa", "clicks": [[212.5, 301.0, "+"], [180.25, 260.5, "-"]]},
            {"label": "lamp", "clicks": [[0, 480, "+"]]},
        ],
    }


@given(st.lists(st.tuples(st.floats(0, 640), st.floats(0, 480), st.booleans()), max_size=5))
def test_an_instance_survives_json_exactly(others):
    thing = ClickedThing("sofa", (Click(1.0, 2.0), *(Click(*other) for other in others)))
    assert read_thing(json.loads(json.dumps(thing_as_json(thing))), DRAWING) == thing


def test_clicks_at_another_image_hold_no_longer(tmp_path):
    assert load_clicks(tmp_path, DRAWING) is None
    save_clicks(tmp_path, ClickedImage(DRAWING, (SOFA,)))
    assert load_clicks(tmp_path, dataclasses.replace(DRAWING, digest="1" * 20)) is None
    assert load_clicks(tmp_path, dataclasses.replace(DRAWING, name="hall/furnish1")) is None
    assert load_clicks(tmp_path, DRAWING) is not None


def test_marks_in_a_former_image_are_copied_before_they_are_overwritten(tmp_path):
    file = tmp_path / clicks_file(DRAWING.name)
    save_clicks(tmp_path, ClickedImage(DRAWING, (SOFA,)))
    save_clicks(tmp_path, ClickedImage(DRAWING, (SOFA, SOFA)))
    assert list(file.parent.iterdir()) == [file]
    former = file.read_bytes()
    save_clicks(tmp_path, ClickedImage(dataclasses.replace(DRAWING, digest="1" * 20)))
    copies = [other for other in file.parent.iterdir() if other != file]
    assert [copy.read_bytes() for copy in copies] == [former] and copies[0].name.startswith("furnish0.json.before-")
    assert len(clicks_state(tmp_path)) == 1


@pytest.mark.parametrize(
    "wrong",
    [
        [],
        [[1, 2, "-"]],
        [[1, 2, "+"], [-0.1, 2, "+"]],
        [[640.1, 2, "+"]],
        [[1, 480.5, "+"]],
        [[float("nan"), 2, "+"]],
        [[10**400, 2, "+"]],
        [[True, 2, "+"]],
        [["1", 2, "+"]],
        [[1, 2, 1]],
        [[1, 2]],
        [1, 2, "+"],
        [[1, 2, "+"]] * 201,
        "abc",
        None,
    ],
)
def test_clicks_of_another_form_are_refused(wrong):
    with pytest.raises(ClicksError):
        read_clicks(wrong, DRAWING)


@pytest.mark.parametrize("wrong", ["", "  ", "a" * 61, "so\x00fa", "so\x1b[31mfa"])
def test_labels_that_cannot_be_shown_are_refused(wrong):
    with pytest.raises(ClicksError):
        read_label(wrong)


def test_labels_have_single_spaces_and_any_letters():
    assert read_label("  coffee\n  table ") == "coffee table"
    assert read_label("Sessel für Gäste") == "Sessel für Gäste"


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"version": 2}, "version 1"),
        ({"instances": None}, "another type"),
        ({"instances": [{"label": "sofa"}]}, "an instance has"),
        ({"instances": [{"label": "sofa", "clicks": [[9999, 1, "+"]]}]}, "outside the image of 640 x 480"),
        ({"image": []}, "another type"),
    ],
)
def test_a_damaged_file_is_named_with_what_is_wrong(tmp_path, change, said):
    save_clicks(tmp_path, ClickedImage(DRAWING, (SOFA,)))
    file = tmp_path / clicks_file(DRAWING.name)
    file.write_text(json.dumps(json.loads(file.read_text()) | change))
    with pytest.raises(ClicksError, match=rf"hall/furnish0\.json: .*{said}"):
        load_clicks(tmp_path, DRAWING)


def test_text_that_is_no_json_is_refused(tmp_path):
    (tmp_path / "clicks/hall").mkdir(parents=True)
    for text in (b"{", b"\xff", b"[" * 100_000):
        (tmp_path / clicks_file(DRAWING.name)).write_bytes(text)
        with pytest.raises(ClicksError, match="cannot be read"):
            load_clicks(tmp_path, DRAWING)


def test_nothing_is_read_or_written_outside_the_folder(tmp_path):
    outside = dataclasses.replace(DRAWING, name="../furnish0")
    for act in (load_clicks, lambda folder, drawing: save_clicks(folder, ClickedImage(drawing))):
        with pytest.raises(ArtifactError):
            act(tmp_path / "run", outside)


def test_the_state_changes_with_every_change(tmp_path):
    states = [clicks_state(tmp_path)]
    for things, finished in (((), False), ((SOFA,), False), ((SOFA,), True)):
        save_clicks(tmp_path, ClickedImage(DRAWING, things, finished))
        states.append(clicks_state(tmp_path))
    assert states[0] == [] and len({json.dumps(state) for state in states}) == 4
    assert clicks_state(tmp_path) == states[-1]
