"""The command line: python -m wm.export RUN to=[...]."""

import sys
from collections.abc import Sequence
from pathlib import Path

from wm import console
from wm.errors import InputError
from wm.export.exporting import FOLDER, export, exported_table
from wm.export.records import ExportError
from wm.export.targets import TARGETS, installed_targets
from wm.export.words import help_text, listed, run_and_words
from wm.finished import open_finished

BAD_INPUT = 2
USAGE = "python -m wm.export RUN [to=[TARGET,...]] [output=FOLDER]"
KEYS = {
    "to": "what to write, such as to=[navmesh,world]; by default every target whose extra is installed",
    "output": f"the folder; by default {FOLDER} in the run folder",
}


def main(arguments: Sequence[str] | None = None) -> int:
    """Writes the targets and prints what was written. Returns 0, or 2 where that cannot be; the reason is a line on stderr."""
    arguments = sys.argv[1:] if arguments is None else arguments
    if {"-h", "--help"} & set(arguments):
        console.say(_help())
        return 0
    try:
        path, told = run_and_words(arguments, KEYS)
        names = listed(told["to"]) if "to" in told else installed_targets()
        if not names:
            raise ExportError(f"to= names no target; targets are {', '.join(sorted(TARGETS))}")
        run = open_finished(path)
        folder = Path(told["output"]) if told.get("output") else run.folder / FOLDER
        console.say(exported_table(export(run, names, folder), folder))
        console.say(f"results: {folder}")
    except (InputError, OSError) as error:
        console.warn(f"wm.export: {error}")
        return BAD_INPUT
    return 0


def _help() -> str:
    needs = {name: f" (wm[{target.extra}])" if target.extra else "" for name, target in TARGETS.items()}
    width = max(map(len, TARGETS), default=0)
    rows = [f"  {name:<{width}}  {target.what}{needs[name]}" for name, target in TARGETS.items()]
    return "\n".join([help_text(USAGE, "Writes what other programs take of a finished run.", KEYS), "", "targets:", *rows])


if __name__ == "__main__":
    console.end(main)
