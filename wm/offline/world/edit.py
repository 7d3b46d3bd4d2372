"""Changes of one image of the world: things removed, moved or added a second time, and doorways closed.

An edited mesh has faces of its own, each of which looks like some face of the mesh that was dressed and lit: a thing keeps its
material and the light of its place, and a door leaf borrows the trim of its opening. So an edit takes a new BVH but no bake.
"""

import dataclasses

import numpy as np
from jaxtyping import Int

from wm.geometry.mesh.scene_mesh import BOX_CORNERS, BOX_FACES, face_crosses
from wm.geometry.plan.openings import portals
from wm.geometry.plan.portal import Portal
from wm.geometry.plan.records import FloorPlan
from wm.types import OUTSIDE, Mesh, SurfaceKind

LEAF = 0.04
"""Thickness of a door leaf, metres."""
SNUG = 0.005
"""Metres of air between a leaf and its opening's reveals, so that no two faces share a plane."""


@dataclasses.dataclass(frozen=True, eq=False)
class Edit:
    """The changes. Objects are indices into the scene's; movements are [4, 4] transformations of the world."""

    removed: tuple[int, ...] = ()
    moved: tuple[tuple[int, np.ndarray], ...] = ()
    added: tuple[tuple[int, np.ndarray], ...] = ()  # a second one of a kind that is there
    closed: tuple[int, ...] = ()  # indices into `portals(plan)`


def edited_mesh(mesh: Mesh, plan: FloorPlan, edit: Edit) -> tuple[Mesh, Int[np.ndarray, "g"]]:
    """The mesh with its changes, and for each of its faces the face of `mesh` that it looks like."""
    gone = np.isin(mesh.face_object, [*edit.removed, *(thing for thing, _ in edit.moved)])
    gone &= mesh.face_object != OUTSIDE
    parts = [(mesh.vertices, mesh.faces[~gone], np.flatnonzero(~gone), mesh.face_room[~gone])]
    for thing, transform in (*edit.moved, *edit.added):
        source = np.flatnonzero(mesh.face_object == thing)
        corners = mesh.vertices[mesh.faces[source]].reshape(-1, 3)
        faces = np.arange(len(corners), dtype=np.int32).reshape(-1, 3)
        parts.append((corners @ transform[:3, :3].T + transform[:3, 3], faces, source, mesh.face_room[source]))
    for k in edit.closed:
        parts.append(_leaf(mesh, portals(plan)[k]))
    starts = np.cumsum([0, *(len(vertices) for vertices, *_ in parts[:-1])])
    source = np.concatenate([part[2] for part in parts]).astype(np.int32)
    edited = Mesh(
        vertices=np.concatenate([vertices for vertices, *_ in parts]),
        faces=np.concatenate([faces + np.int32(start) for (_, faces, *_), start in zip(parts, starts)]),
        face_room=np.concatenate([room for *_, room in parts]),
        face_kind=mesh.face_kind[source],
        face_object=mesh.face_object[source],
    )
    return edited, source


def _leaf(mesh: Mesh, portal: Portal) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """(vertices, faces, source, room) of a leaf in the middle of an opening; each side belongs to the room that sees it."""
    along = portal.ends[1] - portal.ends[0]
    width = float(np.linalg.norm(along))
    axes = np.array([[*(along / width), 0.0], [*portal.normal, 0.0], [0.0, 0.0, 1.0]])
    low = np.array([SNUG, -LEAF / 2, portal.sill + SNUG])
    high = np.array([width - SNUG, LEAF / 2, portal.head - SNUG])
    vertices = (low + BOX_CORNERS * (high - low)) @ axes + np.array([*portal.ends[0], 0.0])
    middle = vertices[BOX_FACES].mean(axis=1) - np.array([*portal.ends.mean(axis=0), 0.0])
    behind = middle[:, :2] @ portal.normal > 0  # the normal leads from the first room into the second
    looks = [_trim(mesh, portal, room) for room in portal.rooms]
    rooms = mesh.face_room[looks]
    return vertices, BOX_FACES, np.where(behind, looks[1], looks[0]), np.where(behind, rooms[1], rooms[0])


def _trim(mesh: Mesh, portal: Portal, room: int) -> int:
    """The largest of the faces nearest to an opening that are reveals of a room; of any room where that one has none."""
    reveals = np.flatnonzero((mesh.face_kind == SurfaceKind.REVEAL) & (mesh.face_room != OUTSIDE))
    own = reveals[mesh.face_room[reveals] == room]
    reveals = own if len(own) else reveals
    corners = mesh.vertices[mesh.faces[reveals]]
    far = np.linalg.norm(corners.mean(axis=1)[:, :2] - portal.ends.mean(axis=0), axis=1)
    area = np.linalg.norm(face_crosses(corners), axis=1)
    near = far < np.linalg.norm(portal.ends[1] - portal.ends[0])
    return int(reveals[np.argmax(np.where(near, area, -far))]) if near.any() else int(reveals[np.argmin(far)])
