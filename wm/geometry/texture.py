"""Projecting images back into the texture atlas (paper, "Scaffold Mesh Texturing Details").

A texel takes colour from a view where it is seen, with the weight
    w = facing * resolution * fade * purity,
facing from the cosine between normal and view (0 at `min_facing`, 1 head-on), resolution = min(1, pixels per texel), fade from
0 at the image's border to 1 a tenth of the image inside, purity from how much of the neighbourhood shows the same surface
(pixels on an outline mix two surfaces). Colour is the weighted running mean over views, in the images' own sRGB encoding: what
is averaged is what image models see and write, and views of one surface differ by little.

Seen: one of the four pixels around the texel's projection shows the texel's own chart, and the texel is no deeper than the
deepest of those by more than `occlusion_tolerance`. The paper compares depth alone, with 0.10 m; that lets everything within 10
cm of a wall leak onto it. Comparing surfaces lets nothing through but the width of an outline.

Tiers of work: per chart in view, the projection is affine in (row, column); per texel in the image, gathers.
"""

import dataclasses

import numpy as np
from jaxtyping import Bool, Float

from wm.geometry.atlas import chart_image
from wm.geometry.sampling import pixel_charts
from wm.schema import TextureSettings
from wm.types import Atlas, Camera, GBuffer

_DEFAULTS = TextureSettings()
_FADE = 0.1  # share of the image's smaller side over which a view fades in from its border
_NEAR = 1e-3  # metres: texels closer to the camera's plane are behind it


@dataclasses.dataclass(frozen=True, eq=False)
class _Projected:
    """Texels that fall into the image, of all charts in view one after the other."""

    texel: np.ndarray  # [n] int64 index into the atlas
    chart: np.ndarray  # [n] int32
    x: np.ndarray  # [n] float32 column, in pixel indices (a pixel's centre is at its index)
    y: np.ndarray  # [n] float32 row, likewise
    depth: np.ndarray  # [n] float32 metres


def accumulate(
    atlas: Atlas,
    gbuffer: GBuffer,
    camera: Camera,
    rgb: Float[np.ndarray, "h w 3"],
    room: int,
    settings: TextureSettings = _DEFAULTS,
    *,
    usable: Bool[np.ndarray, "h w"] | None = None,
) -> Atlas:
    """The atlas with one view's colours added to the surfaces of one room.

    Args:
      atlas: the texture so far; it is not changed.
      gbuffer: what the camera sees of the true scaffold: the mesh the atlas was built from (or one that begins with its faces).
      camera: the camera of that G-buffer.
      rgb: the view's image, sRGB in [0, 1].
      room: the view's room; surfaces of other rooms are left alone, though the view may see them through a door.
      settings: facing, occlusion and texel knobs.
      usable: pixels that may be used; None for all.

    Returns:
      An atlas that shares all but colour and weight with the given one.
    """
    shown = pixel_charts(atlas, gbuffer)
    mine = np.append(atlas.chart_room == room, False)
    wanted = mine[shown] if usable is None else mine[shown] & usable
    shown = np.where(wanted, shown, np.int32(-1))
    projected = _project(atlas, camera, np.flatnonzero(np.bincount(shown[shown >= 0], minlength=len(atlas.chart_start))))
    color, purity, deepest = _fetch(projected, shown, gbuffer.depth, rgb)
    seen = (purity > 0) & (projected.depth <= deepest + np.float32(settings.occlusion_tolerance))
    weight = np.where(seen, purity * _view_weight(atlas, camera, projected, settings), 0)

    used = np.flatnonzero(weight > 0)
    texel, added = projected.texel[used], weight[used]
    before = atlas.weight[texel]
    after = before + added
    new_color, new_weight = atlas.color.copy(), atlas.weight.copy()
    new_color[texel] += (color[used] - atlas.color[texel]) * (added / after)[:, None]
    new_weight[texel] = after
    return dataclasses.replace(atlas, color=new_color, weight=new_weight)


def _project(atlas: Atlas, camera: Camera, charts: np.ndarray) -> _Projected:
    """Texels of some charts inside the image: (x, y, 1) depth = K (R p + t) is affine in a chart's (row, column)."""
    K = np.array([[camera.focal[0], 0, camera.principal[0]], [0, camera.focal[1], camera.principal[1]], [0, 0, 1]])
    R, t = camera.T_cam_world[:3, :3], camera.T_cam_world[:3, 3]
    parts = []
    for chart in charts:
        inside = chart_image(atlas, int(chart), atlas.inside)
        rows, columns = inside.shape
        base = K @ (R @ atlas.chart_origin[chart] + t)
        along_u = np.outer(K @ R @ atlas.chart_u[chart], (np.arange(columns) + 0.5) * atlas.texel_size)
        along_v = np.outer(K @ R @ atlas.chart_v[chart], (np.arange(rows) + 0.5) * atlas.texel_size) + base[:, None]
        along_u, along_v = along_u.astype(np.float32)[:, None, :], along_v.astype(np.float32)[:, :, None]
        depth = along_v[2] + along_u[2]
        ahead = inside & (depth > _NEAR)
        inverse = 1 / np.where(ahead, depth, 1)
        x = (along_v[0] + along_u[0]) * inverse
        y = (along_v[1] + along_u[1]) * inverse
        kept = np.flatnonzero(ahead & (x > 0) & (x < camera.width) & (y > 0) & (y < camera.height))
        texel = atlas.chart_start[chart] + kept
        parts.append((texel, np.full(len(kept), chart, np.int32), *(a.ravel()[kept] for a in (x - 0.5, y - 0.5, depth))))
    empty = (np.zeros(0, np.int64), np.zeros(0, np.int32), *[np.zeros(0, np.float32)] * 3)
    texel, chart, x, y, depth = (np.concatenate(part) for part in zip(empty, *parts))
    return _Projected(texel=texel, chart=chart, x=x, y=y, depth=depth)


def _fetch(
    projected: _Projected, shown: np.ndarray, depth: np.ndarray, rgb: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Bilinear colour [n, 3] from the pixels that show each texel's chart, their purity [n] and their largest depth [n]."""
    height, width = shown.shape
    pure = _purity(shown).ravel()
    planes = np.ascontiguousarray(rgb.reshape(-1, 3).T, np.float32)
    shown, depth = shown.ravel(), depth.ravel()
    left, top = np.floor(projected.x), np.floor(projected.y)
    fx, fy = projected.x - left, projected.y - top
    left, top = left.astype(np.int32), top.astype(np.int32)

    color = np.zeros((3, len(left)), np.float32)
    total = np.zeros(len(left), np.float32)
    deepest = np.zeros(len(left), np.float32)
    for i, share_y in ((top, 1 - fy), (top + 1, fy)):
        line = np.clip(i, 0, height - 1) * width
        for j, share_x in ((left, 1 - fx), (left + 1, fx)):
            pixel = line + np.clip(j, 0, width - 1)
            own = shown[pixel] == projected.chart
            share = share_x * share_y * own * pure[pixel]
            total += share
            for plane, out in zip(planes, color):
                out += share * plane[pixel]
            np.maximum(deepest, depth[pixel], out=deepest, where=own)
    color /= np.where(total > 0, total, 1)
    return color.T, total, deepest


def _purity(shown: np.ndarray) -> np.ndarray:
    """[h, w] float32: the square of the share of a pixel's 3 x 3 neighbourhood that shows the same chart."""
    padded = np.pad(shown, 1, mode="edge")
    height, width = shown.shape
    same = np.zeros(shown.shape, np.uint8)
    for i in range(3):
        for j in range(3):
            same += padded[i : i + height, j : j + width] == shown
    return (same / np.float32(9)) ** 2


def _view_weight(atlas: Atlas, camera: Camera, projected: _Projected, settings: TextureSettings) -> np.ndarray:
    """[n] float32: facing * resolution * fade."""
    R, t = camera.T_cam_world[:3, :3], camera.T_cam_world[:3, 3]
    height_above = np.einsum("ci,ci->c", -R.T @ t - atlas.chart_origin, atlas.chart_normal).astype(np.float32)
    x, y = projected.x + np.float32(0.5), projected.y + np.float32(0.5)
    tangent = ((x - camera.principal[0]) / camera.focal[0]) ** 2 + ((y - camera.principal[1]) / camera.focal[1]) ** 2
    cosine = height_above[projected.chart] / (projected.depth * np.sqrt(1 + tangent))
    facing = np.clip((cosine - settings.min_facing) / (1 - settings.min_facing), 0, 1)
    resolution = np.minimum(1, atlas.texel_size * camera.focal.min() / projected.depth)
    border = np.minimum(np.minimum(x, camera.width - x), np.minimum(y, camera.height - y))
    fade = np.minimum(1, border / (_FADE * min(camera.width, camera.height)))
    return (facing * resolution * fade).astype(np.float32)
