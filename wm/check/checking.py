"""The checks of every target whose files are in a folder, as one table."""

from collections.abc import Sequence
from pathlib import Path

from tabulate import tabulate

from wm.errors import InputError
from wm.export.records import Check
from wm.export.targets import TARGETS, ExportTarget
from wm.finished import FinishedRun
from wm.stages.progress import progress


def check_run(run: FinishedRun, folder: Path, names: Sequence[str]) -> list[Check]:
    """The checks of targets, in the order of TARGETS. What keeps one from being made is a check that failed."""
    ordered = [name for name in TARGETS if name in names]
    checks: list[Check] = []
    with progress("check", len(ordered)) as bar:
        for name in ordered:
            bar.set_postfix_str(name)
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
    except (InputError, OSError, ValueError, KeyError) as error:
        return [Check(name, "files can be read", f"no: {error}", "yes", False)]
