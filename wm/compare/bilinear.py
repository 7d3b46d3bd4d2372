"""Values of an image between its pixels."""

import numpy as np
from jaxtyping import Float


def bilinear(values: Float[np.ndarray, "h w c"], uv: Float[np.ndarray, "n 2"]) -> Float[np.ndarray, "n c"]:
    """Values at positions in pixels: the first pixel's centre is (0.5, 0.5), and beyond the outer centres the border goes on."""
    last = np.array([values.shape[1], values.shape[0]]) - 1
    at = np.clip(uv - 0.5, 0, last)
    low = np.floor(at).astype(np.int64)
    (i, j), (right, below) = low.T, np.minimum(low + 1, last).T
    x, y = (at - low).T[..., None].astype(values.dtype)
    upper = values[j, i] * (1 - x) + values[j, right] * x
    lower = values[below, i] * (1 - x) + values[below, right] * x
    return upper * (1 - y) + lower * y
