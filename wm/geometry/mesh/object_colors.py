"""The base colours of objects at points of their faces: their texture where they have one, else the colour of the slot.

A texture is read bilinearly between the centres of its pixels, which lie at ((i + 1/2) / w, (j + 1/2) / h).
"""

from collections.abc import Sequence

import numpy as np
from jaxtyping import Float, Int

from wm.types import SceneObject, Texture


def object_colors(
    objects: Sequence[SceneObject],
    thing: Int[np.ndarray, "n"],
    face: Int[np.ndarray, "n"],
    barycentric: Float[np.ndarray, "n 2"],
) -> Float[np.ndarray, "n 3"]:
    """sRGB base colours, float32.

    Args:
      objects: the things.
      thing: index of each point's object.
      face: index of its face among that object's.
      barycentric: (u, v) in that face: p = (1 - u - v) p0 + u p1 + v p2.
    """
    rgb = np.zeros((len(thing), 3), np.float32)
    order = np.argsort(thing, kind="stable")
    present, first = np.unique(thing[order], return_index=True)
    for k, mine in zip(present, np.split(order, first[1:])):
        one = objects[int(k)]
        slot = one.face_slot[face[mine]]
        rgb[mine] = one.slot_colors[slot]
        if one.texture is not None:
            shown = mine[one.texture.slots[slot]]
            rgb[shown] = texture_colors(one.texture, face[shown], barycentric[shown])
    return rgb


def texture_colors(
    texture: Texture, face: Int[np.ndarray, "n"], barycentric: Float[np.ndarray, "n 2"]
) -> Float[np.ndarray, "n 3"]:
    """sRGB colours of a texture at points of faces, float32."""
    a, b = barycentric[:, :1], barycentric[:, 1:]
    corner = texture.corner_uv[face]
    uv = (1 - a - b) * corner[:, 0] + a * corner[:, 1] + b * corner[:, 2]
    height, width = texture.image.shape[:2]
    x = np.clip(uv[:, 0] * width - 0.5, 0, width - 1)
    y = np.clip(uv[:, 1] * height - 0.5, 0, height - 1)
    j, i = x.astype(np.intp), y.astype(np.intp)
    fx, fy = (x - j).astype(np.float32)[:, None], (y - i).astype(np.float32)[:, None]
    right, below = np.minimum(j + 1, width - 1), np.minimum(i + 1, height - 1)
    top = (1 - fx) * texture.image[i, j] + fx * texture.image[i, right]
    bottom = (1 - fx) * texture.image[below, j] + fx * texture.image[below, right]
    return ((1 - fy) * top + fy * bottom) * np.float32(1 / 255)
