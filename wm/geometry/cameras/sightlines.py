"""Which rooms a view can look into, from the plan alone: through doors and passages, and through those behind them.

A ray leaves a room only through the rectangle in which a portal opens into that room. So the view's frustum is cut by that
rectangle (Sutherland and Hodgman, CACM 17, 1974), and what is left of the rectangle, seen from the eye, is the frustum for the
next room. Walls within a concave room and objects are left out, so the answer errs on the side of "visible".
Source: cells and portals, Luebke and Georges, "Portals and Mirrors", I3D 1995.
"""

from collections.abc import Sequence

import numpy as np
import shapely
from jaxtyping import Bool

from wm.geometry.plan.footprint import interior_polygon
from wm.geometry.plan.openings import portals
from wm.geometry.plan.portal import Portal
from wm.geometry.plan.records import FloorPlan
from wm.geometry.rays.pinhole import camera_center, camera_rotation
from wm.types import Camera, Mesh, View

_SLACK = 0.02
"""Metres by which a portal's rectangle is larger than its opening and stands before it."""
_NEAR = 0.1
"""Metres around an opening within which an eye looks through it whatever its direction."""


def visible_rooms(plan: FloorPlan, mesh: Mesh, views: View | Sequence[View]) -> Bool[np.ndarray, "views rooms"]:
    """Which rooms each view can look into: never False for a room of which the view shows a face, door reveals included.

    Args:
        plan: a valid plan.
        mesh: its structure or scene: a room without faces in it is visible to no view.
        views: one view or several.
    """
    views = [views] if isinstance(views, View) else list(views)
    count = len(plan.rooms)
    floors = [interior_polygon(plan, index) for index in range(count)]
    doors: list[list[Portal]] = [[] for _ in range(count)]
    for portal in portals(plan):
        if portal.is_open:
            for room in portal.rooms:
                doors[room].append(portal)
    drawn = np.isin(np.arange(count), mesh.face_room)
    visible = np.zeros((len(views), count), bool)
    for row, view in zip(visible, views):
        row[:] = _rooms_in_view(floors, doors, view.camera) & drawn
    return visible


def _rooms_in_view(floors: list[shapely.Polygon], doors: list[list[Portal]], camera: Camera) -> np.ndarray:
    eye = camera_center(camera)
    visible = np.zeros(len(floors), bool)
    through = {id(portal): portal for known in doors for portal in known if _beside(portal, eye)}
    start = {room for portal in through.values() for room in portal.rooms}
    start |= {index for index, floor in enumerate(floors) if shapely.intersects_xy(floor, eye[0], eye[1])}
    if not start:  # in a wall or outside: nothing is known
        visible[:] = True
    for room in start:
        _look(room, eye, _frustum(camera), doors, visible, crossed=(), beside=frozenset(through))
    return visible


def _look(
    room: int,
    eye: np.ndarray,
    planes: np.ndarray,
    doors: list[list[Portal]],
    visible: np.ndarray,
    *,
    crossed: tuple[int, ...],
    beside: frozenset[int],
) -> None:
    """Mark the room and, through its portals, those behind; `planes` [k, 3] are the frustum's inward normals through the eye."""
    visible[room] = True
    for portal in doors[room]:
        if id(portal) in crossed:
            continue
        here = portal.rooms.index(room)
        window = planes
        if id(portal) not in beside:
            rectangle = _clip(_rectangle(portal, here) - eye, planes)
            if len(rectangle) < 3 or not _faces(portal, here, eye):
                continue
            window = _cone(rectangle)
        _look(portal.rooms[1 - here], eye, window, doors, visible, crossed=(*crossed, id(portal)), beside=beside)


def _frustum(camera: Camera) -> np.ndarray:
    """[4, 3]: inward normals of the planes through the eye and the image's edges."""
    (fx, fy), (cx, cy) = np.asarray(camera.focal, float), np.asarray(camera.principal, float)
    left, right, top, bottom = -cx / fx, (camera.width - cx) / fx, -cy / fy, (camera.height - cy) / fy
    inward = np.array([[1.0, 0.0, -left], [-1.0, 0.0, right], [0.0, 1.0, -top], [0.0, -1.0, bottom]])
    return inward @ camera_rotation(camera)


def _rectangle(portal: Portal, side: int) -> np.ndarray:
    """[4, 3]: the opening as it stands before its wall in room `rooms[side]`, a little larger than it is."""
    inward = portal.normal * (1.0 if side == 1 else -1.0)
    along = (portal.ends[1] - portal.ends[0]) / portal.width
    before = inward * (portal.half_depths[side] + _SLACK)
    start, end = portal.ends[0] - _SLACK * along + before, portal.ends[1] + _SLACK * along + before
    low, high = portal.sill - _SLACK, portal.head + _SLACK
    return np.array([[*start, low], [*end, low], [*end, high], [*start, high]])


def _faces(portal: Portal, side: int, eye: np.ndarray) -> bool:
    """Whether the eye is on the room's side of the opening: no straight ray leaves through it otherwise."""
    inward = portal.normal * (1.0 if side == 1 else -1.0)
    return bool((eye[:2] - portal.ends[0]) @ inward > portal.half_depths[side])


def _beside(portal: Portal, eye: np.ndarray) -> bool:
    """Whether the eye is in the opening or within _NEAR of it."""
    across = (eye[:2] - portal.ends[0]) @ portal.normal
    along = (eye[:2] - portal.ends[0]) @ (portal.ends[1] - portal.ends[0]) / portal.width
    deep = -portal.half_depths[0] - _NEAR < across < portal.half_depths[1] + _NEAR
    wide = -_NEAR < along < portal.width + _NEAR
    return bool(deep and wide and portal.sill - _NEAR < eye[2] < portal.head + _NEAR)


def _clip(polygon: np.ndarray, planes: np.ndarray) -> np.ndarray:
    """The part of a convex polygon (relative to the eye) on the inner side of every plane through the eye, [k, 3]."""
    for normal in planes:
        if len(polygon) == 0:
            break
        side = polygon @ normal
        following, next_side = np.roll(polygon, -1, axis=0), np.roll(side, -1)
        kept = []
        for a, b, sa, sb in zip(polygon, following, side, next_side):
            if sa >= 0:
                kept.append(a)
            if (sa >= 0) != (sb >= 0):
                kept.append(a + (b - a) * (sa / (sa - sb)))
        polygon = np.array(kept).reshape(-1, 3)
    return polygon


def _cone(polygon: np.ndarray) -> np.ndarray:
    """[k, 3]: inward normals of the planes through the eye and the edges of a convex polygon (relative to the eye)."""
    normals = np.cross(polygon, np.roll(polygon, -1, axis=0))
    normals = normals[np.linalg.norm(normals, axis=1) > 1e-12]
    inside = normals @ polygon.mean(axis=0)
    return normals * np.where(inside < 0, -1.0, 1.0)[:, None]
