"""Colours of reconstructed things, from the images that show them.

A slot's colour is the median of the pixels in which its faces are seen; what varies around it is `texturing`'s. Those are the
colours of lit surfaces; the surfaces' own are told apart for a whole room at once (wm.synth.lifting.unlit).
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
"""Pixels that a slot must be seen in."""


def slot_colors(
    thing: SceneObject, observations: Sequence[Observation]
) -> tuple[Float[np.ndarray, "s 3"], Bool[np.ndarray, "s"]]:
    """(the colour of each slot as the images show it, whether they do); a slot that is not seen, or that glows, keeps its own."""
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
    """[k, 3] colours of the pixels in which points are seen."""
    pixels, z = project_points(observation.camera, points)
    height, width = observation.depth.shape
    inside = (z > 0.1) & (pixels >= 0).all(axis=1) & (pixels < [width, height]).all(axis=1)
    x, y = pixels[inside].astype(int).T
    near = np.abs(observation.depth[y, x] - z[inside]) < 0.03 + 0.02 * z[inside]
    shown = near & observation.mask[y, x]
    return observation.rgb[y[shown], x[shown]]
