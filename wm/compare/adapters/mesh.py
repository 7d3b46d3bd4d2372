"""Any textured mesh: GLB, glTF, OBJ, PLY, with or without cameras; y is up in glTF, z elsewhere, unless `METHOD.up` says."""

import pathlib

from wm.compare.adapters.files import check_some, one_file, reading
from wm.compare.adapters.own_cameras import own_cameras
from wm.compare.painted_mesh import read_painted_mesh
from wm.compare.records import ComparedScene, Source, System

SUFFIXES = (".glb", ".gltf", ".obj", ".ply")
SYSTEM = System(
    name="any mesh",
    file=", ".join(SUFFIXES),
    up="METHOD.up, else by its cameras, else +y in glTF and +z elsewhere",
    scale="not known",
    colors="base colours: textures, vertices, materials",
    activations="none",
    antialias=False,
    source="docs/comparison.md",
    commit="",
    options=("up", "cameras"),
)
_EXPECTED = f"a mesh ({', '.join(SUFFIXES)})"


def files(source: Source) -> list[pathlib.Path]:
    """The files whose content decides what is drawn. Raises: CompareError."""
    file = one_file(source, _EXPECTED, *(f"*{suffix}" for suffix in SUFFIXES))
    cameras = own_cameras(source, file).file
    beside = [path for path in sorted(file.parent.iterdir()) if path.suffix.lower() in _BESIDE]
    return [file, *([] if cameras is None else [cameras]), *(beside if file.suffix.lower() in (".gltf", ".obj") else [])]


_BESIDE = (".mtl", ".bin", ".png", ".jpg", ".jpeg", ".webp")
"""Files that a mesh of several files may refer to."""


def read(source: Source) -> ComparedScene:
    """The scene. Raises: CompareError."""
    file = files(source)[0]
    mesh = reading(source, file, _EXPECTED, read_painted_mesh)
    check_some(source, file, len(mesh.vertices), _EXPECTED)
    own = own_cameras(source, file, up="y" if file.suffix.lower() in (".glb", ".gltf") else "z")
    return ComparedScene(method=source.method, mesh=mesh, R_world_file=own.R_world_file, cameras=own.cameras)
