"""A run folder with two drawings, and a segmentation that takes what is within some pixels of clicks on the thing."""

import numpy as np

from wm.artifacts.digests import json_text
from wm.synth.backends import Segment
from wm.synth.lifting.drawings import keep_drawing

NAMES = ("bath/furnish0", "hall/furnish0")
WIDTH, HEIGHT = 120, 90


class Discs:
    """A segmentation backend by clicks."""

    def __init__(self, radius=12.0):
        self.radius, self.asked = radius, []

    def mask_of(self, rgb, clicks):
        self.asked.append(tuple(clicks))
        y, x = np.mgrid[: rgb.shape[0], : rgb.shape[1]] + 0.5

        def near(on):
            return np.any(
                [np.zeros(x.shape, bool), *(np.hypot(x - c.x, y - c.y) < self.radius for c in clicks if c.on is on)], axis=0
            )

        return Segment("", near(True) & ~near(False), 0.75)

    def prepare(self, drawn):
        """Everything can be segmented."""

    def segment(self, result, *, where, seed):
        return []


def picture(seed=0):
    """[h, w, 3] uint8, with steps from pixel to pixel."""
    return np.random.default_rng(seed).integers(0, 256, (HEIGHT, WIDTH, 3), dtype=np.uint8)


def drawn_run(folder, segmentation=None, objects=None):
    """A run folder that stopped once its rooms were drawn; returns its drawings."""
    config = {"segmentation": segmentation or {}, "objects": objects or {}}
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "manifest.json").write_text(json_text({"header": {"config": config}, "entries": {}}))
    return [keep_drawing(folder, name, name.partition("/")[0], picture(k)) for k, name in enumerate(NAMES)]
