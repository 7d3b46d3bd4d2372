"""Every adapter by name, and which one a path is for where nobody says."""

import pathlib
import types

from wm.artifacts.digests import digest, file_digest
from wm.compare.adapters import (
    dreamscene360,
    flexworld,
    layerpano3d,
    mesh,
    ours,
    spatialgen,
    splats,
    wonderworld,
    worldexplorer,
)
from wm.compare.errors import CompareError
from wm.compare.records import ComparedScene, Source
from wm.splat import PlyError
from wm.splat.ply.header import read_header

ADAPTERS: dict[str, types.ModuleType] = {
    "ours": ours,
    "wonderworld": wonderworld,
    "flexworld": flexworld,
    "layerpano3d": layerpano3d,
    "worldexplorer": worldexplorer,
    "spatialgen": spatialgen,
    "dreamscene360": dreamscene360,
    "splats": splats,
    "mesh": mesh,
}
"""Each has SYSTEM, read(source), and files(source), for which a run of ours has identity(source)."""

VERSION = 1
"""To be raised when an adapter comes to make another scene of the same file."""


def adapter_for(method: str, path: pathlib.Path) -> str:
    """The adapter of a row: the one of its name, or the one that the path tells. Raises: CompareError."""
    if method.lower() in ADAPTERS:
        return method.lower()
    if (path / "manifest.json").is_file():
        return "ours"
    suffix = path.suffix.lower()
    if suffix == ".ply" and _has_faces(path):
        return "mesh"
    if suffix in splats.SUFFIXES:
        return "splats"
    if suffix in mesh.SUFFIXES:
        return "mesh"
    raise CompareError(
        f"{method}: nothing tells how to read {path}; {method}:ADAPTER={path} would, with one of {', '.join(ADAPTERS)}"
    )


def _has_faces(path: pathlib.Path) -> bool:
    """Whether a PLY is a mesh. A file that cannot be read has none: the adapter says what is wrong with it."""
    try:
        header = read_header(path)
    except (OSError, PlyError):
        return False
    return any(element.name == "face" and element.count > 0 for element in header.elements)


def identity_of(source: Source) -> str:
    """A digest of everything that decides what is drawn of a source, without reading the scene. Raises: InputError, OSError."""
    module = ADAPTERS[source.adapter]
    told = (VERSION, source.adapter, source.up, source.antialias)
    if module is ours:
        return digest("compared", *told, ours.identity(source))
    return digest("compared", *told, [file_digest(file) for file in module.files(source)])


def read_scene(source: Source) -> ComparedScene:
    """The scene of a source. Raises: InputError, which names the method and the file."""
    return ADAPTERS[source.adapter].read(source)
