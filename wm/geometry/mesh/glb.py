"""Writing GLB (glTF 2.0, binary): in metres, y up, one node per object; equal nodes give equal bytes.

glTF is y-up and we are z-up: (x, y, z) becomes (x, z, -y). Colours are sRGB here and linear in glTF's factors; textures are
sRGB in both, embedded as PNG, sampled with CLAMP_TO_EDGE so that charts do not bleed around the atlas. Normals are left out:
a reader then shades flat, as the specification asks. The rooms' textures carry their light (they are painted views), so their
nodes are unlit (KHR_materials_unlit); those of objects are colours of surfaces, and lit. A node with a frame of its own has its
vertices in it, so that other programs move and turn it about its foot.

trimesh reads meshes for us (wm.geometry.exchange) and does not write these files: its exporter (5.2) has no unlit material, no
sampler and no strength of emission (it writes a factor of 3 where the specification allows 1), puts one primitive in a mesh, and
leaves z up. Measured by experiments/library_peers.
Source: Khronos, glTF 2.0 specification, sections 3.6-3.10 and 4; KHR_lights_punctual.
"""

import io
import json
import os
import struct
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image
from scipy.spatial.transform import Rotation

from wm.geometry.mesh.axes import Y_UP, opengl_pose
from wm.geometry.mesh.glb_nodes import GlbLight, GlbNode
from wm.types import View

_FLOAT, _UINT32 = 5126, 5125  # componentType
_VERTICES, _INDICES = 34962, 34963  # bufferView.target
_LINEAR, _LINEAR_MIPMAP, _CLAMP = 9729, 9987, 33071  # sampler
_T_Y_UP = np.eye(4)
_T_Y_UP[:3, :3] = Y_UP
_NEAR = 0.05  # metres


def save_glb(
    path: str | os.PathLike[str], nodes: Iterable[GlbNode], *, lights: Sequence[GlbLight] = (), views: Sequence[View] = ()
) -> None:
    """Writes nodes to a GLB file; nodes without faces are left out.

    Args:
      nodes: those that are `apart` are the file's second scene, "exterior".
      lights: point lights; their parents are among the nodes.
      views: become cameras of their names.

    Raises:
      ValueError: a node's vertices or faces have another shape or type than [v, 3] and integer [f, 3], its coordinates are not
        finite, its indices out of range, or its uv and texture do not belong together. The message names node and field.
    """
    Path(path).write_bytes(_encode(nodes, lights, views))


def _encode(nodes: Iterable[GlbNode], lights: Sequence[GlbLight], views: Sequence[View]) -> bytes:
    document = _Document()
    for node in nodes:
        _check(node)
        if len(node.faces):
            document.add(node)
    for light in lights:
        document.add_light(light)
    for view in views:
        document.add_camera(view)
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
    if node.T_world_node is not None and not _is_rigid(node.T_world_node):
        raise ValueError(f"{where}: T_world_node must be a rotation and a translation, [4, 4]; it is {node.T_world_node}")


def _is_rigid(T: np.ndarray) -> bool:
    if np.shape(T) != (4, 4) or not np.isfinite(T).all():
        return False
    rotation = T[:3, :3]
    return bool(np.allclose(rotation @ rotation.T, np.eye(3), atol=1e-5) and np.linalg.det(rotation) > 0)


class _Document:
    """A glTF document under construction: its JSON and its one binary buffer."""

    def __init__(self) -> None:
        self.binary = bytearray()
        self.views: list[dict[str, Any]] = []
        self.accessors: list[dict[str, Any]] = []
        self.materials: list[dict[str, Any]] = []
        self.images: list[dict[str, Any]] = []
        self.meshes: list[dict[str, Any]] = []
        self.nodes: list[dict[str, Any]] = []
        self.lights: list[dict[str, Any]] = []
        self.cameras: list[dict[str, Any]] = []
        self.extensions: set[str] = set()
        self._named: dict[str, int] = {}  # nodes with a mesh
        self._frames: dict[str, np.ndarray] = {}  # of those that have one of their own, in our axes
        self._apart: set[int] = set()  # nodes of the second scene
        self._children: set[int] = set()
        self._known: dict[str, int] = {}  # materials by their content
        self._textures: dict[int, int] = {}  # id of an array the caller holds -> image
        self._held: list[np.ndarray] = []

    def add(self, node: GlbNode) -> None:
        frame = np.eye(4) if node.T_world_node is None else node.T_world_node
        if node.name not in self._named:
            self._add_node(node, frame)
        frame = self._frames[node.name]
        local = (np.asarray(node.vertices, np.float64) - frame[:3, 3]) @ frame[:3, :3]
        attributes = {"POSITION": self._accessor(_y_up(local).astype("<f4"), "VEC3", _FLOAT, _VERTICES, bounds=True)}
        if node.uv is not None:
            attributes["TEXCOORD_0"] = self._accessor(np.asarray(node.uv).astype("<f4"), "VEC2", _FLOAT, _VERTICES)
        primitive = {
            "attributes": attributes,
            "indices": self._accessor(np.asarray(node.faces).astype("<u4").reshape(-1), "SCALAR", _UINT32, _INDICES),
            "material": self._material(node),
        }
        self.meshes[self.nodes[self._named[node.name]]["mesh"]]["primitives"].append(primitive)

    def add_light(self, light: GlbLight) -> None:
        """A light's node: a child of its parent, in the frame of that, or one of its own."""
        parent = self._named.get(light.parent)
        position = np.asarray(light.position, np.float64)
        if parent is not None:
            frame = self._frames[light.parent]
            position = (position - frame[:3, 3]) @ frame[:3, :3]
        color = _linear(np.clip(np.asarray(light.color, np.float64), 0, 1)).tolist()
        self.lights.append({"name": light.name, "type": "point", "color": color, "intensity": float(light.intensity)})
        shining = {"KHR_lights_punctual": {"light": len(self.lights) - 1}}
        self.nodes.append({"name": light.name, "translation": _y_up(position).tolist(), "extensions": shining})
        self.extensions.add("KHR_lights_punctual")
        if parent is not None:
            self.nodes[parent].setdefault("children", []).append(len(self.nodes) - 1)
            self._children.add(len(self.nodes) - 1)

    def add_camera(self, view: View) -> None:
        camera = view.camera
        yfov = 2 * float(np.arctan(camera.height / 2 / float(camera.focal[1])))
        aspect = camera.width / camera.height * float(camera.focal[1]) / float(camera.focal[0])
        lens = {"yfov": yfov, "aspectRatio": aspect, "znear": _NEAR}
        self.cameras.append({"name": view.name, "type": "perspective", "perspective": lens})
        pose = _T_Y_UP @ opengl_pose(camera)
        self.nodes.append({"name": view.name, "camera": len(self.cameras) - 1, **_placed(pose)})

    def _add_node(self, node: GlbNode, frame: np.ndarray) -> None:
        """A node with an empty mesh; the primitives of all nodes of its name go into it."""
        self._frames[node.name], self._named[node.name] = frame, len(self.nodes)
        placed = {} if node.T_world_node is None else _placed(_T_Y_UP @ frame @ _T_Y_UP.T)
        extras = {"extras": node.extras} if node.extras else {}
        self.nodes.append({"name": node.name, "mesh": len(self.meshes), **placed, **extras})
        self.meshes.append({"name": node.name, "primitives": []})
        if node.apart:
            self._apart.add(len(self.nodes) - 1)

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
        name = node.material or node.name
        material: dict[str, Any] = {"name": name, "pbrMetallicRoughness": surface, "doubleSided": node.double_sided}
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
        content = json.dumps(material)
        if content not in self._known:
            self._known[content] = len(self.materials)
            self.materials.append(material)
        return self._known[content]

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

    def _scenes(self) -> list[dict[str, Any]]:
        """The house; and, where a node stands apart, its exterior."""
        roots = [k for k in range(len(self.nodes)) if k not in self._children]
        first, second = ([k for k in roots if (k in self._apart) == apart] for apart in (False, True))
        if not second:
            return [{"nodes": first}] if first else [{}]
        return [{"name": "house", **({"nodes": first} if first else {})}, {"name": "exterior", "nodes": second}]

    def to_bytes(self) -> bytes:
        document: dict[str, Any] = {
            "asset": {"version": "2.0", "generator": "wm"},
            "scene": 0,
            "scenes": self._scenes(),
        }
        if self.nodes:
            document["nodes"] = self.nodes
        if self.meshes:
            self.binary.extend(b"\0" * (-len(self.binary) % 4))
            document |= {
                "meshes": self.meshes,
                "materials": self.materials,
                "accessors": self.accessors,
                "bufferViews": self.views,
                "buffers": [{"byteLength": len(self.binary)}],
            }
        if self.cameras:
            document["cameras"] = self.cameras
        if self.lights:
            document["extensions"] = {"KHR_lights_punctual": {"lights": self.lights}}
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


def _y_up(points: np.ndarray) -> np.ndarray:
    """Points [..., 3] in glTF's axes."""
    return points @ Y_UP.T


def _placed(T: np.ndarray) -> dict[str, list[float]]:
    """A rigid transform as the properties of a glTF node."""
    rotation = Rotation.from_matrix(T[:3, :3]).as_quat(canonical=True)
    return {"rotation": (rotation / np.linalg.norm(rotation)).tolist(), "translation": T[:3, 3].tolist()}
