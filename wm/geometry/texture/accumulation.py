"""Projecting images back into the texture atlas (paper, "Scaffold Mesh Texturing Details").

A texel takes colour from a view where it is seen, with the weight
    w = facing * resolution * fade * purity,
facing from the cosine between normal and view (0 at `min_facing`, 1 head-on), resolution = min(1, pixels per texel), fade from
0 at the image's border to 1 a tenth of the image inside, purity from how much of the neighbourhood shows the same surface
(pixels on an outline mix two surfaces). Colour is the weighted running mean over views, in the images' own sRGB encoding: what
is averaged is what image models see and write, and views of one surface differ by little.

A texel is seen where one of the four pixels around its projection shows the texel's own chart, and the texel is no deeper than
the deepest of those by more than `occlusion_tolerance`. The paper compares depth alone, with 0.10 m; that lets everything within
10 cm of a wall leak onto it. Comparing surfaces lets nothing through but the width of an outline.

Tiers of work: per view, what each pixel shows; per block of texels of a chart in view (small enough for the cache, and for the
allocator to reuse), the projection, which is affine in (row, column), and the gathers. Blocks write to texels of their own.
"""

import dataclasses

import numpy as np
from jaxtyping import Bool, Float

from wm.bounds import check_settings
from wm.geometry.texture.atlas import chart_image
from wm.geometry.texture.sampling import check_camera_of, pixel_charts
from wm.schema import TextureSettings
from wm.types import Atlas, Camera, GBuffer, SurfaceKind

_DEFAULTS = TextureSettings()
_FADE = 0.1  # share of the image's smaller side over which a view fades in from its border
_NEAR = 1e-3  # metres: texels closer to the camera's plane are behind it
_BLOCK = 1 << 14  # texels


@dataclasses.dataclass(frozen=True, eq=False)
class _Picture:
    """One view, ready to be read by texels."""

    camera: Camera
    shown: np.ndarray  # [h w] int32 the chart each pixel may colour, -1 for none
    purity: np.ndarray  # [h w] float32
    pixels: np.ndarray  # [h w, 4] float32 red, green, blue, depth: one gather fetches a row


@dataclasses.dataclass(frozen=True, eq=False)
class _Projected:
    """Texels of one chart that fall into the image."""

    texel: np.ndarray  # [n] int64 index into the atlas
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
      rgb: the view's image, sRGB in [0, 1]; a pixel with a colour that is not finite is left out, as if it were not usable.
      room: the view's room; surfaces of other rooms but reveals are left alone, though the view may see them through a door.
      settings: facing, occlusion and texel knobs.
      usable: pixels that may be used; None for all.

    Returns:
      An atlas that shares all but colour and weight with the given one.

    Raises:
      ValueError: G-buffer, image or mask are not of the camera's size or not of their type, the atlas has no surface of the
        room, or a setting is outside its bounds.
    """
    copied = dataclasses.replace(atlas, color=atlas.color.copy(), weight=atlas.weight.copy())
    accumulate_in_place(copied, gbuffer, camera, rgb, room, settings, usable=usable)
    return copied


def accumulate_in_place(
    atlas: Atlas,
    gbuffer: GBuffer,
    camera: Camera,
    rgb: Float[np.ndarray, "h w 3"],
    room: int,
    settings: TextureSettings = _DEFAULTS,
    *,
    usable: Bool[np.ndarray, "h w"] | None = None,
) -> None:
    """As `accumulate`, into the colour and weight of an atlas that the caller owns: the cost is that of what the view sees, not
    of the scene.

    Raises: as `accumulate`, before anything is changed.
    """
    _check(atlas, gbuffer, camera, rgb, room, settings, usable)
    pixels = np.dstack([rgb, gbuffer.depth]).astype(np.float32, copy=False)
    finite = np.isfinite(pixels).all(axis=-1)
    pixels[~finite] = 0  # weighted by zero below, where NaN would stay NaN
    shown = pixel_charts(atlas, gbuffer)
    # A door's reveal belongs to one of its two rooms and is seen from both, so views of either room paint it.
    mine = np.append((atlas.chart_room == room) | (atlas.chart_kind == SurfaceKind.REVEAL), False)[shown]
    shown = np.where(finite & mine if usable is None else finite & mine & usable, shown, np.int32(-1))
    picture = _Picture(
        camera=camera,
        shown=shown.ravel(),
        purity=_purity(shown).ravel(),
        pixels=pixels.reshape(-1, 4),
    )
    for chart in np.flatnonzero(np.bincount(shown[shown >= 0], minlength=len(atlas.chart_start))):
        rows, columns = (int(k) for k in atlas.chart_shape[chart])
        step = max(1, _BLOCK // columns)
        for first in range(0, rows, step):
            _add(atlas, picture, int(chart), slice(first, min(first + step, rows)), settings)


def _check(
    atlas: Atlas,
    gbuffer: GBuffer,
    camera: Camera,
    rgb: np.ndarray,
    room: int,
    settings: TextureSettings,
    usable: np.ndarray | None,
) -> None:
    check_camera_of(gbuffer, camera)
    size = camera.height, camera.width
    if rgb.shape != (*size, 3) or not np.issubdtype(rgb.dtype, np.floating):
        raise ValueError(f"rgb must be floating [{size[0]}, {size[1]}, 3] in [0, 1]; it is {rgb.dtype} {list(rgb.shape)}")
    if usable is not None and (usable.shape != size or usable.dtype != bool):
        raise ValueError(f"usable must be bool [{size[0]}, {size[1]}]; it is {usable.dtype} {list(usable.shape)}")
    if len(atlas.chart_room) and room not in atlas.chart_room:
        raise ValueError(f"room {room} has no surface in the atlas; it holds rooms {np.unique(atlas.chart_room).tolist()}")
    check_settings("texture", settings)


def _add(atlas: Atlas, picture: _Picture, chart: int, rows: slice, settings: TextureSettings) -> None:
    """Update the texels of some rows of a chart: the running mean, weight += w and colour += (c - colour) w / weight."""
    projected = _project(atlas, picture.camera, chart, rows)
    color, purity, deepest = _fetch(projected, picture, chart)
    seen = projected.depth <= deepest + np.float32(settings.occlusion_tolerance)
    added = seen * purity * _view_weight(atlas, picture.camera, chart, projected, settings)
    used = np.flatnonzero(added > 0)
    texel, added = projected.texel[used], added[used]
    after = atlas.weight[texel] + added
    before = atlas.color[texel]
    atlas.color[texel] = before + (color.T[used] - before) * (added / after)[:, None]
    atlas.weight[texel] = after


def _project(atlas: Atlas, camera: Camera, chart: int, rows: slice) -> _Projected:
    """Texels of some rows of a chart inside the image: (x, y, 1) depth = K (R p + t) is affine in (row, column)."""
    K = np.array([[camera.focal[0], 0, camera.principal[0]], [0, camera.focal[1], camera.principal[1]], [0, 0, 1]])
    R, t = camera.T_cam_world[:3, :3], camera.T_cam_world[:3, 3]
    inside = chart_image(atlas, chart, atlas.inside)[rows]
    columns = inside.shape[1]
    base = K @ (R @ atlas.chart_origin[chart] + t)
    along_u = np.outer(K @ R @ atlas.chart_u[chart], (np.arange(columns) + 0.5) * atlas.texel_size)
    along_v = np.outer(K @ R @ atlas.chart_v[chart], (np.arange(rows.start, rows.stop) + 0.5) * atlas.texel_size) + base[:, None]
    along_u, along_v = along_u.astype(np.float32)[:, None, :], along_v.astype(np.float32)[:, :, None]
    depth = along_v[2] + along_u[2]
    ahead = inside & (depth > _NEAR)
    inverse = 1 / np.where(ahead, depth, 1)
    x = (along_v[0] + along_u[0]) * inverse
    y = (along_v[1] + along_u[1]) * inverse
    kept = np.flatnonzero(ahead & (x > 0) & (x < camera.width) & (y > 0) & (y < camera.height))
    texel = atlas.chart_start[chart] + rows.start * columns + kept
    return _Projected(texel=texel, x=x.ravel()[kept] - 0.5, y=y.ravel()[kept] - 0.5, depth=depth.ravel()[kept])


def _fetch(projected: _Projected, picture: _Picture, chart: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Bilinear colour [3, n] from the pixels that show the chart, their purity [n] and their largest depth [n]."""
    height, width = picture.camera.height, picture.camera.width
    left, top = np.floor(projected.x), np.floor(projected.y)
    fx, fy = projected.x - left, projected.y - top
    left, top = left.astype(np.intp), top.astype(np.intp)
    columns = ((np.maximum(left, 0), 1 - fx), (np.minimum(left + 1, width - 1), fx))
    lines = ((np.maximum(top, 0) * width, 1 - fy), (np.minimum(top + 1, height - 1) * width, fy))
    color = np.zeros((3, len(left)), np.float32)
    total = np.zeros(len(left), np.float32)
    deepest = np.zeros(len(left), np.float32)
    for line, share_y in lines:
        for column, share_x in columns:
            pixel = line + column
            fetched = picture.pixels.take(pixel, axis=0)
            own = picture.shown.take(pixel) == chart
            share = share_x * share_y * own * picture.purity.take(pixel)
            total += share
            for k in range(3):
                color[k] += share * fetched[:, k]
            np.maximum(deepest, fetched[:, 3] * own, out=deepest)
    return color / np.where(total > 0, total, 1), total, deepest


def _purity(shown: np.ndarray) -> np.ndarray:
    """[h, w] float32: the square of the share of a pixel's 3 x 3 neighbourhood that shows the same chart."""
    padded = np.pad(shown, 1, mode="edge")
    height, width = shown.shape
    same = np.zeros(shown.shape, np.uint8)
    for i in range(3):
        for j in range(3):
            same += padded[i : i + height, j : j + width] == shown
    return (same / np.float32(9)) ** 2


def _view_weight(atlas: Atlas, camera: Camera, chart: int, projected: _Projected, settings: TextureSettings) -> np.ndarray:
    """[n] float32: facing * resolution * fade."""
    R, t = camera.T_cam_world[:3, :3], camera.T_cam_world[:3, 3]
    above = np.float32((-R.T @ t - atlas.chart_origin[chart]) @ atlas.chart_normal[chart])  # metres from plane to eye
    (fx, fy), (cx, cy) = camera.focal.astype(np.float32), camera.principal.astype(np.float32)
    x, y = projected.x + np.float32(0.5), projected.y + np.float32(0.5)
    cosine = above / (projected.depth * np.sqrt(1 + ((x - cx) / fx) ** 2 + ((y - cy) / fy) ** 2))
    facing = np.clip((cosine - np.float32(settings.min_facing)) / np.float32(1 - settings.min_facing), 0, 1)
    resolution = np.minimum(1, np.float32(atlas.texel_size) * min(fx, fy) / projected.depth)
    border = np.minimum(np.minimum(x, camera.width - x), np.minimum(y, camera.height - y))
    fade = np.minimum(1, border / np.float32(_FADE * min(camera.width, camera.height)))
    return facing * resolution * fade
