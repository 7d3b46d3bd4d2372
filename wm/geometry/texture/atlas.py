"""The texture atlas: a regular grid of texels on every planar surface of a scaffold.

Texel (i, j) of a chart is the square whose centre is origin + (j + 1/2) s u + (i + 1/2) s v, with s the texel size; walls have v
upwards. The grid is centred on the chart's bounding rectangle, so every surface, however narrow, holds texel centres.
Building is linear in surface and stores no positions: they follow from the chart (`texel_positions`).
"""

import numpy as np
from jaxtyping import Float, Int, Shaped

from wm.geometry.mesh.scene_mesh import face_crosses
from wm.geometry.texture.charts import planar_charts
from wm.types import Atlas, Mesh

EDGE = 1e-6  # texels: a centre this close to a surface's edge is on it, so that faces that share an edge leave no gap


def build_atlas(mesh: Mesh, texel_size: float, surface: Int[np.ndarray, "f"] | None = None) -> Atlas:
    """An empty atlas (no colour, no weight) over the structure of a mesh: walls, floors, ceilings, reveals and panes.

    Args:
      mesh: a scaffold; faces of objects and of the outer skin get no chart. The atlas may be read through G-buffers of this
        mesh, or of one that begins with its faces (a structure and the same structure with objects appended).
      texel_size: metres.
      surface: other surfaces than the structure's (`planar_charts`).

    Raises:
      ValueError: the texel size is not a positive number.
    """
    if not (np.isfinite(texel_size) and texel_size > 0):
        raise ValueError(f"texel_size must be a positive number of metres, got {texel_size}")
    face_chart = planar_charts(mesh, surface)
    faces = np.flatnonzero(face_chart >= 0)
    faces = faces[np.argsort(face_chart[faces], kind="stable")]
    chart = face_chart[faces]
    count = int(face_chart.max(initial=-1)) + 1
    first = np.searchsorted(chart, np.arange(count))
    corners = mesh.vertices[mesh.faces[faces]]

    normal = _reduce_by(np.add, face_crosses(corners), first)
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    u, v = _axes(normal)
    anchor = corners[first, 0]
    offset = corners - anchor[chart][:, None]
    st = np.stack([np.einsum("fki,fi->fk", offset, axis[chart]) for axis in (u, v)], axis=-1) / texel_size  # [f, 3, 2] texels
    low = _reduce_by(np.minimum, st.min(axis=1), first)
    extent = _reduce_by(np.maximum, st.max(axis=1), first) - low
    size = np.maximum(np.ceil(extent - EDGE), 1).astype(np.int64)  # columns, rows
    corner = low - (size - extent) / 2
    texels = size.prod(axis=1)
    start = np.cumsum(texels) - texels
    inside = _rasterize(st - corner[chart][:, None], start[chart], size[chart, 0], size[chart, 1], int(texels.sum()))
    return Atlas(
        texel_size=float(texel_size),
        chart_origin=anchor + texel_size * (corner[:, :1] * u + corner[:, 1:] * v),
        chart_u=u,
        chart_v=v,
        chart_normal=normal,
        chart_shape=size[:, ::-1].astype(np.int32),
        chart_start=start,
        chart_room=mesh.face_room[faces[first]].astype(np.int32),
        chart_kind=mesh.face_kind[faces[first]].astype(np.int32),
        face_chart=face_chart,
        inside=inside,
        color=np.zeros((len(inside), 3), np.float32),
        weight=np.zeros(len(inside), np.float32),
    )


def texel_positions(atlas: Atlas, charts: Int[np.ndarray, "k"] | None = None) -> Float[np.ndarray, "t 3"]:
    """World positions of the texel centres, metres: of the whole atlas, or of some charts one after the other."""
    chosen = np.arange(len(atlas.chart_start)) if charts is None else charts
    return np.concatenate([np.zeros((0, 3))] + [_grid(atlas, int(k)) for k in chosen])


def texel_charts(atlas: Atlas) -> Int[np.ndarray, "t"]:
    """The chart of every texel."""
    return np.repeat(np.arange(len(atlas.chart_start), dtype=np.int32), atlas.chart_shape.prod(axis=1, dtype=np.int64))


def chart_image(atlas: Atlas, chart: int, values: Shaped[np.ndarray, "t *rest"]) -> Shaped[np.ndarray, "rows columns *rest"]:
    """One chart's part of a per-texel array, as an image (a view, row 0 at the chart's origin)."""
    rows, columns = (int(k) for k in atlas.chart_shape[chart])
    start = int(atlas.chart_start[chart])
    return values[start : start + rows * columns].reshape(rows, columns, *values.shape[1:])


def _grid(atlas: Atlas, chart: int) -> np.ndarray:
    rows, columns = atlas.chart_shape[chart]
    along_u = atlas.texel_size * (np.arange(columns) + 0.5)[:, None] * atlas.chart_u[chart]
    along_v = atlas.texel_size * (np.arange(rows) + 0.5)[:, None] * atlas.chart_v[chart]
    return (atlas.chart_origin[chart] + along_v[:, None] + along_u).reshape(-1, 3)


def _axes(normal: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """u, v such that (u, v, normal) is right-handed, with v upwards on walls and u along x on floors and ceilings."""
    level = np.abs(normal[:, 2:]) > 0.9
    u = np.where(level, np.cross(np.cross(normal, [1.0, 0.0, 0.0]), normal), np.cross([0.0, 0.0, 1.0], normal))
    u /= np.linalg.norm(u, axis=1, keepdims=True)
    return u, np.cross(normal, u)


def _reduce_by(ufunc: np.ufunc, values: np.ndarray, first: np.ndarray) -> np.ndarray:
    """Reduce runs of rows that begin at `first`."""
    return ufunc.reduceat(values, first, axis=0) if len(first) else np.zeros((0, *values.shape[1:]))


def _rasterize(st: np.ndarray, start: np.ndarray, columns: np.ndarray, rows: np.ndarray, total: int) -> np.ndarray:
    """[total] bool: which texel centres triangles `st` [f, 3, 2] (texel units of their charts) cover.

    By scan lines: each triangle meets each row of centres in one interval of columns; intervals are summed as differences, so
    the work is the sum of the triangles' heights plus the texels, also for long thin triangles.
    """
    low = np.clip(np.ceil(st[..., 1].min(axis=1) - EDGE - 0.5), 0, rows).astype(np.int64)
    high = np.clip(np.floor(st[..., 1].max(axis=1) + EDGE - 0.5) + 1, low, rows).astype(np.int64)
    lines = high - low
    face = np.repeat(np.arange(len(st)), lines)
    row = np.arange(len(face)) - np.repeat(np.cumsum(lines) - lines, lines) + low[face]
    left, right = _intervals(st[face], row + 0.5)
    begin = np.clip(np.ceil(left - EDGE - 0.5), 0, columns[face])
    end = np.clip(np.floor(right + EDGE - 0.5) + 1, begin, columns[face])
    met = end > begin  # NaN, where a line only grazes a corner, is not
    base = (start[face] + row * columns[face])[met]
    opened = np.bincount(base + begin[met].astype(np.int64), minlength=total + 1)
    closed = np.bincount(base + end[met].astype(np.int64), minlength=total + 1)
    return np.cumsum(opened - closed)[:total] > 0


def _intervals(triangles: np.ndarray, y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Where the horizontal lines y [k] enter and leave triangles [k, 3, 2]; NaN where they miss."""
    a, b = triangles, np.roll(triangles, -1, axis=1)
    rise = b[..., 1] - a[..., 1]
    slanted = rise != 0  # an edge along the line adds nothing: its ends belong to the other two
    part = (y[:, None] - a[..., 1]) / np.where(slanted, rise, 1.0)
    met = slanted & (part >= -EDGE) & (part <= 1 + EDGE)
    x = a[..., 0] + np.clip(part, 0, 1) * (b[..., 0] - a[..., 0])
    left = np.where(met, x, np.inf).min(axis=1)
    right = np.where(met, x, -np.inf).max(axis=1)
    missed = ~met.any(axis=1)
    return np.where(missed, np.nan, left), np.where(missed, np.nan, right)
