"""Imperfections that images of models have: errors of tone, exposure, fine detail and sharpness.

Each function returns an image with one imperfection of a given strength. At strength 0 it returns the image unchanged.
"""

import numpy as np
from jaxtyping import Float, Int
from scipy.ndimage import gaussian_filter, zoom

from wm.types import OUTSIDE

REFERENCE_WIDTH = 1376
"""Image width for which lengths in pixels are given: that of the paper's images."""
EDDY = 40.0
"""Distance, in pixels at the reference width, over which the displacement of detail is correlated."""


def drifted(image: Float[np.ndarray, "h w 3"], amount: float, rng: np.random.Generator) -> Float[np.ndarray, "h w 3"]:
    """The image with a gain and a hue that vary smoothly: one value for the view, plus a field of 3 x 4 knots."""
    whole = rng.normal(size=3) * 0.35 + rng.normal()
    knots = rng.normal(size=(3, 4, 3)) * 0.35 + rng.normal(size=(3, 4, 1)) * 0.35
    if amount == 0:
        return image
    height, width = image.shape[:2]
    field = np.stack([_stretched(knots[..., c], height, width) for c in range(3)], axis=-1)
    return image * (1 + np.float32(amount) * (whole + field)).astype(np.float32)


def drifted_apart(
    image: Float[np.ndarray, "h w 3"], thing: Int[np.ndarray, "h w"], amount: float, rng: np.random.Generator
) -> Float[np.ndarray, "h w 3"]:
    """The image with a separate gain and hue for each object, as if a model invented its colours anew in each view."""
    count = int(thing.max(initial=OUTSIDE)) + 2
    gains = (1 + amount * (rng.normal(size=(count, 3)) * 0.7 + rng.normal(size=(count, 1)))).astype(np.float32)
    gains[0] = 1  # structure
    return image * np.maximum(gains[thing + 1], 0.2)


def exposed(image: Float[np.ndarray, "h w 3"], amount: float, rng: np.random.Generator) -> Float[np.ndarray, "h w 3"]:
    """The whole image made brighter or darker, and a little warmer or colder. `amount` is the standard deviation of the gain."""
    gain = 1 + amount * (rng.normal() + 0.3 * rng.normal(size=3))
    return image if amount == 0 else image * np.maximum(gain, 0.2).astype(np.float32)


def strayed(
    image: Float[np.ndarray, "h w 3"], surface: Int[np.ndarray, "h w"], pixels: float, rng: np.random.Generator
) -> Float[np.ndarray, "h w 3"]:
    """The image with its detail displaced by about `pixels` (at the reference width), while silhouettes stay in place.

    Args:
      surface: [h, w] number of the surface at each pixel; a pixel whose colour would come from another surface keeps its own.
    """
    height, width = surface.shape
    scale = width / REFERENCE_WIDTH
    noise = rng.normal(size=(2, max(round(height / (EDDY * scale)), 2) + 1, max(round(width / (EDDY * scale)), 2) + 1))
    if pixels == 0:
        return image
    shift = np.stack([_stretched(noise[k], height, width) for k in range(2)]) * pixels * scale
    i, j = np.mgrid[:height, :width]
    rows, columns = np.clip(i + shift[0], 0, height - 1), np.clip(j + shift[1], 0, width - 1)
    top, left = np.floor(rows).astype(int), np.floor(columns).astype(int)
    bottom, right = np.minimum(top + 1, height - 1), np.minimum(left + 1, width - 1)
    a, b = (rows - top)[..., None].astype(np.float32), (columns - left)[..., None].astype(np.float32)
    corners = ((top, left), (top, right), (bottom, left), (bottom, right))
    moved = (1 - a) * ((1 - b) * image[corners[0]] + b * image[corners[1]])
    moved += a * ((1 - b) * image[corners[2]] + b * image[corners[3]])
    same = np.all([surface[corner] == surface for corner in corners], axis=0)
    return np.where(same[..., None], moved, image)


def softened(image: Float[np.ndarray, "h w 3"], pixels: float) -> Float[np.ndarray, "h w 3"]:
    """The image blurred by a gaussian with a standard deviation of `pixels` (at the reference width)."""
    sigma = pixels * image.shape[1] / REFERENCE_WIDTH
    return image if pixels == 0 else gaussian_filter(image, (sigma, sigma, 0), mode="nearest")


def _stretched(knots: np.ndarray, height: int, width: int) -> np.ndarray:
    rows, columns = knots.shape
    stretched = zoom(knots, (max(height, rows) / rows, max(width, columns) / columns), order=1, mode="nearest", grid_mode=True)
    return np.asarray(stretched)[:height, :width]
