"""The pieces of which an object is put together: triangles that hang together by edges of exactly two of them.

Edges that more triangles share do not join: two books that touch along an edge are two parts.
"""

import dataclasses

import numpy as np
from jaxtyping import Float, Int
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from wm.types import SceneObject


@dataclasses.dataclass(frozen=True, eq=False)
class BodyPart:
    """One piece of an object."""

    corners: np.ndarray  # [f, 3, 3] float64, metres, world
    slot: int  # of the object: the material of most of its surface
    closed: bool  # it bounds a volume, and is wound outward

    @property
    def area(self) -> float:
        """Square metres."""
        return float(_areas(self.corners).sum())


def parts_of(thing: SceneObject) -> list[BodyPart]:
    """The parts of an object in the order of their first triangle."""
    corners = thing.vertices[thing.faces]
    first, second = _neighbours(thing.faces)
    count = len(thing.faces)
    graph = coo_array((np.ones(len(first)), (first, second)), shape=(count, count))
    number, part = connected_components(graph, directed=False)
    order = np.argsort(part, kind="stable")
    pieces = np.split(order, np.searchsorted(part[order], np.arange(1, number)))
    pieces.sort(key=lambda piece: int(piece[0]))
    return [_part(thing, corners[piece], piece) for piece in pieces]


def _part(thing: SceneObject, corners: Float[np.ndarray, "f 3 3"], piece: Int[np.ndarray, "f"]) -> BodyPart:
    area = np.bincount(thing.face_slot[piece], weights=_areas(corners), minlength=len(thing.slots))
    return BodyPart(corners=corners, slot=int(np.argmax(area)), closed=_is_closed(thing.faces[piece]) and volume(corners) > 0)


def volume(corners: Float[np.ndarray, "f 3 3"]) -> float:
    """Cubic metres within a closed surface, negative where it is wound inward."""
    a, b, c = np.moveaxis(corners - corners.mean(axis=(0, 1)), 1, 0)
    return float(np.einsum("fi,fi->", a, np.cross(b, c))) / 6


def _neighbours(faces: Int[np.ndarray, "f 3"]) -> tuple[np.ndarray, np.ndarray]:
    """Pairs of triangles that alone share an edge."""
    edges = np.sort(np.stack([faces, np.roll(faces, -1, axis=1)], axis=2).reshape(-1, 2), axis=1)
    _, index, times = np.unique(edges, axis=0, return_inverse=True, return_counts=True)
    index = index.reshape(-1)
    order = np.argsort(index, kind="stable")
    start = np.concatenate([[0], np.cumsum(times)[:-1]])[times == 2]
    return order[start] // 3, order[start + 1] // 3


def _is_closed(faces: Int[np.ndarray, "f 3"]) -> bool:
    """Whether each edge is there once in either direction."""
    edges = np.stack([faces, np.roll(faces, -1, axis=1)], axis=2).reshape(-1, 2)
    there = {tuple(edge) for edge in edges.tolist()}
    return len(there) == len(edges) and all((b, a) in there for a, b in there)


def _areas(corners: np.ndarray) -> np.ndarray:
    return np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1) / 2
