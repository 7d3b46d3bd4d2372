"""The figures of the splat engine beside what is wanted of them: printed, and written to result.csv or held against it.

    python experiments/splat_speed/run.py                     all figures; writes result.csv beside itself
    python experiments/splat_speed/run.py rooms memory        these; the others stay in result.csv as they are
    python experiments/splat_speed/run.py --gate              leaves result.csv, and fails where a figure is worse than in it
    python experiments/splat_speed/run.py --tiny              shows in two minutes that all scripts work; its numbers mean nothing

Every figure is a script beside this one, in a process of its own: one is held to a core, another counts its memory.
"""

import argparse
import os
import pathlib
import subprocess
import sys

from records import Record, read, table, worse, write

HERE = pathlib.Path(__file__).parent
BASELINE = HERE / "result.csv"
FIGURES = ("one_core", "two_cores", "whole_fit", "rooms", "memory")
ALL = (*FIGURES, "gpu")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("figures", nargs="*", default=FIGURES, metavar="figure", help=f"of {', '.join(ALL)}; none: all but gpu")
    parser.add_argument("--gate", action="store_true", help="compare with result.csv and leave it")
    parser.add_argument("--tiny", action="store_true", help="small sizes; nothing is written")
    arguments = parser.parse_args()
    if arguments.gate and arguments.tiny:
        parser.error("--tiny measures nothing that --gate could compare")
    if unknown := sorted(set(arguments.figures) - set(ALL)):
        parser.error(f"no figure is called {', '.join(unknown)}; there are {', '.join(ALL)}")
    baseline = read(BASELINE.read_text().splitlines()) if BASELINE.exists() else []
    complaints = []
    for figure in arguments.figures:
        found = measured(figure, arguments.tiny)
        print(table(found), flush=True)
        complaints += worse(found, baseline) if arguments.gate else []
        if not arguments.gate and not arguments.tiny:
            baseline = sorted([*(r for r in baseline if r.figure != figure), *found], key=lambda r: ALL.index(r.figure))
            with BASELINE.open("w") as file:
                write(baseline, file)
    sys.exit("\n".join(complaints) or None)


def measured(figure: str, tiny: bool) -> list[Record]:
    """The records of a figure, from a process of its own."""
    command = [sys.executable, str(HERE / f"{figure}.py"), *(["--tiny"] if tiny else [])]
    paths = os.pathsep.join(filter(None, (str(HERE.parents[1]), os.environ.get("PYTHONPATH"))))  # for the rooms of the tests
    print(f"{figure} ...", file=sys.stderr, flush=True)
    done = subprocess.run(command, stdout=subprocess.PIPE, text=True, env=os.environ | {"PYTHONPATH": paths})
    if done.returncode:
        sys.exit(f"{figure}.py ended with {done.returncode}")
    return read(done.stdout.splitlines())


if __name__ == "__main__":
    main()
