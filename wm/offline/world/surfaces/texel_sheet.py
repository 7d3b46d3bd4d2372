"""A planar surface of a room as a sheet of texels, and the layers it is dressed with.

A sheet is the chart of one surface (wm.geometry's atlas at the light map's coarse texels) subdivided into fine texels. Dressing
starts from a material and lays bands, casings and panels over it: each layer has a coverage, an albedo, a roughness and a height,
and the finished height gives slopes for shading and cavities that are darker for being deep.
"""

import dataclasses

import numpy as np
from scipy.ndimage import gaussian_filter

from wm.offline.style.finish import Finish, Style, Surfaces
from wm.offline.world.materials import MaterialSample, evaluate, flat_points
from wm.offline.world.noise import F32
from wm.types import SurfaceKind


@dataclasses.dataclass(frozen=True, eq=False)
class Chart:
    """Where a sheet lies: texel (i, j) is centred at origin + (j + 1/2) texel u + (i + 1/2) texel v; walls have v upwards."""

    kind: SurfaceKind
    origin: np.ndarray  # [3] float64 metres
    u: np.ndarray  # [3] unit
    v: np.ndarray  # [3] unit
    normal: np.ndarray  # [3] unit, into the room
    shape: tuple[int, int]  # fine rows, columns
    texel: float  # metres


@dataclasses.dataclass(frozen=True, eq=False)
class Interior:
    """What dressing needs to know of a room."""

    name: str
    kind: str  # of wm.offline.arrangement.room_type
    polygon: np.ndarray  # [k, 2] float64 inner wall faces
    height: float  # floor to ceiling, metres
    style: Style
    surfaces: Surfaces
    seed: int


@dataclasses.dataclass(frozen=True, eq=False)
class TexelSheet:
    """A dressed surface, before light."""

    albedo: np.ndarray  # [3, h, w] float32 linear
    roughness: np.ndarray  # [h, w] float32
    height: np.ndarray  # [h, w] float32 metres of relief
    emission: np.ndarray | None = None  # [3, h, w] float32 radiance that it gives of itself
    metallic: float = 0.0


def grid(chart: Chart) -> tuple[np.ndarray, np.ndarray]:
    """[h, w] float32 metres along u and along v of every fine texel."""
    rows, columns = chart.shape
    s = ((np.arange(columns) + 0.5) * chart.texel).astype(F32)
    t = ((np.arange(rows) + 0.5) * chart.texel).astype(F32)
    return np.broadcast_to(s[None, :], chart.shape), np.broadcast_to(t[:, None], chart.shape)


def lay(chart: Chart, finish: Finish, s: np.ndarray, t: np.ndarray, *, seed: int) -> TexelSheet:
    """A finish over the whole sheet, its pattern placed by s and t ([h, w] metres)."""
    points = flat_points(s.ravel(), t.ravel(), footprint=chart.texel, depth=0.31 * (seed % 7))
    return as_sheet(evaluate(points, finish, seed=seed), chart.shape)


def as_sheet(surface: MaterialSample, shape: tuple[int, int]) -> TexelSheet:
    """A sheet of a material sampled at the centre of every texel, row by row."""
    return TexelSheet(
        albedo=surface.albedo.reshape(3, *shape),
        roughness=_image(surface.roughness, shape),
        height=_image(surface.height, shape),
        metallic=surface.metallic,
    )


def over(below: TexelSheet, layer: TexelSheet, cover: np.ndarray, *, lift: np.ndarray | float = 0.0) -> TexelSheet:
    """`layer`, raised by `lift` metres, laid over `below` where cover ([h, w] in [0, 1]) is 1."""
    cover = cover.astype(F32)
    return TexelSheet(
        albedo=below.albedo + (layer.albedo - below.albedo) * cover,
        roughness=below.roughness + (layer.roughness - below.roughness) * cover,
        height=(below.height + (layer.height + lift - below.height) * cover).astype(F32),
        emission=None if below.emission is None else below.emission * (1 - cover),
        metallic=below.metallic,
    )


def shaded(sheet: TexelSheet, amount: np.ndarray) -> TexelSheet:
    """The sheet with its albedo multiplied by `amount` ([h, w]): painted occlusion."""
    return dataclasses.replace(sheet, albedo=(sheet.albedo * np.clip(amount, 0, 1)).astype(F32))


def with_cavities(sheet: TexelSheet, texel: float, *, reach: float = 0.03, strength: float = 22.0) -> TexelSheet:
    """Darker where the relief lies below its surroundings within `reach` metres, a touch lighter where it stands out."""
    if not np.any(sheet.height):
        return sheet
    depth = sheet.height - gaussian_filter(sheet.height, reach / texel, mode="nearest")
    return dataclasses.replace(
        sheet, albedo=np.clip(sheet.albedo * np.exp(np.clip(strength * depth, -0.7, 0.1)), 0, 1).astype(F32)
    )


def cropped(sheet: TexelSheet, window: tuple[slice, slice]) -> TexelSheet:
    """The part of a sheet in a window of rows and columns, as views."""
    return dataclasses.replace(
        sheet,
        albedo=sheet.albedo[:, *window], roughness=sheet.roughness[window], height=sheet.height[window],
        emission=None if sheet.emission is None else sheet.emission[:, *window],
    )  # fmt: skip


def pasted(sheet: TexelSheet, window: tuple[slice, slice], part: TexelSheet) -> TexelSheet:
    """The sheet with `part`, which gives no light of its own, in a window of rows and columns."""
    albedo, roughness, height = sheet.albedo.copy(), sheet.roughness.copy(), sheet.height.copy()
    albedo[:, *window], roughness[window], height[window] = part.albedo, part.roughness, part.height
    return dataclasses.replace(sheet, albedo=albedo, roughness=roughness, height=height)


def inside_distance(polygon: np.ndarray, x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """[h, w] metres from (x, y) to the nearest edge of the polygon."""
    nearest = np.full(x.shape, np.inf, F32)
    for a, b in zip(polygon, np.roll(polygon, -1, axis=0)):
        direction = b - a
        part = np.clip(((x - a[0]) * direction[0] + (y - a[1]) * direction[1]) / (direction @ direction), 0, 1)
        np.minimum(nearest, np.hypot(x - a[0] - part * direction[0], y - a[1] - part * direction[1]), out=nearest)
    return nearest.astype(F32)


def _image(value: np.ndarray | float, shape: tuple[int, int]) -> np.ndarray:
    if isinstance(value, np.ndarray):
        return value.reshape(shape).astype(F32)
    return np.full(shape, value, F32)
