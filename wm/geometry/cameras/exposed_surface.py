"""The exposed surface of a room: what an eye may see from anywhere in its free air, or through one of its doors.

A camera outside a room sees it only through a doorway. So eyes in the room's air and in its doorways stand for
all cameras of the scene, and the exposed surface of a room costs the same however many rooms there are.

Tiers of work: per room the eyes; per eye the shadow rays of the points that face it and that no eye before has seen.
"""

import dataclasses

import numpy as np
from jaxtyping import Bool, Float

from wm.geometry.cameras.air import FACE, RoomAir, free, room_air
from wm.geometry.mesh.scene_mesh import face_crosses
from wm.geometry.plan.openings import portals
from wm.geometry.plan.records import FloorPlan
from wm.geometry.rays.raycast import RayScene
from wm.geometry.rays.surface_points import SurfacePoints, in_sight, surface_points
from wm.schema import CameraSettings
from wm.types import OUTSIDE, Mesh

_LOW = 0.9  # metres: the lowest eyes, those of views close to furniture
_EYES = 8  # per room and height, evenly over its floor
_ACROSS = (0.15, 0.5, 0.85)  # where eyes stand in a doorway, as shares of its width
_A_CELL = 3.0
"""Points per area of a cell: points that fell at random would then miss one cell in twenty; the R2 sequence misses fewer."""


def room_surface(mesh: Mesh, room: int, *, spacing: float, detail_spacing: float) -> SurfacePoints:
    """Points over all surfaces of a room, backs and insides too, close enough for cells of an edge.

    Args:
        mesh: the scene; `face` of the points indexes its faces.
        room: index into the plan's rooms.
        spacing, detail_spacing: edges of the cells on the structure and on objects, metres.
    """
    parts = []
    for objects, edge in ((False, spacing), (True, detail_spacing)):
        faces = np.flatnonzero((mesh.face_room == room) & ((mesh.face_object != OUTSIDE) == objects))
        some = dataclasses.replace(mesh, faces=mesh.faces[faces], face_kind=mesh.face_kind[faces])
        corners = mesh.vertices[some.faces]
        area = 0.5 * np.linalg.norm(face_crosses(corners), axis=1).sum()
        points = surface_points(some, int(np.ceil(_A_CELL * area / edge**2)))
        parts.append(dataclasses.replace(points, face=faces[points.face]))
    return SurfacePoints(*(np.concatenate([getattr(part, name) for part in parts]) for name in ("position", "normal", "face")))


def room_eyes(plan: FloorPlan, scene: RayScene, room: int, settings: CameraSettings) -> Float[np.ndarray, "n 3"]:
    """Where eyes may be that see a room: in its free air near its furniture, standing and near the ceiling, and in its doorways.

    Raises: InputError if the room has no free spot for a camera, naming the room and why.
    """
    air = room_air(plan, room, scene, settings)
    inside = [_spread(air, height) for height in sorted({min(_LOW, air.eye_height), air.eye_height, air.high})]
    doors = [
        _in_doorway(portal.ends, height)
        for portal in portals(plan)
        if portal.is_way and room in portal.rooms
        for height in (_LOW, min(air.eye_height, portal.head - FACE))
    ]
    return np.concatenate([*inside, *doors])


def exposed(scene: RayScene, points: SurfacePoints, eyes: Float[np.ndarray, "n 3"]) -> Bool[np.ndarray, "p"]:
    """Which points at least one of the eyes sees: it faces the eye with nothing between."""
    seen = np.zeros(len(points.face), bool)
    for eye in eyes:
        left = np.flatnonzero(~seen)
        seen[left] = in_sight(scene, points, left, eye)
    return seen


def _spread(air: RoomAir, height: float) -> Float[np.ndarray, "n 3"]:
    """Up to _EYES free points of the room at a height, each the one farthest from those before it."""
    spots = np.column_stack([air.samples, np.full(len(air.samples), height)])
    spots = spots[free(air.scene, spots, FACE)]
    chosen = spots[:1]
    while len(chosen) < min(_EYES, len(spots)):
        gap = np.linalg.norm(spots[:, None] - chosen, axis=-1).min(axis=1)
        chosen = np.concatenate([chosen, spots[np.argmax(gap)][None]])
    return chosen


def _in_doorway(ends: Float[np.ndarray, "2 2"], height: float) -> Float[np.ndarray, "n 3"]:
    across = np.array(_ACROSS)[:, None]
    return np.column_stack([(1 - across) * ends[0] + across * ends[1], np.full(len(_ACROSS), height)])
