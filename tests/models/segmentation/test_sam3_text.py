"""SAM 3 by names, on a tiny checkpoint with random weights."""

import dataclasses

import numpy as np
import pytest

from tests.models import tiny
from wm.geometry.rays.pinhole import make_camera
from wm.models.segmentation import sam3_text
from wm.models.segmentation.masks import resized
from wm.models.segmentation.sam3 import image_tensor, load_detector
from wm.models.weights import find_weights
from wm.services.faults import RefusedError, ReplayError, ServiceError
from wm.services.ledger import Ledger
from wm.services.services import Services
from wm.services.store import AnswerStore
from wm.synth.backends import ImageResult, LanguageResult, NamedSegmentation, NamingBackend, ServedBackend, Surroundings
from wm.synth.lifting.drawings import pixels
from wm.synth.lifting.usual_things import usual_things
from wm.synth.registry import make_backend
from wm.types import View

torch = pytest.importorskip("torch")
transformers = pytest.importorskip("transformers")

IMAGE = ImageResult(rgb=np.random.default_rng(0).random((60, 90, 3)).astype(np.float32))
CAMERA = make_camera(np.array([0.0, 0, 1]), np.array([1.0, 0, 1]), width=90, height=60, fov_deg=60.0)
WHERE = Surroundings("gothic", "guest bedroom", View(CAMERA, 0, "bootstrap", "b/furnish0"))


def settings(**changes):
    return sam3_text.Settings(**{"model": str(tiny.checkpoint("sam3")), "device": "cpu", "threshold": 0.0, "same": 1.0} | changes)


@dataclasses.dataclass
class Naming:
    """A language model that names things."""

    things: list
    asked: list = dataclasses.field(default_factory=list)

    def propose(self, theme, rooms, *, seed, violations, previous):
        return LanguageResult("")

    def name_things(self, theme, room, rgb, *, seed):
        self.asked.append((theme, room, rgb.shape, seed))
        if not self.things:
            raise RefusedError("names nothing")
        return self.things


class Silent:
    """A language model that names nothing."""

    def propose(self, theme, rooms, *, seed, violations, previous):
        return LanguageResult("")


def test_scores_and_masks_are_those_that_transformers_documents():
    """Its own post-processing needs torchvision; these are its five lines."""
    model, tokenizer = load_detector(find_weights(str(tiny.checkpoint("sam3")), "sam"), "cpu", torch.float32)
    words = tokenizer("oak chair", padding="max_length", max_length=32, return_tensors="pt")
    with torch.no_grad():
        out = model(pixel_values=image_tensor(pixels(IMAGE.rgb), model), **words)
    scores = (out.pred_logits.sigmoid() * out.presence_logits.sigmoid())[0].numpy()
    inside = torch.nn.functional.interpolate(out.pred_masks.sigmoid(), size=(60, 90), mode="bilinear", align_corners=False)
    masks = (inside > 0.5)[0].numpy()
    backend = sam3_text.make(settings(labels="Oak chair"))
    found = backend.segment(IMAGE, where=WHERE, seed=0)
    kept = [k for k in np.argsort(-scores, kind="stable") if masks[k].any()]
    assert len(found) == len(kept) > 2
    np.testing.assert_allclose([segment.score for segment in found], scores[kept], atol=1e-6)
    for segment, k in zip(found, kept, strict=True):
        assert segment.label == "oak chair" and segment.mask.dtype == bool
        assert (segment.mask != masks[k]).mean() < 2e-3  # half precision of kept logits


def test_masks_are_resized_as_torch_does():
    grid = np.random.default_rng(1).normal(size=(32, 32)).astype(np.float32)
    for shape in ((60, 90), (20, 33), (32, 32), (300, 17)):
        wanted = torch.nn.functional.interpolate(torch.tensor(grid)[None, None], shape, mode="bilinear", align_corners=False)
        np.testing.assert_allclose(resized(grid, shape), wanted[0, 0].numpy(), atol=1e-5)


def test_an_image_is_encoded_once_however_many_names(monkeypatch):
    backend, encoded = sam3_text.make(settings(labels="sofa, chair, lamp")), []
    kind = transformers.Sam3Model
    inner = kind.get_vision_features
    monkeypatch.setattr(kind, "get_vision_features", lambda self, **given: encoded.append(1) or inner(self, **given))
    labels = {segment.label for segment in backend.segment(IMAGE, where=WHERE, seed=0)}
    assert labels == {"sofa", "chair", "lamp"} and encoded == [1]


def test_the_threshold_is_a_threshold_and_duplicates_go():
    everything = sam3_text.make(settings(labels="sofa, chair")).segment(IMAGE, where=WHERE, seed=0)
    scores = sorted(segment.score for segment in everything)
    middle = scores[len(scores) // 2]
    half = sam3_text.make(settings(labels="sofa, chair", threshold=middle)).segment(IMAGE, where=WHERE, seed=0)
    assert [segment.score for segment in half] == sorted((score for score in scores if score > middle), reverse=True)
    apart = sam3_text.make(settings(labels="sofa, chair", same=0.0)).segment(IMAGE, where=WHERE, seed=0)
    assert np.sum([segment.mask for segment in apart], axis=0).max() == 1
    assert apart[0].score == scores[-1]
    assert sam3_text.make(settings(labels="sofa", threshold=1.0)).segment(IMAGE, where=WHERE, seed=0) == []


def test_names_come_from_the_settings_then_from_the_language_model_then_from_the_list():
    naming = Naming(["Bed", "door", "wall", "night stand", "bed"])
    assert isinstance(naming, NamingBackend)
    backend = sam3_text.make(settings())
    assert isinstance(backend, NamedSegmentation)

    def names(backend):
        return backend.names(IMAGE, where=WHERE, seed=3)

    assert names(backend) == names(backend.with_language(Silent())) == list(usual_things("guest bedroom"))
    assert names(backend.with_language(naming)) == ["bed", "night stand"]
    assert naming.asked == [("gothic", "guest bedroom", (60, 90, 3), 3)]
    assert names(backend.with_language(Naming([]))) == list(usual_things("guest bedroom"))
    assert names(sam3_text.make(settings(labels=" Sofa,, window,sofa, rug")).with_language(naming)) == ["sofa", "rug"]
    assert len(naming.asked) == 1
    assert names(sam3_text.make(settings(most_labels=1)).with_language(naming)) == ["bed"]


def test_the_answer_is_kept_and_read_again_without_the_model(tmp_path):
    def served(**changes):
        services = Services(store=AnswerStore(tmp_path / "answers"), ledger=Ledger(), **changes)
        return make_backend("segmentation", settings(labels="sofa, chair"), None, services), services

    backend, services = served()
    assert isinstance(backend, ServedBackend) and backend.quote().usd == 0
    first = backend.segment(IMAGE, where=WHERE, seed=0)
    assert services.ledger.spent().requests == 0  # a local model costs time only
    backend.close()
    backend.close()
    again, _ = served(replay="only")
    kept = again.segment(IMAGE, where=WHERE, seed=9)
    assert [(s.label, s.score, s.mask.tobytes()) for s in kept] == [(s.label, s.score, s.mask.tobytes()) for s in first] != []
    assert again.model._key is None
    other = ImageResult(rgb=1 - IMAGE.rgb)
    with pytest.raises(ReplayError):
        again.segment(other, where=WHERE, seed=0)


def test_a_checkpoint_that_lacks_weights_or_is_none_is_refused(tmp_path):
    wrong = {
        "are missing": str(tiny.checkpoint("sam3_tracker")),
        "cannot be loaded": str(tmp_path),
    }
    for said, model in wrong.items():
        with pytest.raises(ServiceError, match=said):
            sam3_text.make(settings(model=model, labels="sofa")).segment(IMAGE, where=WHERE, seed=0)


def test_weights_that_give_no_numbers_are_an_error_and_no_empty_image(tmp_path):
    model, tokenizer = tiny.sam3()
    with torch.no_grad():
        model.text_projection.bias.fill_(float("nan"))
    for part in (model, tokenizer):
        part.save_pretrained(tmp_path)
    with pytest.raises(ServiceError, match="not finite"):
        sam3_text.make(settings(model=str(tmp_path), labels="sofa")).segment(IMAGE, where=WHERE, seed=0)
