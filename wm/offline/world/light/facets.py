"""Where light is stored on objects: corners of a regular subdivision of every triangle.

A triangle whose longest edge is L is divided into n x n small ones, n = ceil(L / spacing). Corner (i, j), 0 <= i + j <= n, lies
at barycentrics (i, j) / n and is entry i (n + 1) - i (i - 1) / 2 + j of the face's part of a table. Corners of neighbouring faces
that agree in place and in smoothed normal are one light point, so light is continuous over curved surfaces and breaks at creases.
"""

import dataclasses

import numpy as np
from jaxtyping import Float, Int
from scipy.sparse import coo_array

from wm.geometry.mesh.scene_mesh import face_crosses

CREASE = np.cos(np.radians(40.0))
"""Faces that meet at a smaller angle are shaded as one smooth surface."""
MOST = 12
"""Subdivisions of an edge at most, so that one large triangle cannot ask for thousands of points."""
PULL = 0.04
"""Light points are drawn this share of a small triangle inwards, so that their rays do not start on the floor they stand on."""


@dataclasses.dataclass(frozen=True, eq=False)
class Facets:
    """Light points of a set of triangles."""

    divisions: np.ndarray  # [f] int32 n of each face
    start: np.ndarray  # [f] int64 first entry of each face in `table`
    table: np.ndarray  # [e] int32 light point of each corner
    position: np.ndarray  # [p, 3] float64 where a point's rays start, metres
    normal: np.ndarray  # [p, 3] float64 unit
    face: np.ndarray  # [p] int32: a face that the point lies on
    corner_normal: np.ndarray  # [f, 3, 3] float32 smoothed unit normals at the corners of each face


def build_facets(vertices: Float[np.ndarray, "v 3"], faces: Int[np.ndarray, "f 3"], *, spacing: float) -> Facets:
    """Light points about `spacing` metres apart on triangles."""
    if len(faces) == 0:
        none = np.zeros(0, np.int32)
        return Facets(
            divisions=none, start=np.zeros(0, np.int64), table=none,
            position=np.zeros((0, 3)), normal=np.zeros((0, 3)), face=none,
            corner_normal=np.zeros((0, 3, 3), np.float32),
        )  # fmt: skip
    corners = vertices[faces]
    smooth = _corner_normals(corners)
    longest = np.linalg.norm(corners - np.roll(corners, -1, axis=1), axis=2).max(axis=1)
    divisions = np.clip(np.ceil(longest / spacing), 1, MOST).astype(np.int32)
    sizes = ((divisions + 1) * (divisions + 2) // 2).astype(np.int64)
    start = np.cumsum(sizes) - sizes
    position, normal = np.empty((int(sizes.sum()), 3)), np.empty((int(sizes.sum()), 3))
    exact = np.empty_like(position)
    for n in np.unique(divisions):
        chosen = np.flatnonzero(divisions == n)
        weights = _lattice(int(n))
        entries = start[chosen][:, None] + np.arange(len(weights))
        pulled = weights * (1 - PULL) + PULL * _cell_middle(weights, int(n))
        exact[entries] = np.einsum("kp,fpi->fki", weights, corners[chosen])
        position[entries] = np.einsum("kp,fpi->fki", pulled, corners[chosen])
        normal[entries] = np.einsum("kp,fpi->fki", weights, smooth[chosen])
    normal /= np.maximum(np.linalg.norm(normal, axis=1, keepdims=True), 1e-12)
    owner = np.repeat(np.arange(len(faces), dtype=np.int32), sizes)
    _, first, table = np.unique(_keys(exact, normal), return_index=True, return_inverse=True)
    return Facets(
        divisions=divisions, start=start, table=table.ravel().astype(np.int32), position=position[first], normal=normal[first],
        face=owner[first], corner_normal=smooth.astype(np.float32),
    )  # fmt: skip


def facet_weights(
    facets: Facets, face: Int[np.ndarray, "r"], barycentric: Float[np.ndarray, "r 2"]
) -> tuple[Int[np.ndarray, "r 3"], Float[np.ndarray, "r 3"]]:
    """The three light points around each hit and their linear weights."""
    n = facets.divisions[face]
    u = np.clip(barycentric[:, 0] * n, 0, n).astype(np.float32)
    v = np.clip(barycentric[:, 1] * n, 0, n).astype(np.float32)
    i = np.minimum(u.astype(np.int32), n - 1)
    j = np.minimum(v.astype(np.int32), n - 1 - i)
    j = np.maximum(j, 0)
    fu, fv = np.clip(u - i, 0, 1), np.clip(v - j, 0, 1)
    upper = (fu + fv > 1) & (i + j + 2 <= n)
    base = facets.start[face]

    def entry(a: np.ndarray, b: np.ndarray) -> np.ndarray:
        return facets.table[base + a * (n + 1) - a * (a - 1) // 2 + b]

    first = entry(i + upper, j + upper)
    points = np.stack([first, entry(i + 1, j), entry(i, j + 1)], axis=1)
    excess = np.where(upper, fu + fv - 1, np.maximum(1 - fu - fv, 0))
    weights = np.stack([excess, np.where(upper, 1 - fv, fu), np.where(upper, 1 - fu, fv)], axis=1).astype(np.float32)
    return points, weights / weights.sum(axis=1, keepdims=True)


def _corner_normals(corners: np.ndarray) -> np.ndarray:
    """[f, 3, 3] unit normals: at each corner the area-weighted mean of the faces there that meet this one smoothly."""
    cross = face_crosses(corners)
    unit = cross / np.maximum(np.linalg.norm(cross, axis=1, keepdims=True), 1e-12)
    count = 3 * len(corners)
    _, place = np.unique(_place_keys(corners.reshape(-1, 3), 1e-4), return_inverse=True)
    at = coo_array((np.ones(count, np.float32), (np.arange(count), place.ravel()))).tocsr()
    pairs = (at @ at.T).tocoo()
    row, column = pairs.row // 3, pairs.col // 3
    smooth = np.einsum("ki,ki->k", unit[row], unit[column]) > CREASE
    joined = coo_array((smooth[smooth].astype(np.float64), (pairs.row[smooth], pairs.col[smooth])), shape=(count, count)).tocsr()
    total = joined @ np.repeat(cross, 3, axis=0)
    length = np.linalg.norm(total, axis=1, keepdims=True)
    return np.where(length > 1e-12, total / np.maximum(length, 1e-12), np.repeat(unit, 3, axis=0)).reshape(-1, 3, 3)


def _lattice(n: int) -> np.ndarray:
    """[(n + 1)(n + 2) / 2, 3] barycentrics of a subdivided triangle's corners, in the table's order."""
    return np.array([((n - i - j) / n, i / n, j / n) for i in range(n + 1) for j in range(n + 1 - i)])


def _cell_middle(weights: np.ndarray, n: int) -> np.ndarray:
    """Barycentrics a small triangle further towards the face's middle."""
    toward = np.full(3, 1 / 3) - weights
    return weights + toward * min(1.0, 1.5 / n)


def _place_keys(points: np.ndarray, step: float) -> np.ndarray:
    """One integer per place on a grid of `step` metres (21 bits per axis)."""
    cell = np.round((points - points.min(axis=0)) / step).astype(np.int64) & 0x1FFFFF
    return cell[:, 0] | (cell[:, 1] << 21) | (cell[:, 2] << 42)


def _keys(points: np.ndarray, normals: np.ndarray) -> np.ndarray:
    """One integer per place (1 mm, 17 bits per axis) and direction of the normal (4 bits per axis)."""
    cell = np.round((points - points.min(axis=0)) / 1e-3).astype(np.int64) & 0x1FFFF
    turn = np.round((normals + 1) * 4).astype(np.int64)
    place = cell[:, 0] | (cell[:, 1] << 17) | (cell[:, 2] << 34)
    return place | (turn[:, 0] << 51) | (turn[:, 1] << 55) | (turn[:, 2] << 59)
