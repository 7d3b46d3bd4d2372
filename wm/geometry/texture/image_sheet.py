"""Several images side by side in one, for a record that holds only one (`wm.types.Texture`)."""

from collections.abc import Sequence

import numpy as np
from jaxtyping import Float, Int, UInt8

from wm.geometry.texture.packing import filled_image, shelves

RIM = 1  # pixels around every image, copies of its border: bilinear reading at its edge finds no neighbour


def image_sheet(images: Sequence[UInt8[np.ndarray, "_h _w 3"]]) -> tuple[UInt8[np.ndarray, "h w 3"], Int[np.ndarray, "k 2"]]:
    """The images in one, and the (row, column) at which the first pixel of each lies; one image alone stays as it is."""
    if len(images) == 1:
        return images[0], np.zeros((1, 2), np.int64)
    corner, size = shelves(np.array([image.shape[:2] for image in images], np.int64) + 2 * RIM)
    color, known = np.zeros((*size, 3), np.float64), np.zeros(size, bool)
    for (row, column), image in zip(corner, images):
        framed = np.pad(image, ((RIM, RIM), (RIM, RIM), (0, 0)), mode="edge")
        here = np.s_[row : row + framed.shape[0], column : column + framed.shape[1]]
        color[here], known[here] = framed / 255, True
    return filled_image(color, known), corner + RIM


def sheet_uv(
    uv: Float[np.ndarray, "*n 2"], image: UInt8[np.ndarray, "_h _w 3"], corner: Int[np.ndarray, "2"], size: tuple[int, ...]
) -> Float[np.ndarray, "*n 2"]:
    """Texture coordinates of an image as those of the sheet, of (height, width), in which it lies at `corner`."""
    height, width = size[:2]
    pixel = uv * np.array([image.shape[1], image.shape[0]]) + corner[::-1]
    return pixel / np.array([width, height])
