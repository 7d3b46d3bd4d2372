"""Reading the texture atlas from a camera: bilinear over the texels that are known.

A pixel's hit point has chart coordinates (column, row) = depth A (x, y, 1) + b, with A [2, 3] and b [2] of its chart. Of the four
texels around it each counts with its bilinear share times its opacity a = min(weight / opaque weight, 1), so colour never comes
from unknown texels or from beyond an edge and fades in without a jump: colour = sum s a c / sum s a, alpha = sum s a / sum s,
sums over texels inside the surface.
"""

import numpy as np
from jaxtyping import Float

from wm.schema import TextureSettings
from wm.types import Atlas, Camera, GBuffer

_DEFAULTS = TextureSettings()
_BLOCK = 1 << 14  # pixels at a time: their arrays stay in the cache, and the allocator reuses them


def sample_atlas(
    atlas: Atlas, gbuffer: GBuffer, camera: Camera, settings: TextureSettings = _DEFAULTS
) -> tuple[Float[np.ndarray, "h w 3"], Float[np.ndarray, "h w"]]:
    """The accumulated texture as a camera sees it.

    Args:
      atlas: the texture.
      gbuffer: what the camera sees of the mesh the atlas was built from (or one that begins with its faces).
      camera: the camera of that G-buffer.
      settings: `opaque_weight` says at which weight a texel counts as fully known.

    Returns:
      rgb [h, w, 3] float32 (0 where nothing is known) and alpha [h, w] float32 in [0, 1] (0 off the atlas).

    Raises:
      ValueError: the G-buffer is not of the camera's size.
    """
    check_camera_of(gbuffer, camera)
    chart = pixel_charts(atlas, gbuffer).ravel()
    depth = gbuffer.depth.ravel()
    rgb = np.zeros((len(chart), 3), np.float32)
    alpha = np.zeros(len(chart), np.float32)
    on_atlas = np.flatnonzero(chart >= 0)
    for first in range(0, len(on_atlas), _BLOCK):
        pixels = on_atlas[first : first + _BLOCK]
        column, row = _chart_coordinates(atlas, camera, chart[pixels], pixels, depth[pixels])
        rgb[pixels], alpha[pixels] = _bilinear(atlas, chart[pixels], column, row, settings.opaque_weight)
    return rgb.reshape(*gbuffer.depth.shape, 3), alpha.reshape(gbuffer.depth.shape)


def _bilinear(
    atlas: Atlas, chart: np.ndarray, column: np.ndarray, row: np.ndarray, opaque_weight: float
) -> tuple[np.ndarray, np.ndarray]:
    """Colour [n, 3] and alpha [n] at positions (column, row), in texel indices, of charts [n]."""
    left, top = np.floor(column), np.floor(row)
    fx, fy = column - left, row - top
    left, top = left.astype(np.intp), top.astype(np.intp)
    rows, columns = atlas.chart_shape.astype(np.intp).T
    width, start = columns[chart], atlas.chart_start[chart]
    last_row, last_column = rows[chart] - 1, width - 1
    sides = ((np.clip(left, 0, last_column), 1 - fx), (np.clip(left + 1, 0, last_column), fx))
    color = np.zeros((3, len(chart)), np.float32)
    total = np.zeros(len(chart), np.float32)
    known = np.zeros(len(chart), np.float32)
    for i, share_y in ((top, 1 - fy), (top + 1, fy)):
        line = start + np.clip(i, 0, last_row) * width
        for j, share_x in sides:
            texel = line + j
            fetched = atlas.color.take(texel, axis=0)
            share = share_x * share_y * atlas.inside.take(texel)
            total += share
            share *= np.minimum(atlas.weight.take(texel) / np.float32(opaque_weight), 1)
            known += share
            for k in range(3):
                color[k] += share * fetched[:, k]
    color /= np.where(known > 0, known, 1)
    return color.T, np.minimum(known / np.where(total > 0, total, 1), 1)


def check_camera_of(gbuffer: GBuffer, camera: Camera) -> None:
    """Raises: ValueError if a G-buffer is not as large as the images of the camera it is said to be of."""
    if gbuffer.depth.shape != (camera.height, camera.width):
        found = " x ".join(map(str, gbuffer.depth.shape))
        raise ValueError(f"the G-buffer of another camera: it has {found} pixels, the camera {camera.height} x {camera.width}")


def pixel_charts(atlas: Atlas, gbuffer: GBuffer) -> np.ndarray:
    """[h, w] int32 the chart that each pixel sees, -1 for objects and misses."""
    table = np.append(atlas.face_chart, np.int32(-1))  # faces beyond the atlas's mesh are objects; -1 finds the last entry
    return table[np.minimum(gbuffer.face, len(atlas.face_chart))]


def _chart_coordinates(
    atlas: Atlas, camera: Camera, chart: np.ndarray, pixels: np.ndarray, depth: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """(column, row) in texel indices (a texel's centre is at its index) of the surface points that pixels see at a depth."""
    R_cam_world, t = camera.T_cam_world[:3, :3], camera.T_cam_world[:3, 3]
    (fx, fy), (cx, cy) = camera.focal, camera.principal
    unproject = np.array([[1 / fx, 0, (0.5 - cx) / fx], [0, 1 / fy, (0.5 - cy) / fy], [0, 0, 1]])  # from pixel indices
    to_eye = -R_cam_world.T @ t - atlas.chart_origin
    y, x = (k.astype(np.float32) for k in np.divmod(pixels, camera.width))
    coordinates = []
    for axis in (atlas.chart_u, atlas.chart_v):
        ray = (axis @ R_cam_world.T @ unproject / atlas.texel_size).astype(np.float32)
        eye = (np.einsum("ci,ci->c", to_eye, axis) / atlas.texel_size - 0.5).astype(np.float32)
        slope = ray[chart, 0] * x + ray[chart, 1] * y + ray[chart, 2]
        coordinates.append(depth * slope + eye[chart])
    return coordinates[0], coordinates[1]
