"""Points spread over a triangle mesh, and the distance of other points from it."""

import dataclasses

import numpy as np
from jaxtyping import Float, Int
from scipy.spatial import KDTree
from trimesh.triangles import closest_point

_GOLDEN = np.array([0.7548776662466927, 0.5698402909980532])
"""Steps of the sequence R2, whose points fill a square evenly. Source: Roberts, "The unreasonable effectiveness of quasirandom
sequences", 2018."""
_SPREAD = 20_000
_FACES = 4
"""Spread points nearest to a point whose faces are tried for the nearest one."""


@dataclasses.dataclass(frozen=True, eq=False)
class SurfacePoints:
    """Points on faces of a mesh."""

    points: np.ndarray  # [n, 3]
    face: np.ndarray  # [n] int
    barycentric: np.ndarray  # [n, 2] (u, v): p = (1 - u - v) p0 + u p1 + v p2


def surface_points(vertices: Float[np.ndarray, "v 3"], faces: Int[np.ndarray, "f 3"], count: int) -> SurfacePoints:
    """About `count` points, as many on a face as its area asks for. Equal meshes give equal points.

    Raises:
      ValueError: no face has an area.
    """
    corners = vertices[faces]
    area = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
    total = np.cumsum(area)
    if not len(total) or not total[-1] > 0:
        raise ValueError("a mesh without any area has no points on its surface")
    face = np.searchsorted(total, (np.arange(count) + 0.5) / count * total[-1])
    u, v = ((np.arange(count)[:, None] * _GOLDEN) % 1.0).T
    beyond = u + v > 1
    barycentric = np.stack([np.where(beyond, 1 - u, u), np.where(beyond, 1 - v, v)], axis=1)
    return SurfacePoints(points=points_at(corners, face, barycentric), face=face, barycentric=barycentric)


def points_at(
    corners: Float[np.ndarray, "f 3 3"], face: Int[np.ndarray, "n"], barycentric: Float[np.ndarray, "n 2"]
) -> Float[np.ndarray, "n 3"]:
    """The points of faces at barycentric coordinates."""
    u, v = barycentric[:, :1], barycentric[:, 1:]
    own = corners[face]
    return (1 - u - v) * own[:, 0] + u * own[:, 1] + v * own[:, 2]


def distances(
    points: Float[np.ndarray, "n 3"], vertices: Float[np.ndarray, "v 3"], faces: Int[np.ndarray, "f 3"]
) -> Float[np.ndarray, "n"]:
    """The distance of points from a mesh: exact for the faces that are near one of the points spread over it."""
    spread = surface_points(vertices, faces, _SPREAD)
    _, near = KDTree(spread.points).query(points, k=_FACES)
    corners = vertices[faces[spread.face[near]]].reshape(-1, 3, 3)
    repeated = np.repeat(points, _FACES, axis=0)
    away = np.linalg.norm(closest_point(corners, repeated) - repeated, axis=1)
    return away.reshape(-1, _FACES).min(axis=1)
