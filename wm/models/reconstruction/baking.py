"""The colours of a fine mesh as a texture of a coarse one with the same surface.

Every face of the coarse mesh has a block of n x n pixels. The centre of its pixel (i, j) stands for the point with barycentric
coordinates (u, v) = (j, i) / (n - 1), those beyond the diagonal for the nearest point on it. A pixel has the mean colour of the
_NEAREST points of the fine mesh that lie nearest to its point and face the same way.
"""

import dataclasses

import numpy as np
from jaxtyping import Float, Int
from scipy.spatial import KDTree
from trimesh.triangles import points_to_barycentric

from wm.geometry.mesh.object_colors import object_colors, texture_colors
from wm.geometry.mesh.scene_mesh import face_crosses
from wm.geometry.rays.surface_points import surface_points
from wm.types import Mesh, SceneObject, Texture

_NEAREST = 3
_TURNED = 0.1
"""Share of the mesh's extent that opposite normals count as, so that the two sides of a sheet keep their own colours."""
_DENSITY = 2
"""Points of the fine mesh for each pixel."""
_MOST_PIXELS = 64
"""Pixels of one face along a side."""


def baked(fine: SceneObject, vertices: Float[np.ndarray, "v 3"], faces: Int[np.ndarray, "f 3"], *, texels: int) -> SceneObject:
    """The fine object with a coarse mesh in place of its own.

    Args:
      fine: gives the colours, slots and everything else.
      vertices, faces: the coarse mesh, in the same frame.
      texels: pixels of the texture, about.
    """
    side = int(np.clip(np.sqrt(texels / len(faces)), 2, _MOST_PIXELS))
    corners = vertices[faces].astype(np.float64)
    face, barycentric = _grid(len(faces), side)
    rgb, slot = _looked_up(fine, corners, face, barycentric)
    image, corner_uv = _sheet(rgb.reshape(len(faces), side, side, 3))
    texture = Texture(image=image, corner_uv=corner_uv, slots=np.ones(len(fine.slots), bool))
    face_slot = slot.reshape(len(faces), -1)[:, 0].astype(np.int32)
    return dataclasses.replace(
        fine, vertices=vertices, faces=faces.astype(np.int32), face_slot=face_slot, texture=texture,
        slot_colors=_mean_colors(texture, face_slot, fine.slot_colors),
    )  # fmt: skip


def _grid(count: int, side: int) -> tuple[np.ndarray, np.ndarray]:
    """(face [n], barycentric [n, 2]) of all pixels, a face's block after the other's."""
    v, u = np.meshgrid(np.linspace(0, 1, side), np.linspace(0, 1, side), indexing="ij")
    beyond = np.maximum(u + v - 1, 0) / 2
    block = np.stack([u - beyond, v - beyond], axis=-1).reshape(-1, 2)
    return np.repeat(np.arange(count), side * side), np.tile(block, (count, 1))


def _looked_up(
    fine: SceneObject, corners: np.ndarray, face: np.ndarray, barycentric: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """(colours [n, 3] in [0, 1], slots [n]) of the fine object at points of the coarse mesh's faces."""
    found = surface_points(Mesh.from_triangles(fine.vertices, fine.faces), max(_DENSITY * len(face), len(fine.faces)))
    where = points_to_barycentric(fine.vertices[fine.faces][found.face], found.position)
    rgb = object_colors([fine], np.zeros(len(found.face), np.intp), found.face, where[:, 1:])
    reach = _TURNED * float(np.ptp(fine.vertices, axis=0).max()) / 2
    theirs = np.concatenate([found.position, reach * found.normal], axis=1)
    u, v = barycentric[:, :1], barycentric[:, 1:]
    points = (1 - u - v) * corners[face, 0] + u * corners[face, 1] + v * corners[face, 2]
    ours = np.concatenate([points, reach * _normals(corners)[face]], axis=1)
    _, near = KDTree(theirs).query(ours, k=_NEAREST)
    near = np.asarray(near)
    return rgb[near].mean(axis=1), fine.face_slot[found.face[near[:, 0]]]


def _normals(corners: np.ndarray) -> np.ndarray:
    crosses = face_crosses(corners)
    length = np.linalg.norm(crosses, axis=1, keepdims=True)
    return crosses / np.where(length > 0, length, 1.0)


def _sheet(blocks: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """(image [h, w, 3] uint8, corner_uv [f, 3, 2]) of the blocks [f, n, n, 3] of all faces, in rows of a square."""
    count, side = blocks.shape[:2]
    across = int(np.ceil(np.sqrt(count)))
    down = -(-count // across)
    sheet = np.zeros((down * across, side, side, 3), np.uint8)
    sheet[:count] = np.round(255 * np.clip(blocks, 0, 1))
    image = sheet.reshape(down, across, side, side, 3).swapaxes(1, 2).reshape(down * side, across * side, 3)
    row, column = np.divmod(np.arange(count), across)
    origin = np.stack([column, row], axis=1)[:, None] * side + 0.5
    corner = (side - 1) * np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]])
    return image, ((origin + corner) / [across * side, down * side]).astype(np.float32)


def _mean_colors(texture: Texture, face_slot: np.ndarray, otherwise: np.ndarray) -> np.ndarray:
    """[s, 3] float32 the mean colour of each slot's faces; of a slot without faces that of `otherwise`."""
    rgb = texture_colors(texture, np.arange(len(face_slot)), np.full((len(face_slot), 2), 1 / 3))
    count = np.bincount(face_slot, minlength=len(otherwise))
    total = np.stack([np.bincount(face_slot, column, len(otherwise)) for column in rgb.T], axis=1)
    return np.where(count[:, None] > 0, total / np.maximum(count, 1)[:, None], otherwise).astype(np.float32)
