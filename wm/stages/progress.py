"""The progress of a stage on standard error: a bar on a terminal, plain lines elsewhere, nothing where there is nothing to do."""

import sys
import time
from types import TracebackType
from typing import Protocol, runtime_checkable

from tqdm import tqdm

from wm import console

LINE_SECONDS = 30.0
"""Least time between two lines of one stage."""


@runtime_checkable
class Progress(Protocol):
    """What a stage tells of its progress; to be used in a `with`."""

    n: float | int  # how much is done

    def __enter__(self) -> "Progress": ...

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None, /) -> None: ...

    def update(self, n: float | int = 1) -> object:
        """So much more is done."""
        ...

    def set_postfix_str(self, s: str = "", refresh: bool = True) -> None:
        """What is at work."""
        ...


def progress(name: str, total: int) -> Progress:
    """The progress of a stage that has `total` things to do."""
    if console.on_terminal():
        return tqdm(total=total, desc=f"{name:>11}", dynamic_ncols=True, file=sys.stderr, mininterval=0.5, disable=total == 0)
    return ProgressLines(name, total)


class ProgressLines:
    """Progress as lines for a file or a pipe: one every LINE_SECONDS, and one at the end."""

    def __init__(self, name: str, total: int):
        self.n: float | int = 0
        self._name, self._total = name, total
        self._began = self._said = time.monotonic()

    def __enter__(self) -> "ProgressLines":
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None) -> None:
        if self._total:
            self._tell()

    def update(self, n: float | int = 1) -> object:
        self.n += n
        if self.n < self._total and time.monotonic() - self._said > LINE_SECONDS:
            self._tell()
        return None

    def set_postfix_str(self, s: str = "", refresh: bool = True) -> None:
        """A line has no room for what is at work."""

    def _tell(self) -> None:
        self._said = time.monotonic()
        console.warn(f"{self._name}: {self.n:g} of {self._total} after {self._said - self._began:.0f} s")
