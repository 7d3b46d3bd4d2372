"""Points on the surface of a template, which are compared with observed points."""

import dataclasses
import math

import numpy as np
from jaxtyping import Float, Int
from scipy.spatial import KDTree

from wm.geometry.mesh.scene_mesh import face_crosses
from wm.offline.furniture import Piece

_COUNT = 1200


@dataclasses.dataclass(frozen=True, eq=False)
class TemplateSurface:
    """Points on the surface of a piece of furniture, at the size in which it was built."""

    size: np.ndarray  # [3] metres
    points: np.ndarray  # [m, 3] in the piece's frame
    normals: np.ndarray  # [m, 3] unit
    tree: KDTree
    spacing: float  # approximate distance between neighbouring points, metres


def surface_of(piece: Piece) -> TemplateSurface:
    """Points sampled uniformly by area from the surface of a piece."""
    points, normals = surface_samples(piece.vertices, piece.faces, _COUNT)
    area = float(np.linalg.norm(face_crosses(piece.vertices[piece.faces]), axis=1).sum()) / 2
    return TemplateSurface(size=piece.size, points=points, normals=normals, tree=KDTree(points), spacing=math.sqrt(area / _COUNT))


def surface_samples(
    vertices: Float[np.ndarray, "v 3"], faces: Int[np.ndarray, "f 3"], count: int
) -> tuple[Float[np.ndarray, "m 3"], Float[np.ndarray, "m 3"]]:
    """(points, unit normals) sampled uniformly by area from a mesh. Equal meshes give equal samples."""
    rng = np.random.default_rng(7)
    crosses = face_crosses(vertices[faces])
    doubled_areas = np.linalg.norm(crosses, axis=1)
    chosen = rng.choice(len(faces), count, p=doubled_areas / doubled_areas.sum())
    a, b, c = (vertices[faces[chosen, k]] for k in range(3))
    u, v = np.sqrt(rng.random(count)), rng.random(count)
    points = (1 - u)[:, None] * a + (u * (1 - v))[:, None] * b + (u * v)[:, None] * c
    normals = crosses[chosen]
    return points, normals / np.linalg.norm(normals, axis=1, keepdims=True)
