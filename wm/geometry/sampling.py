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
    """
    shape = gbuffer.depth.shape
    chart = pixel_charts(atlas, gbuffer).ravel()
    pixels = np.flatnonzero(chart >= 0)
    chart = chart[pixels]
    column, row = _chart_coordinates(atlas, camera, chart, pixels, gbuffer.depth.ravel()[pixels])
    column -= 0.5
    row -= 0.5
    left, top = np.floor(column).astype(np.int64), np.floor(row).astype(np.int64)
    fx, fy = (column - left).astype(np.float32), (row - top).astype(np.float32)
    rows, columns = atlas.chart_shape[chart, 0], atlas.chart_shape[chart, 1]
    start = atlas.chart_start[chart]

    total = np.zeros(len(pixels), np.float32)
    known = np.zeros(len(pixels), np.float32)
    color = np.zeros((len(pixels), 3), np.float32)
    for i, share_y in ((top, 1 - fy), (top + 1, fy)):
        line = start + np.clip(i, 0, rows - 1) * columns
        for j, share_x in ((left, 1 - fx), (left + 1, fx)):
            texel = line + np.clip(j, 0, columns - 1)
            share = share_x * share_y * atlas.inside[texel]
            total += share
            share *= np.minimum(atlas.weight[texel] / np.float32(settings.opaque_weight), 1)
            known += share
            color += share[:, None] * atlas.color[texel]
    rgb = np.zeros((shape[0] * shape[1], 3), np.float32)
    alpha = np.zeros(shape[0] * shape[1], np.float32)
    rgb[pixels] = color / np.where(known > 0, known, 1)[:, None]
    alpha[pixels] = np.minimum(known / np.where(total > 0, total, 1), 1)
    return rgb.reshape(*shape, 3), alpha.reshape(shape)


def pixel_charts(atlas: Atlas, gbuffer: GBuffer) -> np.ndarray:
    """[h, w] int32 the chart that each pixel sees, -1 for objects and misses."""
    table = np.append(atlas.face_chart, np.int32(-1))  # faces beyond the atlas's mesh are objects; -1 finds the last entry
    return table[np.minimum(gbuffer.face, len(atlas.face_chart))]


def _chart_coordinates(
    atlas: Atlas, camera: Camera, chart: np.ndarray, pixels: np.ndarray, depth: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """(column, row) in texels, measured from the chart's origin, of the surface points that pixels see at a depth."""
    R_cam_world, t = camera.T_cam_world[:3, :3], camera.T_cam_world[:3, 3]
    (fx, fy), (cx, cy) = camera.focal, camera.principal
    unproject = np.array([[1 / fx, 0, (0.5 - cx) / fx], [0, 1 / fy, (0.5 - cy) / fy], [0, 0, 1]])  # from pixel indices
    to_eye = -R_cam_world.T @ t - atlas.chart_origin
    y, x = np.divmod(pixels, camera.width)
    coordinates = []
    for axis in (atlas.chart_u, atlas.chart_v):
        ray = axis @ R_cam_world.T @ unproject / atlas.texel_size
        eye = np.einsum("ci,ci->c", to_eye, axis) / atlas.texel_size
        slope = ray[chart, 0] * x + ray[chart, 1] * y + ray[chart, 2]
        coordinates.append(depth * slope + eye[chart])
    return coordinates[0], coordinates[1]
