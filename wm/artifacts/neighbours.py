"""The reuse cache: finished entries of other run folders, copied if they have the key that this run needs.

The runs of a sweep lie side by side (outputs/<scene>/<variant>/<seed>), and most rows of an ablation differ in one stage only.
The stages before it have the same keys in each row, hence the same bytes. Their entries are copied and not linked, so that each
folder can be changed or deleted without affecting the others.
"""

import dataclasses
import pathlib
from collections.abc import Callable, Iterable, Mapping
from typing import Any

from wm.artifacts.atomic import write_atomically
from wm.artifacts.confined import confined
from wm.artifacts.digests import content_digest
from wm.artifacts.manifest import Loan, ManifestDamage, read_manifest
from wm.errors import ArtifactError


@dataclasses.dataclass(frozen=True, eq=False)
class Neighbour:
    """Another run's folder, as its manifest describes it."""

    path: pathlib.Path
    entries: Mapping[str, Any]  # name -> {"key", "files": {relative: digest}}


class Neighbours:
    """The reuse cache over several run folders.

    Args:
      folders: run folders; one without a readable manifest is ignored.
      say: called with one line of text for each pair of a stage and a folder from which an entry is copied.
      account: called for the same pairs with the stage and the folder, so that the time spent there can be accounted for.
    """

    def __init__(
        self,
        folders: Iterable[pathlib.Path],
        *,
        say: Callable[[str], None],
        account: Callable[[str, pathlib.Path], None],
    ):
        self._neighbours = [one for folder in folders if (one := _read(folder)) is not None]
        self._say, self._account = say, account
        self._said: set[tuple[str, pathlib.Path]] = set()

    def lend(self, name: str, key: str, into: pathlib.Path) -> Loan | None:
        """Copies the files of the entry `name` with the key `key` into a run folder.

        Returns:
          What was copied; None if no neighbour has all files unchanged.
        """
        for neighbour in self._neighbours:
            entry = neighbour.entries.get(name)
            if entry is not None and entry["key"] == key and _copy(neighbour.path, entry["files"], into):
                self._tell(name.partition("/")[0], neighbour.path)
                return Loan(tuple(entry["files"]), entry.get("note"))
        return None

    def _tell(self, stage: str, path: pathlib.Path) -> None:
        if (stage, path) not in self._said:
            self._said.add((stage, path))
            self._say(f"{stage}: taken from {path}, where it is the same")
            self._account(stage, path)


def _read(folder: pathlib.Path) -> Neighbour | None:
    try:
        manifest = read_manifest(folder)
    except (OSError, ManifestDamage, ArtifactError):
        return None
    return None if manifest is None else Neighbour(path=folder, entries=manifest.entries)


def _copy(source: pathlib.Path, files: Mapping[str, str], into: pathlib.Path) -> bool:
    """Copies the files into `into` if all of them can be read and have the expected digest, and returns whether it did."""
    try:
        contents = {relative: confined(source, relative).read_bytes() for relative in files}
    except (OSError, ArtifactError):  # another run is writing the folder, files were deleted, may not be read, or are not its own
        return False
    if any(content_digest(contents[relative]) != expected for relative, expected in files.items()):
        return False
    for relative, content in contents.items():
        write_atomically(confined(into, relative, replaced=True), content)
    return True
