"""The private folder in which arrays and files travel between wm and a worker."""

import contextlib
import os
import pathlib
import shutil
import tempfile
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

LOG = "log.txt"
"""What the worker prints."""


class ExchangeFolder:
    """A folder of this user alone. Whoever is last removes it: `remove` here, or the worker once its standard input has ended."""

    def __init__(self) -> None:
        self.path = pathlib.Path(tempfile.mkdtemp(prefix="wm-worker-"))

    def put(self, number: int, arrays: Mapping[str, np.ndarray]) -> str:
        """Writes the arrays of a request, and removes what was here before.

        Returns:
          The name of their file.

        Raises:
          OSError: the disk is full.
        """
        self.empty()
        name = f"{number}.npz"
        named: dict[str, Any] = dict(arrays)
        np.savez(self.path / name, **named)
        return name

    def take(self, names: Sequence[str]) -> dict[str, bytes]:
        """The content of an answer's files by name.

        Raises:
          OSError: a file is not there.
          ValueError: a name leads out of the folder.
        """
        outside = [name for name in names if not isinstance(name, str) or os.path.basename(name) != name]
        if outside:
            raise ValueError(f"the worker names the file {outside[0]!r}; a name without a folder would be right")
        return {name: (self.path / name).read_bytes() for name in names}

    def empty(self) -> None:
        """Removes all files but the log."""
        for file in self.path.iterdir():
            if file.name != LOG:
                with contextlib.suppress(OSError):
                    file.unlink()

    def remove(self) -> None:
        shutil.rmtree(self.path, ignore_errors=True)
