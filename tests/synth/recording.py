"""The choice `recording` of a group of backends: the offline one, with a log of what becomes of it.

It stands in for a model of the user's own, so it can do what the protocols ask of one and nothing that they do not: an image
model that knows no world, begins on nothing early, and may fail.
"""

import importlib
import sys
import types

from wm.synth import backends
from wm.synth.backends import CHOICES, ImageResult, close_backend


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

    def estimate(self, result, *, seed):
        self._asked()
        return self.inner.estimate(result, seed=seed)

    def segment(self, result, *, seed):
        self._asked()
        return self.inner.segment(result, seed=seed)

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
    """Registers `recording` in these groups and returns its log.

    `fails` says by group at which question it fails; `draws`, whether the image model tells what it drew: a real one does not.
    """
    if draws:
        monkeypatch.setattr(backends, "DRAWING", (*backends.DRAWING, "recording"))
    log = Log()
    for group in groups:
        _register(monkeypatch, group, log, (fails or {}).get(group), draws)
    return log


def _register(monkeypatch, group, log, fails_at, draws):
    offline = importlib.import_module(backends._MODULES[group, CHOICES[group][0]])
    wrapper = RecordingImages if group == "image" and draws else Recording
    module = types.ModuleType(f"tests.recording_{group}")
    vars(module)["make"] = lambda config, context: wrapper(group, offline.make(config, context), log, fails_at, draws)
    monkeypatch.setitem(sys.modules, module.__name__, module)
    monkeypatch.setitem(CHOICES, group, (*CHOICES[group], "recording"))
    monkeypatch.setitem(backends._MODULES, (group, "recording"), module.__name__)
