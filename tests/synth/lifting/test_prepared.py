"""Segmentations that need more than an image: names from a language model, or a person who looks at all images first."""

import contextlib
import dataclasses
import sys
import types

import numpy as np
import pytest

from tests.synth.lifting.scenes import bare
from wm.errors import InputError
from wm.offline.depth.estimator import Settings as DepthSettings
from wm.offline.image.painter import Settings as ImageSettings
from wm.schema import BackendSettings
from wm.synth.backends import LanguageResult, ModelSettings, NamedSegmentation, PreparedSegmentation
from wm.synth.lifting.drawings import INDEX, keep_drawing, kept_drawings, pixels, read_drawing
from wm.synth.lifting.lifted import Settings
from wm.synth.registry import make_backend

CONFIG = Settings(image_width=24, image_height=18)
NAMES = ["bath/furnish0", "bath/furnish1", "living/furnish0", "living/furnish1"]


class Waiting:
    """A segmentation that goes by what a person does with all images."""

    def __init__(self, log, settings):
        self.log, self.ready = log, settings.ready

    def prepare(self, drawn):
        self.log.append(("prepare", sorted(where.view.name for _, where in drawn)))
        for result, where in drawn:
            kept = {drawing.name: drawing for drawing in kept_drawings(where.folder)}
            assert (read_drawing(where.folder, kept[where.view.name]) == pixels(result.rgb)).all()
        if not self.ready:
            raise InputError("a person has to look at these first")

    def segment(self, result, *, where, seed):
        self.log.append(("segment", where.view.name))
        return []


class Hearing:
    """A segmentation that looks for what a language model names."""

    def __init__(self, log, settings, language=None):
        self.log, self.language = log, language

    def with_language(self, language):
        return Hearing(self.log, None, language)

    def segment(self, result, *, where, seed):
        self.log.append(("names", self.language.name_things(where.theme, where.room, result.rgb, seed=seed)))
        return []


class Speaking:
    """A language model that names things."""

    def __init__(self, log, settings):
        self.log = log

    def propose(self, theme, rooms, *, seed, violations, previous):
        return LanguageResult("")

    def name_things(self, theme, room, rgb, *, seed):
        return [f"{room} chair"]

    def close(self):
        self.log.append(("closed",))


@pytest.fixture
def models(monkeypatch, tmp_path):
    """Builds the settings of the models; and a log of what becomes of them."""
    log = []

    def settings(group, kind, **values):
        module = types.ModuleType(f"{kind.__name__.lower()}_{group}")
        record = dataclasses.make_dataclass(
            "Settings", [("backend", str, module.__name__), ("ready", bool, False)], bases=(BackendSettings,), kw_only=True
        )
        vars(module).update(make=lambda settings, context: kind(log, settings), Settings=record, VERSION="1")
        monkeypatch.setitem(sys.modules, module.__name__, module)
        return record(**values)

    def models(segmentation, language=None, **values):
        return ModelSettings(
            image=ImageSettings(texel_size=0.2),
            depth=DepthSettings(),
            segmentation=settings("segmentation", segmentation, **values),
            reconstruction=BackendSettings(backend="wm.offline.reconstruction.templates"),
            language=None if language is None else settings("language", language),
            folder=tmp_path,
        )

    return models, log


def test_all_rooms_are_drawn_and_kept_before_a_person_is_asked_once(models, tmp_path):
    settings, log = models
    keep_drawing(tmp_path, "former_room/furnish0", "former room", np.zeros((4, 5, 3), np.uint8))
    with contextlib.closing(make_backend("objects", CONFIG, bare()).with_models(settings(Waiting))) as backend:
        assert issubclass(Waiting, PreparedSegmentation)
        with pytest.raises(InputError, match="look at these first"):
            backend.furnish(bare(), 0)
    assert log == [("prepare", NAMES)]
    drawn = {name: (tmp_path / f"drawings/{name}.png").read_bytes() for name in NAMES}
    assert [drawing.name for drawing in kept_drawings(tmp_path)] == NAMES and (tmp_path / INDEX).is_file()
    assert not (tmp_path / "drawings/former_room/furnish0.png").exists()
    log.clear()
    with contextlib.closing(make_backend("objects", CONFIG, bare()).with_models(settings(Waiting, ready=True))) as backend:
        for room in (0, 1):
            backend.furnish(bare(), room)
    assert log[0] == ("prepare", NAMES) and sorted(name for _, name in log[1:]) == NAMES
    assert drawn == {name: (tmp_path / f"drawings/{name}.png").read_bytes() for name in NAMES}


def test_a_segmentation_by_names_is_given_the_language_model_which_is_closed_with_it(models, tmp_path):
    settings, log = models
    with contextlib.closing(make_backend("objects", CONFIG, bare()).with_models(settings(Hearing, Speaking))) as backend:
        assert issubclass(Hearing, NamedSegmentation)
        backend.furnish(bare(), 1)
    assert log == [("names", ["bathroom chair"]), ("names", ["bathroom chair"]), ("closed",)]
    assert [drawing.name for drawing in kept_drawings(tmp_path)] == NAMES[:2]  # drawings are kept for every segmentation
