"""A mesh with its colours as rays see it: base colours, without any light. Embree finds the faces."""

import dataclasses
import pathlib

import numpy as np
from jaxtyping import Float, UInt8

from wm.geometry.exchange.parts import MeshPart, read_parts
from wm.geometry.rays.raycast import RayScene, build_ray_scene, cast
from wm.types import Camera, Mesh, Render


@dataclasses.dataclass(frozen=True, eq=False)
class PaintedMesh:
    """Triangles ready for rays, and what colours each.

    Attributes:
        rays: the mesh; `Mesh.face_object` is the part of each face
        parts: the parts in the order of their faces
        start: [parts] the first face of each
    """

    rays: RayScene
    parts: tuple[MeshPart, ...]
    start: np.ndarray

    @property
    def vertices(self) -> Float[np.ndarray, "v 3"]:
        return self.rays.mesh.vertices


def read_painted_mesh(path: pathlib.Path) -> PaintedMesh:
    """The triangles of a GLB, glTF, OBJ or PLY file, in its axes and unit. Raises: MeshError, naming the file."""
    parts = tuple(read_parts(path))
    corners = np.concatenate([part.corners for part in parts]) if parts else np.zeros((0, 3, 3))
    counts = [len(part.corners) for part in parts]
    mesh = Mesh.from_triangles(
        corners.reshape(-1, 3), np.arange(3 * len(corners)).reshape(-1, 3), face_object=np.repeat(np.arange(len(parts)), counts)
    )
    return PaintedMesh(rays=build_ray_scene(mesh), parts=parts, start=np.cumsum([0, *counts[:-1]]))


def see(mesh: PaintedMesh, camera: Camera) -> Render:
    """What a camera sees (NumPy leaves), over black; alpha is 1 where a face is hit."""
    gbuffer = cast(mesh.rays, camera)
    rgb = np.zeros((camera.height, camera.width, 3), np.float32)
    hit = gbuffer.hit
    face = gbuffer.face[hit]
    u, v = np.moveaxis(gbuffer.barycentric[hit].astype(np.float64), -1, 0)
    weights = np.stack([1 - u - v, u, v], axis=-1)
    part = mesh.rays.mesh.face_object[face]
    colors = np.zeros((len(face), 3), np.float32)
    for index in np.unique(part):
        own = part == index
        colors[own] = _colors(mesh.parts[index], face[own] - mesh.start[index], weights[own])
    rgb[hit] = colors
    return Render(rgb=rgb, depth=gbuffer.depth, alpha=hit.astype(np.float32))


def _colors(part: MeshPart, face: np.ndarray, weights: Float[np.ndarray, "n 3"]) -> Float[np.ndarray, "n 3"]:
    """sRGB of points on the faces of one part."""
    if part.corner_colors is not None:
        return np.einsum("nc,ncd->nd", weights, part.corner_colors[face] / 255)
    if part.corner_uv is None or part.paint.image is None:
        return np.broadcast_to(part.paint.color, (len(face), 3))
    uv = np.einsum("nc,ncd->nd", weights, part.corner_uv[face])
    return _texels(part.paint.image, uv, repeats=part.paint.repeats)


def _texels(image: UInt8[np.ndarray, "h w 3"], uv: Float[np.ndarray, "n 2"], *, repeats: bool) -> Float[np.ndarray, "n 3"]:
    """Bilinear look-ups; (0, 0) is the first pixel's corner and v runs down."""
    size = np.array([image.shape[1], image.shape[0]])
    at = uv * size - 0.5
    low = np.floor(at).astype(np.int64)
    share = at - low
    total = np.zeros((len(uv), 3))
    for dx, wx in ((0, 1 - share[:, 0]), (1, share[:, 0])):
        for dy, wy in ((0, 1 - share[:, 1]), (1, share[:, 1])):
            pixel = low + np.array([dx, dy])
            pixel = pixel % size if repeats else np.clip(pixel, 0, size - 1)
            total += (wx * wy)[:, None] * image[pixel[:, 1], pixel[:, 0]]
    return total / 255
