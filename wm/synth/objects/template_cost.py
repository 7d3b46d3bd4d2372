"""How well a template of a given size and pose explains what images show of a thing.

    seen      every point seen lies on the template: distance along the template's normal, and a little along its surface
    unseen    no part of the template stands where an image looks through it: before what the image shows there, outside the mask
    usual     sizes are those that the kind is built in; what no image shows is settled by this alone
    room      nothing reaches into a wall or faces one closely; what stands with its back near a wall stands at it, squarely

All are residuals over their standard deviations, as Gauss-Newton wants them; distances saturate at OUTLIER, so that a ragged
mask's strays count for little.
"""

import dataclasses
import math
from collections.abc import Sequence

import numpy as np
from jaxtyping import Bool, Float
from scipy import ndimage
from scipy.spatial import KDTree

from wm.geometry.camera import project_points
from wm.geometry.site import Site
from wm.geometry.upright import turn_between
from wm.geometry.upright_box import UprightBox
from wm.synth.backends import Sighting
from wm.synth.objects.kinds import Template

OUTLIER = 0.1
"""Metres at which a distance counts as somebody else's point."""
_SIGMA_SEEN, _SIGMA_UNSEEN = 0.02, 0.03
_EVIDENCE = 60.0
"""Independent measurements that all pixels of a thing are worth."""
_SIGMA_WALL = 0.015
_AT_WALL = 0.15
"""Metres between a wall and a thing's back within which it is taken to stand at that wall."""
_SQUARE = math.radians(4.0)
_PARALLEL = math.cos(math.radians(16.0))
_FACING, _BARRED = 0.35, 8.0
"""Metres of floor that a thing wants before its front, and how much it minds a wall there."""
_SURFACE, _PROBES = 1200, 160
"""Points on a template that seen points are compared with, and points that are looked for in the images."""


@dataclasses.dataclass(frozen=True, eq=False)
class Surface:
    """Points on a template at its middle size."""

    points: np.ndarray  # [m, 3] in the template's frame
    normals: np.ndarray  # [m, 3] unit
    tree: KDTree
    spacing: float  # metres between neighbouring points, about


@dataclasses.dataclass(frozen=True, eq=False)
class Evidence:
    """Everything a fit looks at."""

    template: Template
    surface: Surface
    points: np.ndarray  # [n, 3] world points seen
    views: tuple[tuple[Sighting, np.ndarray], ...]  # each sighting with the distance to its mask, at half its resolution, pixels
    site: Site


def evidence_of(template: Template, points: Float[np.ndarray, "n 3"], sightings: Sequence[Sighting], site: Site) -> Evidence:
    """What a template is fitted to."""
    views = tuple((sighting, _distance_to(sighting.mask)) for sighting in sightings)
    return Evidence(template=template, surface=surface_of(template), points=points, views=views, site=site)


def _distance_to(mask: Bool[np.ndarray, "h w"]) -> Float[np.ndarray, "h2 w2"]:
    """Pixels to the mask, for every second pixel of every second row."""
    return 2.0 * np.asarray(ndimage.distance_transform_edt(~mask[::2, ::2]), np.float32)


def surface_of(template: Template) -> Surface:
    """Points spread over a template's surface by area."""
    piece = template.piece
    points, normals = surface_samples(piece.vertices, piece.faces, _SURFACE)
    area = triangle_areas(piece.vertices, piece.faces).sum()
    return Surface(points=points, normals=normals, tree=KDTree(points), spacing=math.sqrt(float(area) / _SURFACE))


def triangle_areas(vertices: Float[np.ndarray, "v 3"], faces: np.ndarray) -> Float[np.ndarray, "f"]:
    corners = vertices[faces]
    return np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1) / 2


def surface_samples(
    vertices: Float[np.ndarray, "v 3"], faces: np.ndarray, count: int
) -> tuple[Float[np.ndarray, "m 3"], Float[np.ndarray, "m 3"]]:
    """(points, unit normals) spread over a mesh by area; the same mesh always gives the same ones."""
    rng = np.random.default_rng(7)
    areas = triangle_areas(vertices, faces)
    chosen = rng.choice(len(faces), count, p=areas / areas.sum())
    a, b, c = (vertices[faces[chosen, k]] for k in range(3))
    u, v = np.sqrt(rng.random(count)), rng.random(count)
    points = (1 - u)[:, None] * a + (u * (1 - v))[:, None] * b + (u * v)[:, None] * c
    normals = np.cross(b - a, c - a)
    return points, normals / np.linalg.norm(normals, axis=1, keepdims=True)


def residuals(box: UprightBox, evidence: Evidence) -> Float[np.ndarray, "_"]:
    """All residuals of a template filling a box."""
    return np.concatenate([
        math.sqrt(_EVIDENCE / max(len(evidence.points), 1)) / _SIGMA_SEEN * _saturated(seen_distances(box, evidence)),
        math.sqrt(_EVIDENCE / _PROBES) / _SIGMA_UNSEEN * _saturated(_seen_through(box, evidence)),
        _unusual(box, evidence.template),
        _against_room(box, evidence),
    ])  # fmt: skip


def seen_distances(box: UprightBox, evidence: Evidence) -> Float[np.ndarray, "n"]:
    """Metres from each seen point to the template."""
    surface, size = evidence.surface, np.maximum(_size(box), 1e-3)
    ratio = size / evidence.template.piece.size
    T = box.transform
    local = ((evidence.points - T[:3, 3]) @ T[:3, :3]) / ratio
    _, k = surface.tree.query(local)
    gap = (local - surface.points[k]) * ratio
    normal = surface.normals[k] / ratio
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    across = np.abs(np.einsum("ni,ni->n", gap, normal))
    along = np.maximum(np.linalg.norm(gap, axis=1) - 1.5 * surface.spacing, 0.0)
    return np.hypot(across, 0.5 * along)


def _seen_through(box: UprightBox, evidence: Evidence) -> np.ndarray:
    """[probes] metres by which points of the template stand where an image, looking farther, shows them not to."""
    T, ratio = box.transform, _size(box) / evidence.template.piece.size
    probes = (evidence.surface.points[:_PROBES] * ratio) @ T[:3, :3].T + T[:3, 3]
    worst = np.zeros(len(probes))
    for sighting, outside in evidence.views:
        pixels, z = project_points(sighting.camera, probes)
        height, width = sighting.depth.shape
        inside = (z > 0.1) & (pixels >= 0).all(axis=1) & (pixels < [width, height]).all(axis=1)
        x, y = np.where(inside[:, None], pixels, 0.0).astype(int).T
        depth = sighting.depth[y, x]
        before = depth - z - 0.02 - 0.02 * depth
        apart = outside[y // 2, x // 2]
        aside = apart * z / float(sighting.camera.focal[0])
        amount = np.minimum(np.where(apart > 0, aside, before), np.maximum(before, 0.0))
        worst = np.maximum(worst, np.where(inside & (depth > 0), np.maximum(amount, 0.0), 0.0))
    return worst


def _unusual(box: UprightBox, template: Template) -> np.ndarray:
    """[6] how far sizes are from the kind's range, and, weakly, from its middle."""
    size, low, high = _size(box), template.low, template.high
    beyond = np.maximum(np.maximum(low - size, size - high), 0.0)
    spread = (high - low) / 2 + 0.05 * high
    return np.concatenate([beyond / (0.02 + 0.02 * high), 0.5 * (size - (low + high) / 2) / spread])


def _against_room(box: UprightBox, evidence: Evidence) -> np.ndarray:
    """[7] corners in walls, how close a wall is to the front, and the gap and the skew to the wall at the back."""
    site = evidence.site
    offset = np.einsum("cwi,wi->cw", box.corners[:, None] - site.starts, site.normals)
    along = np.einsum("cwi,wi->cw", box.corners[:, None] - site.starts, site.directions)
    beside = (along > 0) & (along < site.lengths) & (offset > -0.5)
    inside = np.where(beside, np.maximum(-offset, 0.0), 0.0).max(axis=1) / _SIGMA_WALL
    if evidence.template.support != "floor":
        return np.append(inside, [0.0, 0.0, 0.0])
    _, before = _wall_beyond(box, site, -1.0)
    inside = np.append(inside, _BARRED * max(1.0 - max(before, 0.0) / _FACING, 0.0))
    k, gap = _wall_beyond(box, site, 1.0)
    if abs(gap) > _AT_WALL:
        return np.append(inside, [0.0, 0.0])
    skew = turn_between(box.yaw, math.atan2(float(site.normals[k, 0]), -float(site.normals[k, 1])))
    fade = 1.0 - (abs(gap) / _AT_WALL) ** 2
    return np.append(inside, [fade * (gap - 0.03) / (2 * _SIGMA_WALL), fade * skew / _SQUARE])


def _wall_beyond(box: UprightBox, site: Site, side: float) -> tuple[int, float]:
    """(the wall that runs along a box's back (side 1) or front (-1), metres to it); infinitely far where there is none."""
    middle = box.center + side * box.axes[1] * box.depth / 2
    gaps = ((middle - site.starts) * site.normals).sum(axis=1)
    along = ((middle - site.starts) * site.directions).sum(axis=1)
    facing = (site.normals @ (-side * box.axes[1]) > _PARALLEL) & (along > 0) & (along < site.lengths)
    distance = np.where(facing, np.abs(gaps - 0.03), np.inf)
    k = int(np.argmin(distance))
    return k, float(gaps[k]) if facing[k] else math.inf


def _size(box: UprightBox) -> np.ndarray:
    return np.array([box.width, box.depth, box.height])


def _saturated(distance: np.ndarray) -> np.ndarray:
    return distance / np.sqrt(1.0 + (distance / OUTLIER) ** 2)
