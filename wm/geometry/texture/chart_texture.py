"""The charts of an object packed into one image, for whoever looks colours up by face: the object's texture.

Charts are laid on shelves, each with a rim of its own border colours, so that reading between pixels never finds a neighbour.
Charts of which nothing is known take a pixel of plain colour, shared by all of that colour; charts of a single texel take that
pixel. So the size of the image follows from the known surface alone.
"""

import numpy as np
from jaxtyping import Float, UInt8

from wm.geometry.texture.atlas import texel_charts
from wm.geometry.texture.packing import filled_image, shelves
from wm.types import Atlas

RIM = 1  # pixels around every chart of more than one texel: what bilinear lookups reach (atlas_export allows for mipmaps)


def chart_texture(
    atlas: Atlas, corners: Float[np.ndarray, "f 3 3"], plain: Float[np.ndarray, "c 3"]
) -> tuple[UInt8[np.ndarray, "h w 3"], Float[np.ndarray, "f 3 2"]]:
    """(image, uv of each face's corners), as `wm.types.Texture` has them; faces without a chart look up the first pixel.

    Args:
      atlas: an object's texels; those inside a chart that is known anywhere have a colour.
      corners: of the faces that the atlas was built from, metres, where they were then.
      plain: colours of the charts of which nothing is known, sRGB.
    """
    texel_chart = texel_charts(atlas)
    known = np.bincount(texel_chart[atlas.inside & (atlas.weight > 0)], minlength=len(plain)) > 0
    swatches, swatch = np.unique(plain[~known], axis=0, return_inverse=True)
    single = (atlas.chart_shape == 1).all(axis=1)
    rim = np.where(single, 0, RIM)
    shapes = np.concatenate([np.ones((len(swatches), 2), np.int64), (atlas.chart_shape + 2 * rim[:, None])[known]])
    place, size = shelves(shapes)
    corner = np.zeros((len(plain), 2), np.int64)  # row and column of each chart's first texel
    corner[known] = place[len(swatches) :] + rim[known, None]
    corner[~known] = place[: len(swatches)][swatch.ravel()]

    color, filled = np.zeros((*size, 3), np.float32), np.zeros(size, bool)
    at = tuple(place[: len(swatches)].T)
    color[at], filled[at] = swatches, True
    texel = np.flatnonzero(atlas.inside & known[texel_chart])
    chart = texel_chart[texel]
    row, column = np.divmod(texel - atlas.chart_start[chart], atlas.chart_shape[chart, 1])
    at = row + corner[chart, 0], column + corner[chart, 1]
    color[at], filled[at] = atlas.color[texel], True
    return filled_image(color, filled), _corner_uv(atlas, corners, corner, size, flat=single | ~known)


def _corner_uv(atlas: Atlas, corners: np.ndarray, corner: np.ndarray, size: tuple[int, int], *, flat: np.ndarray) -> np.ndarray:
    """[f, 3, 2] (u, v): across a face's chart, or of charts of one colour in the middle of their pixel."""
    chart = np.maximum(atlas.face_chart, 0)
    offset = (corners - atlas.chart_origin[chart][:, None]) / atlas.texel_size
    uv = np.stack([np.einsum("fki,fi->fk", offset, axis[chart]) for axis in (atlas.chart_u, atlas.chart_v)], axis=-1)
    uv = np.where(flat[chart][:, None, None], 0.5, uv) + corner[chart][:, None, ::-1]
    uv = np.where((atlas.face_chart < 0)[:, None, None], 0.0, uv / np.array(size[::-1]))
    return uv.astype(np.float32)
