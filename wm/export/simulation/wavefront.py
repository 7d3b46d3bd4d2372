"""Meshes as OBJ files with one image each, and as binary STL files: what MuJoCo and every reader of URDF load.

The image of an object is its texture and below it a palette, a square of pixels for each material without one; so one mesh and
one image show all of it. Faces that glow are a mesh of their own beside it. Every triangle has its own normal: shading is flat,
as in the scaffold's GLB.
"""

import dataclasses
import io

import numpy as np
from jaxtyping import Float
from PIL import Image

from wm.export.simulation.hulls import Hull
from wm.export.simulation.looks import Appearance

_SQUARE = 8  # pixels of a colour's square: its middle stays its own under filtering


@dataclasses.dataclass(frozen=True, eq=False)
class ObjMesh:
    """One mesh of a look."""

    obj: str
    glow: float  # how strongly it glows
    unlit: bool


@dataclasses.dataclass(frozen=True, eq=False)
class ObjFiles:
    """The meshes of a look and the image [h, w, 3] uint8 that they share."""

    meshes: tuple[ObjMesh, ...]
    image: np.ndarray


def obj_files(look: Appearance, material: str) -> ObjFiles:
    """A look as OBJ text; `material` is the name of the material file without its ending, and of the material in it."""
    image, corner_uv = _sheet(look)
    glow = look.emission[look.face_slot]
    meshes = []
    for shine in (False, True):
        mine = (glow > 0) == shine
        if mine.any():
            text = _obj(look.vertices[look.faces[mine]], corner_uv[mine], material)
            meshes.append(ObjMesh(text, float(glow[mine].max()) if shine else 0.0, look.unlit))
    return ObjFiles(tuple(meshes), image)


def mtl(material: str, image: str) -> str:
    """The material file of an OBJ: dull, in the colours of an image."""
    return f"newmtl {material}\nKa 1 1 1\nKd 1 1 1\nKs 0 0 0\nillum 1\nmap_Kd {image}\n"


def png(image: np.ndarray) -> bytes:
    """A lossless PNG of [h, w, 3] uint8."""
    data = io.BytesIO()
    Image.fromarray(np.ascontiguousarray(image)).save(data, format="PNG", compress_level=6)
    return data.getvalue()


def stl(hull: Hull) -> bytes:
    """A hull as binary STL."""
    corners = hull.vertices[hull.faces]
    rows = np.zeros(len(corners), np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("unused", "<u2")]))
    rows["normal"], rows["corners"] = _normals(corners), corners
    return b"\0" * 80 + np.uint32(len(rows)).astype("<u4").tobytes() + rows.tobytes()


def _sheet(look: Appearance) -> tuple[np.ndarray, Float[np.ndarray, "f 3 2"]]:
    """The image of a look, and where in it the corners of its faces are; (0, 0) is the first pixel's corner, v runs down."""
    plain = ~look.texture.slots if look.texture is not None else np.ones(len(look.slots), bool)
    if look.texture is not None and not plain[look.face_slot].any():
        return look.texture.image, look.texture.corner_uv.astype(np.float64)
    image, center = _palette(look, 0 if look.texture is None else look.texture.image.shape[1])
    if look.texture is None:
        size = np.array([image.shape[1], image.shape[0]])
        return image, np.repeat((center / size)[look.face_slot][:, None], 3, axis=1)
    above = look.texture.image
    sheet = np.zeros((above.shape[0] + image.shape[0], max(above.shape[1], image.shape[1]), 3), np.uint8)
    sheet[: above.shape[0], : above.shape[1]], sheet[above.shape[0] :, : image.shape[1]] = above, image
    size = np.array([sheet.shape[1], sheet.shape[0]])
    in_palette = np.repeat(((center + np.array([0, above.shape[0]])) / size)[look.face_slot][:, None], 3, axis=1)
    in_texture = look.texture.corner_uv * np.array([above.shape[1], above.shape[0]]) / size
    return sheet, np.where(plain[look.face_slot][:, None, None], in_palette, in_texture)


def _palette(look: Appearance, width: int) -> tuple[np.ndarray, Float[np.ndarray, "s 2"]]:
    """Squares of the slots' colours in rows of `width` pixels, or as many as columns; and their middles in pixels."""
    count = len(look.slots)
    columns = max(1, width // _SQUARE) if width else int(np.ceil(np.sqrt(count)))
    row, column = np.divmod(np.arange(count), columns)
    colors = np.zeros((row.max() + 1, columns, 3), np.uint8)
    colors[row, column] = np.round(np.clip(look.slot_colors, 0, 1) * 255)
    image = colors.repeat(_SQUARE, axis=0).repeat(_SQUARE, axis=1)
    return image, (np.stack([column, row], axis=1) + 0.5) * _SQUARE


def _obj(corners: Float[np.ndarray, "f 3 3"], corner_uv: Float[np.ndarray, "f 3 2"], material: str) -> str:
    """The text of a mesh, equal positions, coordinates and normals once; triangles without an area are left out."""
    normals = _normals(corners)
    there = np.abs(normals).max(axis=1) > 0
    corners, corner_uv, normals = corners[there], corner_uv[there], normals[there]
    if len(corners) == 1:  # MuJoCo refuses meshes of three vertices
        corners, corner_uv, normals = _halved(corners), _halved(corner_uv), normals.repeat(2, axis=0)
    upright = np.stack([corner_uv[..., 0], 1.0 - corner_uv[..., 1]], axis=-1)  # OBJ counts v upward
    lines = [f"mtllib {material}.mtl", f"usemtl {material}"]
    index = []
    for keyword, values, digits in (("v", corners.reshape(-1, 3), 6), ("vt", upright.reshape(-1, 2), 6), ("vn", normals, 5)):
        once, place = np.unique(np.round(values, digits) + 0.0, axis=0, return_inverse=True)
        lines += [f"{keyword} " + " ".join(f"{number:.{digits}f}" for number in row) for row in once.tolist()]
        index.append(place.reshape(-1) + 1)
    normal = np.repeat(index[2], 3)
    v, vt, vn = (numbers.reshape(-1, 3).tolist() for numbers in (index[0], index[1], normal))
    lines += ["f " + " ".join(f"{a}/{b}/{c}" for a, b, c in zip(*face)) for face in zip(v, vt, vn)]
    return "\n".join(lines) + "\n"


def _halved(corners: Float[np.ndarray, "1 3 k"]) -> Float[np.ndarray, "2 3 k"]:
    """A triangle cut in two at the middle of its first side."""
    a, b, c = corners[0]
    middle = (a + b) / 2
    return np.array([[a, middle, c], [middle, b, c]])


def _normals(corners: Float[np.ndarray, "f 3 3"]) -> Float[np.ndarray, "f 3"]:
    """Unit normals; 0 of triangles without an area."""
    cross = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    length = np.linalg.norm(cross, axis=1, keepdims=True)
    return cross / np.where(length > 0, length, 1.0)
