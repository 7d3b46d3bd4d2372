"""Light in a room, once: what every light point receives from panes, sun and lamps, directly and after several bounces.

Notation: e = irradiance / pi, so a matt surface of albedo a shows radiance a e. With direct light d, hits h(i, j) of
cosine-weighted ray j from point i, and radiosity a e of what it hits,
    e_i = d_i + mean_j a_h(i,j) e_h(i,j)          (+ the radiance of sources nearer than NEAR, which sampling d would make noisy)
is iterated as a gather: rays are traced once, bounces are table look-ups. Light the room loses through doors comes back as the
room's own mean. Tiers of work: per room, R rays per point and one shadow ray per point and source sample; per bounce, one gather.
Source: Cohen and Wallace, Radiosity and Realistic Image Synthesis, 1993, gathering; the bend vector is ours: the direction that
light comes from, by which relief is shaded: e(n + g) ~ e(n) (1 + bend . g).
"""

import dataclasses

import numpy as np
from scipy.sparse import csr_array

from wm.color import LUMINANCE
from wm.geometry.rays.raycast import RayScene
from wm.offline.world.light.environment import environment
from wm.offline.world.light.luxels import LightPoints, filled, smooth
from wm.offline.world.light.sources import Emitter
from wm.offline.world.light.transport import directions_about, in_chunks, mirrored, sampled_light, sunlight, traced
from wm.offline.world.tone import adapted

BURIED = 0.5
"""Share of rays that hit a surface from behind, above which a point lies inside a solid, so that its darkness is not spread."""
BRIGHT, RANGE = 1.7, 1.7
"""In multiples of a room's target: e above which light is compressed, and how far beyond it ends. An eye does the same that looks
at a room and at the wall behind a lamp at once."""

ADAPTED = 0.5
"""How far an eye adapts to the colour of a room's light: without adaptation, walls that tint each other at every bounce would
give a cast that no visitor sees; with full adaptation, no cast would be left."""


@dataclasses.dataclass(frozen=True, eq=False)
class Sources:
    """What shines into a room, in relative radiances."""

    panes: list[Emitter]
    lamps: list[Emitter]
    sun: np.ndarray  # [3] unit vector towards the sun
    sun_light: np.ndarray  # [3] e on a surface that faces the sun
    day: float  # 0..1 share of the room's light that daylight may give
    evening: float  # 0..1 how strong lamps are at least
    mood: float = 1.0  # how bright the room is to be, against the settings' target


@dataclasses.dataclass(frozen=True, eq=False)
class LightField:
    """Baked light at the light points."""

    irradiance: np.ndarray  # [n, 3] float32 e = irradiance / pi
    bend: np.ndarray  # [n, 3] float32 where light comes from
    mirror: np.ndarray  # [n, 3] float32 radiance that a gloss at the point reflects to the middle of the room
    environment: np.ndarray  # [h, w, 3] float32 radiance about the middle of the room (see light.environment)


@dataclasses.dataclass(frozen=True)
class BakeSettings:
    """How fine the light is."""

    cell: float = 0.06  # metres between light points on structure
    spacing: float = 0.15  # metres between corners that store light on objects
    probe_spacing: float = 0.09  # metres between the probes that light is computed at on objects
    probes: int = 24000  # per room at most
    rays: int = 80  # per point
    sun_rays: int = 6  # per point
    bounces: int = 4
    target: float = 0.23  # mean radiance that a room is lit to
    ambient: float = 0.05  # share of the mean e that reaches even hidden places


def bake(
    scene: RayScene, points: LightPoints, sources: Sources, *, eye: np.ndarray, seed: int, settings: BakeSettings
) -> LightField:
    """The light field of a room, glosses and mirrors reflecting for an eye in its middle, `eye` [3]."""
    live = np.flatnonzero(points.live)
    hits, near, sky, behind = traced(scene, points, live, settings.rays, seed)
    exposed = points.live.copy()
    exposed[live[behind > BURIED]] = False
    kept = exposed[live]
    live, hits, near, sky = live[kept], hits[kept], near[kept], sky[kept]
    points = dataclasses.replace(points, live=exposed)

    direct = np.zeros((len(points.live), 9), np.float32)  # of panes, lamps and sun
    direct[live, 0:3] = sampled_light(scene, points, live, sources.panes, seed)
    direct[live, 3:6] = sampled_light(scene, points, live, sources.lamps, seed + 1)
    direct[live, 6:9] = sunlight(
        scene, points, live, sources.sun, sources.sun_light, seed, rays=settings.sun_rays, cell=settings.cell
    )
    direct = smooth(points, direct, sigma=0.55, rounds=1)
    direct[live, 3:6] += near
    if sources.panes:
        direct[live, 0:3] += sky[:, None] * sources.panes[0].radiance[0]
    field = _bounced(points, live, direct, hits, settings.bounces)

    mean_albedo = max(float(_mean(points.albedo, points.live) @ LUMINANCE), 0.05)
    target = float(np.clip(sources.mood * settings.target / mean_albedo, 0.36, 0.62))
    factors = np.repeat(_balance(points, field, sources, target), 3)
    total = (field * factors).reshape(-1, 3, 3).sum(axis=1) + np.float32(settings.ambient * target)
    total = _compressed(adapted(total, _mean(total, live), ADAPTED), BRIGHT * target, RANGE * target)
    radiance = points.albedo * total + points.glow
    table = np.concatenate([radiance, _mean(radiance, points.live)[None]])
    bend, mirror = np.zeros((2, len(points.live), 3), np.float32)
    bend[live] = _bends(points, live, table, hits, total, seed)
    bend[live] += _source_bends(points, live, sources.panes, direct[:, :3] * factors[:3], total)
    mirror[live] = mirrored(scene, points, live, table, eye, seed)
    return LightField(
        irradiance=filled(points, total),
        bend=filled(points, smooth(points, bend, sigma=1.0, rounds=2)),
        mirror=filled(points, smooth(points, mirror, sigma=0.8, rounds=1)),
        environment=environment(scene, points, table, eye),
    )


def _bounced(points: LightPoints, live: np.ndarray, direct: np.ndarray, hits: np.ndarray, bounces: int) -> np.ndarray:
    """[n, 9] e of each source after the bounces, the indirect part smoothed."""
    field, gather = direct, _gather_matrix(hits, len(points.live) + 1)
    for _ in range(bounces):
        radiosity = np.tile(points.albedo, (1, 3)) * field
        lost = _mean(radiosity, points.live) * np.float32(0.9)
        bounced = np.zeros_like(field)
        bounced[live] = gather @ np.concatenate([radiosity, lost[None]])
        field = direct + smooth(points, bounced, sigma=1.3, rounds=3)
    return field


def _gather_matrix(hits: np.ndarray, columns: int) -> csr_array:
    """[l, columns] the mean over each point's rays, as a matrix on a table of what they hit."""
    l, rays = hits.shape
    weights = np.full(hits.size, 1 / rays, np.float32)
    return csr_array((weights, hits.ravel(), np.arange(l + 1) * rays), shape=(l, columns))


def _mean(values: np.ndarray, live: np.ndarray) -> np.ndarray:
    return values[live].mean(axis=0).astype(np.float32)


def _balance(points: LightPoints, field: np.ndarray, sources: Sources, target: float) -> np.ndarray:
    """[3] factors for daylight, lamps and sun that bring the structure's median e to about `target`.

    Daylight gives its share within bounds, the sun comes on top of it as it is, and lamps fill what is missing.
    """
    count = len(points.charts.atlas.inside)
    inside = points.live[:count]
    day, lamps, sun = (float(np.median((field[:count, k : k + 3] @ LUMINANCE)[inside])) for k in (0, 3, 6))
    sunlight = target
    daylight = float(np.clip(target * sources.day / max(day, 1e-6), 0.5, 14.0)) if day > 1e-6 else 1.0
    missing = max(target - daylight * day - sunlight * sun, 0.22 * sources.evening * target)
    return np.array([daylight, missing / max(lamps, 1e-6), sunlight], np.float32)


def _compressed(e: np.ndarray, knee: float, span: float) -> np.ndarray:
    """e with its luminance above `knee` led towards knee + span, hue kept."""
    luminance = e @ LUMINANCE
    excess = np.maximum(luminance - knee, 0)
    shown = np.minimum(luminance, knee) - span * np.expm1(-excess / span)
    return (e * (shown / np.maximum(luminance, 1e-6))[:, None]).astype(np.float32)


def _bends(
    points: LightPoints, live: np.ndarray, table: np.ndarray, hits: np.ndarray, total: np.ndarray, seed: int
) -> np.ndarray:
    """[l, 3] tangential part of the mean direction of bounced light, weighed by luminance over the whole of e."""
    luminance = (table @ LUMINANCE).astype(np.float32)
    out = np.empty((len(live), 3), np.float32)
    rays = hits.shape[1]

    def bend(part: slice) -> None:
        index = live[part]
        directions = directions_about(points.normal[index], index, rays, seed)
        normal = points.normal[index].astype(np.float32)
        cosine = np.maximum(np.matmul(directions, normal[:, :, None])[..., 0], 0.3)
        weight = luminance[hits[part]] / cosine
        mean = np.matmul(weight[:, None], directions)[:, 0] / rays
        mean -= np.einsum("ri,ri->r", mean, normal)[:, None] * normal
        out[part] = mean / np.maximum(total[index] @ LUMINANCE, 1e-3)[:, None]

    in_chunks(bend, len(live))
    return np.clip(out, -1.5, 1.5)


def _source_bends(
    points: LightPoints, live: np.ndarray, panes: list[Emitter], direct: np.ndarray, total: np.ndarray
) -> np.ndarray:
    """[l, 3] the same for light straight from the panes: the direction to their middle, weighed by distance."""
    mean = np.zeros((len(live), 3))
    weight = np.zeros(len(live))
    for pane in panes:
        toward = pane.points.mean(axis=0) - points.position[live]
        squared = np.maximum(np.einsum("ri,ri->r", toward, toward), 0.1)
        form = np.maximum(-(toward @ pane.normals[0]), 0) * pane.areas.sum() / squared**1.5
        mean += (form / np.sqrt(squared))[:, None] * toward
        weight += form
    mean /= np.maximum(weight, 1e-9)[:, None]
    normal = points.normal[live]
    cosine = np.einsum("ri,ri->r", mean, normal)
    mean -= cosine[:, None] * normal
    share = (direct[live] @ LUMINANCE) / np.maximum(total[live] @ LUMINANCE, 1e-3)
    return np.clip(mean * (share / np.maximum(cosine, 0.3))[:, None], -1.5, 1.5).astype(np.float32)
