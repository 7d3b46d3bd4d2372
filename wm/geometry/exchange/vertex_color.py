"""Colours given at the corners of faces, as few slots where faces are of one colour each, and else as a texture.

In that texture every face (those of the same three colours together) has a block of 2 x 2 pixels: its corners' colours, and
their continuation c1 + c2 - c0 in the fourth. Read bilinearly between the pixels' centres this is the linear interpolation that
vertex colours mean, exactly, but where the fourth colour would leave [0, 1] and is clipped.
"""

import numpy as np
from jaxtyping import Float, Int, UInt8

MOST_SLOTS = 64
"""Colours up to which faces of one colour each become slots, as furniture has them, and not a texture."""


def face_colors(corner_colors: UInt8[np.ndarray, "f 3 3"]) -> tuple[UInt8[np.ndarray, "s 3"], Int[np.ndarray, "f"]] | None:
    """The colours of faces that are of one colour each, and which each face has; None where they are too many, or blend."""
    if not (corner_colors == corner_colors[:, :1]).all():
        return None
    colors, face_color = np.unique(corner_colors[:, 0], axis=0, return_inverse=True)
    return (colors, face_color.reshape(-1)) if len(colors) <= MOST_SLOTS else None


def blended(corner_colors: UInt8[np.ndarray, "f 3 3"]) -> tuple[UInt8[np.ndarray, "h w 3"], Float[np.ndarray, "f 3 2"]]:
    """The texture of faces whose corners have colours, and the texture coordinates of those corners."""
    triples, block = np.unique(corner_colors.reshape(-1, 9), axis=0, return_inverse=True)
    first, second, third = (triples[:, 3 * k : 3 * k + 3].astype(np.int64) for k in range(3))
    fourth = np.clip(second + third - first, 0, 255)
    across = int(np.ceil(np.sqrt(len(triples))))
    down = -(-len(triples) // across)
    image = np.zeros((2 * down, 2 * across, 3), np.uint8)
    row, column = np.divmod(np.arange(len(triples)), across)
    for i, j, color in ((0, 0, first), (0, 1, second), (1, 0, third), (1, 1, fourth)):
        image[2 * row + i, 2 * column + j] = color
    origin = np.stack([2 * column, 2 * row], axis=1)[block.reshape(-1)] + 0.5
    corner = np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]])
    return image, (origin[:, None] + corner) / np.array([2 * across, 2 * down])
