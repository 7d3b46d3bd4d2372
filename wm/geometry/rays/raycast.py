"""What rays see of a mesh: nearest hits, occlusion and whole G-buffers, by Embree on every core.

Tiers of work: per mesh, `build_ray_scene` builds the BVH and the table of normals; per query, rays are made, traced and looked
up in chunks, one thread per core (Embree and NumPy release the GIL). Chunks write into disjoint slices, so the result does not
depend on the number of threads. Embree works in float32: the mesh's middle is subtracted in float64 first, which leaves an
error of about 1e-7 of the scene's extent wherever the scene stands. `_reference.py` holds the slow float64 twin.
"""

import dataclasses
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor

import numpy as np
from jaxtyping import Bool, Float

from wm.geometry.mesh.scene_mesh import check_mesh, face_normals
from wm.geometry.rays import _embree
from wm.geometry.rays.pinhole import basis_rays, camera_center, ray_basis
from wm.host import cores
from wm.types import Camera, GBuffer, Mesh

_CHUNK = 1 << 15
"""Rays per task: their arrays (2 MiB) stay in the L2 cache from tracing to look-up, and a task's overhead is 1 % of its work."""


@dataclasses.dataclass(frozen=True, eq=False)
class RayScene:
    """A mesh that is ready to be hit by rays."""

    mesh: Mesh
    origin: np.ndarray  # [3] float64, the world point that Embree calls zero
    normals: np.ndarray  # [f + 1, 3] float32 unit face normals; the last row is 0, so that face -1 looks up no normal
    embree: _embree.EmbreeScene


@dataclasses.dataclass(frozen=True, eq=False)
class RayHits:
    """The nearest hit of each ray."""

    t: np.ndarray  # [r] float32, in units of the direction's length; inf on a miss
    face: np.ndarray  # [r] int32, -1 on a miss
    barycentric: np.ndarray  # [r, 2] float32 (u, v): p = (1 - u - v) v0 + u v1 + v v2; 0 on a miss
    hit: np.ndarray  # [r] bool


def build_ray_scene(mesh: Mesh) -> RayScene:
    """Check the mesh and build what the queries need of it, once. Raises: ValueError for NaN vertices or bad indices."""
    check_mesh(mesh)
    used = mesh.vertices[mesh.faces.reshape(-1)]
    origin = (used.min(axis=0) + used.max(axis=0)) / 2.0 if len(used) else np.zeros(3)
    normals = np.concatenate([face_normals(mesh), np.zeros((1, 3))]).astype(np.float32)
    embree = _embree.build((mesh.vertices - origin).astype(np.float32), mesh.faces)
    return RayScene(mesh=mesh, origin=origin, normals=normals, embree=embree)


def ray_scene(scene: Mesh | RayScene) -> RayScene:
    """The RayScene of a mesh; a RayScene is returned as it is."""
    return scene if isinstance(scene, RayScene) else build_ray_scene(scene)


def cast(scene: Mesh | RayScene, camera: Camera) -> GBuffer:
    """The G-buffer of a camera. For several views of one mesh, build its RayScene once and pass that.

    Faces are hit from both sides; the normal is as the mesh winds it.
    """
    scene = ray_scene(scene)
    height, width = camera.height, camera.width
    eye = (camera_center(camera) - scene.origin).astype(np.float32)
    columns, rows = (part.astype(np.float32) for part in ray_basis(camera))
    gbuffer = GBuffer(
        depth=np.empty((height, width), np.float32),
        normal=np.empty((height, width, 3), np.float32),
        face=np.empty((height, width), np.int32),
        barycentric=np.empty((height, width, 2), np.float32),
        hit=np.empty((height, width), bool),
    )

    def trace(part: slice) -> None:
        directions = basis_rays(columns, rows[part])
        found = _embree.intersect(scene.embree, np.broadcast_to(eye, directions.shape), directions)
        face = found["primID"]
        hit = face >= 0
        gbuffer.face[part] = face.reshape(-1, width)
        gbuffer.hit[part] = hit.reshape(-1, width)
        np.multiply(found["tfar"].reshape(-1, width), gbuffer.hit[part], out=gbuffer.depth[part])
        np.take(scene.normals, face, axis=0, out=gbuffer.normal[part].reshape(-1, 3), mode="wrap")
        _store_barycentric(gbuffer.barycentric[part].reshape(-1, 2), found, hit)

    _in_threads(trace, height, max(1, _CHUNK // width))
    return gbuffer


def cast_rays(scene: Mesh | RayScene, origins: Float[np.ndarray, "r 3"], directions: Float[np.ndarray, "r 3"]) -> RayHits:
    """The nearest hit of each ray, from either side of a face. Directions need not be unit; a ray with a NaN hits nothing.

    A ray that starts on a surface may hit that surface: start it 1e-4 m or more in front.

    Raises: ValueError for origins and directions that do not belong together, or a broken mesh.
    """
    _check_shapes(origins, directions)
    scene = ray_scene(scene)
    count = len(origins)
    hits = RayHits(
        t=np.empty(count, np.float32),
        face=np.empty(count, np.int32),
        barycentric=np.empty((count, 2), np.float32),
        hit=np.empty(count, bool),
    )

    def trace(part: slice) -> None:
        found = _embree.intersect(scene.embree, *_local(scene, origins[part], directions[part]))
        hits.face[part] = found["primID"]
        hit = np.greater_equal(found["primID"], 0, out=hits.hit[part])
        hits.t[part] = np.where(hit, found["tfar"], np.float32(np.inf))
        _store_barycentric(hits.barycentric[part], found, hit)

    _in_threads(trace, count, _CHUNK)
    return hits


def occluded(
    scene: Mesh | RayScene,
    origins: Float[np.ndarray, "r 3"],
    directions: Float[np.ndarray, "r 3"],
    max_distance: Float[np.ndarray, "r"] | float = np.inf,
) -> Bool[np.ndarray, "r"]:
    """Whether anything stands in each ray's way before `max_distance` (in units of the direction's length).

    Nothing stands before a distance that is zero, negative or NaN.

    Raises: ValueError for rays or distances that do not belong together, or a broken mesh.
    """
    _check_shapes(origins, directions)
    limits = np.asarray(max_distance)
    if limits.shape not in ((), origins.shape[:1]):
        raise ValueError(f"max_distance must be one number or [{len(origins)}], one for each ray; it is {list(limits.shape)}")
    limits = np.broadcast_to(limits, origins.shape[:1])
    scene = ray_scene(scene)
    blocked = np.empty(len(origins), bool)

    def trace(part: slice) -> None:
        blocked[part] = _embree.any_hit(scene.embree, *_local(scene, origins[part], directions[part]), limits[part])

    _in_threads(trace, len(origins), _CHUNK)
    return blocked


def _local(scene: RayScene, origins: np.ndarray, directions: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    return (origins - scene.origin).astype(np.float32), np.asarray(directions, np.float32)


def _store_barycentric(out: np.ndarray, found: dict[str, np.ndarray], hit: np.ndarray) -> None:
    out[:, 0], out[:, 1] = found["u"], found["v"]
    if not hit.all():
        out[~hit] = 0.0


def _check_shapes(origins: np.ndarray, directions: np.ndarray) -> None:
    if origins.ndim != 2 or origins.shape[1] != 3 or origins.shape != directions.shape:
        raise ValueError(f"rays need origins and directions of one shape [r, 3], not {origins.shape} and {directions.shape}")


def _in_threads(work: Callable[[slice], None], count: int, chunk: int) -> None:
    """Run `work` on slices of range(count), on every core this process may use."""
    parts = [slice(start, min(start + chunk, count)) for start in range(0, count, chunk)]
    threads = min(len(parts), cores())
    if threads <= 1:
        for part in parts:
            work(part)
        return
    with ThreadPoolExecutor(threads) as pool:
        list(pool.map(work, parts))
