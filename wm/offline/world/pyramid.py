"""Mip pyramids over many rectangular images of one texel size, sampled trilinearly; finished surfaces are looked up in them.

Level k halves level k - 1 (the mean of 2 x 2, the last row or column repeated where the size is odd) until a side is 1. Texels
are sRGB in 16 bits per channel, four channels in one 64-bit word, so that a look-up is one gather.
"""

import dataclasses

import numpy as np
from jaxtyping import Float, Int

LEVELS = 8


@dataclasses.dataclass(frozen=True, eq=False)
class Pyramid:
    """Images with their levels, in one flat array."""

    texel: float  # metres at level 0
    words: np.ndarray  # [t] uint64: red, green, blue, 0 from the low end, 16 bits each
    start: np.ndarray  # [c, LEVELS] int32 first texel of each level of each image
    shape: np.ndarray  # [c, LEVELS, 2] int32 rows, columns


def build_pyramid(images: list[np.ndarray], texel: float) -> Pyramid:
    """The pyramid of images [h, w, 3] float32 in [0, 1]."""
    starts, shapes, parts = np.zeros((len(images), LEVELS), np.int32), np.zeros((len(images), LEVELS, 2), np.int32), []
    total = 0
    for number, image in enumerate(images):
        level_image = image
        for level in range(LEVELS):
            starts[number, level], shapes[number, level] = total, level_image.shape[:2]
            parts.append(_pack(level_image))
            total += parts[-1].size
            level_image = _halve(level_image)
    return Pyramid(texel=texel, words=np.concatenate(parts), start=starts, shape=shapes)


def sample_pyramid(
    pyramid: Pyramid,
    image: Int[np.ndarray, "n"],
    s: Float[np.ndarray, "n"],
    t: Float[np.ndarray, "n"],
    footprint: Float[np.ndarray, "n"],
) -> Float[np.ndarray, "n 3"]:
    """Colour of images at (s, t) metres along columns and rows, averaged over about `footprint` metres.

    Beyond an image's edge its last texels continue.
    """
    level = np.clip(np.log2(np.maximum(footprint, 1e-6) / np.float32(pyramid.texel)), 0, LEVELS - 1.001).astype(np.float32)
    coarse = level.astype(np.int32)
    part = (level - coarse)[:, None]
    fine_color = _bilinear(pyramid, image, s, t, coarse)
    mixed = np.flatnonzero(level > 0)
    coarse_color = _bilinear(pyramid, image[mixed], s[mixed], t[mixed], coarse[mixed] + 1)
    fine_color[mixed] += part[mixed] * (coarse_color - fine_color[mixed])
    return fine_color[:, :3]


def _bilinear(pyramid: Pyramid, image: np.ndarray, s: np.ndarray, t: np.ndarray, level: np.ndarray) -> np.ndarray:
    scale = (np.float32(1 / pyramid.texel) * np.exp2(-level.astype(np.float32))).astype(np.float32)
    x, y = s * scale - np.float32(0.5), t * scale - np.float32(0.5)
    key = image * LEVELS + level
    rows, columns = pyramid.shape.reshape(-1, 2)[key].T
    start = pyramid.start.reshape(-1)[key]
    x, y = np.clip(x, 0, columns - 1), np.clip(y, 0, rows - 1)
    j, i = x.astype(np.int32), y.astype(np.int32)
    fx, fy = (x - j).astype(np.float32)[:, None], (y - i).astype(np.float32)[:, None]
    right = np.minimum(j + 1, columns - 1)
    low, high = start + i * columns, start + np.minimum(i + 1, rows - 1) * columns
    top = _unpack(pyramid.words[low + j])
    top += fx * (_unpack(pyramid.words[low + right]) - top)
    bottom = _unpack(pyramid.words[high + j])
    bottom += fx * (_unpack(pyramid.words[high + right]) - bottom)
    top += fy * (bottom - top)
    top *= np.float32(1 / 65535)
    return top


def _pack(image: np.ndarray) -> np.ndarray:
    quantised = np.zeros((*image.shape[:2], 4), np.uint16)
    quantised[..., :3] = np.clip(image * 65535 + 0.5, 0, 65535)
    return quantised.reshape(-1).view(np.uint64)


def _unpack(words: np.ndarray) -> np.ndarray:
    return words.view(np.uint16).reshape(-1, 4).astype(np.float32)


def _halve(image: np.ndarray) -> np.ndarray:
    rows, columns = image.shape[:2]
    if rows % 2 and rows > 1:
        image = np.concatenate([image, image[-1:]])
    if columns % 2 and columns > 1:
        image = np.concatenate([image, image[:, -1:]], axis=1)
    if image.shape[0] > 1:
        image = (image[0::2] + image[1::2]) * np.float32(0.5)
    if image.shape[1] > 1:
        image = (image[:, 0::2] + image[:, 1::2]) * np.float32(0.5)
    return image
