"""Discs on surface that no view of a room shows, made so that no view sees them.

A disc near an edge reaches past it. Where a view sees what reaches past, the fit would make the disc fade, and an eye from the
other side would look through it. So discs are tucked in: an end of an axis that a view sees draws the centre and the extent back.

Tiers of work: per view one ray for each end of the discs in its picture that no view before has seen.
"""

import dataclasses
from collections.abc import Sequence

import numpy as np
from jaxtyping import Bool, Float
from scipy.spatial.transform import Rotation

from wm.geometry.rays.pinhole import camera_center
from wm.geometry.rays.raycast import RayScene, occluded
from wm.geometry.rays.surface_points import OFF_SURFACE, SurfacePoints, in_picture
from wm.splat.optimization.cloud import quats_from_normals
from wm.types import Camera

ENDS = 1.5
"""Standard deviations from the centre at which an axis ends: a disc is at a third of its opacity there."""
ROUNDS = 4
"""How often discs are drawn back."""
SHRINK, KEEP = 0.6, 0.85
"""What is left of an extent, in a round, of which a view sees both ends, or one."""
SHIFT, SINK = 0.5, 0.1
"""Shares of its reach by which a centre moves away from an end that is seen, and of its first extent by which it sinks."""


@dataclasses.dataclass(frozen=True, eq=False)
class Discs:
    """Flat gaussians on a surface."""

    centres: np.ndarray  # [n, 3] metres
    extents: np.ndarray  # [n, 2] standard deviations along the axes of `quats_from_normals`, metres


def tucked(scene: RayScene, points: SurfacePoints, extents: Float[np.ndarray, "n"], cameras: Sequence[Camera]) -> Discs:
    """Discs about points that no camera sees, no larger than `extents` (standard deviations, metres) and out of sight."""
    turns = Rotation.from_quat(quats_from_normals(points.normal), scalar_first=True)
    axes = turns.as_matrix()[:, :, :2].transpose(0, 2, 1)  # [n, axis, 3]
    centres, sizes = points.position.copy(), np.repeat(extents[:, None], 2, axis=1)
    left = np.arange(len(centres))
    for _ in range(ROUNDS):
        reach = ENDS * sizes[left][..., None] * axes[left]
        origins = (centres[left] + OFF_SURFACE * points.normal[left])[:, None, None] + np.stack([reach, -reach], axis=2)
        out = _in_view(scene, origins.reshape(-1, 3), cameras).reshape(len(left), 2, 2)  # of each axis its two ends
        one = out[..., 0] ^ out[..., 1]
        inwards = np.where(one, np.where(out[..., 0], -1.0, 1.0), 0.0)
        centres[left] += (SHIFT * inwards[..., None] * reach).sum(axis=1)
        sizes[left] *= np.where(out.all(axis=-1), SHRINK, np.where(out.any(axis=-1), KEEP, 1.0))
        left = left[out.any(axis=(1, 2))]
        centres[left] -= SINK * extents[left, None] * points.normal[left]
    return Discs(centres=centres, extents=sizes)


def _in_view(scene: RayScene, points: Float[np.ndarray, "p 3"], cameras: Sequence[Camera]) -> Bool[np.ndarray, "p"]:
    """Which points some camera sees, from whichever side."""
    seen = np.zeros(len(points), bool)
    for camera in cameras:
        eye, left = camera_center(camera), np.flatnonzero(~seen)
        inside = left[in_picture(camera, SurfacePoints(points[left], points[left], left))]
        seen[inside] = ~occluded(scene, points[inside], eye - points[inside], 1.0 - 1e-4)
    return seen
