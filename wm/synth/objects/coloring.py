"""Colours of reconstructed things, from the images that show them.

A slot's colour is the median of the pixels in which its faces are seen; what varies around it is `texturing`'s. Those
are the colours of lit surfaces; the scaffold wants the colours of the surfaces. What light did is told apart by what all things
of a room have in common: the median ratio, per channel and in linear light, of the colours seen to the usual colours of the same
materials.
"""

import dataclasses
from collections.abc import Sequence

import numpy as np
from jaxtyping import Bool, Float

from wm.geometry.camera import project_points
from wm.synth.backends import Reconstruction, Sighting
from wm.synth.objects.template_surface import surface_samples
from wm.synth.procedural.color import to_linear, to_srgb
from wm.types import SceneObject

_SAMPLES = 1500
_LEAST = 8
"""Pixels that a slot must be seen in."""


def slot_colors(thing: SceneObject, sightings: Sequence[Sighting]) -> tuple[Float[np.ndarray, "s 3"], Bool[np.ndarray, "s"]]:
    """(the colour of each slot as the images show it, whether they do); a slot that is not seen, or that glows, keeps its own."""
    colors, seen = thing.slot_colors.copy(), np.zeros(len(thing.slots), bool)
    pairs = [_slot_samples(thing, k) for k in range(len(thing.slots))]
    for k, points in enumerate(pairs):
        found = np.concatenate([_pixels(points, sighting) for sighting in sightings])
        if thing.emission[k] == 0 and len(found) >= _LEAST:
            colors[k], seen[k] = np.median(found, axis=0), True
    return colors.astype(np.float32), seen


def unlit(things: Sequence[Reconstruction]) -> list[SceneObject]:
    """The things with the colours of their surfaces instead of their colours in the room's light."""
    ratios = [
        to_linear(item.thing.slot_colors[item.seen]) / np.maximum(to_linear(item.usual[item.seen]), 0.01) for item in things
    ]
    known = np.concatenate([np.zeros((0, 3)), *ratios])
    light = np.clip(np.median(known, axis=0), 0.1, 3.0) if len(known) >= 3 else np.ones(3)
    return [_without(item, light) for item in things]


def _without(item: Reconstruction, light: np.ndarray) -> SceneObject:
    thing, texture = item.thing, item.thing.texture
    colors = np.where(item.seen[:, None], _surface(thing.slot_colors, light), item.usual).astype(np.float32)
    if texture is not None:
        image = _surface(texture.image.astype(np.float32) / 255, light)
        texture = dataclasses.replace(texture, image=np.round(255 * image).astype(np.uint8))
    return dataclasses.replace(thing, slot_colors=colors, texture=texture)


def _surface(colors: np.ndarray, light: np.ndarray) -> np.ndarray:
    """Colours [..., 3] that surfaces have which show these in a light."""
    return to_srgb(np.clip(to_linear(colors) / light, 0.0, 0.92).astype(np.float32))


def _slot_samples(thing: SceneObject, slot: int) -> np.ndarray:
    faces = thing.faces[thing.face_slot == slot]
    share = max(60, int(_SAMPLES * len(faces) / len(thing.faces)))
    return surface_samples(thing.vertices, faces, share)[0]


def _pixels(points: np.ndarray, sighting: Sighting) -> np.ndarray:
    """[k, 3] colours of the pixels in which points are seen."""
    pixels, z = project_points(sighting.camera, points)
    height, width = sighting.depth.shape
    inside = (z > 0.1) & (pixels >= 0).all(axis=1) & (pixels < [width, height]).all(axis=1)
    x, y = pixels[inside].astype(int).T
    near = np.abs(sighting.depth[y, x] - z[inside]) < 0.03 + 0.02 * z[inside]
    shown = near & sighting.mask[y, x]
    return sighting.rgb[y[shown], x[shown]]
