"""The building as convex solids: a thin prism behind each of its triangles.

A whole house as one mesh would be its convex hull to most engines, which fills every room. A prism lies in the solid behind its
triangle, so that the surface is exact; no prism is deeper than the walls, slabs and panes that the structure is made of.
"""

import numpy as np
from jaxtyping import Float

from wm.export.simulation.hulls import Hull, convex_hull
from wm.types import Mesh, SurfaceKind

DEPTH = {SurfaceKind.FLOOR: 0.1, SurfaceKind.CEILING: 0.1, SurfaceKind.PANE: 0.004}
"""Metres by which the prism of a kind of surface reaches into the solid: the floor deep, the pane within the glass."""
_OTHER_DEPTH = 0.02


def prisms(mesh: Mesh, faces: np.ndarray) -> list[Hull]:
    """The prisms of some faces [k] of the structure, in their order, in world metres."""
    corners = mesh.vertices[mesh.faces[faces]]
    kinds = mesh.face_kind[faces].tolist()
    return [_prism(triangle, DEPTH.get(SurfaceKind(kind), _OTHER_DEPTH)) for triangle, kind in zip(corners, kinds)]


def _prism(triangle: Float[np.ndarray, "3 3"], depth: float) -> Hull:
    normal = np.cross(triangle[1] - triangle[0], triangle[2] - triangle[0])
    return convex_hull(np.concatenate([triangle, triangle - normal / np.linalg.norm(normal) * depth]))
