"""The triangles of a mesh file, each with what colours it: read by trimesh, every node's transform applied.

What is read of a surface is its base colour, as a texture, a factor, both, or at vertices, and how it glows. Opacity, normal
maps, metal and roughness are left out. Where a material has a texture, colours at vertices are left out too.
"""

import dataclasses
import io
import warnings
from pathlib import Path
from typing import Any

import numpy as np
from jaxtyping import Float
from PIL import Image

from wm.color import LUMINANCE, to_linear, to_srgb
from wm.geometry.exchange.gltf_header import GltfHeader, material, read_header
from wm.geometry.exchange.mesh_error import MeshError

_GREY = 0.6  # sRGB of surfaces that a file does not colour
_DARK = 1e-3  # linear luminance below which a glow is not told as a multiple of the base colour


@dataclasses.dataclass(frozen=True, eq=False)
class Paint:
    """A material."""

    name: str
    color: np.ndarray  # [3] sRGB in [0, 1]; with an image, the factor in it
    emission: float = 0.0
    image: np.ndarray | None = None  # [h, w, 3] uint8 sRGB
    repeats: bool = True  # outside [0, 1] the image repeats; else its border goes on


@dataclasses.dataclass(frozen=True, eq=False)
class MeshPart:
    """Triangles of one material, in the frame and the unit of the file."""

    corners: np.ndarray  # [f, 3, 3] float64
    paint: Paint
    corner_uv: np.ndarray | None = None  # [f, 3, 2], v runs down; with an image only
    corner_colors: np.ndarray | None = None  # [f, 3, 3] uint8 sRGB, in place of the paint's colour


def read_parts(path: Path) -> list[MeshPart]:
    """The parts of a file that have triangles.

    Raises:
      MeshError: trimesh cannot read the file, a file that it refers to is not there, or its textures are placed in a way that
        is not read.
    """
    import trimesh

    header = read_header(path) if path.suffix.lower() in (".glb", ".gltf") else None
    files = _files_beside(path)
    with open(path, "rb") if header is None else io.BytesIO(header.numbered) as stream, warnings.catch_warnings():
        warnings.simplefilter("ignore")  # of NumPy about how trimesh parses
        try:
            scene = trimesh.load_scene(stream, file_type=path.suffix[1:].lower(), resolver=files, process=False)
            placed = [(scene.geometry[name], T) for T, name in map(scene.graph.get, scene.graph.nodes_geometry)]
        except Exception as error:  # a parser that is handed anything raises anything
            _check_files(files.missing, path)
            raise MeshError(f"{path} cannot be read as a mesh: {type(error).__name__}: {error}") from error
    _check_files(files.missing, path)
    meshes = [(mesh, T) for mesh, T in placed if isinstance(mesh, trimesh.Trimesh) and len(mesh.faces)]
    return [_moved(_part(mesh, header, path), np.asarray(T, np.float64)) for mesh, T in meshes]


def _check_files(missing: list[str], path: Path) -> None:
    if missing:
        raise MeshError(f"{path} refers to {', '.join(missing)}, which is not in {path.parent} or its folders")


def _files_beside(path: Path) -> Any:
    """trimesh's resolver of the files that a file refers to, which keeps the names of those that are missing.

    trimesh itself only logs them, and goes on with a mesh without its colours.
    """
    from trimesh.resolvers import FilePathResolver

    class Files(FilePathResolver):
        def __init__(self) -> None:
            super().__init__(str(path))
            self.missing: list[str] = []

        def get(self, name: str) -> bytes:
            try:
                return super().get(name)
            except (OSError, ValueError):
                self.missing.append(name)
                raise

    return Files()


def _moved(part: MeshPart, T: Float[np.ndarray, "4 4"]) -> MeshPart:
    """A part after a node's transform, its winding turned where that mirrors. (`Scene.dump` would lose colours at vertices.)"""
    moved = dataclasses.replace(part, corners=part.corners @ T[:3, :3].T + T[:3, 3])
    if np.linalg.det(T[:3, :3]) >= 0:
        return moved
    return dataclasses.replace(
        moved,
        corners=moved.corners[:, ::-1],
        corner_uv=None if part.corner_uv is None else part.corner_uv[:, ::-1],
        corner_colors=None if part.corner_colors is None else part.corner_colors[:, ::-1],
    )


def _part(mesh: Any, header: GltfHeader | None, path: Path) -> MeshPart:
    corners = np.asarray(mesh.vertices, np.float64)[mesh.faces]
    if not hasattr(mesh.visual, "material"):
        return MeshPart(corners, Paint("unnamed", np.full(3, _GREY)), corner_colors=_corner_colors(mesh))
    paint = _simple_paint(mesh.visual.material) if header is None else _gltf_paint(mesh.visual.material, header, path)
    uv = mesh.visual.uv
    if paint.image is not None and uv is not None and len(uv) == len(mesh.vertices):
        corner_uv = np.stack([uv[:, 0], 1.0 - uv[:, 1]], axis=1).astype(np.float64)[mesh.faces]
        if not np.isfinite(corner_uv).all():
            raise MeshError(f"{path}: a texture coordinate of {paint.name!r} is not finite")
        return MeshPart(corners, paint, corner_uv=corner_uv)
    if paint.image is not None:
        raise MeshError(f"{path}: {paint.name!r} has a texture, and its mesh no texture coordinates: unwrap it first")
    colors = mesh.visual.vertex_attributes.get("color")
    if colors is None or len(colors) != len(mesh.vertices):
        return MeshPart(corners, paint)
    return MeshPart(corners, paint, corner_colors=_multiplied(np.asarray(colors), paint, header)[mesh.faces])


def _corner_colors(mesh: Any) -> np.ndarray | None:
    """[f, 3, 3] uint8: the colours of a mesh that has them at its vertices or faces."""
    if mesh.visual.kind == "vertex":
        return np.asarray(mesh.visual.vertex_colors, np.uint8)[mesh.faces][:, :, :3]
    if mesh.visual.kind == "face":
        return np.repeat(np.asarray(mesh.visual.face_colors, np.uint8)[:, None, :3], 3, axis=1)
    return None


def _multiplied(colors: np.ndarray, paint: Paint, header: GltfHeader | None) -> np.ndarray:
    """[v, 3] uint8 sRGB: colours at vertices, as the file stores them, times the material's."""
    unit = colors[:, :3] / (np.iinfo(colors.dtype).max if np.issubdtype(colors.dtype, np.integer) else 1.0)
    linear = unit if header is not None and header.color_is_linear else to_linear(unit)
    return _bytes(to_srgb(linear * to_linear(paint.color)))


def _simple_paint(material: Any) -> Paint:
    """A material of a format other than glTF, whose colours are sRGB. The factor beside a texture is left out, as viewers do."""
    image = getattr(material, "image", None)
    if image is None:
        image = getattr(material, "baseColorTexture", None)
    color = to_linear(np.asarray(material.main_color[:3], np.float64) / 255)
    glow = np.array([float(x) for x in getattr(material, "kwargs", {}).get("ke", (0, 0, 0))])
    color, emission = _glow(color, to_linear(glow))
    return Paint(str(material.name), color if image is None else np.ones(3), emission, None if image is None else _pixels(image))


def _gltf_paint(visual: Any, header: GltfHeader, path: Path) -> Paint:
    """A material of a glTF file: trimesh holds its pixels, the header the rest."""
    entry = material(header, int(visual.name), path)
    if entry.textured and visual.baseColorTexture is None:
        raise MeshError(f"{path}: the texture of {entry.name!r} cannot be decoded: export it as PNG, JPEG or WebP")
    if not entry.textured:
        color, emission = _glow(entry.color, entry.emissive * _mean(visual.emissiveTexture))
        return Paint(entry.name, color, emission)
    image = _pixels(visual.baseColorTexture)
    shown = entry.emissive * (1.0 if visual.emissiveTexture is None else _mean(visual.emissiveTexture) / _floor(_mean(image)))
    _, emission = _glow(entry.color, shown)
    return Paint(entry.name, to_srgb(entry.color), emission, _tinted(image, entry.color), entry.repeats)


def _glow(color: np.ndarray, emissive: np.ndarray) -> tuple[np.ndarray, float]:
    """A base colour (sRGB) and how many times it is emitted; what glows in another colour than black takes that colour."""
    glow, base = float(emissive @ LUMINANCE), float(color @ LUMINANCE)
    if glow <= 0 or base > _DARK:
        return to_srgb(color), glow / max(base, _DARK)
    return to_srgb(emissive / emissive.max()), float(emissive.max())


def _mean(image: Any) -> float:
    """Mean linear luminance of an image; 1 where there is none."""
    if image is None:
        return 1.0
    pixels = image if isinstance(image, np.ndarray) else _pixels(image)
    return float((to_linear(pixels / np.float32(255)) @ LUMINANCE).mean())


def _floor(luminance: float) -> float:
    return max(luminance, _DARK)


def _tinted(image: np.ndarray, factor: np.ndarray) -> np.ndarray:
    """An image times a factor in linear light; the image itself for white."""
    return image if (factor == 1).all() else _bytes(to_srgb(to_linear(image / 255) * factor))


def _pixels(image: Image.Image) -> np.ndarray:
    """[h, w, 3] uint8 sRGB of any image; its opacity is left out."""
    return np.asarray(image.convert("RGB"))


def _bytes(color: np.ndarray) -> np.ndarray:
    return np.round(np.clip(color, 0, 1) * 255).astype(np.uint8)
