"""Light in a room, once: what every light point receives from panes, sun and lamps, directly and after several bounces.

Notation: e = irradiance / pi, so a matt surface of albedo a shows radiance a e. With direct light d, hits h(i, j) of cosine-weighted
ray j from point i, and radiosity a e of what it hits,
    e_i = d_i + mean_j a_h(i,j) e_h(i,j)          (+ the radiance of sources nearer than NEAR, which sampling d would make noisy)
is iterated as a gather: rays are traced once, bounces are table look-ups. Light the room loses through doors comes back as the
room's own mean. Tiers of work: per room, R rays a point and one shadow ray per point and source sample; per bounce, one gather.
Source: Cohen and Wallace, Radiosity and Realistic Image Synthesis, 1993, gathering; the bend vector is ours: the direction that
light comes from, by which relief is shaded: e(n + g) ~ e(n) (1 + bend . g).
"""

import dataclasses

import numpy as np
from scipy.sparse import csr_array

from wm.geometry.raycast import RayScene
from wm.synth.procedural.color import LUMINANCE
from wm.synth.procedural.light.luxels import LightPoints, filled, smooth
from wm.synth.procedural.light.sources import Emitter
from wm.synth.procedural.light.transport import directions_about, in_chunks, mirrored, sampled_light, sunlight, traced


@dataclasses.dataclass(frozen=True, eq=False)
class LightField:
    """Baked light at the light points."""

    irradiance: np.ndarray  # [n, 3] float32 e = irradiance / pi
    bend: np.ndarray  # [n, 3] float32 where light comes from
    mirror: np.ndarray  # [n, 3] float32 radiance that a gloss at the point reflects to the middle of the room


@dataclasses.dataclass(frozen=True)
class BakeSettings:
    """How fine the light is."""

    cell: float = 0.06  # metres between light points on structure
    spacing: float = 0.15  # metres between corners that store light on objects
    probe_spacing: float = 0.09  # metres between the probes that light is computed at on objects
    probes: int = 24000  # a room at most
    rays: int = 80  # a point
    sun_rays: int = 6  # a point
    bounces: int = 4
    target: float = 0.62  # mean e that a room's lamps are set to reach
    ambient: float = 0.035  # e that reaches even hidden places


def bake(
    scene: RayScene, points: LightPoints, panes: list[Emitter], lamps: list[Emitter], *,
    sun: np.ndarray, sun_radiance: np.ndarray, day: float, evening: float, eye: np.ndarray, seed: int, settings: BakeSettings,
) -> LightField:  # fmt: skip
    """The light field of a room.

    Args:
      panes, lamps: area sources with relative radiance.
      sun: [3] unit vector towards the sun; sun_radiance [3]: e on a surface that faces it, relative to the sky's radiance 1.
      day, evening: 0..1 how strong daylight and lamps are to be.
      eye: [3] the middle of the room, for which glosses reflect.
    """
    live = np.flatnonzero(points.live)
    direct = np.zeros((len(points.live), 6), np.float32)
    direct[live, :3] = sampled_light(scene, points, live, panes, seed) + sunlight(
        scene, points, live, sun, sun_radiance, seed, rays=settings.sun_rays, cell=settings.cell
    )
    direct[live, 3:] = sampled_light(scene, points, live, lamps, seed + 1)
    direct = smooth(points, direct, sigma=0.55, rounds=1)
    hits, near, sky = traced(scene, points, live, settings.rays, seed)
    source = direct.copy()
    if panes:
        source[live, :3] += sky[:, None] * panes[0].radiance[0]
    source[live, 3:] += near
    field = source.copy()
    gather = _gather_matrix(hits, len(points.live) + 1)
    for _ in range(settings.bounces):
        radiosity = np.tile(points.albedo, (1, 2)) * field
        lost = _mean(radiosity, points.live) * np.float32(0.9)
        bounced = np.zeros_like(field)
        bounced[live] = gather @ np.concatenate([radiosity, lost[None]])
        field = source + smooth(points, bounced, sigma=1.3, rounds=3)
    daylight, lamplight = _balance(points, field, day, evening, settings)
    total = field[:, :3] * daylight + field[:, 3:] * lamplight
    total += settings.ambient * np.float32(settings.target)
    radiance = points.albedo * total + points.glow
    table = np.concatenate([radiance, _mean(radiance, points.live)[None]])
    bend = np.zeros((len(points.live), 3), np.float32)
    bend[live] = _bends(points, live, table, hits, total, seed)
    bend[live] += _source_bends(points, live, panes, direct[:, :3] * daylight, total)
    mirror = np.zeros((len(points.live), 3), np.float32)
    mirror[live] = mirrored(scene, points, live, table, eye, seed)
    return LightField(
        irradiance=filled(points, total),
        bend=filled(points, smooth(points, bend, sigma=1.0, rounds=2)),
        mirror=filled(points, smooth(points, mirror, sigma=0.8, rounds=1)),
    )


def _gather_matrix(hits: np.ndarray, columns: int) -> csr_array:
    """[l, columns] the mean over each point's rays, as a matrix on a table of what they hit."""
    l, rays = hits.shape
    weights = np.full(hits.size, 1 / rays, np.float32)
    return csr_array((weights, hits.ravel(), np.arange(l + 1) * rays), shape=(l, columns))


def _mean(values: np.ndarray, live: np.ndarray) -> np.ndarray:
    return values[live].mean(axis=0).astype(np.float32)


def _balance(points: LightPoints, field: np.ndarray, day: float, evening: float, settings: BakeSettings) -> tuple[float, float]:
    """Factors for daylight and lamplight: daylight as the style has it, within bounds; lamps fill what is missing."""
    count = len(points.charts.atlas.inside)
    live = points.live[:count]
    day_mean = float(np.median((field[:count, :3] @ LUMINANCE)[live]))
    lamp_mean = float(np.median((field[:count, 3:] @ LUMINANCE)[live]))
    wanted = settings.target * day
    daylight = float(np.clip(wanted / max(day_mean, 1e-6), 1.0, 14.0)) if day_mean > 1e-6 else 1.0
    missing = max(settings.target - daylight * day_mean, 0.25 * evening * settings.target)
    return daylight, missing / max(lamp_mean, 1e-6)


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
