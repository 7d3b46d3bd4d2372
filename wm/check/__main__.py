"""The command line: python -m wm.check RUN."""

import sys
from collections.abc import Sequence
from pathlib import Path

from wm import console
from wm.check.checking import check_run, check_table
from wm.check.splat_depth import splat_depth
from wm.errors import InputError
from wm.export.exporting import FOLDER, exported_files
from wm.export.records import ExportError
from wm.export.targets import TARGETS
from wm.export.words import help_text, listed, run_and_words
from wm.finished import open_finished

FAILED, BAD_INPUT = 1, 2
USAGE = "python -m wm.check RUN [of=[TARGET,...]] [folder=FOLDER]"
KEYS = {
    "of": "which targets; by default all that were exported, and the depth of the gaussians against the mesh",
    "folder": f"where they were exported to; by default {FOLDER} in the run folder",
}
DEPTH = "depth"
"""What `of` calls the depth of the run's own gaussians."""


def main(arguments: Sequence[str] | None = None) -> int:
    """Prints one table. Returns 0 where all checks pass, 1 where one fails, 2 where nothing can be checked."""
    arguments = sys.argv[1:] if arguments is None else arguments
    if {"-h", "--help"} & set(arguments):
        console.say(help_text(USAGE, "Proves what was exported of a run with the tools of those who use it.", KEYS))
        return 0
    try:
        path, told = run_and_words(arguments, KEYS)
        run = open_finished(path)
        folder = Path(told["folder"]) if told.get("folder") else run.folder / FOLDER
        exported = exported_files(folder)
        names = listed(told["of"]) if "of" in told else [*(name for name in exported if name in TARGETS), DEPTH]
        missing = [name for name in names if name not in exported and name != DEPTH]
        if missing or not names:
            raise ExportError(
                f"{folder}: {', '.join(missing) or 'nothing'} was not exported there; there are {', '.join(exported)}"
            )
        checks = check_run(run, folder, names) + (splat_depth(run) if DEPTH in names else [])
    except (InputError, OSError) as error:
        console.warn(f"wm.check: {error}")
        return BAD_INPUT
    console.say(check_table(checks))
    failed = sum(not one.passed for one in checks)
    console.say(f"{failed} of {len(checks)} checks failed" if failed else f"all {len(checks)} checks passed")
    return FAILED if failed else 0


if __name__ == "__main__":
    console.end(main)
