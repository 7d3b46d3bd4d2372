"""A mask as a picture that lies over the image: filled in a colour that the image shines through, with a firm border."""

import io

import numpy as np
from jaxtyping import Bool
from PIL import Image
from scipy import ndimage

COLORS = ("#e6194b", "#3cb44b", "#4363d8", "#f58231", "#911eb4", "#0aa5a5", "#d61fc4", "#7a8f00", "#9a6324", "#1f77b4")
"""Those of the things of an image, in turn; page.js gives the same to their names."""
_FILL, _BORDER = 110, 255
"""Opacity, of 255."""


def overlay(mask: Bool[np.ndarray, "h w"], color: str) -> bytes:
    """A PNG of the mask's size, transparent outside it. `color` is like "#e6194b"."""
    rgba = np.zeros((*mask.shape, 4), np.uint8)
    rgba[..., :3] = [int(color[k : k + 2], 16) for k in (1, 3, 5)]
    inner = np.asarray(ndimage.binary_erosion(mask, iterations=2))
    rgba[..., 3] = np.where(inner, _FILL, np.where(mask, _BORDER, 0))
    buffer = io.BytesIO()
    Image.fromarray(rgba).save(buffer, format="PNG", compress_level=1)
    return buffer.getvalue()
