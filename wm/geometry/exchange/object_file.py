"""Objects of a user's own or of a reconstruction model, read from mesh files.

All meshes of a file become one object: equal positions one vertex, every material a slot, all textures one image. Colours that
are given at vertices or faces become slots where they are few, and else a texture (`vertex_color`).
"""

import dataclasses
import os
from pathlib import Path

import numpy as np
from jaxtyping import Bool, Float, Int

from wm.geometry.exchange.mesh_error import MeshError
from wm.geometry.exchange.parts import MeshPart, Paint, read_parts
from wm.geometry.exchange.vertex_color import blended, face_colors
from wm.geometry.mesh.object_colors import texture_colors
from wm.geometry.placement.support import support_of
from wm.geometry.texture.image_sheet import image_sheet, sheet_uv
from wm.types import SceneObject, Texture

_TO_Z_UP = {
    "y": np.array([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]]),
    "z": np.eye(3),
}
_SMALLEST, _LARGEST = 0.005, 50.0
"""Metres of an object's largest extent beyond which its unit is taken to be another than the caller says."""
_MOST_PIXELS = 1 << 26
"""Pixels up to which a texture that repeats across a face is written out as often as it repeats."""
_EXACT = 1e-5
"""Share of a texture by which coordinates may leave it through rounding."""


def load_object(
    path: str | os.PathLike[str],
    *,
    label: str,
    room: int,
    up: str | None = None,
    unit: float = 1.0,
    support: str | None = None,
) -> SceneObject:
    """The object that a mesh file holds: GLB, glTF, OBJ, PLY, STL and whatever else trimesh reads.

    Args:
      path: the file; its format goes by the ending.
      label: what a person would call the object.
      room: index into FloorPlan.rooms.
      up: the file's axis that points up, "y" or "z"; without it y for GLB and glTF, which say so, and z for all others, which say
        nothing. With y up the file's front, +z in glTF, comes to look along -y, as furniture does here.
      unit: metres per unit of the file; 0.001 where it is in millimetres.
      support: what it rests on (`SceneObject.support`); without it, told by the label and the size.

    Returns:
      The object at the place where the file has it. Its frame is level, at the middle of the foot of its bounding box. A closed
      surface whose winding points inward is turned inside out.

    Raises:
      MeshError: the file is not there or cannot be read, holds no triangles or none with an area, has vertices that are not
        finite, an extent that no object has, or textures in a form that is not read.
    """
    file = Path(path)
    parts = _checked_parts(file, label, up, unit)
    corners = np.concatenate([part.corners for part in parts]) @ _TO_Z_UP[up or _up_of(file)].T * unit
    _check_extent(corners, file)
    colors = [_colored(part, file) for part in parts]
    vertices, index = np.unique(corners.reshape(-1, 3) + 0.0, axis=0, return_inverse=True)  # + 0.0: no negative zeros
    faces = index.reshape(-1, 3).astype(np.int32)
    paints, face_slot, textured = _slots(colors)
    texture = _texture(colors, textured)
    if _is_inward(vertices, faces):
        faces = faces[:, ::-1].copy()
        texture = texture and dataclasses.replace(texture, corner_uv=texture.corner_uv[:, ::-1].copy())
    slot_colors = np.array([paint.color for paint in paints], np.float32)
    if texture is not None:
        slot_colors[textured] = _mean_colors(texture, face_slot)[textured]
    low, high = vertices.min(axis=0), vertices.max(axis=0)
    T_world_object = np.eye(4)
    T_world_object[:3, 3] = [*(low + high)[:2] / 2, low[2]]
    return SceneObject(
        label=label,
        room=room,
        support=support or support_of(label, (high - low).tolist()),
        vertices=vertices,
        faces=faces,
        face_slot=face_slot,
        slots=tuple(paint.name for paint in paints),
        slot_colors=slot_colors,
        T_world_object=T_world_object,
        size=high - low,
        emission=np.array([paint.emission for paint in paints], np.float32),
        texture=texture,
    )


def _up_of(path: Path) -> str:
    return "y" if path.suffix.lower() in (".glb", ".gltf") else "z"


def _checked_parts(path: Path, label: str, up: str | None, unit: float) -> list[MeshPart]:
    """The parts of a file, its arguments and its coordinates in order."""
    if up not in (None, "y", "z"):
        raise MeshError(f"up is {up!r}; it must be 'y' or 'z', the axis of {path} that points up")
    if not (np.isfinite(unit) and unit > 0):
        raise MeshError(f"unit is {unit}; it must be the metres, above 0, per unit of {path}")
    if not label.strip():
        raise MeshError(f"{path} needs a label: what a person would call the object, such as 'armchair'")
    if not path.is_file():
        raise MeshError(f"there is no file {path}")
    parts = read_parts(path)
    if not parts:
        raise MeshError(f"{path} holds no triangles; points and lines are no surface")
    if not all(np.isfinite(part.corners).all() for part in parts):
        raise MeshError(f"{path} has a vertex that is not finite")
    return parts


def _check_extent(corners: Float[np.ndarray, "f 3 3"], path: Path) -> None:
    """Refuses surfaces without area, and extents that tell of another unit."""
    crosses = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    if not np.abs(crosses).max() > 0:
        raise MeshError(f"{path}: none of its {len(corners)} triangles has an area")
    extent = float(np.ptp(corners.reshape(-1, 3), axis=0).max())
    if not _SMALLEST <= extent <= _LARGEST:
        raise MeshError(
            f"{path} is {extent:.4g} m across; an object measures {_SMALLEST:g} to {_LARGEST:g} m: "
            "give `unit`, the metres per unit of the file (0.001 for millimetres)"
        )


@dataclasses.dataclass(frozen=True, eq=False)
class _Colored:
    """The slots of a part, and the texture of its faces if it has one."""

    paints: tuple[Paint, ...]
    face_paint: np.ndarray  # [f] index into paints
    image: np.ndarray | None = None  # [h, w, 3] uint8
    corner_uv: np.ndarray | None = None  # [f, 3, 2] in [0, 1]


def _colored(part: MeshPart, path: Path) -> _Colored:
    alone = np.zeros(len(part.corners), np.int64)
    if part.corner_colors is not None:
        flat = face_colors(part.corner_colors)
        if flat is None:
            return _Colored((part.paint,), alone, *blended(part.corner_colors))
        names = [part.paint.name] if len(flat[0]) == 1 else [f"{part.paint.name} {k}" for k in range(len(flat[0]))]
        shades = [dataclasses.replace(part.paint, name=name, color=color / 255) for name, color in zip(names, flat[0])]
        return _Colored(tuple(shades), flat[1])
    if part.corner_uv is None or part.paint.image is None:
        return _Colored((part.paint,), alone)
    image, corner_uv = _unrolled(part.paint, part.corner_uv, path)
    return _Colored((part.paint,), alone, image, corner_uv)


def _unrolled(paint: Paint, uv: np.ndarray, path: Path) -> tuple[np.ndarray, np.ndarray]:
    """A texture and coordinates that stay in it: faces are moved by whole repeats, and what one face repeats is written out."""
    image = paint.image
    assert image is not None
    outside = np.any((uv < -_EXACT) | (uv > 1 + _EXACT), axis=(1, 2))
    if outside.any() and not paint.repeats:
        raise MeshError(f"{path}: {paint.name!r} has texture coordinates outside [0, 1] and a texture that does not repeat")
    uv = np.where(outside[:, None, None], uv - np.floor(uv.min(axis=1, keepdims=True) + _EXACT), uv)
    across, down = (max(1, int(np.ceil(most - _EXACT))) for most in uv.max(axis=(0, 1)))
    if across * down > 1 and across * down * image.shape[0] * image.shape[1] > _MOST_PIXELS:
        raise MeshError(
            f"{path}: the texture of {paint.name!r} repeats {across} x {down} times across one triangle, too often to be written "
            "out: cut its faces where the texture repeats, or bake it"
        )
    return np.tile(image, (down, across, 1)), np.clip(uv / np.array([across, down]), 0, 1)


def _texture(colors: list[_Colored], slots: Bool[np.ndarray, "s"]) -> Texture | None:
    """All textures in one image; equal ones once."""
    images = {_key(one.image): one.image for one in colors if one.image is not None}
    if not images:
        return None
    image, corner = image_sheet(list(images.values()))
    place = dict(zip(images, corner))
    uv = [np.zeros((len(one.face_paint), 3, 2)) for one in colors]
    for k, one in enumerate(colors):
        if one.image is not None and one.corner_uv is not None:
            uv[k] = sheet_uv(one.corner_uv, one.image, place[_key(one.image)], image.shape)
    return Texture(image=image, corner_uv=np.concatenate(uv).astype(np.float32), slots=slots)


def _key(image: np.ndarray | None) -> tuple[tuple[int, ...], bytes] | None:
    return None if image is None else (image.shape, image.tobytes())


def _is_inward(vertices: Float[np.ndarray, "v 3"], faces: Int[np.ndarray, "f 3"]) -> bool:
    """Whether a surface is closed and winds inward: its signed volume is negative."""
    import trimesh

    mesh = trimesh.Trimesh(vertices - vertices.mean(axis=0), faces, process=False)
    return bool(mesh.is_watertight and mesh.is_winding_consistent and mesh.volume < 0)


def _slots(colors: list[_Colored]) -> tuple[list[Paint], Int[np.ndarray, "f"], Bool[np.ndarray, "s"]]:
    """A slot for each material, the slot of each face, and which slots have a texture; parts of one material share it."""
    found: dict[tuple[str, bytes, float, bool], int] = {}
    paints: list[Paint] = []
    face_slot = []
    for one in colors:
        index = []
        for paint in one.paints:
            key = paint.name, np.asarray(paint.color, np.float32).tobytes(), paint.emission, one.image is not None
            if key not in found:
                found[key] = len(found)
                paints.append(paint)
            index.append(found[key])
        face_slot.append(np.array(index)[one.face_paint])
    return paints, np.concatenate(face_slot).astype(np.int32), np.array([key[-1] for key in found])


def _mean_colors(texture: Texture, face_slot: Int[np.ndarray, "f"]) -> Float[np.ndarray, "s 3"]:
    """The mean colour of each slot's faces in a texture, one point a face."""
    middle = np.full((len(face_slot), 2), 1 / 3)
    rgb = texture_colors(texture, np.arange(len(face_slot)), middle)
    total = np.zeros((len(texture.slots), 3))
    np.add.at(total, face_slot, rgb)
    count = np.bincount(face_slot, minlength=len(total))
    return (total / np.maximum(count, 1)[:, None]).astype(np.float32)
