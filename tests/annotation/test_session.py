"""What is marked in a run: saved at once, foreseen as the run will see it, and refused where it does not fit."""

import base64
import io
import json

import numpy as np
import pytest
from PIL import Image

from tests.annotation.discs import HEIGHT, NAMES, WIDTH, Discs, drawn_run, picture
from wm.annotation.overlay import COLORS, overlay
from wm.annotation.session import RequestError, Session
from wm.synth.backends import Click, ClickedSegmentation
from wm.synth.lifting.clicks import ClickedThing, ClicksError, load_clicks
from wm.synth.lifting.drawings import keep_drawing
from wm.synth.lifting.usual_things import usual_things

A, B = [[30.0, 40.0, "+"]], [[90.0, 40.0, "+"]]


@pytest.fixture
def run(tmp_path):
    return drawn_run(tmp_path)


def session(folder, min_area=2e-4, **discs):
    backend = Discs(**discs)
    assert isinstance(backend, ClickedSegmentation)
    return Session(folder, backend, min_area=min_area)


def about(drawing, **more):
    return {"image": drawing.name, "digest": drawing.digest, **more}


def seen(answer):
    """The mask that an overlay shows."""
    png = base64.b64decode(answer["overlay"].removeprefix("data:image/png;base64,"))
    with Image.open(io.BytesIO(png)) as image:
        return np.asarray(image)[..., 3] > 0


def test_images_are_listed_with_what_is_to_be_done(tmp_path, run):
    open_ = session(tmp_path)
    images = open_.images()["images"]
    assert [(one["name"], one["finished"], one["marked"]) for one in images] == [(name, False, 0) for name in NAMES]
    assert images[0]["suggestions"] == usual_things("bath") and (images[0]["width"], images[0]["height"]) == (WIDTH, HEIGHT)
    open_.confirm(about(run[1], clicks=A, label="sofa"))
    open_.finish(about(run[1], finished=True))
    assert [(one["finished"], one["marked"]) for one in open_.images()["images"]] == [(False, 0), (True, 1)]


def test_a_mask_is_shown_and_nothing_is_saved_before_it_is_confirmed(tmp_path, run):
    open_ = session(tmp_path)
    clicks = [*A, [36.0, 40.0, "-"]]
    answer = open_.mask(about(run[0], clicks=clicks, color=1))
    wanted = Discs().mask_of(picture(), [Click(30.0, 40.0), Click(36.0, 40.0, on=False)])
    np.testing.assert_array_equal(seen(answer), wanted.mask)
    assert answer["score"] == 0.75 and answer["share"] == pytest.approx(wanted.mask.mean(), abs=1e-5)
    assert load_clicks(tmp_path, run[0]) is None and not (tmp_path / "clicks").exists()


def test_every_change_is_on_the_disk_when_it_is_answered(tmp_path, run):
    open_ = session(tmp_path)

    def labels():
        marked = load_clicks(tmp_path, run[0])
        return [thing.label for thing in marked.things], marked.finished

    open_.confirm(about(run[0], clicks=A, label=" arm  chair"))
    assert labels() == (["arm chair"], False)
    answer = open_.confirm(about(run[0], clicks=B, label="sofa"))
    assert labels() == (["arm chair", "sofa"], False) == ([thing["label"] for thing in answer["things"]], answer["finished"])
    open_.confirm(about(run[0], clicks=[*A, *B], label="bench", replaces=0))
    assert load_clicks(tmp_path, run[0]).things[0] == ClickedThing("bench", (Click(30.0, 40.0), Click(90.0, 40.0)))
    open_.finish(about(run[0], finished=True))
    assert labels() == (["bench", "sofa"], True)
    open_.delete(about(run[0], thing=0))
    assert labels() == (["sofa"], True)
    open_.finish(about(run[0], finished=False))
    assert labels() == (["sofa"], False)
    assert session(tmp_path).things(about(run[0])) == open_.things(about(run[0]))  # another page sees the same


def test_what_becomes_of_masks_is_foreseen(tmp_path, run):
    """Pieces apart are two things, but not of a plural; a speck is none; overlapping ones of one label are one."""
    open_ = session(tmp_path)

    def pieces(clicks, **more):
        return open_.mask(about(run[0], clicks=clicks, **more))["pieces"]

    assert pieces(A) == 1 and pieces([*A, *B]) == 2 and pieces([*A, *B], label="curtains") == 1
    assert pieces(A, label="wooden door") == 0 and open_.mask(about(run[0], clicks=A, label="door"))["building"]
    assert session(tmp_path, min_area=0.2).mask(about(run[0], clicks=A))["pieces"] == 0
    open_.confirm(about(run[0], clicks=A, label="sofa"))
    near = open_.confirm(about(run[0], clicks=[[32.0, 40.0, "+"]], label="sofa"))
    assert (len(near["things"]), near["outcome"]) == (2, 1)


def test_an_image_is_segmented_once_however_often_it_is_looked_at(tmp_path, run):
    open_ = session(tmp_path)
    open_.mask(about(run[0], clicks=A))
    for _ in range(3):
        open_.confirm(about(run[0], clicks=A, label="sofa"))
        open_.things(about(run[0]))
    assert len(open_._backend.asked) == 1


@pytest.mark.parametrize(
    ("action", "more"),
    [
        ("mask", {}),
        ("mask", {"clicks": [[1, 1, "-"]]}),
        ("mask", {"clicks": [[WIDTH + 1, 1, "+"]]}),
        ("confirm", {"clicks": A}),
        ("confirm", {"clicks": A, "label": "x" * 61}),
        ("confirm", {"clicks": A, "label": "sofa", "replaces": 0}),
        ("delete", {}),
        ("delete", {"thing": 0}),
        ("delete", {"thing": -1}),
        ("delete", {"thing": True}),
    ],
)
def test_requests_that_do_not_fit_change_nothing(tmp_path, run, action, more):
    with pytest.raises((RequestError, ClicksError)):
        getattr(session(tmp_path), action)(about(run[0], **more))
    assert not (tmp_path / "clicks").exists()


def test_an_image_that_was_drawn_anew_is_not_marked_unseen(tmp_path, run):
    open_ = session(tmp_path)
    new = keep_drawing(tmp_path, run[0].name, run[0].room, picture(7))
    with pytest.raises(RequestError, match="drawn anew"):
        open_.confirm(about(run[0], clicks=A, label="sofa"))
    open_.confirm(about(new, clicks=A, label="sofa"))
    for name in ("nowhere/furnish0", "../manifest", None, 3):
        with pytest.raises(RequestError, match="no such image"):
            open_.things({"image": name})


def test_an_overlay_is_the_mask_in_its_colour_with_a_firm_border():
    mask = np.zeros((20, 30), bool)
    mask[4:16, 5:25] = True
    with Image.open(io.BytesIO(overlay(mask, COLORS[2]))) as image:
        rgba = np.asarray(image)
    np.testing.assert_array_equal(rgba[..., 3] > 0, mask)
    assert rgba[4, 5, 3] == 255 > rgba[10, 15, 3] > 0
    assert (rgba[..., :3] == [0x43, 0x63, 0xD8]).all()


def test_the_page_gives_things_the_colours_of_their_masks():
    from importlib.resources import files

    script = (files("wm.annotation") / "page" / "page.js").read_text()
    assert f"const COLORS = {json.dumps(COLORS)};" in script
