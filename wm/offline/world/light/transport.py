"""Rays of the light bake: shadow rays to the sources, rays towards the sun, cosine-weighted rays about, mirrored rays.

Chunks of light points run on two threads (Embree and NumPy release the GIL) and write into their own parts of the result, so that
the result does not depend on their order. Random numbers depend on the point's index and the seed only.
"""

import functools
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor

import numpy as np

from wm.geometry.rays.raycast import RayScene, cast_rays, occluded
from wm.offline.world.light.luxels import LightPoints, locate
from wm.offline.world.light.sources import Emitter
from wm.offline.world.noise import hash_cells
from wm.types import SurfaceKind

NEAR = 0.5  # metres within which a pane is found by rays and not sampled
SOFT = 0.05  # square metres added to squared distances: no source is a point
_AT_LAMP = np.float32(0.03)  # metres before a lamp's point at which shadow rays end; what is nearer gets no light from it
_ROWS = 400  # light points per chunk: with 80 rays each, what one core traces at a time


def sampled_light(scene: RayScene, points: LightPoints, live: np.ndarray, emitters: list[Emitter], seed: int) -> np.ndarray:
    """[l, 3] e that sources farther than NEAR send directly: one shadow ray per sample."""
    total = np.zeros((len(live), 3), np.float32)

    def gather(part: slice) -> None:
        origin, normal = _origins(points, live[part]).astype(np.float32), points.normal[live[part]].astype(np.float32)
        for number, emitter in enumerate(emitters):
            total[part] += _from_emitter(scene, live[part], origin, normal, emitter, seed * 31 + number)

    in_chunks(gather, len(live))
    return total


def sunlight(
    scene: RayScene,
    points: LightPoints,
    live: np.ndarray,
    sun: np.ndarray,
    radiance: np.ndarray,
    seed: int,
    *,
    rays: int,
    cell: float,
) -> np.ndarray:
    """[l, 3] e of the sun where a ray towards it leaves through a pane: jittered over the sun's disc and the point's cell."""
    total = np.zeros((len(live), 3), np.float32)
    cosine = points.normal[live] @ sun
    lit = np.flatnonzero(cosine > 0.02)
    if len(lit) == 0 or not np.any(radiance > 0):
        return total
    share = np.zeros(len(lit))
    side = np.cross(sun, [0.0, 0.0, 1.0])
    side /= np.linalg.norm(side)
    up = np.cross(side, sun)
    for k in range(rays):
        r = _jitter(live[lit], seed * 17 + 100 + k, 4) - np.float32(0.5)
        aim = sun + 0.03 * (r[:, :1] * side + r[:, 1:2] * up)
        origin = _origins(points, live[lit])
        tangent = np.cross(points.normal[live[lit]], sun)
        across = np.cross(points.normal[live[lit]], tangent)
        wobble = cell * (r[:, 2:3] * tangent + r[:, 3:] * across)
        hits = cast_rays(scene, origin + np.where(lit[:, None] < len(points.charts.atlas.inside), wobble, 0.0), aim)
        share += hits.hit & (scene.mesh.face_kind[np.maximum(hits.face, 0)] == SurfaceKind.PANE)
    total[lit] = (cosine[lit] * share / rays)[:, None] * radiance
    return total


def in_free_air(scene: RayScene, position: np.ndarray, normal: np.ndarray) -> np.ndarray:
    """[n] bool: whether a point on a surface stands in free air: most of five rays from it meet no surface from behind."""
    free = np.empty(len(position), bool)
    tilted = np.array([[0.0, 0.0, 1.0], [0.8, 0.1, 0.6], [-0.7, 0.2, 0.7], [0.1, 0.8, 0.6], [-0.2, -0.7, 0.7]], np.float32)

    def look_about(part: slice) -> None:
        directions = np.matmul(tilted, _frames(normal[part])).reshape(-1, 3)
        origins = (position[part] + 2e-3 * normal[part]).astype(np.float32)
        found = cast_rays(scene, np.repeat(origins, len(tilted), axis=0), directions)
        inward = np.einsum("ri,ri->r", directions, scene.normals[found.face]) > 0
        free[part] = inward.reshape(-1, len(tilted)).sum(axis=1) < 3

    in_chunks(look_about, len(position), rows=6000)
    return free


def traced(
    scene: RayScene, points: LightPoints, live: np.ndarray, rays: int, seed: int
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """What the rays of each point find.

    Returns:
      hits: [l, rays] light points.
      near: [l, 3] e of lamps nearer than 0.2 m.
      sky: [l] share of the hemisphere that is sky through a pane nearer than NEAR, by its brightness.
      behind: [l] share of rays that hit a surface from behind.
    """
    hits = np.empty((len(live), rays), np.int32)
    near = np.zeros((len(live), 3), np.float32)
    sky, behind = np.zeros((2, len(live)), np.float32)
    pane = np.append(scene.mesh.face_kind == SurfaceKind.PANE, False)
    glow = np.concatenate([points.glow, np.zeros((1, 3), np.float32)])

    def trace(part: slice) -> None:
        index = live[part]
        directions = directions_about(points.normal[index], index, rays, seed).reshape(-1, 3)
        origins = np.repeat(_origins(points, index).astype(np.float32), rays, axis=0)
        found = cast_rays(scene, origins, directions)
        at = locate(points, found.face, found.barycentric)
        hits[part] = at.reshape(-1, rays)
        inward = np.einsum("ri,ri->r", directions, scene.normals[found.face]) > 0
        behind[part] = inward.reshape(-1, rays).mean(axis=1)
        close = np.flatnonzero(found.t < NEAR)
        glass = close[pane[found.face[close]]]
        sky[part] = np.bincount(glass // rays, _sky(directions[glass, 2]), len(index)) / rays
        lamp = close[(found.t[close] < 0.2) & ~pane[found.face[close]]]
        for c in range(3):
            near[part, c] = np.bincount(lamp // rays, glow[at[lamp], c], len(index)) / rays

    in_chunks(trace, len(live))
    return hits, near, sky, behind


def mirrored(scene: RayScene, points: LightPoints, live: np.ndarray, table: np.ndarray, eye: np.ndarray, seed: int) -> np.ndarray:
    """[l, 3] radiance in a narrow lobe about the mirror direction of the line to the room's middle, 8 rays wide."""
    rays, width = 8, 0.16
    out = np.empty((len(live), 3), np.float32)

    def trace(part: slice) -> None:
        index = live[part]
        view = points.position[index] - eye
        view /= np.maximum(np.linalg.norm(view, axis=1, keepdims=True), 1e-6)
        normal = points.normal[index]
        mirror = view - 2 * np.einsum("ri,ri->r", view, normal)[:, None] * normal
        behind = np.einsum("ri,ri->r", mirror, normal)  # seen from behind: the mirror direction would point inside
        mirror += np.maximum(0.05 - behind, 0)[:, None] * 2 * normal
        spread = _jitter(index, seed * 13 + 5, 3 * rays).reshape(-1, rays, 3) - np.float32(0.5)
        directions = (mirror[:, None] + 2 * width * spread).reshape(-1, 3).astype(np.float32)
        found = cast_rays(scene, np.repeat(_origins(points, index).astype(np.float32), rays, axis=0), directions)
        out[part] = table[locate(points, found.face, found.barycentric)].reshape(-1, rays, 3).mean(axis=1)

    in_chunks(trace, len(live))
    return out


def directions_about(normal: np.ndarray, index: np.ndarray, rays: int, seed: int) -> np.ndarray:
    """[r, rays, 3] float32 cosine-weighted about each normal; which of the sets a point takes depends on its index."""
    chosen = hash_cells(index.astype(np.int32), index.astype(np.int32), 1, seed) & np.uint32(63)
    return np.matmul(_direction_sets(rays, seed)[chosen], _frames(normal))


def _frames(normal: np.ndarray) -> np.ndarray:
    """[n, 3, 3] float32 rows of a right-handed frame whose third axis is the normal."""
    n = normal.astype(np.float32)
    helper = np.where(np.abs(n[:, 2:]) < 0.9, np.array([[0, 0, 1]], np.float32), np.array([[1, 0, 0]], np.float32))
    a = np.cross(helper, n)
    a /= np.linalg.norm(a, axis=1, keepdims=True)
    return np.stack([a, np.cross(n, a), n], axis=1)


@functools.lru_cache(maxsize=4)
def _direction_sets(rays: int, seed: int) -> np.ndarray:
    """[64, rays, 3] float32 cosine-weighted about +z: one low-discrepancy set, turned and shifted 64 ways."""
    k = np.arange(rays)
    shift = _jitter(np.arange(64), seed, 2)
    u = np.mod((k + 0.5) / rays + shift[:, :1], 1.0)
    turn = 2 * np.pi * np.mod(k * 0.6180339887 + shift[:, 1:], 1.0)
    radius = np.sqrt(u)
    return np.stack([radius * np.cos(turn), radius * np.sin(turn), np.sqrt(1 - u)], axis=-1).astype(np.float32)


def _from_emitter(
    scene: RayScene, index: np.ndarray, origin: np.ndarray, normal: np.ndarray, emitter: Emitter, seed: int
) -> np.ndarray:
    """[r, 3] e from one emitter at points `origin`."""
    k = len(emitter.points)
    toward = emitter.points.astype(np.float32) - origin[:, None]
    if np.any(emitter.spread):
        shift = _jitter(index, seed, 2 * k).reshape(-1, k, 2) - np.float32(0.5)
        toward += shift[..., :1] * emitter.spread[:, 0].astype(np.float32) + shift[..., 1:] * emitter.spread[:, 1].astype(
            np.float32
        )
    squared = np.einsum("rki,rki->rk", toward, toward)
    distance = np.sqrt(squared)
    toward /= np.maximum(distance, 1e-6)[..., None]
    form = np.maximum(np.einsum("rki,ri->rk", toward, normal), 0)
    if np.any(emitter.normals):
        form *= np.maximum(-np.einsum("rki,ki->rk", toward, emitter.normals.astype(np.float32)), 0)
    form *= emitter.areas.astype(np.float32) / (np.float32(np.pi) * (squared + np.float32(SOFT)))
    if emitter.sky:
        form *= _sky(toward[..., 2]) * (distance > NEAR)
    form *= distance >= _AT_LAMP
    row, column = np.nonzero(form > 1e-6)
    blocked = occluded(scene, origin[row], toward[row, column], distance[row, column] - _AT_LAMP)
    form[row[blocked], column[blocked]] = 0.0
    return form @ emitter.radiance


def _sky(up: np.ndarray) -> np.ndarray:
    """Radiance of the outdoors by the height of the ray: the ground below is a third as bright as the sky."""
    return 0.3 + 0.7 * np.clip((up + 0.15) / 0.4, 0, 1)


def _origins(points: LightPoints, index: np.ndarray) -> np.ndarray:
    return points.position[index] + 2e-3 * points.normal[index]


def _jitter(index: np.ndarray, seed: int, count: int) -> np.ndarray:
    """[n, count] uniform numbers that depend on the point's index only."""
    columns = np.arange(count, dtype=np.int32)
    bits = hash_cells(index[:, None].astype(np.int32), columns[None], 0, seed)
    return (bits >> np.uint32(8)).astype(np.float32) * np.float32(2.0**-24)


def in_chunks(work: Callable[[slice], None], count: int, *, rows: int = _ROWS) -> None:
    """Run `work` on slices of range(count), two at a time; each writes into its own part of its result."""
    parts = [slice(begin, min(begin + rows, count)) for begin in range(0, count, rows)]
    with ThreadPoolExecutor(2) as pool:
        list(pool.map(work, parts))
