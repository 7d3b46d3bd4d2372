"""The size at which a model draws a view, where it cannot draw every size, and images scaled between the two.

The whole image is scaled, along each axis by its own factor. Corner falls on corner, so that what is scaled back registers with
the view without a shift, and nothing is cut off or filled in; the price is a slight difference of the two factors.
"""

import itertools
import math

import numpy as np
from jaxtyping import Float
from PIL import Image


def canvas_size(
    width: int, height: int, *, multiple: int, largest: int, smallest: int = 1, least_side: int = 1
) -> tuple[int, int]:
    """(width, height) of the canvas for a view: multiples of `multiple`, near the view's own size.

    Of the sizes around it, the one that distorts the image least is taken, and of those the largest.

    Args:
      width, height: of the view, pixels.
      multiple: of which both sides are multiples, pixels.
      largest, smallest: bounds of the area, pixels; the view is scaled down or up to keep them.
      least_side: of each side, pixels.

    Raises:
      ValueError: no canvas keeps the bounds: the view is too long for its height, or too high for its width.
    """
    scale = max(1.0, math.sqrt(smallest / (width * height)), least_side / min(width, height))
    scale = min(scale, math.sqrt(largest / (width * height)))

    def sides(length: int) -> list[int]:
        near = math.floor(length * scale / multiple)
        return [multiple * k for k in range(near - 1, near + 3) if multiple * k >= max(least_side, 1)]

    fitting = [(w, h) for w, h in itertools.product(sides(width), sides(height)) if w * h <= largest]
    if not fitting:
        raise ValueError(f"no canvas of at most {largest} pixels with sides from {least_side} suits a view of {width} x {height}")
    return min(fitting, key=lambda size: (round(abs(math.log(size[0] / width * height / size[1])), 9), -size[0] * size[1]))


def scaled(rgb: Float[np.ndarray, "h w 3"], width: int, height: int) -> Float[np.ndarray, "h2 w2 3"]:
    """An image in [0, 1], resampled to another size by Lanczos' filter with the corners kept; unchanged if it has that size."""
    if rgb.shape[:2] == (height, width):
        return rgb.astype(np.float32)
    channels = [Image.fromarray(rgb[..., k].astype(np.float32)) for k in range(3)]
    resized = [np.asarray(channel.resize((width, height), Image.Resampling.LANCZOS)) for channel in channels]
    return np.clip(np.stack(resized, axis=-1), 0, 1)
