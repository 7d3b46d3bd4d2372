"""Gaussians from PLY files of any program."""

from pathlib import Path
from typing import Literal

from wm.splat.ply.body import Table, read_tables
from wm.splat.ply.compressed import PACKED, unpacked
from wm.splat.ply.dialects import Columns, to_gaussians
from wm.splat.ply.errors import PlyError
from wm.splat.ply.header import Element, Header, Property, parse_header, read_header
from wm.types import Gaussians

RenderMode = Literal["default", "mip", "2dgs"]
"""How a file's gaussians were trained: plain, with opacity compensated for the blur (`RasterSettings.antialias`), or as discs."""


def load_ply(path: str | Path) -> Gaussians:
    """Read gaussians (NumPy float32 leaves) from a PLY file, ours or any other program's.

    The layouts of INRIA, 2DGS, nerfstudio's red-green-blue export and PlayCanvas's compressed PLY are read, and point clouds with
    colours as gaussians that a trainer would start from; binary of either byte order or ASCII; properties in any order and of any
    scalar type; other elements and properties are ignored. What is read can be rendered. `splat_render_mode` says whether
    `RasterSettings(antialias=True)` is meant.

    Raises:
        PlyError: the file is no PLY, is shorter than its header says, or holds no gaussians; the message names the place and what
            would be right.
    """
    path = Path(path)
    raw = path.read_bytes()
    header = parse_header(str(path), raw)
    tables = read_tables(str(path), raw, header, _wanted(str(path), header))
    if "chunk" in tables:
        return to_gaussians(str(path), unpacked(str(path), tables))
    return to_gaussians(str(path), _columns(_element(header, "vertex"), tables["vertex"]))


def splat_render_mode(path: str | Path) -> RenderMode:
    """How the gaussians of a file are meant to be rendered, "default" if the file does not say.

    "mip" is `RasterSettings(antialias=True)`. Brush's comment `SplatRenderMode: mip` and Postshot's `antialiased 1` are read, the
    last of them counts; a file of discs without the third scale is "2dgs" whatever it says.

    Raises:
        PlyError: the file has no header of a PLY file.
    """
    header = read_header(path)
    vertex = _element(header, "vertex")
    names = {p.name for p in vertex.properties} if vertex else set()
    if {"scale_0", "scale_1", "rot_0", "opacity"} <= names and "scale_2" not in names:
        return "2dgs"
    mode: RenderMode = "default"
    for comment in header.comments:
        match comment.lower().replace(":", " ").split():
            case ["splatrendermode", "mip"] | ["antialiased", "1"]:
                mode = "mip"
            case ["splatrendermode", "2dgs"]:
                mode = "2dgs"
            case ["splatrendermode", _] | ["antialiased", _]:
                mode = "default"
    return mode


def _wanted(file: str, header: Header) -> tuple[str, ...]:
    """Names of the elements that hold gaussians."""
    vertex = _element(header, "vertex")
    if vertex is None:
        names = ", ".join(element.name for element in header.elements) or "none"
        raise PlyError(f"{file}: no element vertex among the elements ({names}); one with the gaussians would be right")
    lists = [p.name for p in vertex.properties if p.length_type]
    if lists:
        raise PlyError(f"{file}: element vertex has the list {lists[0]}: not a file of gaussians")
    packed = any(p.name in PACKED for p in vertex.properties)
    if packed and _element(header, "chunk") is None:
        raise PlyError(f"{file}: packed vertices without an element chunk; a compressed PLY has one")
    return ("chunk", "vertex", "sh") if packed else ("vertex",)


def _element(header: Header, name: str) -> Element | None:
    return next((element for element in header.elements if element.name == name), None)


def _columns(element: Element | None, table: Table) -> Columns:
    """By name, in the types that the header gives them; ASCII was read as float64."""
    properties: tuple[Property, ...] = element.properties if element else ()
    whole = {p.name: p.type for p in properties if not p.type.startswith("f")}
    return {name: table[name].astype(whole[name]) if name in whole else table[name] for name in table.dtype.names or ()}
