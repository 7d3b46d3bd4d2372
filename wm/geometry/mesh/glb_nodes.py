"""What a GLB file is written from: triangles of one material, and point lights; and the nodes of furniture."""

import dataclasses
from collections.abc import Sequence
from typing import Any

import numpy as np

from wm.types import SceneObject


@dataclasses.dataclass(frozen=True, eq=False)
class GlbNode:
    """Triangles of one material. Nodes of one name become one glTF node with a primitive each."""

    name: str
    vertices: np.ndarray  # [v, 3] metres, z up
    faces: np.ndarray  # [f, 3] integer
    uv: np.ndarray | None = None  # [v, 2]; (0, 0) is the corner of the texture's first pixel, v runs down its rows
    texture: np.ndarray | None = None  # [h, w, 3] uint8 sRGB
    base_color: np.ndarray | None = None  # [3] sRGB in [0, 1]; white without
    emission: float = 0.0  # how strongly it glows in its own colour
    unlit: bool = False  # its colours carry their light
    double_sided: bool = False
    extras: dict[str, Any] | None = None  # of the glTF node: JSON-like values that viewers hand on
    material: str = ""  # its material's name; the node's where this is empty. Equal materials of one name are one
    T_world_node: np.ndarray | None = (
        None  # [4, 4] rigid: the node's own frame, z up; vertices are given in the world all the same
    )
    apart: bool = False  # in the file's second scene only


@dataclasses.dataclass(frozen=True, eq=False)
class GlbLight:
    """A point light (KHR_lights_punctual)."""

    name: str
    position: np.ndarray  # [3] metres, z up
    color: np.ndarray  # [3] sRGB in [0, 1]
    intensity: float  # candela
    parent: str = ""  # the name of the node that it moves with


def object_nodes(objects: Sequence[SceneObject], rooms: Sequence[str] = ()) -> list[GlbNode]:
    """The objects as nodes, each with a primitive for each of its materials.

    Args:
      objects: a node is named by its object's id, or by label and a number where that is empty, and has the object's frame. Its
        extras hold `id`, `label`, `support`, `face_object` (the object's index, as in `Mesh.face_object`) and `room`.
      rooms: the ids of the plan's rooms; without them `room` is the room's index.
    """
    nodes: list[GlbNode] = []
    seen: dict[str, int] = {}
    for index, thing in enumerate(objects):
        seen[thing.label] = seen.get(thing.label, 0) + 1
        name = _name(thing, seen[thing.label])
        room = rooms[thing.room] if rooms else thing.room
        extras = {"id": name, "label": thing.label, "room": room, "support": thing.support, "face_object": index}
        nodes += [_slot_node(thing, slot, name, extras) for slot in range(len(thing.slots))]
    return nodes


def _slot_node(thing: SceneObject, slot: int, name: str, extras: dict[str, Any]) -> GlbNode:
    """The faces of one material, in their texture where they have one and else in one colour."""
    mine = thing.face_slot == slot
    texture = thing.texture
    uv = base_color = image = None
    if texture is None or not texture.slots[slot]:
        vertex, index = np.unique(thing.faces[mine], return_inverse=True)
        base_color = thing.slot_colors[slot]
    else:
        corners = np.concatenate([thing.faces[mine].reshape(-1, 1), texture.corner_uv[mine].reshape(-1, 2)], axis=1)
        corners, index = np.unique(corners, axis=0, return_inverse=True)
        vertex, uv, image = corners[:, 0].astype(np.int64), corners[:, 1:], texture.image
    return GlbNode(
        name=name, vertices=thing.vertices[vertex], faces=index.reshape(-1, 3), uv=uv, texture=image, base_color=base_color,
        emission=float(thing.emission[slot]), double_sided=True, extras=extras, material=thing.slots[slot],
        T_world_node=np.asarray(thing.T_world_object, np.float64),
    )  # fmt: skip


def _name(thing: SceneObject, count: int) -> str:
    return thing.id or f"{thing.label} {count}"
