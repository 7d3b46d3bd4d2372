"""The container of a GLB file: its JSON document, its one binary chunk, and the arrays (accessors) in it.

Source: Khronos, glTF 2.0 specification, sections 3.6 (accessors) and 4 (GLB).
"""

import dataclasses
import json
import struct
from typing import Any

import numpy as np

from wm.splat.formats.errors import SplatFileError

_TYPES = {5120: "i1", 5121: "u1", 5122: "<i2", 5123: "<u2", 5125: "<u4", 5126: "<f4"}
_WIDTH = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}
_VERTICES, _FLOAT = 34962, 5126


@dataclasses.dataclass(frozen=True, eq=False)
class GlbFile:
    """What a GLB file holds. `name` is the file's, for messages."""

    name: str
    document: dict[str, Any]
    binary: bytes


def parse_glb(name: str, raw: bytes) -> GlbFile:
    """Takes the bytes of a GLB file apart.

    Raises:
        SplatFileError: they are none, or are cut short.
    """
    if len(raw) < 20 or raw[:4] != b"glTF":
        raise SplatFileError(f"{name}: no GLB header; a binary glTF 2.0 file would be right")
    version, length = struct.unpack_from("<II", raw, 4)
    if version != 2:
        raise SplatFileError(f"{name}: glTF version {version}; 2 would be right")
    if len(raw) < length:
        raise SplatFileError(f"{name}: truncated: {length} bytes would be right, the file has {len(raw)}")
    chunks: dict[bytes, bytes] = {}
    at = 12
    while at + 8 <= length:
        size, kind = struct.unpack_from("<I4s", raw, at)
        chunks.setdefault(kind, raw[at + 8 : at + 8 + size])
        at += 8 + size
    try:
        document = json.loads(chunks.get(b"JSON", b""))
    except ValueError as error:
        raise SplatFileError(f"{name}: its JSON chunk cannot be read ({error}); a GLB file begins with one") from None
    if not isinstance(document, dict):
        raise SplatFileError(f"{name}: its JSON chunk is no object; that of a GLB file is one")
    return GlbFile(name, document, chunks.get(b"BIN\0", b""))


def glb_bytes(glb: GlbFile) -> bytes:
    """The bytes of a GLB file; equal files give equal bytes. The length of the buffer is set to that of the binary chunk."""
    binary = glb.binary + b"\0" * (-len(glb.binary) % 4)
    document = glb.document | {"buffers": [{"byteLength": len(binary)}]}
    text = json.dumps(document, separators=(",", ":"), allow_nan=False).encode()
    text += b" " * (-len(text) % 4)
    chunks = struct.pack("<I4s", len(text), b"JSON") + text + struct.pack("<I4s", len(binary), b"BIN\0") + binary
    return struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks


def accessor(glb: GlbFile, index: int, *, width: int) -> np.ndarray:
    """The rows [n, width] of an accessor as float32; normalised integers as the shares they stand for.

    Raises:
        SplatFileError: it is not there, of another width, sparse or outside the binary chunk.
    """
    where = f"{glb.name}, accessor {index}"
    try:
        told = glb.document["accessors"][index]
        kind, count, columns = np.dtype(_TYPES[told["componentType"]]), int(told["count"]), _WIDTH[told["type"]]
        view = glb.document["bufferViews"][told["bufferView"]]
        outside = view.get("buffer", 0) != 0 or "uri" in glb.document["buffers"][0]
    except (KeyError, IndexError, TypeError, ValueError):
        raise SplatFileError(
            f"{where}: not there, or without numbers of its own; a plain accessor of floats would be right"
        ) from None
    if columns != width or "sparse" in told or outside:
        raise SplatFileError(
            f"{where}: {told['type']}, sparse or in another file; {width} numbers a row in this file would be right"
        )
    start = view.get("byteOffset", 0) + told.get("byteOffset", 0)
    stride = view.get("byteStride", columns * kind.itemsize)
    end = start + (stride * (count - 1) + columns * kind.itemsize if count else 0)
    if min(start, count) < 0 or stride < columns * kind.itemsize or end > len(glb.binary):
        raise SplatFileError(
            f"{where}: {end} bytes would be right, the binary chunk has {len(glb.binary)} (is the file truncated?)"
        )
    rows = np.ndarray((count, columns), kind, glb.binary, start, (stride, kind.itemsize)).astype(np.float32)
    if not told.get("normalized"):
        return rows
    return np.maximum(rows / np.iinfo(kind).max, -1).astype(np.float32)


def with_arrays(glb: GlbFile, arrays: list[np.ndarray], *, bounded: int) -> tuple[GlbFile, list[int]]:
    """The file with arrays of rows appended as float32 accessors, and their indices; that at `bounded` says its least and largest
    values, as the specification asks of positions."""
    document = dict(glb.document)
    views, accessors = list(document.get("bufferViews", [])), list(document.get("accessors", []))
    binary = bytearray(glb.binary)
    indices = []
    for k, array in enumerate(arrays):
        rows = np.ascontiguousarray(array, "<f4")
        binary.extend(b"\0" * (-len(binary) % 4))
        views.append({"buffer": 0, "byteOffset": len(binary), "byteLength": rows.nbytes, "target": _VERTICES})
        shape = "SCALAR" if rows.ndim == 1 else f"VEC{rows.shape[1]}"
        entry: dict[str, Any] = {"bufferView": len(views) - 1, "componentType": _FLOAT, "count": len(rows), "type": shape}
        if k == bounded:
            entry |= {"min": rows.min(axis=0).astype(float).tolist(), "max": rows.max(axis=0).astype(float).tolist()}
        binary.extend(rows.tobytes())
        indices.append(len(accessors))
        accessors.append(entry)
    return GlbFile(glb.name, document | {"bufferViews": views, "accessors": accessors}, bytes(binary)), indices
