"""Convex hulls that every physics engine takes: closed, at least a millimetre thick, of at most 64 vertices.

64 is the most that PhysX takes; where a hull has more, the farthest points in 64 directions remain. Eight of them lie close
around each axis, so that a round foot keeps a round rim to stand on.
"""

import dataclasses
import functools

import numpy as np
from jaxtyping import Float
from scipy.spatial import ConvexHull

MOST_VERTICES = 64
THINNEST = 1e-3  # metres; engines refuse flat hulls
_BESIDE_AXIS = 0.05  # how far a direction leans away from its axis
_EXACT = 1e-5  # metres by which a box may miss its corners


@dataclasses.dataclass(frozen=True, eq=False)
class Hull:
    """A convex solid."""

    vertices: np.ndarray  # [v, 3] float64 metres
    faces: np.ndarray  # [f, 3] int32, wound outward

    @functools.cached_property
    def box(self) -> tuple[np.ndarray, np.ndarray] | None:
        """Centre and extents [3], metres, of a box along the axes; None of any other solid."""
        low, high = self.vertices.min(axis=0), self.vertices.max(axis=0)
        at_side = (np.abs(self.vertices - low) < _EXACT) | (np.abs(self.vertices - high) < _EXACT)
        if len(self.vertices) != 8 or not at_side.all():
            return None
        return (low + high) / 2, high - low


def convex_hull(points: Float[np.ndarray, "n 3"]) -> Hull:
    """The hull of some points, thickened where it is thinner than THINNEST and thinned out to MOST_VERTICES.

    Raises:
      ValueError: all points are one.
    """
    points = _thickened(np.unique(points, axis=0))
    hull = _qhull(points)
    if len(hull.vertices) <= MOST_VERTICES:
        return hull
    farthest = np.unique(np.argmax(hull.vertices @ _directions().T, axis=0))
    return _qhull(hull.vertices[farthest])


def _qhull(points: np.ndarray) -> Hull:
    found = ConvexHull(points)
    used, index = np.unique(found.simplices, return_inverse=True)
    vertices, faces = points[used], index.reshape(-1, 3).astype(np.int32)
    a, b, c = (vertices[faces[:, k]] for k in range(3))
    inward = np.einsum("fi,fi->f", np.cross(b - a, c - a), a - vertices.mean(axis=0)) < 0
    faces[inward] = faces[inward][:, ::-1]
    return Hull(vertices=vertices, faces=faces)


def _thickened(points: np.ndarray) -> np.ndarray:
    """The points, drawn apart along each principal axis in which they are thinner than THINNEST."""
    center = points.mean(axis=0)
    axes = np.linalg.svd(points - center, full_matrices=True)[2] if len(points) > 1 else np.eye(3)
    along = (points - center) @ axes.T
    if not np.ptp(along, axis=0).max() > 0:
        raise ValueError("a solid of one point has no hull")
    for axis in axes[np.ptp(along, axis=0) < THINNEST]:
        points = np.concatenate([points - axis * THINNEST / 2, points + axis * THINNEST / 2])
    return points


@functools.cache
def _directions() -> np.ndarray:
    """[64, 3] unit vectors: eight around each of the six half axes, and sixteen spread over the sphere."""
    turn = np.arange(8) * np.pi / 4
    ring = np.stack([np.cos(turn) * _BESIDE_AXIS, np.sin(turn) * _BESIDE_AXIS, np.ones(8)], axis=1)
    around = [np.roll(ring * [1, 1, sign], shift, axis=1) for shift in range(3) for sign in (1, -1)]
    height = 1 - (2 * np.arange(16) + 1) / 16
    golden = np.arange(16) * np.pi * (3 - np.sqrt(5))
    radius = np.sqrt(1 - height**2)
    spread = np.stack([radius * np.cos(golden), radius * np.sin(golden), height], axis=1)
    directions = np.concatenate([*around, spread])
    return directions / np.linalg.norm(directions, axis=1, keepdims=True)
