"""The only module that imports embreex. It hides what was measured of embreex: misses carry tfar 1e37, `dists` is overwritten in
place, fewer directions than origins crash, bad indices and NaN vertices are silently never hit, a negative limit reads as
occluded, and the scene is committed by its first query.

embreex is imported when the first scene is built, so that importing `wm.geometry` stays cheap.
"""

import dataclasses
from typing import Any

import numpy as np
from jaxtyping import Float, Int

FAR = np.float32(1e37)
"""Embree's "nothing hit": larger limits are clamped to it."""


@dataclasses.dataclass(frozen=True, eq=False)
class EmbreeScene:
    """A committed Embree scene and the geometry that must outlive it; `scene` is None where there are no triangles."""

    scene: Any
    geometry: Any


def build(vertices: Float[np.ndarray, "v 3"], faces: Int[np.ndarray, "f 3"]) -> EmbreeScene:
    """Embree's BVH over float32 vertices (already near the origin) and valid faces, ready for queries from several threads."""
    if len(faces) == 0:
        return EmbreeScene(scene=None, geometry=None)
    from embreex.mesh_construction import TriangleMesh
    from embreex.rtcore_scene import EmbreeScene as Scene

    scene = Scene(robust=True)
    geometry = TriangleMesh(scene, np.ascontiguousarray(vertices, np.float32), np.ascontiguousarray(faces, np.int32))
    built = EmbreeScene(scene=scene, geometry=geometry)
    intersect(built, np.zeros((1, 3), np.float32), np.ones((1, 3), np.float32))  # the first query commits: not in a thread
    return built


def intersect(
    built: EmbreeScene, origins: Float[np.ndarray, "r 3"], directions: Float[np.ndarray, "r 3"]
) -> dict[str, np.ndarray]:
    """Nearest hits: tfar [r] in units of |d| (FAR on a miss), u, v [r], primID [r] (-1 on a miss). Releases the GIL."""
    _check_rays(origins, directions)
    if built.scene is None or len(origins) == 0:
        count = len(origins)
        zero = np.zeros(count, np.float32)
        return {"tfar": np.full(count, FAR), "u": zero, "v": zero.copy(), "primID": np.full(count, -1, np.int32)}
    return built.scene.run(origins, directions, output=True)


def any_hit(
    built: EmbreeScene,
    origins: Float[np.ndarray, "r 3"],
    directions: Float[np.ndarray, "r 3"],
    limits: Float[np.ndarray, "r"],
) -> np.ndarray:
    """Whether anything is hit at all before `limits` (in units of |d|), bool [r]; twice as fast as the nearest hit.

    Nothing lies before a limit that is zero, negative or NaN.
    """
    _check_rays(origins, directions)
    if limits.shape != origins.shape[:1]:
        raise ValueError(f"{len(origins)} rays need as many limits, not {limits.shape}")
    if built.scene is None or len(origins) == 0:
        return np.zeros(len(origins), bool)
    ahead = limits > 0
    distances = np.where(ahead, np.minimum(limits, FAR), 0).astype(np.float32)  # a copy, for Embree overwrites it
    return ahead & (built.scene.run(origins, directions, dists=distances, query="OCCLUDED") >= 0)


def _check_rays(origins: np.ndarray, directions: np.ndarray) -> None:
    for name, array in (("origins", origins), ("directions", directions)):
        if array.dtype != np.float32 or array.ndim != 2 or array.shape[1] != 3:
            raise ValueError(f"ray {name} must be float32 [r, 3], not {array.dtype} {array.shape}")
    if origins.shape != directions.shape:
        raise ValueError(f"{len(origins)} ray origins but {len(directions)} directions")
