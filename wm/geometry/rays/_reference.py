"""The slow twin of raycast.py: every ray against every triangle in float64, with the same interface.

Source: Moeller and Trumbore, "Fast, Minimum Storage Ray/Triangle Intersection", 1997, without culling. With e1 = v1 - v0,
e2 = v2 - v0, s = o - v0: (t, u, v) = (e2 . (s x e1), s . (d x e2), d . (s x e1)) / (e1 . (d x e2)); a hit has t > 0, u, v >= 0,
u + v <= 1. Among equal t the lowest face wins; a ray in a triangle's plane misses it.
"""

import numpy as np
from jaxtyping import Bool, Float

from wm.geometry.mesh.scene_mesh import face_normals
from wm.geometry.rays.pinhole import camera_center, camera_rays
from wm.geometry.rays.raycast import RayHits
from wm.types import Camera, GBuffer, Mesh

_PAIRS = 1 << 20
"""(ray, face) pairs held at once: bounds the memory."""


def cast_reference(mesh: Mesh, camera: Camera) -> GBuffer:
    """`raycast.cast` in float64 (the fields too)."""
    shape = (camera.height, camera.width)
    directions = camera_rays(camera)
    hits = cast_rays_reference(mesh, np.tile(camera_center(camera), (len(directions), 1)), directions)
    normals = np.concatenate([face_normals(mesh), np.zeros((1, 3))])
    return GBuffer(
        depth=np.where(hits.hit, hits.t, 0.0).reshape(shape),
        normal=normals[hits.face].reshape(*shape, 3),
        face=hits.face.reshape(shape),
        barycentric=hits.barycentric.reshape(*shape, 2),
        hit=hits.hit.reshape(shape),
    )


def cast_rays_reference(mesh: Mesh, origins: Float[np.ndarray, "r 3"], directions: Float[np.ndarray, "r 3"]) -> RayHits:
    """`raycast.cast_rays` in float64 (the fields too)."""
    count = len(origins)
    hits = RayHits(
        t=np.full(count, np.inf), face=np.full(count, -1, np.int32), barycentric=np.zeros((count, 2)), hit=np.zeros(count, bool)
    )
    if len(mesh.faces) == 0:
        return hits
    for start in range(0, count, max(1, _PAIRS // len(mesh.faces))):
        part = slice(start, start + max(1, _PAIRS // len(mesh.faces)))
        t, u, v = _intersect_all(mesh, origins[part], directions[part])
        face = np.argmin(t, axis=1)
        row = np.arange(len(face))
        hit = np.isfinite(t[row, face])
        hits.t[part] = t[row, face]
        hits.hit[part] = hit
        hits.face[part] = np.where(hit, face, -1)
        hits.barycentric[part] = np.where(hit[:, None], np.stack([u[row, face], v[row, face]], axis=1), 0.0)
    return hits


def occluded_reference(
    mesh: Mesh,
    origins: Float[np.ndarray, "r 3"],
    directions: Float[np.ndarray, "r 3"],
    max_distance: Float[np.ndarray, "r"] | float = np.inf,
) -> Bool[np.ndarray, "r"]:
    """`raycast.occluded` in float64."""
    return cast_rays_reference(mesh, origins, directions).t < max_distance


def _intersect_all(mesh: Mesh, origins: np.ndarray, directions: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """(t, u, v), each [r, f]; t is inf where the ray misses the face."""
    v0, v1, v2 = (np.asarray(mesh.vertices, np.float64)[mesh.faces[:, k]] for k in range(3))
    e1, e2 = v1 - v0, v2 - v0
    s = np.asarray(origins, np.float64)[:, None, :] - v0
    d = np.asarray(directions, np.float64)[:, None, :]
    d_cross_e2, s_cross_e1 = np.cross(d, e2), np.cross(s, e1)
    determinant = np.sum(e1 * d_cross_e2, axis=-1)
    crosses = determinant != 0
    safe = np.where(crosses, determinant, 1.0)
    t = np.sum(e2 * s_cross_e1, axis=-1) / safe
    u = np.sum(s * d_cross_e2, axis=-1) / safe
    v = np.sum(d * s_cross_e1, axis=-1) / safe
    inside = crosses & (t > 0) & (u >= 0) & (v >= 0) & (u + v <= 1)
    return np.where(inside, t, np.inf), u, v
