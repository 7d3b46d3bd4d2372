"""Colours of the slots of reconstructed things, from the images that show them.

The colour of a slot is the median of the pixels that show its faces; `texturing` adds the variation around it. These are colours
of lit surfaces. wm.synth.lifting.unlit removes the light for all things of a room together.
"""

from collections.abc import Sequence

import numpy as np
from jaxtyping import Bool, Float

from wm.geometry.rays.pinhole import project_points
from wm.offline.reconstruction.template_surface import surface_samples
from wm.synth.backends import Observation
from wm.types import SceneObject

_SAMPLES = 1500
_LEAST = 8
"""Smallest number of pixels from which the colour of a slot is taken."""


def slot_colors(
    thing: SceneObject, observations: Sequence[Observation]
) -> tuple[Float[np.ndarray, "s 3"], Bool[np.ndarray, "s"]]:
    """(colour of each slot, whether it comes from the images). A slot that is not visible, or that glows, keeps its colour."""
    colors, seen = thing.slot_colors.copy(), np.zeros(len(thing.slots), bool)
    pairs = [_slot_samples(thing, k) for k in range(len(thing.slots))]
    for k, points in enumerate(pairs):
        found = np.concatenate([_pixels(points, observation) for observation in observations])
        if thing.emission[k] == 0 and len(found) >= _LEAST:
            colors[k], seen[k] = np.median(found, axis=0), True
    return colors.astype(np.float32), seen


def _slot_samples(thing: SceneObject, slot: int) -> np.ndarray:
    faces = thing.faces[thing.face_slot == slot]
    share = max(60, int(_SAMPLES * len(faces) / len(thing.faces)))
    return surface_samples(thing.vertices, faces, share)[0]


def _pixels(points: np.ndarray, observation: Observation) -> np.ndarray:
    """[k, 3] colours of the pixels that show the points; hidden points are left out."""
    pixels, z = project_points(observation.camera, points)
    height, width = observation.depth.shape
    inside = (z > 0.1) & (pixels >= 0).all(axis=1) & (pixels < [width, height]).all(axis=1)
    x, y = pixels[inside].astype(int).T
    near = np.abs(observation.depth[y, x] - z[inside]) < 0.03 + 0.02 * z[inside]
    shown = near & observation.mask[y, x]
    return observation.rgb[y[shown], x[shown]]
