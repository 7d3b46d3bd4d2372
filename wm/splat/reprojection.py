"""Cross-view consistency of depth: the splat depth of view i, reprojected into view j, against the splat depth of j there.

    p = unproject_i(D_i),  z_ij = depth of p in j,  compared with D_j at the pixel on which p falls,
    AbsRel = mean |z_ij - D_j| / D_j,   MAE-norm = mean |z_ij - D_j| / median D_j

over the pixels of i of which both views see the same point. With a scaffold that is known exactly (`shared_pixels`); without one
(an outside method) `mutual_pixels` asks that moving there and back ends near where it began. Definitions are ours.
"""

import dataclasses

import numpy as np
from jaxtyping import Bool, Float

from wm.geometry.rays.pinhole import project_points, unproject_depth
from wm.types import Camera

TOLERANCE = 0.02
"""Share of the depth within which two depths of one surface point agree: depths between pixels are interpolated."""


@dataclasses.dataclass(frozen=True)
class ReprojectionError:
    """The disagreement of two views.

    Attributes:
        absrel: mean of the difference of depths over the depth of j
        mae_norm: mean difference of depths over the median depth of j
        pixels: number of those compared
    """

    absrel: float
    mae_norm: float
    pixels: int


@dataclasses.dataclass(frozen=True, eq=False)
class _Moved:
    """The pixels of view i in view j."""

    depth: np.ndarray  # [h, w] their depth in j, metres
    there: np.ndarray  # [h, w] the depth of j where they fall, metres; 0 if they fall outside or where j has none
    uv: np.ndarray  # [h, w, 2] where they fall, pixels


def every(step: int, depth: Float[np.ndarray, "h w"], camera: Camera) -> tuple[Float[np.ndarray, "hs ws"], Camera]:
    """Every `step`-th row and column of a view: the same rays, fewer of them."""
    first = step // 2
    kept = depth[first::step, first::step]
    principal = (np.asarray(camera.principal, np.float64) - (first + 0.5)) / step + 0.5
    focal = np.asarray(camera.focal, np.float64) / step
    return kept, dataclasses.replace(camera, focal=focal, principal=principal, width=kept.shape[1], height=kept.shape[0])


def shared_pixels(
    depth_i: Float[np.ndarray, "h w"], camera_i: Camera, depth_j: Float[np.ndarray, "hj wj"], camera_j: Camera
) -> Bool[np.ndarray, "h w"]:
    """Pixels of i whose scaffold point j sees too: it lies in j's image and nothing stands before it (`TOLERANCE`)."""
    moved = _move(depth_i, camera_i, depth_j, camera_j)
    return (moved.there > 0) & (np.abs(moved.depth - moved.there) <= TOLERANCE * moved.there)


def overlap(
    shared_i: Bool[np.ndarray, "h w"],
    depth_i: Float[np.ndarray, "h w"],
    shared_j: Bool[np.ndarray, "hj wj"],
    depth_j: Float[np.ndarray, "hj wj"],
) -> float:
    """Share of the surface that two views have in common, 0..1: the smaller of the shares of either's scaffold pixels.

    Args:
        shared_i, shared_j: what `shared_pixels` said of i in j, and of j in i.
        depth_i, depth_j: the scaffold's.
    """
    shares = [shared.sum() / max((depth > 0).sum(), 1) for shared, depth in ((shared_i, depth_i), (shared_j, depth_j))]
    return float(min(shares))


def mutual_pixels(
    depth_i: Float[np.ndarray, "h w"],
    camera_i: Camera,
    depth_j: Float[np.ndarray, "hj wj"],
    camera_j: Camera,
    *,
    tolerance: float = 2.0,
) -> Bool[np.ndarray, "h w"]:
    """Pixels of i that come back to within `tolerance` pixels when moved into j by D_i and back by D_j.

    For depths of an outside method, whose scene has no scaffold to tell what two views share; wm's own evaluation knows its
    scaffold and asks `shared_pixels`.
    """
    moved = _move(depth_i, camera_i, depth_j, camera_j)
    known = moved.there > 0
    slopes = (np.where(known[..., None], moved.uv, 0.0) - camera_j.principal) / camera_j.focal
    rays = np.concatenate([slopes, np.ones((*known.shape, 1))], axis=-1)
    T_world_j = np.linalg.inv(np.asarray(camera_j.T_cam_world, np.float64))
    points = (rays * moved.there[..., None]) @ T_world_j[:3, :3].T + T_world_j[:3, 3]
    uv, _ = project_points(camera_i, points.reshape(-1, 3))
    h, w = depth_i.shape
    u, v = np.meshgrid(np.arange(w) + 0.5, np.arange(h) + 0.5)
    distance = np.linalg.norm(uv.reshape(h, w, 2) - np.stack([u, v], -1), axis=-1)
    return known & (distance <= tolerance)  # NaN, behind i, is not within


def reprojection_error(
    depth_i: Float[np.ndarray, "h w"],
    camera_i: Camera,
    depth_j: Float[np.ndarray, "hj wj"],
    camera_j: Camera,
    mask: Bool[np.ndarray, "h w"],
) -> ReprojectionError:
    """The disagreement of the splat depths of i and j over the pixels of i that the mask holds and that fall into j.

    NaN over no pixel. A pixel that j's gaussians do not cover (depth 0) is left out: a hole shows in M-MAE.
    """
    moved = _move(depth_i, camera_i, depth_j, camera_j)
    use = mask & (moved.there > 0)
    if not use.any():
        return ReprojectionError(absrel=float("nan"), mae_norm=float("nan"), pixels=0)
    difference = np.abs(moved.depth - moved.there)[use]
    return ReprojectionError(
        absrel=float(np.mean(difference / moved.there[use])),
        mae_norm=float(np.mean(difference) / np.median(depth_j[depth_j > 0])),
        pixels=int(use.sum()),
    )


def _move(depth_i, camera_i: Camera, depth_j, camera_j: Camera) -> _Moved:
    h, w = depth_i.shape
    uv, depth = project_points(camera_j, unproject_depth(camera_i, depth_i).reshape(-1, 3))
    uv = np.where((depth_i > 0)[..., None], uv.reshape(h, w, 2), np.nan)
    return _Moved(depth=depth.reshape(h, w), there=sample_depth(depth_j, uv), uv=uv)


def sample_depth(depth: Float[np.ndarray, "h w"], uv: Float[np.ndarray, "*n 2"]) -> Float[np.ndarray, "*n"]:
    """Depth at pixel positions: bilinear in 1 / depth, which is affine over a plane's image.

    It is 0 where a neighbour lacks it, outside the image, and where the position is NaN.
    """
    h, w = depth.shape
    x, y = np.moveaxis(uv, -1, 0) - 0.5
    inside = (x >= 0) & (x <= w - 1) & (y >= 0) & (y <= h - 1)
    x, y = np.where(inside, x, 0.0), np.where(inside, y, 0.0)
    i, j = np.floor(x).astype(np.int64), np.floor(y).astype(np.int64)
    near = depth > 0
    inverse = np.where(near, 1 / np.where(near, depth, 1).astype(np.float64), 0.0)
    total, known = np.zeros_like(x), inside
    for dj, wy in ((0, 1 - (y - j)), (1, y - j)):
        for di, wx in ((0, 1 - (x - i)), (1, x - i)):
            at = (np.minimum(j + dj, h - 1), np.minimum(i + di, w - 1))
            total = total + wx * wy * inverse[at]
            known = known & (near[at] | (wx * wy == 0))
    known = known & (total > 0)
    return np.where(known, 1 / np.where(known, total, 1), 0.0)
