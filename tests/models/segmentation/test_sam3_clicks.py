"""SAM 3 by a person's clicks: on a tiny checkpoint with random weights, from the files that wm.annotation writes."""

import dataclasses

import numpy as np
import pytest

from tests.models import tiny
from wm.geometry.rays.pinhole import make_camera
from wm.models.segmentation import sam3_clicks
from wm.models.segmentation.sam3 import image_tensor, load_tracker
from wm.models.weights import find_weights
from wm.services.faults import ServiceError
from wm.services.services import Services
from wm.services.store import AnswerStore
from wm.synth.backends import Click, ClickedSegmentation, ImageResult, Surroundings
from wm.synth.lifting.clicks import ClickedImage, ClickedThing, ClicksError, save_clicks
from wm.synth.lifting.drawings import KeptDrawing, pixel_digest, pixels
from wm.synth.registry import backend_key, make_backend
from wm.types import View

torch = pytest.importorskip("torch")
pytest.importorskip("transformers")

IMAGE = ImageResult(rgb=np.random.default_rng(0).random((60, 90, 3)).astype(np.float32))
CAMERA = make_camera(np.array([0.0, 0, 1]), np.array([1.0, 0, 1]), width=90, height=60, fov_deg=60.0)
SOFA = ClickedThing("sofa", (Click(20.5, 30.5), Click(70.0, 20.0, on=False)))
LAMP = ClickedThing("lamp", (Click(81.0, 11.25),))


def settings(**changes):
    return sam3_clicks.Settings(**{"model": str(tiny.checkpoint("sam3_tracker")), "device": "cpu"} | changes)


def place(folder, name="hall/furnish0"):
    return Surroundings("gothic", "hall", View(CAMERA, 0, "bootstrap", name), folder)


def mark(folder, *things, name="hall/furnish0", finished=True, result=IMAGE):
    drawing = KeptDrawing(name, "hall", 90, 60, pixel_digest(result.rgb))
    save_clicks(folder, ClickedImage(drawing, things, finished))


@pytest.fixture(scope="module")
def backend():
    return sam3_clicks.make(settings())


def test_each_instance_is_one_segment_and_the_building_is_none(tmp_path, backend):
    assert isinstance(backend, ClickedSegmentation)
    mark(tmp_path, SOFA, LAMP, dataclasses.replace(LAMP, label="wooden door"))
    backend.prepare([(IMAGE, place(tmp_path))])
    found = backend.segment(IMAGE, where=place(tmp_path), seed=0)
    assert [segment.label for segment in found] == ["sofa", "lamp"]
    for segment, thing in zip(found, (SOFA, LAMP), strict=True):
        alone = backend.mask_of(pixels(IMAGE.rgb), thing.clicks)
        assert segment.mask.tobytes() == alone.mask.tobytes() and segment.score == alone.score
        assert segment.mask.shape == (60, 90) and 0 <= segment.score <= 1


def test_masks_are_those_of_the_model_asked_directly(backend):
    model = load_tracker(find_weights(str(tiny.checkpoint("sam3_tracker")), "sam"), "cpu", torch.float32)
    scale = np.array([112 / 90, 112 / 60])
    for thing in (SOFA, LAMP):
        points = torch.tensor(np.array([[c.x, c.y] for c in thing.clicks]) * scale - 0.5, dtype=torch.float32)[None, None]
        signs = torch.tensor([[[int(c.on) for c in thing.clicks]]])
        with torch.no_grad():
            out = model(
                pixel_values=image_tensor(pixels(IMAGE.rgb), model), input_points=points, input_labels=signs,
                multimask_output=len(thing.clicks) == 1,
            )  # fmt: skip
        best = int(out.iou_scores[0, 0].argmax())
        logits = torch.nn.functional.interpolate(out.pred_masks[0, :, best : best + 1], (60, 90), mode="bilinear")[0, 0]
        found = backend.mask_of(pixels(IMAGE.rgb), thing.clicks)
        assert (found.mask != (logits > 0).numpy()).mean() < 2e-3  # half precision of kept logits
        assert found.score == pytest.approx(float(out.iou_scores[0, 0, best]), abs=1e-6)


def test_position_and_sign_of_a_click_matter_and_an_image_is_encoded_once():
    backend, image = sam3_clicks.make(settings()), pixels(IMAGE.rgb)
    masks = [
        backend.mask_of(image, clicks).mask.tobytes()
        for clicks in (
            [Click(5.0, 5.0)],
            [Click(85.0, 5.0)],
            [Click(5.0, 55.0)],
            [Click(5.0, 5.0), Click(85.0, 5.0)],
            [Click(5.0, 5.0), Click(85.0, 5.0, False)],
        )
    ]
    assert len(set(masks)) == 5 and backend.tracker.encoded == 1
    for k in range(6):
        backend.mask_of(image ^ np.uint8(k), [Click(5.0, 5.0)])
    assert backend.tracker.encoded == 6 and len(backend.tracker._embedded) == 4


@pytest.mark.parametrize("dtype", ["bfloat16", "float16"])
def test_half_precision_gives_nearly_the_same_mask(backend, dtype):
    """Of two clicks, which give one mask: of one, random weights choose between three by a hair."""
    clicks = [Click(20.0, 10.0), Click(80.0, 30.0, on=False)]
    half = sam3_clicks.make(settings(dtype=dtype)).mask_of(pixels(IMAGE.rgb), clicks)
    whole = backend.mask_of(pixels(IMAGE.rgb), clicks)
    assert (half.mask != whole.mask).mean() < 0.1 and half.score == pytest.approx(whole.score, abs=0.01)


def test_images_without_clicks_are_one_error_that_says_what_to_do(tmp_path, backend):
    drawn = [(IMAGE, place(tmp_path, f"room{k}/furnish{n}")) for k in range(3) for n in range(2)]
    mark(tmp_path, SOFA, name="room0/furnish0")
    mark(tmp_path, SOFA, name="room0/furnish1", finished=False)
    with pytest.raises(ClicksError) as caught:
        backend.prepare(drawn)
    said = str(caught.value)
    assert f"python -m wm.annotate {tmp_path}" in said and "the same command goes on" in said and "\n" not in said
    assert "5 of 6 images" in said and "room0/furnish1, room1/furnish0" in said and "room0/furnish0" not in said
    with pytest.raises(ClicksError, match=r"wm\.annotate"):
        backend.segment(*drawn[1][:1], where=drawn[1][1], seed=0)
    with pytest.raises(ClicksError, match="there is none"):
        backend.prepare([(IMAGE, place(None))])


def test_clicks_at_an_image_that_was_drawn_anew_hold_no_longer(tmp_path, backend):
    mark(tmp_path, SOFA)
    with pytest.raises(ClicksError, match="hall/furnish0"):
        backend.prepare([(ImageResult(rgb=1 - IMAGE.rgb), place(tmp_path))])


def test_an_image_in_which_nothing_is_marked_has_no_segments(tmp_path, backend):
    mark(tmp_path)
    backend.prepare([(IMAGE, place(tmp_path))])
    assert backend.segment(IMAGE, where=place(tmp_path), seed=0) == []


def test_what_was_answered_is_read_again_without_the_model(tmp_path):
    mark(tmp_path, SOFA, LAMP)

    def served(replay):
        return make_backend("segmentation", settings(), None, Services(store=AnswerStore(tmp_path / "answers"), replay=replay))

    first = served("auto").segment(IMAGE, where=place(tmp_path), seed=0)
    again = served("only")
    kept = again.segment(IMAGE, where=place(tmp_path), seed=1)
    assert [s.mask.tobytes() for s in kept] == [s.mask.tobytes() for s in first] and len(kept) == 2
    assert again.tracker.encoded == 0 and again.quote().usd == 0


def test_the_key_of_the_furniture_changes_with_the_clicks(tmp_path):
    keys = [str(backend_key(settings(), tmp_path))]
    for things in ((SOFA,), (SOFA, LAMP)):
        mark(tmp_path, *things)
        keys.append(str(backend_key(settings(), tmp_path)))
    assert len(set(keys)) == 3 and backend_key(settings()) == (settings(), sam3_clicks.VERSION)


def test_a_checkpoint_without_the_heads_for_clicks_is_refused(tmp_path):
    mark(tmp_path, SOFA)
    backend = sam3_clicks.make(settings(model=str(tiny.checkpoint("sam3"))))
    with pytest.raises(ServiceError, match=r"\d+ weights are missing, such as mask_decoder.*Sam3TrackerModel"):
        backend.segment(IMAGE, where=place(tmp_path), seed=0)
