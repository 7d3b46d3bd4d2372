"""The checks of every target whose files are in a folder, as one table."""

from collections.abc import Mapping, Sequence
from pathlib import Path

from tabulate import tabulate

from wm.artifacts.digests import file_digest
from wm.errors import InputError
from wm.export.exporting import exported_digests
from wm.export.records import Check
from wm.export.targets import TARGETS, ExportTarget
from wm.finished import FinishedRun
from wm.stages.progress import progress


def check_run(run: FinishedRun, folder: Path, names: Sequence[str]) -> list[Check]:
    """The checks of targets, in the order of TARGETS. What keeps one from being made is a check that failed.

    Raises:
      ExportError: the folder holds no list of what was exported, or a damaged one.
    """
    written = exported_digests(folder)
    ordered = [name for name in TARGETS if name in names]
    checks: list[Check] = []
    with progress("check", len(ordered)) as bar:
        for name in ordered:
            bar.set_postfix_str(name)
            checks += _unchanged(name, folder, written.get(name, {}))
            checks += _checked(name, TARGETS[name], run, folder)
            bar.update()
    return checks


def check_table(checks: Sequence[Check]) -> str:
    """One line a check."""
    rows = [(one.target, one.what, one.value, one.wanted, "passed" if one.passed else "FAILED") for one in checks]
    return tabulate(rows, headers=("target", "what", "value", "wanted", ""), tablefmt="simple", disable_numparse=True)


def _checked(name: str, target: ExportTarget, run: FinishedRun, folder: Path) -> list[Check]:
    if not target.installed:
        return [Check(name, "extra", f"not installed: pip install 'wm[{target.extra}]'", "installed", False)]
    try:
        return list(target.load().check(run, folder))
    except Exception as error:  # the readers of damaged files are libraries, which raise whatever they trip over
        said = " ".join(str(error).split()) if isinstance(error, (InputError, OSError, ValueError)) else repr(error)
        return [Check(name, "files can be read", f"no: {said}", "yes", False)]


def _unchanged(name: str, folder: Path, written: Mapping[str, str | None]) -> list[Check]:
    """Whether the files are still those that were written; nothing of an export that has no digests."""
    told = {file: one for file, one in written.items() if one is not None}
    if not told:
        return []
    gone = [file for file in told if not (folder / file).is_file()]
    changed = [file for file, one in told.items() if file not in gone and file_digest(folder / file) != one]
    faults = [f"{what}: {_some(files)}" for what, files in (("gone", gone), ("changed", changed)) if files]
    return [Check(name, "files as they were written", "; ".join(faults) or f"{len(told)} of {len(told)}", "all", not faults)]


def _some(files: Sequence[str]) -> str:
    """The first two of them, and how many there are besides."""
    return ", ".join(files[:2]) + (f" and {len(files) - 2} more" if len(files) > 2 else "")
