"""Where light is stored on a room's structure: the coarse texels of its planar surfaces.

The charts are those of wm.geometry's atlas over the room's own faces; here each face also knows the chart coordinates of its
corners, so that a hit's barycentrics give its place on the chart without going through the world.
"""

import dataclasses

import numpy as np
from jaxtyping import Float, Int

from wm.geometry.texture.atlas import build_atlas, texel_positions
from wm.types import OUTSIDE, Atlas, Mesh, SurfaceKind


@dataclasses.dataclass(frozen=True, eq=False)
class RoomCharts:
    """The charts of one room. Faces are numbered as in the scene's mesh; those of other rooms have chart -1."""

    atlas: Atlas  # of the room's faces, coarse texels
    face_chart: np.ndarray  # [f] int32
    face_slot: np.ndarray  # [f] int32: row of face_corners, -1 for faces of no chart
    face_corners: np.ndarray  # [k, 3, 2] float32 metres along (u, v) of the face's three corners on its chart


def room_charts(mesh: Mesh, room: int, cell: float) -> RoomCharts:
    """The charts of a room's walls, floor, ceiling, reveals and panes at texels of `cell` metres."""
    mine = np.flatnonzero(
        (mesh.face_room == room)
        & (mesh.face_object == OUTSIDE)
        & (mesh.face_kind != SurfaceKind.OBJECT)
        & (mesh.face_kind != SurfaceKind.EXTERIOR)
    )
    part = Mesh(
        vertices=mesh.vertices,
        faces=mesh.faces[mine],
        face_room=mesh.face_room[mine],
        face_kind=mesh.face_kind[mine],
        face_object=mesh.face_object[mine],
    )
    atlas = build_atlas(part, cell)
    face_chart = np.full(len(mesh.faces), -1, np.int32)
    face_chart[mine] = atlas.face_chart
    face_slot = np.full(len(mesh.faces), -1, np.int32)
    kept = mine[atlas.face_chart >= 0]
    face_slot[kept] = np.arange(len(kept), dtype=np.int32)
    chart = face_chart[kept]
    offset = mesh.vertices[mesh.faces[kept]] - atlas.chart_origin[chart][:, None]
    corners = np.stack([np.einsum("kpi,ki->kp", offset, axis[chart]) for axis in (atlas.chart_u, atlas.chart_v)], axis=-1)
    return RoomCharts(atlas=atlas, face_chart=face_chart, face_slot=face_slot, face_corners=corners.astype(np.float32))


def chart_places(
    charts: RoomCharts, face: Int[np.ndarray, "r"], barycentric: Float[np.ndarray, "r 2"]
) -> tuple[Int[np.ndarray, "r"], Float[np.ndarray, "r"], Float[np.ndarray, "r"]]:
    """Chart, and metres along its u and v, of hits on faces that have a chart."""
    corner = charts.face_corners[charts.face_slot[face]]
    a, b = barycentric[:, 0], barycentric[:, 1]
    c = 1 - a - b
    s = c * corner[:, 0, 0] + a * corner[:, 1, 0] + b * corner[:, 2, 0]
    t = c * corner[:, 0, 1] + a * corner[:, 1, 1] + b * corner[:, 2, 1]
    return charts.face_chart[face], s, t


def nearest_texel(
    charts: RoomCharts, chart: Int[np.ndarray, "r"], s: Float[np.ndarray, "r"], t: Float[np.ndarray, "r"]
) -> Int[np.ndarray, "r"]:
    """Index of the coarse texel that holds each place."""
    atlas = charts.atlas
    rows, columns = atlas.chart_shape[chart, 0], atlas.chart_shape[chart, 1]
    column = np.clip((s / np.float32(atlas.texel_size)).astype(np.int32), 0, columns - 1)
    row = np.clip((t / np.float32(atlas.texel_size)).astype(np.int32), 0, rows - 1)
    return atlas.chart_start[chart] + row * columns + column


def luxel_positions(charts: RoomCharts) -> Float[np.ndarray, "t 3"]:
    """World positions of the coarse texels' centres, metres."""
    return texel_positions(charts.atlas)
