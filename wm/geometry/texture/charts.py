"""Which faces of a scaffold lie on one planar surface: the charts of the texture atlas.

A chart is a connected set of faces of one surface and plane; surfaces of the structure are told apart by room and kind. Faces of
one plane that do not touch (the heads of several doors, a wall that a passage cuts in two) are separate charts, so that charts
are not mostly empty.
"""

import numpy as np
from jaxtyping import Int
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components
from scipy.spatial import KDTree

from wm.geometry.mesh.scene_mesh import face_crosses
from wm.types import OUTSIDE, Mesh, SurfaceKind

ANGLE_TOLERANCE = 1e-3  # radians between normals of one plane
OFFSET_TOLERANCE = 1e-3  # metres between offsets of one plane
WELD = 1e-6  # metres: corners closer than this are one corner


def planar_charts(mesh: Mesh, surface: Int[np.ndarray, "f"] | None = None) -> Int[np.ndarray, "f"]:
    """The chart of every face, numbered in order of first face; -1 for faces of no surface and faces of no area.

    Args:
      mesh: any triangles.
      surface: a number for each face, -1 for none: faces of different numbers share no chart. Without it the structure's, by
        room and kind, and none for objects and the outer skin.
    """
    surface = _structure(mesh) if surface is None else surface
    chart = np.full(len(mesh.faces), -1, np.int32)
    corners = mesh.vertices[mesh.faces]
    cross = face_crosses(corners)
    doubled_area = np.linalg.norm(cross, axis=1)
    faces = np.flatnonzero((surface >= 0) & (doubled_area > 0))
    if len(faces) == 0:
        return chart
    normal = cross[faces] / doubled_area[faces, None]
    plane = _planes(mesh, faces, normal, surface[faces])
    label = _islands(mesh, faces, plane)
    _, first, inverse = np.unique(label, return_index=True, return_inverse=True)
    rank = np.empty(len(first), np.int32)
    rank[np.argsort(first)] = np.arange(len(first), dtype=np.int32)
    chart[faces] = rank[inverse]
    return chart


def _structure(mesh: Mesh) -> np.ndarray:
    """[f] a number for each room and kind, -1 for objects and the outer skin."""
    structure = (mesh.face_object == OUTSIDE) & (mesh.face_kind != SurfaceKind.OBJECT) & (mesh.face_kind != SurfaceKind.EXTERIOR)
    return np.where(structure, (mesh.face_room - OUTSIDE) * len(SurfaceKind) + mesh.face_kind, -1)


def _planes(mesh: Mesh, faces: np.ndarray, normal: np.ndarray, surface: np.ndarray) -> np.ndarray:
    """A label per face, equal where surfaces are equal and the planes agree within the tolerances."""
    centre = mesh.vertices[mesh.faces[faces]].mean(axis=1)
    offset = np.einsum("fi,fi->f", centre - mesh.vertices.mean(axis=0), normal)
    # In units of the tolerances: labels 4 apart are never within radius 1.
    key = np.column_stack([4.0 * surface, normal / ANGLE_TOLERANCE, offset / OFFSET_TOLERANCE])
    # Faces of one plane agree to rounding: joined here, so that the neighbour search sees planes and not faces.
    distinct, inverse = np.unique(np.round(key, 3), axis=0, return_inverse=True)
    pairs = KDTree(distinct).query_pairs(1.0, output_type="ndarray")
    graph = coo_array((np.ones(len(pairs), bool), (pairs[:, 0], pairs[:, 1])), shape=(len(distinct), len(distinct)))
    return connected_components(graph, directed=False)[1][inverse.ravel()]


def _islands(mesh: Mesh, faces: np.ndarray, plane: np.ndarray) -> np.ndarray:
    """A label per face, equal where faces of one plane hang together by shared corners (by position, not by index)."""
    used, vertex = np.unique(mesh.faces[faces], return_inverse=True)
    _, corner = np.unique(np.round(mesh.vertices[used] / WELD).astype(np.int64), axis=0, return_inverse=True)
    corner = corner.ravel()[vertex.reshape(-1, 3)].astype(np.int64)
    _, node = np.unique(plane[:, None].astype(np.int64) * len(used) + corner, return_inverse=True)
    nodes = int(node.max()) + 1
    face = np.repeat(np.arange(len(faces)), 3)
    size = len(faces) + nodes
    graph = coo_array((np.ones(3 * len(faces), bool), (face, len(faces) + node.ravel())), shape=(size, size))
    return connected_components(graph, directed=False)[1][: len(faces)]
