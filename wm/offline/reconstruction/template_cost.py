"""The cost of a template of a given size and pose: how badly it explains the observations of a thing.

    seen      observed points lie on the template: distance along its normal, and with a lower weight along its surface
    unseen    no part of the template lies in front of what an image shows outside the mask; no part of a flat template (a rug)
              lies where an image shows the bare floor
    usual     the size lies in the range of the kind; only this term decides dimensions that no image shows
    room      the template does not reach into a wall or face one closely; if its back is near a wall, it stands squarely at it

All terms are residuals divided by their standard deviations, as in Gauss-Newton. Distances saturate at OUTLIER, so that stray
points of a ragged mask have little influence. Many poses are evaluated together, one box per row: (x, y, z, yaw, width, depth,
height), the fields of UprightBox.
"""

import dataclasses
import math
from collections.abc import Sequence

import numpy as np
from jaxtyping import Bool, Float, Int
from scipy import ndimage

from wm.geometry.plan.site import Site
from wm.geometry.rays.pinhole import project_points
from wm.offline.reconstruction.kinds import Template
from wm.offline.reconstruction.template_surface import TemplateSurface, surface_of
from wm.synth.backends import Observation

OUTLIER = 0.1
"""Metres. A point at a much larger distance is treated as an outlier."""
_SIGMA_SEEN, _SIGMA_UNSEEN = 0.02, 0.03
_EVIDENCE = 60.0
"""Number of independent measurements that all pixels of a thing together count as."""
_SIGMA_WALL = 0.015
_AT_WALL = 0.15
"""Metres between a wall and the back of a thing up to which the thing is taken to stand at the wall."""
_SQUARE = math.radians(4.0)
_PARALLEL = math.cos(math.radians(16.0))
_FACING, _BARRED = 0.35, 8.0
"""Metres of free floor in front of a thing, and the residual if its front touches a wall."""
_PROBES = 160
"""Number of points of a template that are projected into the images."""
_STRAY = 2.0
"""Pixels outside a mask that may still show the thing, since borders of masks are ragged."""
_UNIT = np.array([[-0.5, -0.5], [0.5, -0.5], [0.5, 0.5], [-0.5, 0.5]])


@dataclasses.dataclass(frozen=True, eq=False)
class Evidence:
    """The input of the fit of one template."""

    template: Template
    surface: TemplateSurface
    points: np.ndarray  # [n, 3] observed points in world space
    views: tuple[tuple[Observation, np.ndarray], ...]  # each with the distance to its mask, at half its resolution, pixels
    site: Site


def evidence_of(
    template: Template, points: Float[np.ndarray, "n 3"], observations: Sequence[Observation], site: Site
) -> Evidence:
    """The input of a fit: a template, observed points, the observations that they come from, and the room."""
    views = tuple((observation, _distance_to(observation.mask)) for observation in observations)
    return Evidence(template=template, surface=surface_of(template.piece), points=points, views=views, site=site)


def _distance_to(mask: Bool[np.ndarray, "h w"]) -> Float[np.ndarray, "h2 w2"]:
    """Distance to the mask in pixels, for every second pixel of every second row."""
    return 2.0 * np.asarray(ndimage.distance_transform_edt(~mask[::2, ::2]), np.float32)


def nearest(boxes: Float[np.ndarray, "b 7"], evidence: Evidence) -> Int[np.ndarray, "b n"]:
    """Index of the template point nearest to each observed point, after both are scaled to the template's own size."""
    local = _in_box(boxes, evidence.points) / (boxes[:, None, 4:] / evidence.surface.size)
    return evidence.surface.tree.query(local)[1]


def residuals(boxes: Float[np.ndarray, "b 7"], evidence: Evidence, matched: Int[np.ndarray, "b n"]) -> Float[np.ndarray, "b _"]:
    """All residuals of a template that fills each box. `matched` is the template point of each observed point (`nearest`)."""
    weight_seen = math.sqrt(_EVIDENCE / max(len(evidence.points), 1)) / _SIGMA_SEEN
    return np.concatenate([
        weight_seen * _saturated(seen_distances(boxes, evidence, matched)),
        math.sqrt(_EVIDENCE / _PROBES) / _SIGMA_UNSEEN * _saturated(_seen_through(boxes, evidence)),
        _unusual(boxes[:, 4:], evidence.template),
        _in_walls(boxes, evidence.site),
        _at_walls(boxes, evidence.site) if evidence.template.support == "floor" else np.zeros((len(boxes), 3)),
    ], axis=1)  # fmt: skip


def cost(boxes: Float[np.ndarray, "b 7"], evidence: Evidence) -> Float[np.ndarray, "b"]:
    """Half the sum of squared residuals."""
    return 0.5 * (residuals(boxes, evidence, nearest(boxes, evidence)) ** 2).sum(axis=1)


def seen_distances(
    boxes: Float[np.ndarray, "b 7"], evidence: Evidence, matched: Int[np.ndarray, "b n"]
) -> Float[np.ndarray, "b n"]:
    """Distance from each observed point to the template, in metres."""
    surface = evidence.surface
    ratio = boxes[:, None, 4:] / surface.size
    gap = _in_box(boxes, evidence.points) - ratio * surface.points[matched]
    normal = surface.normals[matched] / ratio
    across = np.abs((gap * normal).sum(axis=2)) / np.sqrt((normal**2).sum(axis=2))
    along = np.maximum(np.sqrt((gap**2).sum(axis=2)) - 1.5 * surface.spacing, 0.0)
    return np.hypot(across, 0.5 * along)


def _in_box(boxes: np.ndarray, points: np.ndarray) -> np.ndarray:
    """[b, n, 3] world points in the frame of each box."""
    away = points - boxes[:, None, :3]
    c, s = np.cos(boxes[:, 3:4]), np.sin(boxes[:, 3:4])
    return np.stack([c * away[..., 0] + s * away[..., 1], c * away[..., 1] - s * away[..., 0], away[..., 2]], axis=2)


def _seen_through(boxes: np.ndarray, evidence: Evidence) -> np.ndarray:
    """[b, probes] metres by which points of the template lie in space that an image shows to be empty."""
    local = evidence.surface.points[:_PROBES] * (boxes[:, None, 4:] / evidence.surface.size)
    c, s = np.cos(boxes[:, 3:4]), np.sin(boxes[:, 3:4])
    turned = np.stack([c * local[..., 0] - s * local[..., 1], s * local[..., 0] + c * local[..., 1], local[..., 2]], axis=2)
    probes = (turned + boxes[:, None, :3]).reshape(-1, 3)
    worst, flat = np.zeros(len(probes)), evidence.template.support == "flat"
    for observation, outside in evidence.views:
        pixels, z = project_points(observation.camera, probes)
        height, width = observation.depth.shape
        inside = (z > 0.1) & (pixels >= 0).all(axis=1) & (pixels < [width, height]).all(axis=1)
        x, y = np.where(inside[:, None], pixels, 0.0).astype(int).T
        depth = observation.depth[y, x]
        slack = 0.02 + 0.02 * depth
        before = np.maximum(depth - z - slack, 0.0) if not flat else np.where(np.abs(depth - z) < slack, np.inf, 0.0)
        apart = outside[y // 2, x // 2]
        aside = np.maximum(apart - _STRAY, 0.0) * z / float(observation.camera.focal[0])
        amount = np.minimum(aside, before) if flat else np.where(apart > 0, np.minimum(aside, before), before)
        worst = np.maximum(worst, np.where(inside & (depth > 0), amount, 0.0))
    return worst.reshape(len(boxes), -1)


def _unusual(size: np.ndarray, template: Template) -> np.ndarray:
    """[b, 6] residuals of sizes outside the range of the kind, and, with a low weight, of sizes away from its middle."""
    low, high = template.low, template.high
    beyond = np.maximum(np.maximum(low - size, size - high), 0.0)
    spread = (high - low) / 2 + 0.05 * high
    return np.concatenate([beyond / (0.02 + 0.02 * high), 0.5 * (size - (low + high) / 2) / spread], axis=1)


def _axes(boxes: np.ndarray) -> np.ndarray:
    """[b, 2, 2] rows: the directions of each box's width and depth."""
    c, s = np.cos(boxes[:, 3]), np.sin(boxes[:, 3])
    return np.stack([np.stack([c, s], axis=1), np.stack([-s, c], axis=1)], axis=1)


def _in_walls(boxes: np.ndarray, site: Site) -> np.ndarray:
    """[b, 4] residuals of corners that reach into a wall."""
    corners = boxes[:, None, :2] + (_UNIT * boxes[:, None, 4:6]) @ _axes(boxes)
    away = corners[:, :, None] - site.starts
    offset, along = (away * site.normals).sum(axis=3), (away * site.directions).sum(axis=3)
    beside = (along > 0) & (along < site.lengths) & (offset > -0.5)
    return np.where(beside, np.maximum(-offset, 0.0), 0.0).max(axis=2) / _SIGMA_WALL


def _at_walls(boxes: np.ndarray, site: Site) -> np.ndarray:
    """[b, 3] residuals of a wall close to the front, and of the gap and the angle to a wall at the back."""
    _, before = _wall_beyond(boxes, site, -1.0)
    barred = _BARRED * np.maximum(1.0 - np.maximum(before, 0.0) / _FACING, 0.0)
    normal, gap = _wall_beyond(boxes, site, 1.0)
    near = np.abs(gap) <= _AT_WALL
    gap = np.where(near, gap, 0.0)
    fade = np.where(near, 1.0 - (gap / _AT_WALL) ** 2, 0.0)
    skew = np.arctan2(normal[:, 0], -normal[:, 1]) - boxes[:, 3]
    skew = np.arctan2(np.sin(skew), np.cos(skew))
    return np.stack([barred, fade * (gap - 0.03) / (2 * _SIGMA_WALL), fade * skew / _SQUARE], axis=1)


def _wall_beyond(boxes: np.ndarray, site: Site, side: float) -> tuple[np.ndarray, np.ndarray]:
    """(normal [b, 2] of the wall along the back (side 1) or front (side -1) of each box, distance [b] to it in metres).

    The distance is infinite if there is no such wall.
    """
    back = side * _axes(boxes)[:, 1]
    away = (boxes[:, :2] + back * boxes[:, 5:6] / 2)[:, None] - site.starts
    gaps, along = (away * site.normals).sum(axis=2), (away * site.directions).sum(axis=2)
    facing = (-back @ site.normals.T > _PARALLEL) & (along > 0) & (along < site.lengths)
    k = np.argmin(np.where(facing, np.abs(gaps - 0.03), np.inf), axis=1)
    rows = np.arange(len(boxes))
    return site.normals[k], np.where(facing[rows, k], gaps[rows, k], np.inf)


def _saturated(distance: np.ndarray) -> np.ndarray:
    return distance / np.sqrt(1.0 + (distance / OUTLIER) ** 2)
