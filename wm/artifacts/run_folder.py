"""The run folder: entries with keys, resume, and nothing in it that its configuration does not make.

An *entry* is one finished piece of work (a stage, or one view or room of a stage). It has a name, a key (a digest of
everything it was made from: configuration, seed, keys of its inputs) and the digests of its files. An entry is reused only if
its key is the wanted one and its files still have their digests; a half, missing or damaged file is noticed and said.
Nothing in the manifest depends on the clock, so equal runs have equal manifests.
"""

import contextlib
import os
import pathlib
from collections.abc import Callable, Iterable, Iterator, Mapping
from typing import Any, BinaryIO

from wm.artifacts.atomic import Writer, is_temporary, write_atomically
from wm.artifacts.confined import confined
from wm.artifacts.digests import file_digest, json_text
from wm.artifacts.manifest import LOCK, MANIFEST, Loan, Manifest, ManifestDamage, differences, read_manifest
from wm.artifacts.timings import TIMINGS, read_rows
from wm.console import say as to_console
from wm.errors import ArtifactError

try:
    import fcntl
except ImportError:  # Windows has no flock: there the folder is not locked
    fcntl = None

_TELLING = ("config.scene.name", "config.preset", "config.variant", "seed")
"""Of what may differ between two configurations, what tells most: a preset brings a dozen others with it."""

Lender = Callable[[str, str, pathlib.Path], Loan | None]
"""Brings the files of an entry (its name, its key) into a folder from elsewhere; None where that cannot be done."""


class RunFolder:
    """One run's folder, held by one process at a time.

    Use `open_run_folder`, which locks it.
    """

    def __init__(self, path: pathlib.Path, say: Callable[[str], None], lend: Lender | None = None):
        self.path = path
        self._say = say
        self._lend = lend
        self._header: dict[str, Any] = {}
        self._entries: dict[str, dict[str, Any]] = {}
        self._asked: set[str] = set()
        self.recorded = 0
        """How many entries this process has put in: made, or borrowed."""
        self.found = 0
        """How many times it was asked for an entry that was there and whole."""
        self.overwrites = False
        """Whether another configuration's run was here."""

    def entry(self, name: str) -> dict[str, Any] | None:
        """The recorded key and file digests of an entry, whether its files are whole or not; None if there is none."""
        return self._entries.get(name)

    @property
    def stages(self) -> set[str]:
        """The first words of the names of all entries: "paint" of "paint/hall/bootstrap0"."""
        return {name.partition("/")[0] for name in self._entries}

    @property
    def unasked(self) -> set[str]:
        """Names of the entries that this process has neither asked for nor made."""
        return set(self._entries) - self._asked

    def has(self, name: str, key: str) -> bool:
        """Whether entry `name` made from `key` is here and whole; a damaged one is forgotten, with a line.

        One that is not here is here afterwards if it can be borrowed.
        """
        self._asked.add(name)
        if self._holds(name, key):
            self.found += 1
            return True
        return self._borrows(name, key)

    def _holds(self, name: str, key: str) -> bool:
        entry = self._entries.get(name)
        if entry is None or entry["key"] != key:
            return False
        for relative, expected in entry["files"].items():
            state = _state(self.path, relative, expected)
            if state != "whole":
                self._say(f"{self.path / relative}: {state}; making {name} again")
                del self._entries[name]
                return False
        return True

    def _borrows(self, name: str, key: str) -> bool:
        loan = None if self._lend is None else self._lend(name, key, self.path)
        if loan is not None:
            self.record(name, key, list(loan.files), loan.note)
        return loan is not None

    def save(
        self, name: str, key: str, files: Mapping[str, Writer | bytes | str], note: Mapping[str, Any] | None = None
    ) -> None:
        """Writes the files of an entry, each atomically, and then records it, with a note of JSON values if there is one."""
        for relative, write in files.items():
            self.write(relative, write)
        self.record(name, key, list(files), note)

    def write(self, relative: str, content: Writer | bytes | str) -> None:
        """Writes a file atomically. One that belongs to no entry, because it depends on the clock, is written with this alone."""
        write_atomically(confined(self.path, relative, replaced=True), content)

    def record(self, name: str, key: str, relatives: list[str], note: Mapping[str, Any] | None = None) -> None:
        """Records an entry whose files are already in place; files that it had before and has no more are removed."""
        digests = {relative: file_digest(confined(self.path, relative)) for relative in sorted(relatives)}
        former = self._entries.get(name, {"files": {}})["files"]
        self._entries[name] = {"key": key, "files": digests, **({"note": dict(note)} if note else {})}
        self._asked.add(name)
        self.recorded += 1
        self._remove({relative: expected for relative, expected in former.items() if relative not in digests})
        self._write_manifest()

    def drop_others(self, prefix: str, keep: set[str]) -> None:
        """Forgets the entries under `prefix` that are not in `keep`, and removes their files."""
        self._drop([name for name in self._entries if name.startswith(prefix) and name not in keep])

    def drop_unasked(self) -> None:
        """Forgets the entries that this process has neither asked for nor made, and removes their files: a former run's."""
        self._drop(self.unasked)

    def _drop(self, names: Iterable[str]) -> None:
        stale = [self._entries.pop(name) for name in names]
        for entry in stale:
            self._remove(entry["files"])
        if stale:
            self._write_manifest()

    def _remove(self, files: Mapping[str, str]) -> None:
        """Removes files that no entry holds. One that is not what was made here (any more) stays, with a line."""
        held = {file for entry in self._entries.values() for file in entry["files"]} if files else set()
        for relative, expected in files.items():
            state = "held" if relative in held else _state(self.path, relative, expected)
            if state == "damaged":
                self._say(f"{self.path / relative}: not as it was made, so it stays, though this run has no use for it")
            if state == "whole":
                confined(self.path, relative, replaced=True).unlink()
                self._remove_empty(relative)

    def _remove_empty(self, relative: str) -> None:
        """Removes the folders above a removed file that have become empty."""
        with contextlib.suppress(OSError):
            for parent in list(pathlib.PurePosixPath(relative).parents)[:-1]:
                (self.path / parent).rmdir()

    def open(self, header: dict[str, Any], *, overwrite: bool, locked_before: bool = True) -> None:
        """Reads the manifest; the folder must be new, or made by the same configuration, unless `overwrite`.

        What a killed run left half written is swept once the folder is known to be ours.
        """
        found = self._manifest(locked_before)
        if found is None and (strangers := sorted(self._not_ours())) and not overwrite:
            raise ArtifactError(
                f"{self.path} is not empty and holds no run ({', '.join(strangers[:3])}{' ...' if len(strangers) > 3 else ''}); "
                "choose another folder (output=...)"
            )
        old = found or Manifest(header={}, entries={})
        changed = sorted(differences(old.header, header), key=lambda line: not line.startswith(_TELLING))
        if changed and old.entries and not overwrite:
            raise ArtifactError(
                f"{self.path} holds a run with {'; '.join(changed[:4])}{' ...' if len(changed) > 4 else ''}. "
                "Choose another folder (output=...), or pass overwrite=true to remake what differs"
            )
        for name in old.refused:
            self._say(f"{self.path / MANIFEST}: {name} names a file that is none of this folder; it is left out")
        for left in _litter(self.path, below=found is not None):
            with contextlib.suppress(OSError):
                left.unlink(missing_ok=True)
        self._header, self._entries, self.overwrites = header, dict(old.entries), bool(changed)
        self._write_manifest()

    def _manifest(self, locked_before: bool) -> Manifest | None:
        """The manifest, empty if its text is damaged; None if there is none, or somebody else's."""
        try:
            return read_manifest(self.path)
        except ManifestDamage:  # never by a killed run, since manifests are renamed into place
            if not locked_before and self._not_ours() - {MANIFEST}:
                return None  # no run has been in this folder
            self._say(f"{self.path / MANIFEST}: damaged; making everything again")
            return Manifest(header={}, entries={})

    def _not_ours(self) -> set[str]:
        """What is in the folder beside the files that wm writes before and after everything else."""
        return {child.name for child in self.path.iterdir() if not _is_ours(child)}

    def _write_manifest(self) -> None:
        self.write(MANIFEST, json_text({"header": self._header, "entries": self._entries}))


@contextlib.contextmanager
def open_run_folder(
    path: pathlib.Path,
    header: dict[str, Any],
    *,
    overwrite: bool = False,
    say: Callable[[str], None] = to_console,
    lend: Lender | None = None,
) -> Iterator[RunFolder]:
    """The run folder at `path`, made if needed and locked until the block ends (also if the process is killed).

    Args:
      path: the folder.
      header: what identifies the run (configuration, seed, versions): JSON-like.
      overwrite: accept a folder that another configuration made; entries whose keys still fit are reused.
      say: called with one line when something is found damaged.
      lend: asked for entries that the folder does not have (`wm.artifacts.neighbours`); None: every entry is made here.

    Raises:
      ArtifactError: another process uses the folder, or it holds another configuration's run.
      OSError: the folder cannot be made or written.
    """
    path.mkdir(parents=True, exist_ok=True)
    locked_before = (path / LOCK).exists()
    with _lock_file(path) as lock:
        if fcntl is not None:
            try:
                fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
            except BlockingIOError:
                raise ArtifactError(
                    f"{path} is in use by another run; wait for it, or choose another folder (output=...)"
                ) from None
        folder = RunFolder(path, say, lend)
        try:
            folder.open(header, overwrite=overwrite, locked_before=locked_before)
        except (ArtifactError, OSError):
            if not locked_before:
                (path / LOCK).unlink(missing_ok=True)  # a folder that is refused stays as it was
            raise
        yield folder


def _lock_file(path: pathlib.Path) -> BinaryIO:
    """The open lock file; made if needed, and never behind a link. Raises: ArtifactError where the name is a link."""
    if (path / LOCK).is_symlink():
        raise ArtifactError(f"{path / LOCK} is a link; remove it, or choose another folder (output=...)")
    flags = os.O_RDWR | os.O_CREAT | getattr(os, "O_NOFOLLOW", 0)
    return os.fdopen(os.open(path / LOCK, flags, 0o666), "r+b")


def _state(folder: pathlib.Path, relative: str, expected: str) -> str:
    """Whether a file of a folder is "whole" (it has its digest), "damaged" or "missing"."""
    try:
        file = confined(folder, relative)
        return "missing" if not file.is_file() else "whole" if file_digest(file) == expected else "damaged"
    except (ArtifactError, OSError):  # behind a link, or not to be read
        return "damaged"


def _is_ours(file: pathlib.Path) -> bool:
    """Whether a file is one that a run leaves that has recorded nothing: its lock, half a manifest, or its times."""
    if file.name in (LOCK, ".hydra"):
        return True
    if not file.is_file() or file.is_symlink():
        return False
    return is_temporary(file.name) or (file.name == TIMINGS and bool(read_rows(file)))


def _litter(path: pathlib.Path, *, below: bool) -> list[pathlib.Path]:
    """Temporary files of `write_atomically` in a folder; those `below` it too, but for other runs' folders inside it."""
    found = []
    for folder, inner, files in os.walk(path):
        here = pathlib.Path(folder)
        inner[:] = [name for name in inner if below and not any((here / name / kept).exists() for kept in (MANIFEST, LOCK))]
        found += [here / name for name in files if is_temporary(name)]
    return found
