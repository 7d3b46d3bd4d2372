"""The run folder: atomic writes, stage keys, the manifest, resume.

An *entry* is one finished piece of work (a stage, or one view or room of a stage). It has a name, a key (a digest of
everything it was made from: configuration, seed, keys of its inputs) and the digests of its files. An entry is reused only if
its key is the wanted one and its files still have their digests; a half, missing or damaged file is noticed and said.
Nothing in the manifest depends on the clock, so equal runs have equal manifests.
"""

import contextlib
import dataclasses
import hashlib
import json
import os
import pathlib
import tempfile
from collections.abc import Callable, Iterator, Mapping
from typing import Any

import numpy as np

from wm.errors import InputError

try:
    import fcntl
except ImportError:  # Windows has no flock: there the folder is not locked
    fcntl = None

MANIFEST = "manifest.json"
LOCK = ".lock"
TEMPORARY = ".part-"
_TELLING = ("config.scene.name", "config.preset", "config.variant", "seed")
"""Of what may differ between two configurations, what tells most: a preset brings a dozen others with it."""

_UMASK = os.umask(0)
os.umask(_UMASK)  # a process can read it only by setting it

Writer = Callable[[pathlib.Path], Any]
Lender = Callable[[str, str, pathlib.Path], list[str]]
"""Brings the files of an entry (its name, its key) into a folder from elsewhere; an empty list where that cannot be done."""


class ArtifactError(InputError):
    """The run folder cannot be used as asked; the message says why and what would help."""


def digest(*parts: Any) -> str:
    """A stable key of JSON-like values, dataclasses, bytes and arrays (20 hex digits of a SHA-256)."""
    sha = hashlib.sha256()
    for part in parts:
        if isinstance(part, np.ndarray):
            sha.update(f"{part.dtype.str}{part.shape}".encode())
            sha.update(np.ascontiguousarray(part).tobytes())
        elif isinstance(part, bytes):
            sha.update(part)
        else:
            sha.update(json.dumps(identity(part), sort_keys=True, allow_nan=False).encode())
        sha.update(b"\x00")
    return sha.hexdigest()[:20]


def identity(value: Any) -> Any:
    """A settings record as JSON-like values, without the fields that change no result (`wm.schema.BESIDE`)."""
    if not dataclasses.is_dataclass(value) or isinstance(value, type):
        return value
    kept = (field.name for field in dataclasses.fields(value) if field.metadata.get("identity", True))
    return {name: identity(getattr(value, name)) for name in kept}


def write_atomically(path: pathlib.Path, write: Writer | bytes | str) -> None:
    """Writes a file under a temporary name beside `path`, then renames it: readers see the old file or the new one.

    Args:
      path: the file; its folder is made.
      write: the content, or a function that writes it to the path it is given.

    Raises:
      OSError: the disk is full or the folder is not writable; no partial file remains.
    """
    path.parent.mkdir(parents=True, exist_ok=True)
    handle, name = tempfile.mkstemp(dir=path.parent, prefix=TEMPORARY, suffix=path.suffix)
    os.close(handle)
    try:
        if callable(write):
            write(pathlib.Path(name))
        else:
            pathlib.Path(name).write_bytes(write.encode() if isinstance(write, str) else write)
        with open(name, "rb+") as file:
            os.fsync(file.fileno())
        os.chmod(name, 0o666 & ~_UMASK)
        os.replace(name, path)
    except BaseException as error:
        with contextlib.suppress(OSError):
            os.unlink(name)
        if isinstance(error, OSError) and error.filename is None:
            error.filename = str(path)  # a full disk is met while writing, where Python names no file
        raise


def file_digest(path: pathlib.Path) -> str:
    with path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()[:20]


def content_digest(content: bytes) -> str:
    """`file_digest` of a file that holds this."""
    return hashlib.sha256(content).hexdigest()[:20]


def json_text(value: Any) -> str:
    """JSON with sorted keys, one way only; NaN is refused."""
    return json.dumps(value, indent=1, sort_keys=True, allow_nan=False) + "\n"


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
        self.recorded = 0
        """How many entries this process has put in: made, or borrowed."""
        self.overwrites = False
        """Whether another configuration's run was here."""

    def entry(self, name: str) -> dict[str, Any] | None:
        """The recorded key and file digests of an entry, whether its files are whole or not; None if there is none."""
        return self._entries.get(name)

    def has(self, name: str, key: str) -> bool:
        """Whether entry `name` made from `key` is here and whole; a damaged one is forgotten, with a line.

        One that is not here is here afterwards if it can be borrowed.
        """
        return self._holds(name, key) or self._borrows(name, key)

    def _holds(self, name: str, key: str) -> bool:
        entry = self._entries.get(name)
        if entry is None or entry["key"] != key:
            return False
        for relative, expected in entry["files"].items():
            file = self.path / relative
            if not file.is_file() or file_digest(file) != expected:
                self._say(f"{file}: {'damaged' if file.is_file() else 'missing'}; making {name} again")
                del self._entries[name]
                return False
        return True

    def _borrows(self, name: str, key: str) -> bool:
        files = [] if self._lend is None else self._lend(name, key, self.path)
        if files:
            self.record(name, key, files)
        return bool(files)

    def save(self, name: str, key: str, files: Mapping[str, Writer | bytes | str]) -> None:
        """Writes the files of an entry, each atomically, and then records it."""
        for relative, write in files.items():
            write_atomically(self.path / relative, write)
        self.record(name, key, list(files))

    def write(self, relative: str, content: Writer | bytes | str) -> None:
        """Writes a file that belongs to no entry, because it depends on the clock; atomically all the same."""
        write_atomically(self.path / relative, content)

    def record(self, name: str, key: str, relatives: list[str]) -> None:
        """Records an entry whose files are already in place."""
        digests = {relative: file_digest(self.path / relative) for relative in sorted(relatives)}
        self._entries[name] = {"key": key, "files": digests}
        self.recorded += 1
        self._write_manifest()

    def drop_others(self, prefix: str, keep: set[str]) -> None:
        """Forgets the entries under `prefix` that are not in `keep`, and removes their files."""
        stale = [name for name in self._entries if name.startswith(prefix) and name not in keep]
        held = {file for name, entry in self._entries.items() if name not in stale for file in entry["files"]}
        for name in stale:
            for relative in self._entries.pop(name)["files"]:
                if relative not in held:
                    (self.path / relative).unlink(missing_ok=True)
        if stale:
            self._write_manifest()

    def open(self, header: dict[str, Any], *, overwrite: bool) -> None:
        """Reads the manifest; the folder must be new, or made by the same configuration, unless `overwrite`.

        What a killed run left half written is swept once the folder is known to be ours.
        """
        found, here = self._read_manifest(), {child.name for child in self.path.iterdir()} - {LOCK, ".hydra"}
        if found is None and here and not overwrite:
            raise ArtifactError(f"{self.path} is not empty and holds no run; choose another folder (output=...)")
        old, entries = found or ({}, {})
        changed = sorted(_differences(old, header), key=lambda line: not line.startswith(_TELLING))
        if changed and entries and not overwrite:
            raise ArtifactError(
                f"{self.path} holds a run with {'; '.join(changed[:4])}{' ...' if len(changed) > 4 else ''}. "
                "Choose another folder (output=...), or pass overwrite=true to remake what differs"
            )
        for left in _litter(self.path):
            left.unlink(missing_ok=True)
        self._header, self._entries, self.overwrites = header, entries, bool(changed)
        self._write_manifest()

    def _read_manifest(self) -> tuple[dict[str, Any], dict[str, Any]] | None:
        """Header and entries, both empty if the text is damaged; None if there is no manifest, or somebody else's."""
        file = self.path / MANIFEST
        try:
            manifest = json.loads(file.read_text(encoding="utf-8"))
        except FileNotFoundError:
            return None
        except ValueError:  # never by a killed run, since manifests are renamed into place
            self._say(f"{file}: damaged; making everything again")
            return {}, {}
        match manifest:
            case {"header": dict(header), "entries": dict(entries)} if all(map(_is_entry, entries.values())):
                return header, entries
        return None

    def _write_manifest(self) -> None:
        write_atomically(self.path / MANIFEST, json_text({"header": self._header, "entries": self._entries}))


@contextlib.contextmanager
def open_run_folder(
    path: pathlib.Path,
    header: dict[str, Any],
    *,
    overwrite: bool = False,
    say: Callable[[str], None] = print,
    lend: Lender | None = None,
) -> Iterator[RunFolder]:
    """The run folder at `path`, made if needed and locked until the block ends (also if the process is killed).

    Args:
      path: the folder.
      header: what identifies the run (configuration, seed, versions): JSON-like.
      overwrite: accept a folder that another configuration made; entries whose keys still fit are reused.
      say: called with one line when something is found damaged.
      lend: asked for entries that the folder does not have (`wm.neighbours`); None: every entry is made here.

    Raises:
      ArtifactError: another process uses the folder, or it holds another configuration's run.
      OSError: the folder cannot be made or written.
    """
    path.mkdir(parents=True, exist_ok=True)
    locked_before = (path / LOCK).exists()
    with (path / LOCK).open("a+b") as lock:
        if fcntl is not None:
            try:
                fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
            except BlockingIOError:
                raise ArtifactError(
                    f"{path} is in use by another run; wait for it, or choose another folder (output=...)"
                ) from None
        folder = RunFolder(path, say, lend)
        try:
            folder.open(header, overwrite=overwrite)
        except ArtifactError:
            if not locked_before:
                (path / LOCK).unlink(missing_ok=True)  # a folder that is refused stays as it was
            raise
        yield folder


def _litter(path: pathlib.Path) -> list[pathlib.Path]:
    """Temporary files of `write_atomically` below a run folder, but for those in other runs' folders inside it."""
    found = []
    for folder, inner, files in os.walk(path):
        here = pathlib.Path(folder)
        inner[:] = [name for name in inner if not (here / name / MANIFEST).exists()]
        found += [here / name for name in files if name.startswith(TEMPORARY)]
    return found


def _is_entry(entry: Any) -> bool:
    match entry:
        case {"key": str(), "files": dict()}:
            return True
    return False


def _differences(old: Any, new: Any, prefix: str = "") -> list[str]:
    """"key=old (now new)" for every leaf that differs."""
    if isinstance(old, dict) and isinstance(new, dict):
        keys = sorted(old.keys() | new.keys())
        return [line for key in keys for line in _differences(old.get(key), new.get(key), f"{prefix}.{key}" if prefix else key)]
    return [] if old == new else [f"{prefix}={old} (this one: {new})"]
