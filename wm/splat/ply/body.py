"""The rows of a PLY file's elements, as structured arrays: binary of either byte order, or ASCII."""

from collections.abc import Collection

import numpy as np

from wm.splat.ply.errors import PlyError
from wm.splat.ply.header import FORMATS, Element, Header

Table = np.ndarray
"""A structured array: a row an entry, a field a property. Lists are left out."""


def read_tables(file: str, raw: bytes, header: Header, wanted: Collection[str]) -> dict[str, Table]:
    """The elements of the wanted names. Elements before them are skipped by their sizes, those after the last are not looked at.

    Raises:
        PlyError: the file is shorter than its header says, or ASCII holds something that is no number.
    """
    last = max((k for k, element in enumerate(header.elements) if element.name in wanted), default=-1)
    reader = _Text(file, raw, header.start) if header.format == "ascii" else _Binary(file, raw, header)
    tables = {element.name: reader.table(element) for element in header.elements[: last + 1]}
    return {name: table for name, table in tables.items() if name in wanted}


def _scalars(element: Element, order: str) -> np.dtype:
    return np.dtype([(p.name, order + p.type) for p in element.properties if p.length_type is None])


def _wrong_length(file: str, element: Element, row: int, name: str, length: float) -> str:
    return f"{file}: {element.name} row {row}: list {name} of length {length}; 0 or more would be right"


class _Binary:
    """Reads element after element of a binary file."""

    def __init__(self, file: str, raw: bytes, header: Header) -> None:
        self.file, self.raw, self.at, self.order = file, raw, header.start, FORMATS[header.format]

    def table(self, element: Element) -> Table:
        dtype = _scalars(element, self.order)
        if not element.properties:
            return np.zeros(0, dtype)  # rows of no bytes, of which a header may claim any number
        if any(p.length_type for p in element.properties):
            return self._row_by_row(element, dtype)
        start = self._take(element, element.count * dtype.itemsize, element.count)
        return np.frombuffer(self.raw, dtype, element.count, start)

    def _row_by_row(self, element: Element, dtype: np.dtype) -> Table:
        rows = []
        for k in range(element.count):
            row = []
            for p in element.properties:
                kind = np.dtype(self.order + p.type)
                if p.length_type is None:
                    row.append(self._scalar(element, kind, k))
                else:
                    length = int(self._scalar(element, np.dtype(self.order + p.length_type), k))
                    if length < 0:
                        raise PlyError(_wrong_length(self.file, element, k, p.name, length))
                    self._take(element, length * kind.itemsize, k)
            rows.append(tuple(row))
        return np.array(rows, dtype) if dtype.names else np.zeros(element.count, dtype)

    def _scalar(self, element: Element, kind: np.dtype, row: int):
        return np.frombuffer(self.raw, kind, 1, self._take(element, kind.itemsize, row))[0]

    def _take(self, element: Element, size: int, row: int) -> int:
        """The offset of the next `size` bytes, which are then behind the reader."""
        start = self.at
        if len(self.raw) < start + size:
            raise PlyError(
                f"{self.file}: truncated in {element.name}, of which the header says {element.count} (row {row}): "
                f"{start + size} bytes would be right, the file has {len(self.raw)}"
            )
        self.at = start + size
        return start


class _Text:
    """Reads element after element of an ASCII file, whose numbers are separated by white space."""

    def __init__(self, file: str, raw: bytes, start: int) -> None:
        self.file, self.words, self.at = file, raw[start:].split(), 0

    def table(self, element: Element) -> Table:
        dtype = np.dtype([(name, "f8") for name in _scalars(element, "").names or ()])
        if not element.properties:
            return np.zeros(0, dtype)
        if any(p.length_type for p in element.properties):
            rows = [self._row(element, k) for k in range(element.count)]
            return np.array(rows, dtype) if dtype.names else np.zeros(element.count, dtype)
        width = len(element.properties)
        values = self._numbers(element, self._take(element, element.count * width, element.count))
        return np.ascontiguousarray(values.reshape(-1, width)).view(dtype)[:, 0]

    def _row(self, element: Element, k: int) -> tuple:
        row = []
        for p in element.properties:
            value = self._numbers(element, self._take(element, 1, k))[0]
            if p.length_type is None:
                row.append(value)
            elif value >= 0 and value == np.floor(value):
                self._take(element, int(value), k)
            else:
                raise PlyError(_wrong_length(self.file, element, k, p.name, value))
        return tuple(row)

    def _numbers(self, element: Element, words: list[bytes]) -> np.ndarray:
        try:
            return np.array(list(map(float, words)), np.float64)
        except ValueError as error:
            raise PlyError(f"{self.file}: {element.name}: {error}; ASCII numbers would be right") from None

    def _take(self, element: Element, size: int, row: int) -> list[bytes]:
        words = self.words[self.at : self.at + size]
        if len(words) < size:
            raise PlyError(
                f"{self.file}: truncated in {element.name}, of which the header says {element.count} (row {row}): "
                f"{self.at + size} numbers would be right, the file has {len(self.words)}"
            )
        self.at += size
        return words
