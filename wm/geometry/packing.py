"""Laying rectangles side by side into one image: shelves, tallest first."""

import numpy as np
from jaxtyping import Int


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
