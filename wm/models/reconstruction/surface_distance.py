"""The distance of points from a triangle mesh."""

import numpy as np
from jaxtyping import Float, Int
from scipy.spatial import KDTree
from trimesh.triangles import closest_point

from wm.geometry.rays.surface_points import surface_points
from wm.types import Mesh

_SPREAD = 20_000
_FACES = 4
"""Points spread over the mesh that lie nearest to a point: the faces of these are tried."""


def surface_distance(
    points: Float[np.ndarray, "n 3"], vertices: Float[np.ndarray, "v 3"], faces: Int[np.ndarray, "f 3"]
) -> Float[np.ndarray, "n"]:
    """The distance of each point from the mesh, exact if one of the faces tried is the nearest; inf for a mesh without area."""
    spread = surface_points(Mesh.from_triangles(vertices, faces), _SPREAD)
    if not len(spread.face):
        return np.full(len(points), np.inf)
    _, near = KDTree(spread.position).query(points, k=_FACES)
    corners = vertices[faces[spread.face[np.asarray(near)]]].reshape(-1, 3, 3)
    repeated = np.repeat(points, _FACES, axis=0)
    away = np.linalg.norm(closest_point(corners, repeated) - repeated, axis=1)
    return away.reshape(-1, _FACES).min(axis=1)
