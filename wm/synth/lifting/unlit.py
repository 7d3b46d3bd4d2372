"""Colours of surfaces, separated from the light that images show them in.

Reconstructed instances have the colours of lit surfaces, and the scaffold needs the colours of the surfaces themselves. The light
is estimated as what all instances in a room have in common: the median over their slots, per channel and in linear light, of the
ratio of the colour seen to the usual colour of the same material.
"""

import dataclasses
from collections.abc import Sequence

import numpy as np

from wm.color import to_linear, to_srgb
from wm.synth.backends import Reconstruction
from wm.types import SceneObject


def unlit(things: Sequence[Reconstruction]) -> list[SceneObject]:
    """The instances with the colours of their surfaces instead of their colours in the room's light."""
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
    """sRGB colours [..., 3] of the surfaces that show `colors` in this light."""
    return to_srgb(np.clip(to_linear(colors) / light, 0.0, 0.92).astype(np.float32))
