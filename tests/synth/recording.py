"""A backend `recording` for each group: the offline one, with a log of what becomes of it.

It stands in for a model of the user's own, so it can do what the protocols ask of one and nothing that they do not: an image
model that knows no world, begins on nothing early, and may fail.
"""

import dataclasses
import importlib
import sys
import types

from wm.synth.backends import ImageResult
from wm.synth.registry import DRAWN, close_backend

OFFLINE = {
    "image": "wm.offline.image.painter",
    "depth": "wm.offline.depth.estimator",
    "segmentation": "wm.offline.segmentation.drawn",
    "reconstruction": "wm.offline.reconstruction.templates",
}


class Log(list):
    """Lines such as "image asked"; and the requests to image models."""

    def __init__(self):
        super().__init__()
        self.requests = []


class Recording:
    def __init__(self, group, inner, log, fails_at, draws):
        self.group, self.inner, self.log, self.fails_at, self.draws = group, inner, log, fails_at, draws
        self._note("made")

    def _note(self, what):
        assert f"{self.group} closed" not in self.log, f"{self.group} {what} after it was closed"
        self.log.append(f"{self.group} {what}")

    def _asked(self):
        self._note("asked")
        if self.log.count(f"{self.group} asked") == self.fails_at:
            raise MemoryError(f"the {self.group} model is out of memory")

    def generate(self, request):
        self.log.requests.append(request)
        self._asked()
        result = self.inner.generate(request)
        return result if self.draws else ImageResult(rgb=result.rgb)

    def estimate(self, result, *, camera, seed):
        self._asked()
        return self.inner.estimate(result, camera=camera, seed=seed)

    def segment(self, result, *, where, seed):
        self._asked()
        return self.inner.segment(result, where=where, seed=seed)

    def reconstruct(self, label, observations, site, room, *, seed):
        self._asked()
        return self.inner.reconstruct(label, observations, site, room, seed=seed)

    def close(self):
        self._note("closed")
        close_backend(self.inner)


class RecordingImages(Recording):
    """An image model that tells what it draws, and beforehand what it will draw."""

    def imagined(self):
        return self.inner.imagined()


def recorded(monkeypatch, *groups, fails=None, draws=True):
    """Makes the backend `recording` of these groups available, and returns its log.

    `fails` says by group at which question it fails; `draws`, whether the image model tells what it drew: a real one does not.
    """
    log = Log()
    for group in groups:
        _register(monkeypatch, group, log, (fails or {}).get(group), draws)
    return log


def recording(group, **settings):
    """The settings that select it."""
    return sys.modules[f"recording_{group}"].Settings(**settings)


def with_recording(config, *groups):
    """A configuration whose models of these groups are recording ones, with the settings that it has for the offline ones."""
    for group in groups:
        own = dataclasses.asdict(getattr(config, group)) | {"backend": f"recording_{group}"}
        config = dataclasses.replace(config, **{group: recording(group, **own)})
    return config


def _register(monkeypatch, group, log, fails_at, draws):
    offline = importlib.import_module(OFFLINE[group])
    wrapper = RecordingImages if group == "image" and draws else Recording
    module = types.ModuleType(f"recording_{group}")
    settings = dataclasses.make_dataclass(
        "Settings", [("backend", str, module.__name__)], bases=(offline.Settings,), kw_only=True, unsafe_hash=True
    )
    vars(module).update(
        make=lambda settings, context: wrapper(group, offline.make(settings, context), log, fails_at, draws),
        Settings=settings,
        VERSION="1",
        PROVIDES=(DRAWN,) if draws else (),
    )
    monkeypatch.setitem(sys.modules, module.__name__, module)
