"""The floor on which the centre of a body can be, as triangles: through every door, and nowhere else.

It is the exact area of `navigation.body_area` (free floor less obstacles, drawn in by the body's radius) and no grid, so that no
door closes for a coarse cell and neither roof, beds nor table tops are part of it. Rooms and doorways are cut apart before the
triangulation, along lines that both sides have in common, so that every triangle lies in one room and neighbours share whole
edges. Pockets that a body cannot leave or enter, behind a sofa for instance, are left out.
"""

import dataclasses
from collections.abc import Sequence

import numpy as np
import shapely
from jaxtyping import Float, Int
from shapely.geometry.base import BaseGeometry

from wm.geometry.placement.navigation import body_area
from wm.geometry.plan.footprint import interior_polygon
from wm.geometry.plan.records import FloorPlan
from wm.schema import NavigationSettings
from wm.types import OUTSIDE, SceneObject

_DEFAULTS = NavigationSettings()
_MERGE = 1e-6
"""Metres within which corners are one."""


@dataclasses.dataclass(frozen=True, eq=False)
class Navmesh:
    """Where a body can be.

    Attributes:
        radius: of the body, metres
        vertices: [v, 3] float64, metres, z up
        triangles: [t, 3] int32, counter-clockwise from above
        room: [t] int32, index into FloorPlan.rooms, OUTSIDE in a doorway
        part: [t] int32: which triangles are connected; 0 is the part of the largest area
    """

    radius: float
    vertices: Float[np.ndarray, "v 3"]
    triangles: Int[np.ndarray, "t 3"]
    room: Int[np.ndarray, " t"]
    part: Int[np.ndarray, " t"]

    @property
    def areas(self) -> Float[np.ndarray, " t"]:
        """Square metres of each triangle."""
        a, b, c = (self.vertices[self.triangles[:, k], :2] for k in range(3))
        u, v = b - a, c - a
        return (u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]) / 2


def build_navmesh(plan: FloorPlan, objects: Sequence[SceneObject], settings: NavigationSettings = _DEFAULTS) -> Navmesh:
    """The navmesh of a furnished plan for the body of the settings. Equal plans and objects give equal arrays."""
    floors = [interior_polygon(plan, index) for index in range(len(plan.rooms))]
    parts = main_parts(body_area(plan, objects, settings), floors)
    corners, rooms, numbers = [], [], []
    for number, part in enumerate(parts):
        for room, face in _faces(part, floors):
            triangles = _triangles(face)
            corners.append(triangles)
            rooms.append(np.full(len(triangles), room, np.int32))
            numbers.append(np.full(len(triangles), number, np.int32))
    if not corners:
        none = np.zeros(0, np.int32)
        return Navmesh(settings.body_radius, np.zeros((0, 3)), np.zeros((0, 3), np.int32), none, none)
    vertices, triangles = _joined(np.concatenate(corners))
    return Navmesh(settings.body_radius, vertices, triangles, np.concatenate(rooms), np.concatenate(numbers))


def main_parts(area: BaseGeometry, floors: Sequence[shapely.Polygon]) -> list[shapely.Polygon]:
    """The pieces of an area that are the largest piece of some room, the largest first."""
    pieces = np.array(shapely.get_parts(area), dtype=object)
    tree, kept = shapely.STRtree(pieces), set()
    for floor in floors:
        near = np.sort(tree.query(floor, predicate="intersects"))
        shares = shapely.area(shapely.intersection(pieces[near], floor))
        if shares.max(initial=0.0) > 0:
            kept.add(int(near[np.argmax(shares)]))
    return [pieces[k] for k in sorted(kept, key=lambda k: (-pieces[k].area, k))]


def _faces(part: shapely.Polygon, floors: Sequence[shapely.Polygon]) -> list[tuple[int, shapely.Polygon]]:
    """(room or OUTSIDE, face) of a part cut along the edges of rooms; the faces have whole edges in common."""
    tree = shapely.STRtree(floors)
    rooms = np.sort(tree.query(part, predicate="intersects"))
    lines = shapely.union_all([part.boundary, *(floors[room].boundary for room in rooms)])
    shapely.prepare(part)
    faces = []
    for face in shapely.get_parts(shapely.polygonize([lines])):
        inside = shapely.point_on_surface(face)
        if part.contains(inside):
            within = tree.query(inside, predicate="within")
            faces.append((int(within.min()) if len(within) else OUTSIDE, face))
    return sorted(faces, key=lambda one: (one[0], one[1].bounds))


def _triangles(face: shapely.Polygon) -> Float[np.ndarray, "t 3 2"]:
    """Corners of the constrained Delaunay triangles of a polygon, counter-clockwise."""
    parts = shapely.get_parts(shapely.constrained_delaunay_triangles(face))
    corners = np.array([shapely.get_coordinates(part)[:3] for part in parts]).reshape(-1, 3, 2)
    u, v = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    clockwise = u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0] < 0
    corners[clockwise] = corners[clockwise][:, ::-1]
    return corners


def _joined(corners: Float[np.ndarray, "t 3 2"]) -> tuple[Float[np.ndarray, "v 3"], Int[np.ndarray, "t 3"]]:
    """Vertices, each place once and in order, and the triangles as their indices."""
    grid = np.round(corners.reshape(-1, 2) / _MERGE).astype(np.int64)
    places, index = np.unique(grid, axis=0, return_inverse=True)
    vertices = np.column_stack([places * _MERGE, np.zeros(len(places))])
    return vertices, index.reshape(-1, 3).astype(np.int32)
