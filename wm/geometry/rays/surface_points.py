"""Points that stand for a mesh's surface, and from where they are in sight."""

import dataclasses
from collections.abc import Sequence

import numpy as np
from jaxtyping import Bool, Float, Int

from wm.geometry.mesh.scene_mesh import face_crosses
from wm.geometry.rays.pinhole import camera_center, project_points
from wm.geometry.rays.raycast import RayScene, occluded
from wm.types import Camera, Mesh, SurfaceKind

OFF_SURFACE = 1e-3
"""Metres in front of its surface from which a point looks, so that it does not shadow itself."""


@dataclasses.dataclass(frozen=True, eq=False)
class SurfacePoints:
    """Points on a mesh, each standing for the same area."""

    position: np.ndarray  # [p, 3] float64
    normal: np.ndarray  # [p, 3] float64 unit
    face: np.ndarray  # [p] int


def surface_points(mesh: Mesh, count: int) -> SurfacePoints:
    """About `count` points over all but the outer skin, evenly by area; the same for the same mesh.

    Source: systematic sampling along the faces' summed area, and within a face the R2 sequence (Roberts, "The Unreasonable
    Effectiveness of Quasirandom Sequences", 2018) folded into the triangle.
    """
    faces = np.flatnonzero(mesh.face_kind != SurfaceKind.EXTERIOR)
    corners = mesh.vertices[mesh.faces[faces]]
    cross = face_crosses(corners)
    doubled = np.linalg.norm(cross, axis=1)
    total = np.cumsum(doubled)
    if not len(total) or total[-1] == 0:
        return SurfacePoints(np.zeros((0, 3)), np.zeros((0, 3)), np.zeros(0, int))
    k = np.arange(count)
    chosen = np.minimum(np.searchsorted(total, (k + 0.5) / count * total[-1], side="right"), len(faces) - 1)
    u, v = np.modf(0.5 + k * 0.7548776662466927)[0], np.modf(0.5 + k * 0.5698402909980532)[0]
    fold = u + v > 1
    u, v = np.where(fold, 1 - u, u), np.where(fold, 1 - v, v)
    p0, p1, p2 = corners[chosen].transpose(1, 0, 2)
    return SurfacePoints(
        position=(1 - u - v)[:, None] * p0 + u[:, None] * p1 + v[:, None] * p2,
        normal=cross[chosen] / doubled[chosen, None],
        face=faces[chosen],
    )


def in_sight(
    scene: RayScene, points: SurfacePoints, which: Int[np.ndarray, "k"], eye: Float[np.ndarray, "3"]
) -> Bool[np.ndarray, "k"]:
    """Whether the points `which` face the eye with nothing between, bool."""
    normal = points.normal[which]
    towards = eye - points.position[which]
    seen = np.sum(normal * towards, axis=1) > OFF_SURFACE
    facing = np.flatnonzero(seen)
    origins = points.position[which[facing]] + OFF_SURFACE * normal[facing]
    seen[facing] = ~occluded(scene, origins, eye - origins, 1.0 - 1e-4)
    return seen


def in_picture(camera: Camera, points: SurfacePoints) -> Bool[np.ndarray, "p"]:
    """Whether the points fall within the picture, whatever stands between."""
    uv, depth = project_points(camera, points.position)
    with np.errstate(invalid="ignore"):
        return (depth > 0) & np.all((uv >= 0) & (uv < (camera.width, camera.height)), axis=1)


def times_seen(scene: RayScene, points: SurfacePoints, cameras: Sequence[Camera]) -> Int[np.ndarray, "p"]:
    """How many cameras see each point: in the picture, facing it, with nothing between."""
    times = np.zeros(len(points.face), int)
    for camera in cameras:
        inside = np.flatnonzero(in_picture(camera, points))
        times[inside] += in_sight(scene, points, inside, camera_center(camera))
    return times


def some_points(points: SurfacePoints, which: Bool[np.ndarray, "p"] | Int[np.ndarray, "k"]) -> SurfacePoints:
    """The points that `which` picks, by a mask or by their indices."""
    return SurfacePoints(points.position[which], points.normal[which], points.face[which])
