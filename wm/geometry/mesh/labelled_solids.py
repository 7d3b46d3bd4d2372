"""Solids with a label on every plane: the structure is carved from them and with them.

They are not the solids of wm.offline.furniture.solids: those are put together without booleans and carry no labels. trimesh's
extrusions and booleans have no place for a label that survives a cut; manifold3d, which trimesh calls too, has one.
"""

import dataclasses
from collections.abc import Sequence

import manifold3d
import numpy as np
from shapely.geometry import Polygon
from shapely.geometry.polygon import orient


@dataclasses.dataclass(frozen=True, eq=False)
class LabelledSolid:
    """A closed mesh of few planes. Labels are free integers that survive booleans (`carve`)."""

    vertices: np.ndarray  # [v, 3] float64
    faces: np.ndarray  # [f, 3] int64, normals outwards
    face_plane: np.ndarray  # [f] int64, index into plane_label
    plane_label: np.ndarray  # [p] int64

    @property
    def volume(self) -> float:
        a, b, c = (self.vertices[self.faces[:, k]] for k in range(3))
        return float(np.sum(a * np.cross(b, c))) / 6


def prism(rings: Sequence[np.ndarray], low: float, high: float, *, bottom: int, top: int, side: int) -> LabelledSolid:
    """An upright prism over a polygon with holes.

    Args:
      rings: [k, 2] each, as `polygon_rings` gives them.
      low, high: heights of its bottom and top.
      bottom, top, side: labels.
    """
    flat = np.concatenate(rings)
    n = len(flat)
    cap = np.asarray(manifold3d.triangulate([np.ascontiguousarray(ring) for ring in rings]), dtype=np.int64)
    here = np.arange(n)
    after = np.concatenate([np.roll(part, -1) for part in np.split(here, np.cumsum([len(ring) for ring in rings])[:-1])])
    walls = [np.stack([here, after, after + n], axis=1), np.stack([here, after + n, here + n], axis=1)]
    vertices = np.concatenate([np.column_stack([flat, np.full(n, z)]) for z in (low, high)])
    planes = np.concatenate([np.full(len(cap), 0), np.full(len(cap), 1), here + 2, here + 2])
    return LabelledSolid(vertices, np.concatenate([cap[:, ::-1], cap + n, *walls]), planes, np.array([bottom, top] + [side] * n))


def tunnel(sections: np.ndarray, *, bottom: int, side: int, first: int, last: int) -> LabelledSolid:
    """A tube of rectangular sections, closed at both ends.

    Args:
      sections: [k, 4, 3] corners: start and end below, end and start above; each section is counter-clockwise seen from the
        next one.
      bottom: label below; side: beside and above; first, last: at the two ends.
    """
    count = len(sections)
    corner = np.arange(4)
    quads = [
        np.stack([4 * k + corner, 4 * k + (corner + 1) % 4, 4 * (k + 1) + (corner + 1) % 4, 4 * (k + 1) + corner], axis=1)
        for k in range(count - 1)
    ]
    quads = np.concatenate([[[3, 2, 1, 0]], [4 * (count - 1) + corner], *quads])
    faces = np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])
    planes = np.tile(np.arange(len(quads)), 2)
    return LabelledSolid(
        sections.reshape(-1, 3), faces, planes, np.array([first, last] + [bottom, side, side, side] * (count - 1))
    )


def polygon_rings(polygon: Polygon) -> tuple[np.ndarray, ...]:
    """A polygon's outer ring counter-clockwise and its holes clockwise, first points not repeated."""
    polygon = orient(polygon)
    return tuple(np.asarray(ring.coords)[:-1] for ring in (polygon.exterior, *polygon.interiors))


def carve(blocks: Sequence[LabelledSolid], cutters: Sequence[LabelledSolid]) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The union of the blocks less all cutters. Faces of cutters that coincide get the label of either.

    Returns:
      vertices: [v, 3] float64.
      faces: [f, 3] int32, normals out of the solid.
      labels: [f] the label of the plane on which each triangle lies.

    Raises:
      RuntimeError: the geometry kernel failed; it raises nothing itself, so its status is asked for here.
    """
    solids = [*blocks, *cutters]
    first = np.cumsum([0] + [len(solid.plane_label) for solid in solids[:-1]])
    # CSG is lazy: nothing is evaluated before the end (asking for a status before takes 100 times as long).
    parts = [_manifold(solid, int(start)) for solid, start in zip(solids, first)]
    head = manifold3d.Manifold.batch_boolean(parts[: len(blocks)], manifold3d.OpType.Add)
    result = manifold3d.Manifold.batch_boolean([head, *parts[len(blocks) :]], manifold3d.OpType.Subtract)
    if result.status() != manifold3d.Error.NoError or result.is_empty():
        raise RuntimeError(f"the structure could not be carved: {result.status()}")
    mesh = result.to_mesh64()
    labels = np.concatenate([solid.plane_label for solid in solids])
    vertices = np.array(mesh.vert_properties[:, :3])
    return vertices, np.asarray(mesh.tri_verts).astype(np.int32), labels[np.asarray(mesh.face_id).astype(np.int64)]


def _manifold(solid: LabelledSolid, first: int) -> manifold3d.Manifold:
    """The kernel's own form; every plane carries an id, counted from `first`."""
    faces, ids = solid.faces.astype(np.uint64), (solid.face_plane + first).astype(np.uint64)
    return manifold3d.Manifold(manifold3d.Mesh64(np.ascontiguousarray(solid.vertices), faces, face_id=ids))
