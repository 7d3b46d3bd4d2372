"""Laying rectangles side by side into one image (shelves, tallest first), and filling what is left between them."""

import numpy as np
from jaxtyping import Bool, Float, Int, UInt8
from scipy.ndimage import distance_transform_edt


def shelves(shapes: Int[np.ndarray, "k 2"]) -> tuple[Int[np.ndarray, "k 2"], tuple[int, int]]:
    """Where rectangles (rows, columns) lie, as (row, column) of their first pixels, and the size of the nearly square whole."""
    width = max(int(shapes[:, 1].max()), int(np.ceil(np.sqrt(shapes.prod(axis=1, dtype=np.int64).sum()))))
    corner = np.zeros(shapes.shape, np.int64)
    x = top = bottom = 0
    for k in np.lexsort((-shapes[:, 1], -shapes[:, 0])):
        rows, columns = shapes[k]
        if x + columns > width:
            x, top = 0, bottom
        corner[k] = top, x
        x += int(columns)
        bottom = max(bottom, top + int(rows))
    return corner, (int(bottom), width)


def filled_image(color: Float[np.ndarray, "h w 3"], known: Bool[np.ndarray, "h w"]) -> UInt8[np.ndarray, "h w 3"]:
    """Colours in [0, 1] as 8 bits, each unknown pixel with that of the nearest known one; at least one is known."""
    if not known.all():
        nearest = np.empty((2, *known.shape), np.int32)
        distance_transform_edt(~known, return_distances=False, return_indices=True, indices=nearest)
        color = color[nearest[0], nearest[1]]
    return np.round(np.clip(color, 0, 1) * 255).astype(np.uint8)
