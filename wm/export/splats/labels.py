"""Which room and which object every gaussian of a run belongs to.

The room is the one whose fit made it. The object is that of the scaffold's surface nearest to its mean, -1 for the building.
Points are spread over the scaffold; to the triangles of the points nearest to a mean the distance is exact, and the least counts.
"""

import dataclasses

import numpy as np
from jaxtyping import Float, Int
from scipy.spatial import KDTree

from wm.finished import FinishedRun
from wm.geometry.rays.surface_points import surface_points
from wm.types import Mesh, SurfaceKind

_SPACING = 0.03  # metres between points on the scaffold
_MOST = 3_000_000  # points
_NEAREST = 8  # points whose triangles are measured
_BLOCK = 1 << 16


@dataclasses.dataclass(frozen=True, eq=False)
class SplatLabels:
    """By gaussian of `FinishedRun.gaussians`."""

    room: np.ndarray  # [n] int32, index into `FinishedRun.rooms`
    object: np.ndarray  # [n] int32, index into `FinishedRun.objects`, -1 for the building


def splat_labels(run: FinishedRun) -> SplatLabels:
    """Room and object of every gaussian."""
    faces = nearest_faces(run.scaffold, np.asarray(run.gaussians.means, np.float64))
    return SplatLabels(room=run.gaussian_room.astype(np.int32), object=run.scaffold.face_object[faces].astype(np.int32))


def nearest_faces(mesh: Mesh, points: Float[np.ndarray, "n 3"]) -> Int[np.ndarray, " n"]:
    """The face of the mesh, its outer skin left out, that lies nearest to each point; of equally near ones the first."""
    corners = mesh.vertices[mesh.faces]
    area = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1) / 2
    inner = float(area[mesh.face_kind != SurfaceKind.EXTERIOR].sum())
    samples = surface_points(mesh, int(min(_MOST, max(inner / _SPACING**2, 1000))))
    tree = KDTree(samples.position)
    nearest = np.empty(len(points), np.int64)
    for start in range(0, len(points), _BLOCK):
        part = points[start : start + _BLOCK]
        faces = np.sort(samples.face[tree.query(part, k=_NEAREST, workers=-1)[1]], axis=1)
        distance = triangle_distance(part[:, None], corners[faces])
        nearest[start : start + _BLOCK] = faces[np.arange(len(part)), distance.argmin(axis=1)]
    return nearest


def triangle_distance(points: Float[np.ndarray, "*b 3"], corners: Float[np.ndarray, "*c 3 3"]) -> Float[np.ndarray, "*d"]:
    """Metres from points to triangles, which broadcast: to the plane where the foot is inside, else to the nearest edge."""
    a, b, c = np.moveaxis(corners, -2, 0)
    normal = np.cross(b - a, c - a)
    square = np.maximum((normal**2).sum(axis=-1), 1e-300)
    inside = np.ones(np.broadcast_shapes(points.shape[:-1], a.shape[:-1]), bool)
    edges = np.full(inside.shape, np.inf)
    for p, q in ((a, b), (b, c), (c, a)):
        edge, to = q - p, points - p
        inside &= (np.cross(edge, to) * normal).sum(axis=-1) >= 0
        share = np.clip((to * edge).sum(axis=-1) / np.maximum((edge**2).sum(axis=-1), 1e-300), 0, 1)
        edges = np.minimum(edges, np.linalg.norm(to - share[..., None] * edge, axis=-1))
    plane = np.abs(((points - a) * normal).sum(axis=-1)) / np.sqrt(square)
    return np.where(inside, plane, edges)
