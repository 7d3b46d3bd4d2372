"""Writing several targets of one run, and what was written as a table."""

import contextlib
import dataclasses
import json
import os
from collections.abc import Sequence
from pathlib import Path

from tabulate import tabulate

from wm.artifacts.atomic import write_atomically
from wm.artifacts.digests import file_digest
from wm.errors import InputError
from wm.export.records import ExportError
from wm.export.targets import TARGETS, check_targets
from wm.finished import FinishedRun
from wm.stages.progress import progress

FOLDER = "export"
"""Where in a run folder exports go that name no folder."""
LIST = "targets.json"
"""What a folder of exports holds: the files of each target, and the digest of each file."""


@dataclasses.dataclass(frozen=True)
class Exported:
    """The files of one target."""

    target: str
    paths: tuple[Path, ...]

    @property
    def size(self) -> int:
        """Bytes of all files."""
        return sum(path.stat().st_size for path in self.paths)


def export(run: FinishedRun, names: Sequence[str], folder: Path | None = None) -> list[Exported]:
    """Writes targets in the order of TARGETS, which later ones build on.

    Args:
      run: a finished run.
      names: of targets.
      folder: where to; by default `export` in the run folder.

    Raises:
      ExportError: a target is unknown, lacks its extra, or was read back as something else.
      UnfinishedRunError: the run lacks a file that a target needs.
      OSError: a file cannot be written.
    """
    check_targets(names)
    folder = run.folder / FOLDER if folder is None else folder
    done = []
    ordered = [name for name in TARGETS if name in names]
    with progress("export", len(ordered)) as bar:
        for name in ordered:
            bar.set_postfix_str(name)
            try:
                paths = TARGETS[name].load().write(run, folder)
            except InputError as error:
                raise ExportError(f"target {name}: {error}") from error
            done.append(Exported(name, tuple(paths)))
            _note(folder, done[-1])
            bar.update()
    return done


def exported_files(folder: Path) -> dict[str, list[str]]:
    """The files of each target that was written to a folder, in the order of names. Raises: ExportError: none was."""
    return {name: list(files) for name, files in exported_digests(folder).items()}


def exported_digests(folder: Path) -> dict[str, dict[str, str | None]]:
    """By target and file the digest of what was written; None where an older version wrote it. Raises: ExportError: none was."""
    try:
        told = json.loads((folder / LIST).read_text(encoding="utf-8"))
        digests = told.get("digests", {})
        return {str(name): {str(file): digests.get(file) for file in files} for name, files in told["targets"].items()}
    except FileNotFoundError as error:
        raise ExportError(f"{folder}: nothing was exported there; python -m wm.export RUN does") from error
    except (ValueError, KeyError, TypeError, AttributeError) as error:
        raise ExportError(f"{folder / LIST}: is damaged ({error}); export again") from error


def _note(folder: Path, exported: Exported) -> None:
    """Adds the files of a target to the folder's list; a damaged list is begun again."""
    known: dict[str, dict[str, str | None]] = {}
    with contextlib.suppress(ExportError):
        known = exported_digests(folder)
    known[exported.target] = {
        Path(os.path.relpath(path, folder)).as_posix(): file_digest(path) for path in sorted(exported.paths)
    }
    told = {
        "version": 1,
        "targets": {name: sorted(files) for name, files in sorted(known.items())},
        "digests": {file: one for files in known.values() for file, one in sorted(files.items()) if one is not None},
    }
    write_atomically(folder / LIST, json.dumps(told, indent=1) + "\n")


def exported_table(exported: Sequence[Exported], folder: Path) -> str:
    """Targets, the files of each, and their size."""
    rows = [(one.target, _files(one.paths, folder), f"{one.size / 1e6:.2f} MB") for one in exported]
    return tabulate(rows, tablefmt="plain", colalign=("left", "left", "right"), disable_numparse=True)


def _files(paths: Sequence[Path], folder: Path) -> str:
    """The names of a few files, or the folder that many are in."""
    names = [path.relative_to(folder).as_posix() if path.is_relative_to(folder) else str(path) for path in paths]
    if len(names) <= 3:
        return ", ".join(names)
    places = dict.fromkeys(f"{name.partition('/')[0]}/" if "/" in name else name for name in names)
    return f"{', '.join(list(places)[:3])}{' ...' if len(places) > 3 else ''} ({len(names)} files)"
