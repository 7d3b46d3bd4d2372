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
from scipy.ndimage import distance_transform_edt, gaussian_filter
from scipy.sparse import csr_array

from wm.geometry.raycast import RayScene, cast_rays, occluded
from wm.synth.procedural.color import LUMINANCE
from wm.synth.procedural.light.charts import RoomCharts, chart_places, nearest_texel
from wm.synth.procedural.light.facets import Facets, facet_weights
from wm.synth.procedural.light.sources import Emitter
from wm.types import SurfaceKind

NEAR = 0.5  # metres within which a source is found by rays and not sampled
_ROWS = 2048  # light points a chunk


@dataclasses.dataclass(frozen=True, eq=False)
class LightPoints:
    """The light points of a room: coarse texels of its structure first, then those of its objects."""

    charts: RoomCharts
    facets: Facets
    facet_faces: np.ndarray  # [f] int32: row of the scene's faces in `facets`, -1 for structure and other rooms
    position: np.ndarray  # [n, 3] float64
    normal: np.ndarray  # [n, 3] float64
    albedo: np.ndarray  # [n, 3] float32 mean linear albedo around the point
    glow: np.ndarray  # [n, 3] float32 radiance the point's surface gives of itself, as a source of light
    live: np.ndarray  # [n] bool: inside its surface


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
    spacing: float = 0.15  # metres between light points on objects
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
    direct[live, :3] = _sampled(scene, points, live, panes, seed) + _sunlight(
        scene, points, live, sun, sun_radiance, seed, settings
    )
    direct[live, 3:] = _sampled(scene, points, live, lamps, seed + 1)
    direct = smooth(points, direct, sigma=0.55, rounds=1)
    hits, near, sky = _traced(scene, points, live, settings.rays, seed)
    source = direct.copy()
    if panes:
        source[live, :3] += sky[:, None] * panes[0].radiance[0]
    source[live, 3:] += near
    field = source.copy()
    for _ in range(settings.bounces):
        radiosity = np.tile(points.albedo, (1, 2)) * field
        lost = _mean(radiosity, points.live) * np.float32(0.9)
        bounced = np.zeros_like(field)
        bounced[live] = _gathered(np.concatenate([radiosity, lost[None]]), hits)
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
    mirror[live] = _mirrored(scene, points, live, table, eye, seed)
    return LightField(
        irradiance=filled(points, total),
        bend=filled(points, smooth(points, bend, sigma=1.0, rounds=2)),
        mirror=filled(points, smooth(points, mirror, sigma=0.8, rounds=1)),
    )


def locate(points: LightPoints, face: np.ndarray, barycentric: np.ndarray) -> np.ndarray:
    """[r] nearest light point of each hit; the number of points (one past the last) for what is not of this room."""
    found = np.full(len(face), len(points.live), np.int32)
    hit = np.flatnonzero(face >= 0)
    on_chart = hit[points.charts.face_slot[face[hit]] >= 0]
    found[on_chart] = nearest_texel(points.charts, *chart_places(points.charts, face[on_chart], barycentric[on_chart]))
    on_object = hit[points.facet_faces[face[hit]] >= 0]
    corners, weights = facet_weights(points.facets, points.facet_faces[face[on_object]], barycentric[on_object])
    first = len(points.live) - len(points.facets.position)
    found[on_object] = first + np.take_along_axis(corners, weights.argmax(axis=1)[:, None], axis=1)[:, 0]
    return found


def smooth(points: LightPoints, values: np.ndarray, *, sigma: float, rounds: int) -> np.ndarray:
    """Values at light points averaged with their neighbours: a masked gaussian (texels) on charts, rounds of averaging on objects."""
    out = values.astype(np.float32)
    atlas = points.charts.atlas
    for chart in range(len(atlas.chart_start)):
        part, shape = _chart_slice(points, chart)
        mask = points.live[part].reshape(shape).astype(np.float32)
        weight = gaussian_filter(mask, sigma, mode="constant", truncate=3.0)
        image = values[part].reshape(*shape, -1) * mask[..., None]
        blurred = gaussian_filter(image, (sigma, sigma, 0), mode="constant", truncate=3.0) / np.maximum(weight, 1e-6)[..., None]
        out[part] = (blurred * mask[..., None]).reshape(-1, values.shape[1])
    first = len(points.live) - len(points.facets.position)
    if first < len(values):
        average = _averaging(points)
        for _ in range(rounds):
            out[first:] = average @ out[first:]
    return out


def filled(points: LightPoints, values: np.ndarray) -> np.ndarray:
    """Values with every texel off its surface given those of the nearest texel on it."""
    out = values.astype(np.float32)
    for chart in range(len(points.charts.atlas.chart_start)):
        part, shape = _chart_slice(points, chart)
        mask = points.live[part].reshape(shape)
        if mask.any() and not mask.all():
            _, index = distance_transform_edt(~mask, return_indices=True)
            out[part] = values[part].reshape(*shape, -1)[tuple(index)].reshape(-1, values.shape[1])
    return out


def _averaging(points: LightPoints) -> csr_array:
    from wm.synth.procedural.light.facets import facet_edges

    edges = facet_edges(points.facets)
    p = edges.shape[0]
    edges = (edges > 0).astype(np.float32) + csr_array((np.full(p, 1.5, np.float32), (np.arange(p), np.arange(p))), shape=(p, p))
    total = np.asarray(edges.sum(axis=1)).ravel()
    return (csr_array((1 / total, (np.arange(p), np.arange(p))), shape=(p, p)) @ edges).astype(np.float32)


def _chart_slice(points: LightPoints, chart: int) -> tuple[slice, tuple[int, int]]:
    atlas = points.charts.atlas
    rows, columns = (int(k) for k in atlas.chart_shape[chart])
    start = int(atlas.chart_start[chart])
    return slice(start, start + rows * columns), (rows, columns)


def _origins(points: LightPoints, index: np.ndarray) -> np.ndarray:
    return points.position[index] + 2e-3 * points.normal[index]


def _jitter(index: np.ndarray, seed: int, count: int) -> np.ndarray:
    """[n, count] uniform numbers that depend on the point's index only."""
    from wm.synth.procedural.noise import hash_cells

    columns = np.arange(count, dtype=np.int32)
    bits = hash_cells(index[:, None].astype(np.int32), columns[None], 0, seed)
    return (bits >> np.uint32(8)).astype(np.float32) * np.float32(2.0**-24)


def _sampled(scene: RayScene, points: LightPoints, live: np.ndarray, emitters: list[Emitter], seed: int) -> np.ndarray:
    """[l, 3] e that sources farther than NEAR send directly: one shadow ray a sample."""
    total = np.zeros((len(live), 3), np.float32)
    for number, emitter in enumerate(emitters):
        k = len(emitter.points)
        shift = _jitter(live, seed * 31 + number, 2 * k).reshape(-1, k, 2) - np.float32(0.5)
        for begin in range(0, len(live), _ROWS):
            part = slice(begin, begin + _ROWS)
            origin, normal = _origins(points, live[part]), points.normal[live[part]]
            target = emitter.points + np.einsum("rka,kai->rki", shift[part], emitter.spread)
            toward = target - origin[:, None]
            squared = np.einsum("rki,rki->rk", toward, toward)
            distance = np.sqrt(squared)
            unit = toward / np.maximum(distance, 1e-6)[..., None]
            at_point = np.einsum("rki,ri->rk", unit, normal)
            all_ways = ~np.any(emitter.normals, axis=1)
            at_source = np.where(all_ways, 1.0, -np.einsum("rki,ki->rk", unit, emitter.normals))
            form = np.maximum(at_point, 0) * np.maximum(at_source, 0) * emitter.areas / (np.pi * np.maximum(squared, 0.04))
            if emitter.sky:
                form *= _sky(unit[..., 2])
            form *= distance > NEAR if emitter.sky else 1.0
            row, column = np.nonzero(form > 1e-7)
            if len(row) == 0:
                continue
            blocked = occluded(scene, origin[row], unit[row, column], distance[row, column] - 0.03)
            form[row[blocked], column[blocked]] = 0.0
            total[part] += (form @ emitter.radiance).astype(np.float32)
    return total


def _sky(up: np.ndarray) -> np.ndarray:
    """Radiance of the outdoors by the height of the ray: the ground below is a third as bright as the sky."""
    return 0.3 + 0.7 * np.clip((up + 0.15) / 0.4, 0, 1)


def _sunlight(
    scene: RayScene,
    points: LightPoints,
    live: np.ndarray,
    sun: np.ndarray,
    radiance: np.ndarray,
    seed: int,
    settings: BakeSettings,
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
    for k in range(settings.sun_rays):
        r = _jitter(live[lit], seed * 17 + 100 + k, 4) - np.float32(0.5)
        aim = sun + 0.03 * (r[:, :1] * side + r[:, 1:2] * up)
        origin = _origins(points, live[lit])
        tangent = np.cross(points.normal[live[lit]], sun)
        across = np.cross(points.normal[live[lit]], tangent)
        wobble = settings.cell * (r[:, 2:3] * tangent + r[:, 3:] * across)
        hits = cast_rays(scene, origin + np.where(lit[:, None] < len(points.charts.atlas.inside), wobble, 0.0), aim)
        share += hits.hit & (scene.mesh.face_kind[np.maximum(hits.face, 0)] == SurfaceKind.PANE)
    total[lit] = (cosine[lit] * share / settings.sun_rays)[:, None] * radiance
    return total


def _directions(normal: np.ndarray, index: np.ndarray, rays: int, seed: int) -> np.ndarray:
    """[r, rays, 3] float32 cosine-weighted about each normal: one low-discrepancy set, turned and shifted point by point."""
    k = np.arange(rays)
    shift = _jitter(index, seed * 7 + 3, 2)
    u = np.mod((k + 0.5) / rays + shift[:, :1], 1.0).astype(np.float32)
    v = np.mod(k * np.float32(0.61803399) + shift[:, 1:], 1.0).astype(np.float32)
    radius, turn = np.sqrt(u), np.float32(2 * np.pi) * v
    n = normal.astype(np.float32)
    helper = np.where(np.abs(n[:, 2:]) < 0.9, np.float32([[0, 0, 1]]), np.float32([[1, 0, 0]]))
    a = np.cross(helper, n)
    a /= np.linalg.norm(a, axis=1, keepdims=True)
    b = np.cross(n, a)
    x, y, z = radius * np.cos(turn), radius * np.sin(turn), np.sqrt(np.maximum(1 - u, 0))
    return x[..., None] * a[:, None] + y[..., None] * b[:, None] + z[..., None] * n[:, None]


def _traced(
    scene: RayScene, points: LightPoints, live: np.ndarray, rays: int, seed: int
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """What the rays of each point hit: light points [l, rays], e of lamps nearer than 0.2 m [l, 3], share of near sky [l]."""
    hits = np.empty((len(live), rays), np.int32)
    near = np.zeros((len(live), 3), np.float32)
    sky = np.zeros(len(live), np.float32)
    pane = np.append(scene.mesh.face_kind == SurfaceKind.PANE, False)
    glow = np.concatenate([points.glow, np.zeros((1, 3), np.float32)])
    for begin in range(0, len(live), _ROWS):
        part = live[begin : begin + _ROWS]
        directions = _directions(points.normal[part], part, rays, seed).reshape(-1, 3)
        found = cast_rays(scene, np.repeat(_origins(points, part), rays, axis=0), directions)
        at = locate(points, found.face, found.barycentric)
        hits[begin : begin + len(part)] = at.reshape(-1, rays)
        glass = pane[found.face] & (found.t < NEAR)
        sky[begin : begin + len(part)] = (glass * _sky(directions[:, 2])).reshape(-1, rays).mean(axis=1)
        lamp = ~pane[found.face] & (found.t < 0.2)
        near[begin : begin + len(part)] = (glow[at] * lamp[:, None]).reshape(-1, rays, 3).mean(axis=1)
    return hits, near, sky


def _gathered(table: np.ndarray, hits: np.ndarray) -> np.ndarray:
    """[l, c] mean over each point's rays of the table's rows that they hit."""
    out = np.empty((len(hits), table.shape[1]), np.float32)
    for begin in range(0, len(hits), _ROWS):
        out[begin : begin + _ROWS] = table[hits[begin : begin + _ROWS]].mean(axis=1)
    return out


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
    for begin in range(0, len(live), _ROWS):
        part = live[begin : begin + _ROWS]
        directions = _directions(points.normal[part], part, rays, seed)
        normal = points.normal[part].astype(np.float32)
        cosine = np.maximum(np.einsum("rji,ri->rj", directions, normal), 0.3)
        weight = luminance[hits[begin : begin + _ROWS]] / cosine
        mean = np.einsum("rj,rji->ri", weight, directions) / rays
        mean -= np.einsum("ri,ri->r", mean, normal)[:, None] * normal
        out[begin : begin + _ROWS] = mean / np.maximum(total[part] @ LUMINANCE, 1e-3)[:, None]
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


def _mirrored(
    scene: RayScene, points: LightPoints, live: np.ndarray, table: np.ndarray, eye: np.ndarray, seed: int
) -> np.ndarray:
    """[l, 3] radiance in a narrow lobe about the mirror direction of the line to the room's middle, 8 rays wide."""
    rays, width = 8, 0.16
    out = np.empty((len(live), 3), np.float32)
    for begin in range(0, len(live), _ROWS):
        part = live[begin : begin + _ROWS]
        view = points.position[part] - eye
        view /= np.maximum(np.linalg.norm(view, axis=1, keepdims=True), 1e-6)
        normal = points.normal[part]
        mirror = view - 2 * np.einsum("ri,ri->r", view, normal)[:, None] * normal
        behind = np.einsum("ri,ri->r", mirror, normal)  # seen from behind: the mirror direction would point inside
        mirror += np.maximum(0.05 - behind, 0)[:, None] * 2 * normal
        spread = _jitter(part, seed * 13 + 5, 3 * rays).reshape(-1, rays, 3) - np.float32(0.5)
        directions = mirror[:, None] + 2 * width * spread
        found = cast_rays(scene, np.repeat(_origins(points, part), rays, axis=0), directions.reshape(-1, 3).astype(np.float32))
        at = locate(points, found.face, found.barycentric)
        out[begin : begin + _ROWS] = table[at].reshape(-1, rays, 3).mean(axis=1)
    return out
