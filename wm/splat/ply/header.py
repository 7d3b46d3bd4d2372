"""The header of a PLY file: lines of text up to one that is `end_header`, which say what the bytes after it are.

Source: Turk, "The PLY Polygon File Format" (1994).
"""

import dataclasses
import re
from pathlib import Path

from wm.splat.ply.errors import PlyError

TYPES = {
    "char": "i1", "int8": "i1", "uchar": "u1", "uint8": "u1", "short": "i2", "int16": "i2", "ushort": "u2", "uint16": "u2",
    "int": "i4", "int32": "i4", "uint": "u4", "uint32": "u4", "float": "f4", "float32": "f4", "double": "f8", "float64": "f8",
}  # fmt: skip
"""NumPy's code of every scalar type that a header may name."""

FORMATS = {"ascii": "", "binary_little_endian": "<", "binary_big_endian": ">"}
"""NumPy's byte order of the three formats; none for text."""

LONGEST = 1 << 20
"""Bytes within which the header has to end."""

_MOST_DIGITS = 18  # of a count: 64 bits hold every number of so many


@dataclasses.dataclass(frozen=True)
class Property:
    """One value of a row, or a list of values that is preceded by its length."""

    name: str
    type: str  # NumPy's code, without byte order
    length_type: str | None = None  # NumPy's code of the length of a list; None for a single value


@dataclasses.dataclass(frozen=True)
class Element:
    """A table of the file."""

    name: str
    count: int  # rows
    properties: tuple[Property, ...]


@dataclasses.dataclass(frozen=True)
class Header:
    """What a PLY file says about itself."""

    format: str  # a key of FORMATS
    elements: tuple[Element, ...]  # in the order in which they follow
    comments: tuple[str, ...]  # without the word `comment`
    start: int  # offset of the first byte after the header


def read_header(path: str | Path) -> Header:
    """The header of a file, without its rows. Raises: PlyError, OSError."""
    with Path(path).open("rb") as file:
        return parse_header(str(path), file.read(LONGEST))


def parse_header(file: str, raw: bytes) -> Header:
    """The header at the start of the bytes of a file.

    Lines may end in LF, CR LF or CR; what stands before `end_header` on a line of comment does not end the header.

    Args:
        file: its name, for messages.

    Raises:
        PlyError: naming the file, the line and what would be right.
    """
    lines, start = _lines(file, raw)
    formats: list[str] = []
    elements: list[Element] = []
    comments: list[str] = []
    for number, line in enumerate(lines, 2):
        where = f"{file}, header line {number}"
        match line.split():
            case [] | ["obj_info", *_]:
                pass
            case ["comment", *_]:
                comments.append(line.split("comment", 1)[1].strip())
            case ["format", kind, *_]:
                formats.append(_format(where, kind, formats))
            case ["element", name, size]:
                elements.append(_element(where, name, size, elements))
            case ["property", *words]:
                elements[-1:] = [_with_property(where, words, elements)]
            case _:
                raise PlyError(
                    f"{where}: {_short(line)!r} is no line of a PLY header; format, element, property or comment would be right"
                )
    if not formats:
        raise PlyError(f"{file}: the header has no format line; one of {', '.join(FORMATS)} would be right")
    return Header(format=formats[0], elements=tuple(elements), comments=tuple(comments), start=start)


def _lines(file: str, raw: bytes) -> tuple[list[str], int]:
    """The lines between `ply` and `end_header`, and the offset of the byte after them."""
    first = re.match(rb"ply[ \t]*(\r?\n|\r)", raw)
    if first is None:
        raise PlyError(f"{file}: does not start with 'ply' on a line of its own: not a PLY file")
    newline = rb"\r" if first[1] == b"\r" else rb"\r?\n"  # a byte of 10 after a CR alone is the first of the rows
    end = re.compile(rb"[\r\n][ \t]*end_header[ \t]*" + newline).search(raw, 0, LONGEST)
    if end is None:
        raise PlyError(f"{file}: no line that is 'end_header' in the first {LONGEST} bytes; the header would end there")
    text = raw[: end.start() + 1].decode("ascii", "replace")
    return re.split(r"\r\n|\n|\r", text)[1:], end.end()


def _format(where: str, kind: str, before: list[str]) -> str:
    if kind not in FORMATS:
        raise PlyError(f"{where}: unknown format {_short(kind)!r}; one of {', '.join(FORMATS)} would be right")
    if before:
        raise PlyError(f"{where}: a second format; one format line would be right")
    return kind


def _element(where: str, name: str, size: str, before: list[Element]) -> Element:
    if not (size.isascii() and size.isdigit()) or len(size) > _MOST_DIGITS:
        raise PlyError(f"{where}: element {_short(name)} {_short(size)}: not a count; a number from 0 on would be right")
    if any(element.name == name for element in before):
        raise PlyError(f"{where}: element {_short(name)} is declared twice; each once would be right")
    return Element(name=name, count=int(size), properties=())


def _with_property(where: str, words: list[str], elements: list[Element]) -> Element:
    if not elements:
        raise PlyError(f"{where}: a property before any element; an element line above it would be right")
    match words:
        case ["list", length, kind, name]:
            wanted = Property(name=name, type=_type(where, name, kind), length_type=_type(where, name, length))
            if wanted.length_type is not None and wanted.length_type.startswith("f"):
                raise PlyError(f"{where}: list {_short(name)} counts in {length}; a type of whole numbers would be right")
        case [kind, name]:
            wanted = Property(name=name, type=_type(where, name, kind))
        case _:
            raise PlyError(f"{where}: property {_short(' '.join(words))!r}; a type and a name would be right")
    last = elements[-1]
    if any(other.name == name for other in last.properties):
        raise PlyError(f"{where}: property {_short(name)} of {_short(last.name)} is declared twice; each once would be right")
    return dataclasses.replace(last, properties=(*last.properties, wanted))


def _type(where: str, name: str, kind: str) -> str:
    if kind not in TYPES:
        raise PlyError(f"{where}: property {_short(name)} has the unknown type {_short(kind)}; float or double would be right")
    return TYPES[kind]


def _short(text: str) -> str:
    return text if len(text) <= 40 else text[:37] + "..."
