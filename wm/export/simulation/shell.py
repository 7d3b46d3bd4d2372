"""The building as convex solids: a thin prism behind each convex piece of its surface.

A whole house as one mesh would be its convex hull to most engines, which fills every room. A prism lies in the solid behind its
piece, so that the surface is exact; no prism is deeper than the walls, slabs and panes that the structure is made of.

Pieces are triangles of one plane, joined across an edge as long as both corners there stay convex. Source: Hertel, Mehlhorn, Fast
triangulation of simple polygons (1983); we go from the longest edge to the shortest, which makes rectangles of most walls.
"""

import numpy as np
from jaxtyping import Float, Int

from wm.export.simulation.hulls import Hull, convex_hull
from wm.types import Mesh, SurfaceKind

DEPTH = {SurfaceKind.FLOOR: 0.1, SurfaceKind.CEILING: 0.1, SurfaceKind.PANE: 0.004}
"""Metres by which the prism of a kind of surface reaches into the solid: the floor deep, the pane within the glass."""
_OTHER_DEPTH = 0.02
_COPLANAR = 1e-9  # of 1 - cosine between normals
_STRAIGHT = 1e-9  # square metres: twice the area of the triangle at a corner that counts as straight


def prisms(mesh: Mesh, faces: Int[np.ndarray, "f"]) -> list[Hull]:
    """The prisms behind some faces of one kind of the structure, in world metres."""
    depth = DEPTH.get(SurfaceKind(int(mesh.face_kind[faces[0]])), _OTHER_DEPTH)
    return [_prism(mesh.vertices[loop], normal, depth) for loop, normal in convex_pieces(mesh.vertices, mesh.faces[faces])]


def convex_pieces(vertices: Float[np.ndarray, "v 3"], faces: Int[np.ndarray, "f 3"]) -> list[tuple[np.ndarray, np.ndarray]]:
    """Convex polygons that cover the faces: the indices of their corners, counter-clockwise, and their unit normals."""
    corners = vertices[faces]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    loops: dict[int, list[int]] = dict(enumerate(faces.tolist()))
    owner = {(a, b): k for k, face in loops.items() for a, b in zip(face, [*face[1:], face[0]])}
    inner = [edge for edge in owner if edge[0] < edge[1] and edge[::-1] in owner]
    for a, b in sorted(inner, key=lambda edge: (-float(np.linalg.norm(vertices[edge[0]] - vertices[edge[1]])), edge)):
        first, second = owner[a, b], owner[b, a]
        if first == second or normals[first] @ normals[second] < 1 - _COPLANAR:
            continue
        joined = _joined(loops[first], loops[second], a, b)
        if len(set(joined)) == len(joined) and _is_convex(vertices[joined], normals[first]):
            loops[first] = joined
            owner |= dict.fromkeys(zip(joined, [*joined[1:], joined[0]]), first)
            del loops[second]
    return [(_without_straight(vertices, loop, normals[k]), normals[k]) for k, loop in loops.items()]


def _joined(first: list[int], second: list[int], a: int, b: int) -> list[int]:
    """The loop around two polygons, of which one has the edge a to b and the other b to a."""
    start, other = first.index(b), second.index(a)
    return [*first[start:], *first[:start], *second[other + 1 :], *second[:other]][: len(first) + len(second) - 2]


def _turns(corners: Float[np.ndarray, "k 3"], normal: Float[np.ndarray, "3"]) -> Float[np.ndarray, "k"]:
    """Twice the signed area of the triangle at each corner of a polygon: above 0 where it is convex."""
    before, after = corners - np.roll(corners, 1, axis=0), np.roll(corners, -1, axis=0) - corners
    return np.cross(before, after) @ normal


def _is_convex(corners: Float[np.ndarray, "k 3"], normal: Float[np.ndarray, "3"]) -> bool:
    return bool(np.all(_turns(corners, normal) > -_STRAIGHT))


def _without_straight(vertices: np.ndarray, loop: list[int], normal: np.ndarray) -> np.ndarray:
    return np.array(loop)[_turns(vertices[loop], normal) > _STRAIGHT]


def _prism(corners: Float[np.ndarray, "k 3"], normal: Float[np.ndarray, "3"], depth: float) -> Hull:
    return convex_hull(np.concatenate([corners, corners - normal * depth]))
