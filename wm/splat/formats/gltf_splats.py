"""Gaussians in glTF: KHR_gaussian_splatting, a primitive of points whose attributes are those of gaussians.

    POSITION                                    the mean
    KHR_gaussian_splatting:ROTATION             the unit quaternion xyzw
    KHR_gaussian_splatting:SCALE                standard deviations, not their logarithms
    KHR_gaussian_splatting:OPACITY              0 to 1
    KHR_gaussian_splatting:SH_DEGREE_l_COEF_n   the coefficients, red green blue
    COLOR_0                                     linear colour and opacity of the points that other viewers show

Drafts of 2025 had logarithms of scales; the extension as it was ratified has the scales, and so have we. Our harmonics have the
signs and order of the extension. glTF is y up: `wm.splat.formats.turning` turns what stands z-up.
Source: Khronos, glTF 2.0, extension KHR_gaussian_splatting (ratified), "Attributes" and its schema.
"""

from pathlib import Path
from typing import Any

import jax
import numpy as np
from jaxtyping import Float

from wm.color import to_linear
from wm.splat.formats.errors import SplatFileError
from wm.splat.formats.glb_file import GlbFile, accessor, glb_bytes, parse_glb, with_arrays
from wm.splat.formats.turning import turned
from wm.splat.ply.standard import packable
from wm.splat.rasterizer.checks import DEGREES
from wm.splat.rasterizer.harmonics import SH_C0
from wm.types import Gaussians

NAME = "KHR_gaussian_splatting"
_SPACES = ("srgb_rec709_display", "BT.709-sRGB")
"""Colour spaces that are ours: sRGB for a display, by its ratified name and by that of drafts."""
_POINTS = 0  # primitive.mode
_COEFFICIENTS = [(degree, k) for degree in range(4) for k in range(2 * degree + 1)]


def save_gltf_splats(path: str | Path, gaussians: Gaussians) -> None:
    """Write gaussians as a GLB file of one node, in their order and axes (glTF's are y up).

    Raises:
        SplatFileError: there are none.
    """
    empty = GlbFile(str(path), {"asset": {"version": "2.0", "generator": "wm"}, "scene": 0, "scenes": [{"nodes": []}]}, b"")
    Path(path).write_bytes(glb_bytes(with_gaussians(empty, gaussians)))


def with_gaussians(
    glb: GlbFile, gaussians: Gaussians, *, node: str = "gaussians", extras: dict[str, Any] | None = None
) -> GlbFile:
    """The file with gaussians as one more node of its first scene.

    Args:
        glb: such as the scaffold's, in whose axes the gaussians must be.
        gaussians: in their order.
        node: its name.
        extras: of the node.

    Raises:
        SplatFileError: there are no gaussians, which glTF cannot hold.
    """
    g = packable(gaussians)
    if not len(g.means):
        raise SplatFileError(f"{glb.name}: there are no gaussians to write; a glTF accessor has at least one row")
    opacity = 1 / (1 + np.exp(-g.opacity_logits.astype(np.float64)))
    color = to_linear(np.clip(0.5 + SH_C0 * g.sh[:, 0], 0, 1))
    arrays = {
        "POSITION": g.means,
        "COLOR_0": np.c_[color, opacity],
        f"{NAME}:ROTATION": np.roll(g.quats, -1, axis=1),
        f"{NAME}:SCALE": np.exp(g.log_scales),
        f"{NAME}:OPACITY": opacity,
    } | {f"{NAME}:SH_DEGREE_{degree}_COEF_{k}": g.sh[:, degree**2 + k] for degree, k in _COEFFICIENTS[: g.sh.shape[1]]}
    glb, indices = with_arrays(glb, list(arrays.values()), bounded=0)
    primitive = {
        "attributes": dict(zip(arrays, indices)),
        "mode": _POINTS,
        "extensions": {NAME: {"kernel": "ellipse", "colorSpace": _SPACES[0]}},
    }
    return _with_node(glb, {"name": node, "primitives": [primitive]}, {"name": node} | ({"extras": extras} if extras else {}))


def read_gltf_splats(file: str, raw: bytes) -> Gaussians:
    """All gaussians (NumPy float32 leaves) of the first scene of a GLB file, where its nodes put them. Opacities are finite.

    Raises:
        SplatFileError: the file holds none, packs them by another extension, or a node stretches them.
    """
    glb = parse_glb(file, raw)
    try:
        found = [_gaussians(glb, primitive, matrix) for primitive, matrix in _primitives(glb)]
    except (KeyError, IndexError, TypeError, ValueError, AttributeError, RecursionError) as error:
        if isinstance(error, SplatFileError):
            raise
        raise SplatFileError(f"{file}: its glTF document is damaged ({type(error).__name__}: {error})") from None
    if not found:
        raise SplatFileError(f"{file}: no primitive with {NAME} in its scene; a GLB file of gaussians has one")
    if len({g.sh.shape[1] for g in found}) > 1:
        raise SplatFileError(f"{file}: primitives with different degrees of harmonics; one degree would be right")
    return jax.tree.map(lambda *leaves: np.concatenate(leaves), *found)


def _with_node(glb: GlbFile, mesh: dict[str, Any], node: dict[str, Any]) -> GlbFile:
    document = dict(glb.document)
    meshes, nodes = (
        [*document.get("meshes", []), mesh],
        [*document.get("nodes", []), node | {"mesh": len(document.get("meshes", []))}],
    )
    first = document.get("scene", 0)
    scenes = [dict(scene) for scene in document["scenes"]]
    scenes[first]["nodes"] = [*scenes[first].get("nodes", []), len(nodes) - 1]
    used = sorted({*document.get("extensionsUsed", []), NAME})
    return GlbFile(glb.name, document | {"meshes": meshes, "nodes": nodes, "scenes": scenes, "extensionsUsed": used}, glb.binary)


def _primitives(glb: GlbFile) -> list[tuple[dict[str, Any], Float[np.ndarray, "4 4"]]]:
    """The primitives of gaussians of the first scene, each with the matrix of its node."""
    document = glb.document
    scenes = document.get("scenes", [])
    nodes = document.get("nodes", [])
    roots = scenes[document.get("scene", 0)].get("nodes", []) if scenes else range(len(nodes))
    waiting = [(index, np.eye(4)) for index in reversed(roots)]
    found, visits = [], 0
    while waiting:
        index, above = waiting.pop()
        visits += 1
        if visits > len(nodes):
            raise SplatFileError(f"{glb.name}: a node is below two others or below itself; a tree would be right")
        node = nodes[index]
        matrix = above @ _matrix(node)
        if "mesh" in node:
            primitives = document["meshes"][node["mesh"]]["primitives"]
            found += [(primitive, matrix) for primitive in primitives if NAME in primitive.get("extensions", {})]
        waiting += [(child, matrix) for child in reversed(node.get("children", []))]
    return found


def _matrix(node: dict[str, Any]) -> Float[np.ndarray, "4 4"]:
    if "matrix" in node:
        return np.array(node["matrix"], np.float64).reshape(4, 4).T
    x, y, z, w = np.array(node.get("rotation", [0, 0, 0, 1]), np.float64)
    matrix = np.eye(4)
    matrix[:3, :3] = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
    ]
    matrix[:3, :3] *= np.array(node.get("scale", [1, 1, 1]), np.float64)
    matrix[:3, 3] = node.get("translation", [0, 0, 0])
    return matrix


def _gaussians(glb: GlbFile, primitive: dict[str, Any], matrix: Float[np.ndarray, "4 4"]) -> Gaussians:
    extension, attributes = primitive["extensions"][NAME], primitive["attributes"]
    packed = sorted(extension.get("extensions", {}))
    if packed:
        raise SplatFileError(f"{glb.name}: its gaussians are packed by {', '.join(packed)}; plain attributes would be right")
    space = extension.get("colorSpace", _SPACES[0])
    if space not in _SPACES:
        raise SplatFileError(f"{glb.name}: colours in {space}; {_SPACES[0]} would be right")
    count = next(k for k in (16, 9, 4, 1) if k == 1 or f"{NAME}:SH_DEGREE_{DEGREES[k]}_COEF_0" in attributes)
    names = [f"{NAME}:SH_DEGREE_{degree}_COEF_{k}" for degree, k in _COEFFICIENTS[:count]]
    wanted = {"POSITION": 3, f"{NAME}:ROTATION": 4, f"{NAME}:SCALE": 3, f"{NAME}:OPACITY": 1} | dict.fromkeys(names, 3)
    missing = [name for name in wanted if name not in attributes]
    if missing:
        raise SplatFileError(f"{glb.name}: gaussians without the attributes {', '.join(missing)}; {NAME} has them")
    rows = {name: accessor(glb, attributes[name], width=width) for name, width in wanted.items()}
    if len({len(row) for row in rows.values()}) > 1:
        raise SplatFileError(f"{glb.name}: attributes of different lengths; one row a gaussian in each would be right")
    opacity = np.clip(rows[f"{NAME}:OPACITY"][:, 0].astype(np.float64), 1e-9, 1 - 1e-9)
    with np.errstate(divide="ignore", invalid="ignore"):
        local = Gaussians(
            means=rows["POSITION"],
            quats=np.roll(rows[f"{NAME}:ROTATION"], 1, axis=1),
            log_scales=np.log(rows[f"{NAME}:SCALE"]),
            opacity_logits=np.log(opacity / (1 - opacity)).astype(np.float32),
            sh=np.stack([rows[name] for name in names], axis=1),
        )
    return packable(local if np.array_equal(matrix, np.eye(4)) else _placed(glb.name, local, matrix))


def _placed(file: str, gaussians: Gaussians, matrix: Float[np.ndarray, "4 4"]) -> Gaussians:
    linear = matrix[:3, :3]
    scale = float(np.cbrt(max(np.linalg.det(linear), 0)))
    if scale <= 0 or np.abs(linear @ linear.T / scale**2 - np.eye(3)).max() > 1e-4:
        raise SplatFileError(f"{file}: a node stretches or mirrors its gaussians; turned, moved and scaled alike would be right")
    return turned(gaussians, linear / scale, scale, matrix[:3, 3])
