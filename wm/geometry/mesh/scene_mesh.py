"""Triangle meshes of a whole scene: putting structure and objects together, and looking at what one holds."""

from collections.abc import Sequence

import numpy as np
from jaxtyping import Float

from wm.types import OUTSIDE, Mesh, SceneObject, SurfaceKind

BOX_COLOR = 0.5  # sRGB grey of the boxes that stand in for objects
BOX_CORNERS = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]], np.float64)
BOX_FACES = np.array(
    [
        [0, 2, 1],
        [0, 3, 2],
        [4, 5, 6],
        [4, 6, 7],
        [0, 1, 5],
        [0, 5, 4],
        [1, 2, 6],
        [1, 6, 5],
        [2, 3, 7],
        [2, 7, 6],
        [3, 0, 4],
        [3, 4, 7],
    ],
    np.int32,
)


def face_crosses(corners: Float[np.ndarray, "f 3 3"]) -> Float[np.ndarray, "f 3"]:
    """(c1 - c0) x (c2 - c0) of triangles [f, corner, xyz]: along the normal as they are wound, and twice the area long."""
    return np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])


def face_normals(mesh: Mesh) -> Float[np.ndarray, "f 3"]:
    """Unit normals of a mesh's triangles, as they are wound; 0 for triangles without area."""
    normals = face_crosses(mesh.vertices[mesh.faces])
    length = np.linalg.norm(normals, axis=1, keepdims=True)
    return np.divide(normals, length, out=np.zeros_like(normals), where=length > 0)


def assemble_scene(structure: Mesh, objects: Sequence[SceneObject]) -> Mesh:
    """One mesh of a structure and its objects, structure first; `face_object` indexes `objects`.

    Raises:
      ValueError: an object is broken; the message names it.
    """
    parts = [structure]
    for index, thing in enumerate(objects):
        count = len(thing.faces)
        part = Mesh(
            vertices=np.asarray(thing.vertices, np.float64),
            faces=np.asarray(thing.faces, np.int32),
            face_room=np.full(count, thing.room, np.int32),
            face_kind=np.full(count, SurfaceKind.OBJECT, np.int32),
            face_object=np.full(count, index, np.int32),
        )
        check_mesh(part, f"object {index} ({thing.label})")
        parts.append(part)
    offsets = np.cumsum([0] + [len(part.vertices) for part in parts[:-1]])
    return Mesh(
        vertices=np.concatenate([part.vertices for part in parts]),
        faces=np.concatenate([part.faces + np.int32(offset) for part, offset in zip(parts, offsets)]),
        face_room=np.concatenate([part.face_room for part in parts]),
        face_kind=np.concatenate([part.face_kind for part in parts]),
        face_object=np.concatenate([part.face_object for part in parts]),
    )


def object_boxes(objects: Sequence[SceneObject]) -> tuple[SceneObject, ...]:
    """Each object replaced by the grey box that bounds it along its own axes (paper, ablation "walls and bounding boxes")."""
    return tuple(_boxed(thing) for thing in objects)


def _boxed(thing: SceneObject) -> SceneObject:
    rotation, origin = thing.T_world_object[:3, :3], thing.T_world_object[:3, 3]
    local = (thing.vertices - origin) @ rotation
    low, high = local.min(axis=0), local.max(axis=0)
    return SceneObject(
        label=thing.label,
        room=thing.room,
        support=thing.support,
        vertices=(low + BOX_CORNERS * (high - low)) @ rotation.T + origin,
        faces=BOX_FACES.copy(),
        face_slot=np.zeros(len(BOX_FACES), np.int32),
        slots=("grey",),
        slot_colors=np.full((1, 3), BOX_COLOR, np.float32),
        T_world_object=thing.T_world_object,
        size=high - low,
        emission=np.zeros(1, np.float32),
    )


def check_mesh(mesh: Mesh, name: str = "mesh") -> None:
    """Makes sure that rays can be cast against a mesh: ray tracers silently never hit a broken triangle.

    Raises:
      ValueError: a coordinate is not finite, an index is out of range, an array has another shape or length than the rest,
        a kind is no SurfaceKind, or a room or object is below OUTSIDE.
    """
    vertices, faces = mesh.vertices, mesh.faces
    if vertices.ndim != 2 or vertices.shape[1] != 3 or faces.ndim != 2 or faces.shape[1] != 3:
        raise ValueError(f"{name}: vertices must be [v, 3] and faces [f, 3]; they are {vertices.shape} and {faces.shape}")
    broken = np.flatnonzero(~np.isfinite(vertices).all(axis=1))
    if broken.size:
        raise ValueError(f"{name}: vertex {broken[0]} is {vertices[broken[0]]}; coordinates must be finite")
    stray = np.flatnonzero(((faces < 0) | (faces >= len(vertices))).any(axis=1))
    if stray.size:
        raise ValueError(f"{name}: face {stray[0]} is {faces[stray[0]]}; there are {len(vertices)} vertices")
    for field in ("face_room", "face_kind", "face_object"):
        labels = getattr(mesh, field)
        if labels.shape != (len(faces),):
            raise ValueError(f"{name}: {field} has shape {labels.shape}; there are {len(faces)} faces")
        if labels.size and labels.min() < (0 if field == "face_kind" else OUTSIDE):
            raise ValueError(f"{name}: {field} holds {labels.min()}")
    if len(faces) and mesh.face_kind.max() >= len(SurfaceKind):
        raise ValueError(f"{name}: face_kind holds {mesh.face_kind.max()}; the last SurfaceKind is {len(SurfaceKind) - 1}")
