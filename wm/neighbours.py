"""Finished work of the runs beside this one: an entry of the same key need not be made twice.

The runs of a sweep lie side by side (outputs/<scene>/<variant>/<seed>), and most rows of an ablation differ from each other in
one stage: whatever comes before it has the same key in each, hence the same bytes. Such entries are copied, never linked, so
that a folder can be changed or deleted without the others.
"""

import dataclasses
import pathlib
from collections.abc import Callable, Iterable, Mapping
from typing import Any

from wm.atomic import write_atomically
from wm.confined import confined
from wm.digests import content_digest
from wm.errors import ArtifactError
from wm.manifest import ManifestDamage, read_manifest


@dataclasses.dataclass(frozen=True, eq=False)
class Neighbour:
    """Another run's folder, as its manifest describes it."""

    path: pathlib.Path
    entries: Mapping[str, Any]  # name -> {"key", "files": {relative: digest}}


class Neighbours:
    """What the runs beside this one have finished.

    Args:
      folders: run folders; one without a readable manifest lends nothing.
      say: called with one line for each stage and folder from which something is taken.
      account: called with a stage and a folder at the same time: the work has cost something there.
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

    def lend(self, name: str, key: str, into: pathlib.Path) -> list[str]:
        """Copies the files of entry `name` made from `key` into a run folder.

        Returns:
          The files, relative to the folder; none if no neighbour has the entry whole.
        """
        for neighbour in self._neighbours:
            entry = neighbour.entries.get(name)
            if entry is not None and entry["key"] == key and _copy(neighbour.path, entry["files"], into):
                self._tell(name.partition("/")[0], neighbour.path)
                return list(entry["files"])
        return []

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
    """Whether all files were there, to be read, and whole; they are then in `into`."""
    try:
        contents = {relative: confined(source, relative).read_bytes() for relative in files}
    except (OSError, ArtifactError):  # the neighbour is at work, somebody tidied up, it is not ours to read, or none of its files
        return False
    if any(content_digest(contents[relative]) != expected for relative, expected in files.items()):
        return False
    for relative, content in contents.items():
        write_atomically(confined(into, relative, replaced=True), content)
    return True
