"""The light points of a room, and what is done over all of them: finding the one that a ray hit, smoothing, filling holes."""

import dataclasses

import numpy as np
from scipy.ndimage import distance_transform_edt, gaussian_filter
from scipy.sparse import csr_array

from wm.offline.world.light.charts import RoomCharts, chart_places, nearest_texel
from wm.offline.world.light.facets import Facets, facet_weights
from wm.offline.world.light.probes import Probes


@dataclasses.dataclass(frozen=True, eq=False)
class LightPoints:
    """The light points of a room: coarse texels of its structure first, then its objects' probes."""

    charts: RoomCharts
    facets: Facets
    probes: Probes
    facet_faces: np.ndarray  # [f] int32: row of the scene's faces in `facets`, -1 for structure and other rooms
    position: np.ndarray  # [n, 3] float64
    normal: np.ndarray  # [n, 3] float64
    albedo: np.ndarray  # [n, 3] float32 mean linear albedo around the point
    glow: np.ndarray  # [n, 3] float32 radiance the point's surface gives of itself, as a source of light
    live: np.ndarray  # [n] bool: inside its surface


def locate(points: LightPoints, face: np.ndarray, barycentric: np.ndarray) -> np.ndarray:
    """[r] nearest light point of each hit; the number of points (one past the last) for what is not of this room."""
    found = np.full(len(face), len(points.live), np.int32)
    hit = np.flatnonzero(face >= 0)
    on_chart = hit[points.charts.face_slot[face[hit]] >= 0]
    found[on_chart] = nearest_texel(points.charts, *chart_places(points.charts, face[on_chart], barycentric[on_chart]))
    on_object = hit[points.facet_faces[face[hit]] >= 0]
    corners, weights = facet_weights(points.facets, points.facet_faces[face[on_object]], barycentric[on_object])
    corner = np.take_along_axis(corners, weights.argmax(axis=1)[:, None], axis=1)[:, 0]
    found[on_object] = len(points.charts.atlas.inside) + points.probes.nearest[corner]
    return found


def smooth(points: LightPoints, values: np.ndarray, *, sigma: float, rounds: int) -> np.ndarray:
    """Values at light points averaged with their neighbours.

    On charts a masked gaussian of `sigma` texels, among probes `rounds` of averaging.
    """
    out = values.astype(np.float32)
    atlas = points.charts.atlas
    for chart in range(len(atlas.chart_start)):
        part, shape = _chart_slice(points, chart)
        mask = points.live[part].reshape(shape).astype(np.float32)
        weight = gaussian_filter(mask, sigma, mode="constant", truncate=3.0)
        image = values[part].reshape(*shape, -1) * mask[..., None]
        blurred = gaussian_filter(image, (sigma, sigma, 0), mode="constant", truncate=3.0) / np.maximum(weight, 1e-6)[..., None]
        out[part] = (blurred * mask[..., None]).reshape(-1, values.shape[1])
    first = len(atlas.inside)
    for _ in range(rounds):
        out[first:] = mixed(points.probes.average, points.live[first:], out[first:])
    return out


def mixed(weights: csr_array, live: np.ndarray, values: np.ndarray) -> np.ndarray:
    """Weighted means of the live among values; where none is live, of all."""
    mask = live.astype(np.float32)
    total = weights @ mask
    some = total > 1e-6
    means = (weights @ (values * mask[:, None])) / np.where(some, total, 1)[:, None]
    return np.where(some[:, None], means, weights @ values).astype(np.float32)


def filled(points: LightPoints, values: np.ndarray) -> np.ndarray:
    """Values without holes: texels off their surface take the nearest one on it, buried probes the mean of their neighbours."""
    out = values.astype(np.float32)
    for chart in range(len(points.charts.atlas.chart_start)):
        part, shape = _chart_slice(points, chart)
        mask = points.live[part].reshape(shape)
        if mask.any() and not mask.all():
            index = np.asarray(distance_transform_edt(~mask, return_distances=False, return_indices=True))
            out[part] = values[part].reshape(*shape, -1)[tuple(index)].reshape(-1, values.shape[1])
    first = len(points.charts.atlas.inside)
    buried = np.flatnonzero(~points.live[first:])
    out[first + buried] = mixed(points.probes.average[buried], points.live[first:], values[first:])
    return out


def _chart_slice(points: LightPoints, chart: int) -> tuple[slice, tuple[int, int]]:
    atlas = points.charts.atlas
    rows, columns = (int(k) for k in atlas.chart_shape[chart])
    start = int(atlas.chart_start[chart])
    return slice(start, start + rows * columns), (rows, columns)
