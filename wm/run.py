"""The command line: compose conf/ (wm.cli.composition), run the pipeline, and say what went wrong in one line.

    wm gothic
    wm --theme "a children's library, bright" --rooms "hall, kitchen, bedroom"
    wm -m gothic variant=full,depth_only

`python -m wm.run` is the same as `wm`; wm.cli.command_line says what may be typed, wm.cli.help what --help answers. Errors are
one line on stderr (tracebacks with debug=true) and an exit code: 2 for input that cannot be run, 1 for a run that failed, 130
after Ctrl-C, 143 after SIGTERM.
"""

import contextlib
import errno
import importlib
import logging
import os
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import hydra
from hydra.core.hydra_config import HydraConfig
from hydra.errors import HydraException
from hydra.types import RunMode
from omegaconf.errors import OmegaConfBaseException

from wm import console
from wm.artifacts.atomic import discard_unfinished
from wm.cli import command_line, composition
from wm.cli.composition import CONF, freeze, one_line
from wm.cli.composition import load_config as load_config
from wm.cli.composition import options as options
from wm.cli.help import answer, asks_for_help
from wm.cli.preflight import planned_runs, shared_folder
from wm.cli.signals import ending
from wm.errors import InputError
from wm.schema import STAGES, RunConfig
from wm.validate import ConfigError as ConfigError

FAILED, BAD_INPUT, INTERRUPTED = 1, 2, 130
_SAID = "said on stderr"
_begun: list[Path] = []
_finished: list[Path] = []
"""Folders of the runs that this process has begun, and of those that it has finished."""
_missing: dict[Path, tuple[Path, ...]] = {}
"""By the folder of a run, it and those above it that were not there before."""


def main() -> None:
    """The command line. Exits with 0, FAILED, BAD_INPUT, or 128 and the number of the signal that ended it."""
    console.open_standard_streams()
    try:
        with ending(_interrupted):
            _main()
    finally:
        console.flush()


def _main() -> None:
    os.environ["HYDRA_FULL_ERROR"] = "1"  # Hydra then raises to here instead of printing its own report
    debug = "debug=true" in (argument.lower() for argument in sys.argv)
    try:
        if asks_for_help(sys.argv[1:]):
            _print_answer()
            return
        sys.argv[1:] = command_line.translated(sys.argv[1:])
        _run_all()
    except KeyboardInterrupt:
        _interrupted(INTERRUPTED)
    except Exception as error:
        if debug:
            raise
        if _SAID not in getattr(error, "__notes__", ()):
            _say(explain(error))
        sys.exit(_exit_code(error))


def _print_answer() -> None:
    """What --help, --version or --completion ask for. A reader that has seen enough, such as `head`, is no error."""
    try:
        print(answer(sys.argv[1:], CONF), flush=True)
    except BrokenPipeError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())  # or Python would complain at exit


def _interrupted(code: int) -> None:
    """Says so, shows what a sweep has made so far, and ends the process."""
    if console.on_terminal():
        console.warn("")  # the line of a progress bar ends here
    _say("interrupted; the same command resumes")
    if len(_finished) > 1:
        with contextlib.suppress(Exception):
            _print_sweep(_finished)
    _leave(code)


def _leave(code: int) -> None:
    """Ends the process now. Threads in the middle of a bake or a compilation are not waited for: every artifact is whole."""
    console.flush()
    discard_unfinished()
    os._exit(code)


def explain(error: BaseException) -> str:
    """One line that says what is wrong, in the configuration or with the run."""
    if isinstance(error, OSError) and not isinstance(error, HydraException):  # a missing YAML is both
        return _explain_os_error(error)
    return composition.explain(error)


def _run_all() -> None:
    """What the command line asks for; after a sweep also a table of what it made, as far as it came."""
    _begun.clear()
    _finished.clear()
    _missing.clear()
    _missing.update({run.folder: run.missing for run in planned_runs(sys.argv[1:])})
    try:
        _composed_by_hydra()
    finally:
        if len(_finished) > 1:
            _print_sweep(_finished)


def _run_one(composed: Any) -> None:
    logging.getLogger().setLevel(logging.WARNING)  # Hydra shows what libraries tell: every accelerator JAX lacks, every request
    config: RunConfig | None = None
    folder = Path(HydraConfig.get().runtime.output_dir)
    try:
        config = freeze(composed)
        _begin(folder)
        importlib.import_module("wm.pipeline").run(config, folder, neighbours=_neighbours(config, folder))
        if config.until == STAGES[-1]:
            _finished.append(folder)
    except Exception as error:
        _tidy(folder)
        if HydraConfig.get().mode == RunMode.MULTIRUN and not composed.debug:
            _say(f"{folder}: {explain(error)}")  # the others of the sweep go on; Hydra reports only the first failure
            error.add_note(_SAID)
            raise
        if composed.debug:
            raise
        _say(explain(error))
        sys.exit(_exit_code(error))


def _begin(folder: Path) -> None:
    """Raises: ConfigError where an earlier run of this sweep has the folder."""
    if folder in _begun:
        raise shared_folder()
    _begun.append(folder)


def _tidy(folder: Path) -> None:
    """Removes the folders that Hydra has made for a run that never came to write anything, and none that was there before."""
    with contextlib.suppress(OSError):  # not empty
        for level in _missing.get(folder, ()):
            level.rmdir()


def _neighbours(config: RunConfig, folder: Path) -> list[Path]:
    """The runs of other variants of the scene with the same seed: outputs/<scene>/*/<seed>."""
    if config.output is not None or not config.reuse or len(folder.parents) < 2:
        return []
    return sorted(other for other in folder.parents[1].glob(f"*/{config.seed}") if other != folder)


def _print_sweep(folders: Sequence[Path]) -> None:
    """One table of what a sweep has made. Launchers that start processes of their own leave it to `python -m wm.report.sweep`."""
    sweep = importlib.import_module("wm.report.sweep")
    console.say(f"\n{sweep.sweep_table(sweep.read_runs(folders))}")


def _explain_os_error(error: OSError) -> str:
    where = f"{error.filename}: " if error.filename else ""
    if error.errno == errno.ENOSPC:
        return f"{where}the disk is full; what is finished is kept, and the same command resumes once there is room"
    if error.errno in (errno.EACCES, errno.EPERM, errno.EROFS):
        return f"{where}no permission to write or read here; output=FOLDER names another run folder"
    if error.errno == errno.EISDIR:
        return f"{where}a folder stands where a file is needed; move it away, or name another run folder with output=FOLDER"
    if error.errno in (errno.EEXIST, errno.ENOTDIR):
        return f"{where}a file stands where a folder is needed; output=FOLDER names another run folder"
    return f"{where}{one_line(error.strerror or str(error))}"


def _exit_code(error: BaseException) -> int:
    misplaced = isinstance(error, FileExistsError | NotADirectoryError | IsADirectoryError)
    return BAD_INPUT if misplaced or isinstance(error, InputError | HydraException | OmegaConfBaseException) else FAILED


def _say(line: str) -> None:
    console.warn(f"wm: {line}")


_composed_by_hydra = hydra.main(config_path=str(CONF), config_name="config", version_base="1.3")(_run_one)


if __name__ == "__main__":
    main()
