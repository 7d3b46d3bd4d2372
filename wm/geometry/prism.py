"""Upright prisms with a label on every face: what the structure is carved from, and with."""

import dataclasses
from collections.abc import Sequence

import manifold3d
import numpy as np
from shapely.geometry import Polygon
from shapely.geometry.polygon import orient


@dataclasses.dataclass(frozen=True, eq=False)
class Prism:
    """A polygon, holes allowed, between two heights. Labels are free integers that survive booleans (`carve`)."""

    rings: tuple[np.ndarray, ...]  # [k, 2] each: outer counter-clockwise, then holes clockwise
    low: float
    high: float
    bottom: int
    top: int
    sides: Sequence[int]  # one a ring edge, rings in order


def polygon_rings(polygon: Polygon) -> tuple[np.ndarray, ...]:
    """A polygon's outer ring counter-clockwise and its holes clockwise, first points not repeated."""
    polygon = orient(polygon)
    return tuple(np.asarray(ring.coords)[:-1] for ring in (polygon.exterior, *polygon.interiors))


def carve(block: Sequence[Prism], cutters: Sequence[Prism]) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The union of `block` less all `cutters`.

    Returns:
      vertices: [v, 3] float64.
      faces: [f, 3] int32, normals out of the solid.
      labels: [f] the label of the prism face on which each triangle lies.

    Raises:
      RuntimeError: the geometry kernel failed; its errors are values, so they are asked for here.
    """
    prisms = [*block, *cutters]
    counts = [2 + len(prism.sides) for prism in prisms]
    first = np.concatenate([[0], np.cumsum(counts)])
    # CSG is lazy: nothing is evaluated before to_mesh64 (asking for a status in between costs x100).
    solids = [_solid(prism, int(start)) for prism, start in zip(prisms, first)]
    head = manifold3d.Manifold.batch_boolean(solids[: len(block)], manifold3d.OpType.Add)
    result = manifold3d.Manifold.batch_boolean([head, *solids[len(block) :]], manifold3d.OpType.Subtract)
    if result.status() != manifold3d.Error.NoError or result.is_empty():
        raise RuntimeError(f"the structure could not be carved: {result.status()}")
    mesh = result.to_mesh64()
    labels = np.concatenate([[prism.bottom, prism.top, *prism.sides] for prism in prisms])
    vertices = np.array(mesh.vert_properties[:, :3])
    return vertices, np.asarray(mesh.tri_verts).astype(np.int32), labels[np.asarray(mesh.face_id).astype(np.int64)]


def _solid(prism: Prism, first: int) -> manifold3d.Manifold:
    """The prism as a solid whose faces carry the ids first (bottom), first + 1 (top), first + 2 ... (sides)."""
    flat = np.concatenate(prism.rings)
    n = len(flat)
    cap = np.asarray(manifold3d.triangulate([np.ascontiguousarray(ring) for ring in prism.rings])).astype(np.uint64)
    here = np.arange(n, dtype=np.uint64)
    sizes = [len(ring) for ring in prism.rings]
    offsets = np.concatenate([[0], np.cumsum(sizes)[:-1]])
    after = np.concatenate([offset + np.roll(np.arange(size), -1) for offset, size in zip(offsets, sizes)]).astype(np.uint64)
    top = np.uint64(n)
    faces = np.concatenate(
        [
            cap[:, ::-1],
            cap + top,
            np.stack([here, after, after + top], axis=1),
            np.stack([here, after + top, here + top], axis=1),
        ]
    )
    sides = np.arange(first + 2, first + 2 + n)
    ids = np.concatenate([np.full(len(cap), first), np.full(len(cap), first + 1), sides, sides]).astype(np.uint64)
    vertices = np.empty((2 * n, 3))
    vertices[:, :2] = np.tile(flat, (2, 1))
    vertices[:n, 2], vertices[n:, 2] = prism.low, prism.high
    return manifold3d.Manifold(manifold3d.Mesh64(vertices, np.ascontiguousarray(faces), face_id=ids))
