"""Finding and reading what an adapter is given, with errors that name the method, the file and what would be right."""

import pathlib
from collections.abc import Callable
from typing import TypeVar

from wm.compare.errors import CompareError
from wm.compare.records import Source

Read = TypeVar("Read")


def one_file(source: Source, expected: str, *patterns: str) -> pathlib.Path:
    """The file that a source names, or the only one of a pattern in the folder that it names, the first pattern first.

    Raises:
        CompareError: nothing is there, or several files fit.
    """
    path = source.path
    if path.is_file():
        return path
    if not path.is_dir():
        raise CompareError(f"{source.method}: {path} is not there; {expected} would be right")
    for pattern in patterns:
        found = sorted(path.rglob(pattern))
        if len(found) == 1:
            return found[0]
        if found:
            names = ", ".join(str(file.relative_to(path)) for file in found[:4])
            raise CompareError(f"{source.method}: {path} holds {len(found)} files that fit ({names}); name one of them")
    raise CompareError(f"{source.method}: {path} holds no {' or '.join(patterns)}; {expected} would be right")


def reading(source: Source, file: pathlib.Path, expected: str, read: Callable[[pathlib.Path], Read]) -> Read:
    """What a reader makes of a file. Raises: CompareError for whatever it refuses."""
    try:
        return read(file)
    except (OSError, ValueError, EOFError, KeyError) as error:
        told = str(error) if str(file) in str(error) else f"{file}: {error}"
        raise CompareError(f"{source.method}: {told}; expected {expected}") from error


def check_some(source: Source, file: pathlib.Path, count: int, expected: str) -> None:
    """Raises: CompareError where a file holds nothing."""
    if count == 0:
        raise CompareError(f"{source.method}: {file}: nothing to draw in it; expected {expected}")
