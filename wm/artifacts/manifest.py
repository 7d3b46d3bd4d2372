"""The manifest of a run folder: what identifies the run, and what it has finished.

    {"header": {configuration, seed, versions}, "entries": {name: {"key": digest, "files": {file: digest}, "note": {}}}}

It may be damaged or somebody else's, so its form is checked, and every file that it names must stay in its folder.
"""

import dataclasses
import json
import pathlib
from collections.abc import Mapping
from typing import Any

from wm.artifacts.atomic import is_temporary
from wm.artifacts.confined import confined, is_plain

MANIFEST = "manifest.json"
LOCK = ".lock"


class ManifestDamage(Exception):
    """The text of a manifest is not JSON."""


@dataclasses.dataclass(frozen=True, eq=False)
class Manifest:
    """A manifest of ours."""

    header: dict[str, Any]
    entries: dict[str, dict[str, Any]]  # name -> {"key", "files": {relative: digest}}
    refused: tuple[str, ...] = ()
    """Names of the entries that are left out, since a file of theirs has a name that no entry can have."""


@dataclasses.dataclass(frozen=True)
class Loan:
    """An entry that was copied from elsewhere."""

    files: tuple[str, ...]  # relative to the folder
    note: Mapping[str, Any] | None


def read_manifest(folder: pathlib.Path) -> Manifest | None:
    """The manifest of a folder; None if there is none, or somebody else's.

    Raises:
      ManifestDamage: the text is not JSON.
      ArtifactError: the manifest is a link that leads out of the folder.
      OSError: it cannot be read.
    """
    try:
        text = confined(folder, MANIFEST).read_bytes()
    except FileNotFoundError:
        return None
    try:
        manifest = json.loads(text.decode())
    except (ValueError, RecursionError) as error:
        raise ManifestDamage(str(error)) from error
    match manifest:
        case {"header": dict(header), "entries": dict(entries)} if all(map(_is_entry, entries.values())):
            refused = tuple(name for name, entry in entries.items() if not all(map(_may_be_held, entry["files"])))
            kept = {name: _kept(entry) for name, entry in entries.items() if name not in refused}
            return Manifest(header=header, entries=kept, refused=refused)
    return None


def differences(old: Any, new: Any, prefix: str = "") -> list[str]:
    """"key=old (this one: new)" for every leaf of two headers that differs."""
    if isinstance(old, dict) and isinstance(new, dict):
        keys = sorted(old.keys() | new.keys())
        return [line for key in keys for line in differences(old.get(key), new.get(key), f"{prefix}.{key}" if prefix else key)]
    return [] if old == new else [f"{prefix}={old} (this one: {new})"]


def _kept(entry: dict[str, Any]) -> dict[str, Any]:
    """What is read of an entry; its note is nobody's input, and goes with it."""
    note = entry.get("note")
    return {"key": entry["key"], "files": entry["files"], **({"note": note} if _is_note(note) else {})}


def _is_note(note: Any) -> bool:
    return isinstance(note, dict) and all(value is None or isinstance(value, str | int) for value in note.values())


def _is_entry(entry: Any) -> bool:
    match entry:
        case {"key": str(), "files": dict(files)}:
            return bool(files) and all(isinstance(value, str) for value in files.values())
    return False


def _may_be_held(relative: str) -> bool:
    """Whether an entry may hold a file of this name: one below the folder, and none that keeps the folder itself."""
    return is_plain(relative) and relative not in (MANIFEST, LOCK) and not is_temporary(relative.rpartition("/")[2])
