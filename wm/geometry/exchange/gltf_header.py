"""What a glTF file says of its materials that trimesh does not hand on.

trimesh rounds a base colour factor to 8 bits of linear light, which moves dark sRGB colours by up to 6/255, and it drops
samplers, the strength of emission, second sets of texture coordinates and texture transforms (experiments/library_peers). So the
JSON header is read here too. Materials are renamed to their index, so that each of trimesh's can be found in the header again,
and primitives without a material are given the specification's default one.
Source: Khronos, glTF 2.0 specification, sections 3.9 and 4; KHR_materials_emissive_strength, _pbrSpecularGlossiness.
"""

import copy
import dataclasses
import json
import struct
from pathlib import Path
from typing import Any

import numpy as np

from wm.geometry.exchange.mesh_error import MeshError

_READ = ("KHR_materials_", "EXT_texture_webp")
"""Extensions that a file may require: of surfaces only the colours are read, whatever else is said of them."""
_REPEAT, _CLAMP = 10497, 33071
_GLOSSY = "KHR_materials_pbrSpecularGlossiness"


@dataclasses.dataclass(frozen=True, eq=False)
class GltfMaterial:
    """The colours of one material, in linear light."""

    name: str
    color: np.ndarray  # [3] factor of the base colour
    emissive: np.ndarray  # [3] factor of the emitted colour, with its strength
    textured: bool
    repeats: bool  # outside [0, 1] the texture repeats; else its border goes on


@dataclasses.dataclass(frozen=True, eq=False)
class GltfHeader:
    """The JSON of a file, and the file's bytes with that JSON changed as the module's docstring says."""

    document: dict[str, Any]
    numbered: bytes

    @property
    def color_is_linear(self) -> bool:
        """Whether COLOR_0 is linear light, as the specification asks; trimesh itself writes sRGB there, unconverted."""
        return "trimesh" not in str(self.document["asset"].get("generator", ""))


def read_header(path: Path) -> GltfHeader:
    """The header of a .glb or .gltf file.

    Raises:
      MeshError: the file is no glTF 2.0, or requires an extension that is not read here.
    """
    data = path.read_bytes()
    try:
        document, rest = _container(data) if path.suffix.lower() == ".glb" else (json.loads(data), None)
        version = str(document["asset"]["version"])
    except (ValueError, KeyError, TypeError, struct.error) as error:
        raise MeshError(f"{path} is not a glTF file: {error}") from error
    if not version.startswith("2"):
        raise MeshError(f"{path} is glTF {version}; only glTF 2 is read")
    unread = [name for name in document.get("extensionsRequired", []) if not name.startswith(_READ)]
    if unread:
        raise MeshError(f"{path} requires {', '.join(unread)}, which is not read: export it without")
    document = _plain_materials(document)
    return GltfHeader(document, _encoded(_numbered(document), rest))


def material(header: GltfHeader, index: int, path: Path) -> GltfMaterial:
    """One of the file's materials.

    Raises:
      MeshError: its texture is placed in a way that is not read.
    """
    entry = header.document["materials"][index]
    surface, extensions = entry.get("pbrMetallicRoughness", {}), entry.get("extensions", {})
    texture = surface.get("baseColorTexture")
    strength = extensions.get("KHR_materials_emissive_strength", {}).get("emissiveStrength", 1.0)
    return GltfMaterial(
        name=str(entry.get("name", f"material {index}")),
        color=np.array(surface.get("baseColorFactor", [1, 1, 1, 1])[:3], np.float64),
        emissive=np.array(entry.get("emissiveFactor", [0, 0, 0]), np.float64) * strength,
        textured=texture is not None,
        repeats=texture is None or _repeats(header.document, texture, f"{path}, material {entry.get('name', index)!r}"),
    )


def _repeats(document: dict[str, Any], texture: dict[str, Any], where: str) -> bool:
    if texture.get("texCoord", 0) != 0:
        raise MeshError(f"{where}: its texture goes by the second set of texture coordinates; only the first is read")
    if "KHR_texture_transform" in texture.get("extensions", {}):
        raise MeshError(f"{where}: its texture is moved by KHR_texture_transform: export it with the transform applied")
    sampler = document["textures"][texture["index"]].get("sampler")
    wraps = {} if sampler is None else document["samplers"][sampler]
    modes = {wraps.get("wrapS", _REPEAT), wraps.get("wrapT", _REPEAT)}
    if modes - {_REPEAT, _CLAMP}:
        raise MeshError(f"{where}: its texture repeats mirrored: only REPEAT and CLAMP_TO_EDGE are read")
    return modes == {_REPEAT}


def _container(data: bytes) -> tuple[dict[str, Any], bytes]:
    """The JSON of a GLB file and the chunks after it."""
    magic, _, _, size, kind = struct.unpack_from("<4sIII4s", data)
    if magic != b"glTF" or kind != b"JSON":
        raise ValueError("it does not begin with glTF's magic number and a JSON chunk")
    return json.loads(data[20 : 20 + size]), data[20 + size :]


def _encoded(document: dict[str, Any], rest: bytes | None) -> bytes:
    text = json.dumps(document).encode()
    if rest is None:
        return text
    text += b" " * (-len(text) % 4)
    return struct.pack("<4sIII4s", b"glTF", 2, 20 + len(text) + len(rest), len(text), b"JSON") + text + rest


def _plain_materials(document: dict[str, Any]) -> dict[str, Any]:
    """The document with a material for every primitive, its colours where the core specification has them."""
    document = copy.deepcopy(document)
    materials = document.setdefault("materials", [])
    for entry in materials:
        glossy = entry.get("extensions", {}).pop(_GLOSSY, None)
        if glossy is not None:
            names = {"diffuseFactor": "baseColorFactor", "diffuseTexture": "baseColorTexture"}
            entry["pbrMetallicRoughness"] = {names[key]: glossy[key] for key in names if key in glossy}
    for primitive in (p for mesh in document.get("meshes", []) for p in mesh["primitives"]):
        primitive.setdefault("material", len(materials))
    return document | {"materials": [*materials, {"name": "default"}]}


def _numbered(document: dict[str, Any]) -> dict[str, Any]:
    return document | {"materials": [entry | {"name": str(k)} for k, entry in enumerate(document["materials"])]}
