"""Writing GLB (glTF 2.0, binary): in metres, y up, one node per object; equal nodes give equal bytes.

glTF is y-up and we are z-up: (x, y, z) becomes (x, z, -y). Colours are sRGB here and linear in glTF's factors; textures are
sRGB in both, embedded as PNG, sampled with CLAMP_TO_EDGE so that charts do not bleed around the atlas. Normals are left out:
a reader then shades flat, as the specification asks. The rooms' textures carry their light (they are painted views), so their
nodes are unlit (KHR_materials_unlit); those of objects are colours of surfaces, and lit.

trimesh reads meshes for us (wm.geometry.exchange) and does not write these files: its exporter (5.2) has no unlit material, no
sampler and no strength of emission (it writes a factor of 3 where the specification allows 1), puts one primitive in a mesh, and
leaves z up. Measured by experiments/library_peers.
Source: Khronos, glTF 2.0 specification, sections 3.6-3.9 and 4.
"""

import dataclasses
import io
import json
import os
import struct
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image

from wm.types import SceneObject

_FLOAT, _UINT32 = 5126, 5125  # componentType
_VERTICES, _INDICES = 34962, 34963  # bufferView.target
_LINEAR, _LINEAR_MIPMAP, _CLAMP = 9729, 9987, 33071  # sampler


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


def object_nodes(objects: Sequence[SceneObject], rooms: Sequence[str] = ()) -> list[GlbNode]:
    """The objects as nodes, each with a primitive for each of its materials.

    Args:
      objects: a node is named by its object's id, or by label and a number where that is empty. Its extras hold `id`, `label`,
        `support`, `face_object` (the object's index, as in `Mesh.face_object`) and `room`.
      rooms: the ids of the plan's rooms; without them `room` is the room's index.
    """
    nodes: list[GlbNode] = []
    seen: dict[str, int] = {}
    for index, thing in enumerate(objects):
        seen[thing.label] = seen.get(thing.label, 0) + 1
        name = thing.id or f"{thing.label} {seen[thing.label]}"
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
        emission=float(thing.emission[slot]), double_sided=True, extras=extras,
    )  # fmt: skip


def save_glb(path: str | os.PathLike[str], nodes: Iterable[GlbNode]) -> None:
    """Writes nodes to a GLB file; nodes without faces are left out.

    Raises:
      ValueError: a node's vertices or faces have another shape or type than [v, 3] and integer [f, 3], its coordinates are not
        finite, its indices out of range, or its uv and texture do not belong together. The message names node and field.
    """
    Path(path).write_bytes(_encode(nodes))


def _encode(nodes: Iterable[GlbNode]) -> bytes:
    document = _Document()
    for node in nodes:
        _check(node)
        if len(node.faces):
            document.add(node)
    return document.to_bytes()


def _check(node: GlbNode) -> None:
    where = f"GLB node {node.name!r}"
    if node.vertices.ndim != 2 or node.vertices.shape[1] != 3:
        raise ValueError(f"{where}: vertices must be [v, 3]; they are {list(node.vertices.shape)}")
    if node.faces.ndim != 2 or node.faces.shape[1] != 3 or not np.issubdtype(node.faces.dtype, np.integer):
        raise ValueError(f"{where}: faces must be integers [f, 3]; they are {node.faces.dtype} {list(node.faces.shape)}")
    if not (np.abs(node.vertices) <= np.finfo(np.float32).max).all():
        raise ValueError(f"{where}: a vertex is not finite in float32")
    if len(node.faces) and not (node.faces.min() >= 0 and node.faces.max() < len(node.vertices)):
        raise ValueError(f"{where}: a face refers to a vertex that is not there ({len(node.vertices)} vertices)")
    if (node.uv is None) != (node.texture is None):
        raise ValueError(f"{where}: uv and texture go together; only one is given")
    if node.uv is not None and (node.uv.shape != (len(node.vertices), 2) or not np.isfinite(node.uv).all()):
        raise ValueError(f"{where}: uv must be finite and [{len(node.vertices)}, 2]; it is {node.uv.shape}")
    if node.texture is not None and (node.texture.dtype != np.uint8 or node.texture.ndim != 3 or node.texture.shape[2] != 3):
        raise ValueError(f"{where}: texture must be uint8 [h, w, 3]; it is {node.texture.dtype} {node.texture.shape}")
    if node.base_color is not None and (np.shape(node.base_color) != (3,) or not np.isfinite(node.base_color).all()):
        raise ValueError(f"{where}: base_color must be three finite numbers; it is {node.base_color}")
    if not (np.isfinite(node.emission) and node.emission >= 0):
        raise ValueError(f"{where}: emission is {node.emission}; it must be finite and not negative")


class _Document:
    """A glTF document under construction: its JSON and its one binary buffer."""

    def __init__(self) -> None:
        self.binary = bytearray()
        self.views: list[dict[str, Any]] = []
        self.accessors: list[dict[str, Any]] = []
        self.materials: list[dict[str, Any]] = []
        self.images: list[dict[str, Any]] = []
        self.meshes: dict[str, dict[str, Any]] = {}  # by node name
        self.extras: dict[str, dict[str, Any]] = {}  # likewise, of the nodes that have some
        self.extensions: set[str] = set()
        self._textures: dict[int, int] = {}  # id of an array the caller holds -> image
        self._held: list[np.ndarray] = []

    def add(self, node: GlbNode) -> None:
        x, y, z = np.asarray(node.vertices, np.float64).T
        position = np.stack([x, z, -y], axis=1).astype("<f4")
        attributes = {"POSITION": self._accessor(position, "VEC3", _FLOAT, _VERTICES, bounds=True)}
        if node.uv is not None:
            attributes["TEXCOORD_0"] = self._accessor(np.asarray(node.uv).astype("<f4"), "VEC2", _FLOAT, _VERTICES)
        primitive = {
            "attributes": attributes,
            "indices": self._accessor(np.asarray(node.faces).astype("<u4").reshape(-1), "SCALAR", _UINT32, _INDICES),
            "material": self._material(node),
        }
        mesh = self.meshes.setdefault(node.name, {"name": node.name, "primitives": []})
        mesh["primitives"].append(primitive)
        if node.extras:
            self.extras[node.name] = {"extras": node.extras}

    def _view(self, data: bytes, target: int | None = None) -> int:
        self.binary.extend(b"\0" * (-len(self.binary) % 4))
        view: dict[str, Any] = {"buffer": 0, "byteOffset": len(self.binary), "byteLength": len(data)}
        if target is not None:
            view["target"] = target
        self.binary.extend(data)
        self.views.append(view)
        return len(self.views) - 1

    def _accessor(self, array: np.ndarray, shape: str, component: int, target: int, *, bounds: bool = False) -> int:
        accessor: dict[str, Any] = {
            "bufferView": self._view(array.tobytes(), target),
            "componentType": component,
            "count": len(array),
            "type": shape,
        }
        if bounds:
            # The specification compares these with the stored float32 values, bit for bit.
            accessor |= {"min": array.min(axis=0).astype(float).tolist(), "max": array.max(axis=0).astype(float).tolist()}
        self.accessors.append(accessor)
        return len(self.accessors) - 1

    def _material(self, node: GlbNode) -> int:
        color = np.ones(3) if node.base_color is None else _linear(np.clip(np.asarray(node.base_color, np.float64), 0, 1))
        surface: dict[str, Any] = {"baseColorFactor": [*color.tolist(), 1.0], "metallicFactor": 0.0, "roughnessFactor": 1.0}
        material: dict[str, Any] = {"name": node.name, "pbrMetallicRoughness": surface, "doubleSided": node.double_sided}
        if node.texture is not None:
            surface["baseColorTexture"] = {"index": self._texture(node.texture)}
        if node.emission > 0:
            material["emissiveFactor"] = (color * min(node.emission, 1.0)).tolist()
            if node.texture is not None:
                material["emissiveTexture"] = {"index": self._texture(node.texture)}
            if node.emission > 1:
                self._extend(material, "KHR_materials_emissive_strength", {"emissiveStrength": node.emission})
        elif node.unlit:
            self._extend(material, "KHR_materials_unlit", {})
        self.materials.append(material)
        return len(self.materials) - 1

    def _extend(self, material: dict[str, Any], name: str, value: dict[str, Any]) -> None:
        material.setdefault("extensions", {})[name] = value
        self.extensions.add(name)

    def _texture(self, pixels: np.ndarray) -> int:
        """The texture of these pixels, stored once however many nodes share the array."""
        if id(pixels) not in self._textures:
            png = io.BytesIO()
            Image.fromarray(np.ascontiguousarray(pixels)).save(png, format="PNG", compress_level=6)
            self._textures[id(pixels)] = len(self.images)
            self._held.append(pixels)  # so that its id stays its own
            self.images.append({"bufferView": self._view(png.getvalue()), "mimeType": "image/png"})
        return self._textures[id(pixels)]

    def to_bytes(self) -> bytes:
        meshes = list(self.meshes.values())
        document: dict[str, Any] = {
            "asset": {"version": "2.0", "generator": "wm"},
            "scene": 0,
            "scenes": [{"nodes": list(range(len(meshes)))}] if meshes else [{}],
        }
        if meshes:
            self.binary.extend(b"\0" * (-len(self.binary) % 4))
            document |= {
                "nodes": [{"name": name, "mesh": k, **self.extras.get(name, {})} for k, name in enumerate(self.meshes)],
                "meshes": meshes,
                "materials": self.materials,
                "accessors": self.accessors,
                "bufferViews": self.views,
                "buffers": [{"byteLength": len(self.binary)}],
            }
        if self.images:
            document |= {
                "images": self.images,
                "textures": [{"source": k, "sampler": 0} for k in range(len(self.images))],
                "samplers": [{"magFilter": _LINEAR, "minFilter": _LINEAR_MIPMAP, "wrapS": _CLAMP, "wrapT": _CLAMP}],
            }
        if self.extensions:
            document["extensionsUsed"] = sorted(self.extensions)
        text = json.dumps(document, separators=(",", ":"), allow_nan=False).encode()
        text += b" " * (-len(text) % 4)
        chunks = struct.pack("<I4s", len(text), b"JSON") + text
        if self.binary:
            chunks += struct.pack("<I4s", len(self.binary), b"BIN\0") + bytes(self.binary)
        return struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks


def _linear(srgb: np.ndarray) -> np.ndarray:
    """IEC 61966-2-1: sRGB in [0, 1] to linear light."""
    return np.where(srgb <= 0.04045, srgb / 12.92, ((srgb + 0.055) / 1.055) ** 2.4)
