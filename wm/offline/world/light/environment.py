"""What the middle of a room sees all about: the light that polished things reflect.

A map of equal angles: row i is at polar angle (i + 1/2) / h pi from straight up, column j at azimuth (j + 1/2) / w 2 pi.
"""

import numpy as np
from jaxtyping import Float
from scipy.ndimage import gaussian_filter1d

from wm.geometry.rays.raycast import RayScene, cast_rays
from wm.offline.world.light.luxels import LightPoints, locate

ROWS, COLUMNS = 48, 96
BLUR = 1.3
"""Standard deviation in map pixels (3.75 degrees): brushed metal, not a mirror."""


def environment(
    scene: RayScene, points: LightPoints, table: Float[np.ndarray, "n 3"], eye: Float[np.ndarray, "3"]
) -> Float[np.ndarray, "h w 3"]:
    """The map around `eye`; `table` holds the radiance of every light point, and last that of anything else."""
    polar = (np.arange(2 * ROWS) + 0.5) / (2 * ROWS) * np.pi
    azimuth = (np.arange(2 * COLUMNS) + 0.5) / (2 * COLUMNS) * 2 * np.pi
    p, a = np.meshgrid(polar, azimuth, indexing="ij")
    directions = np.stack([np.sin(p) * np.cos(a), np.sin(p) * np.sin(a), np.cos(p)], axis=-1).reshape(-1, 3)
    hits = cast_rays(scene, np.broadcast_to(eye, directions.shape).astype(np.float32), directions.astype(np.float32))
    seen = np.minimum(table[locate(points, hits.face, hits.barycentric)], 3.0)
    image = seen.reshape(ROWS, 2, COLUMNS, 2, 3).mean(axis=(1, 3))
    image = gaussian_filter1d(image, BLUR, axis=0, mode="nearest")
    return gaussian_filter1d(image, BLUR, axis=1, mode="wrap").astype(np.float32)


def look_up(image: Float[np.ndarray, "h w 3"], directions: Float[np.ndarray, "n 3"]) -> Float[np.ndarray, "n 3"]:
    """Bilinear colours of a map in unit directions."""
    rows, columns = image.shape[:2]
    y = np.arccos(np.clip(directions[:, 2], -1, 1)) * np.float32(rows / np.pi) - np.float32(0.5)
    x = np.arctan2(directions[:, 1], directions[:, 0]) * np.float32(columns / (2 * np.pi)) - np.float32(0.5)
    y = np.clip(y, 0, rows - 1)
    i, j = y.astype(np.int32), np.floor(x).astype(np.int32)
    fy, fx = (y - i)[:, None].astype(np.float32), (x - j)[:, None].astype(np.float32)
    low, high = np.mod(j, columns), np.mod(j + 1, columns)
    below = np.minimum(i + 1, rows - 1)
    top = image[i, low] * (1 - fx) + image[i, high] * fx
    bottom = image[below, low] * (1 - fx) + image[below, high] * fx
    return top * (1 - fy) + bottom * fy
