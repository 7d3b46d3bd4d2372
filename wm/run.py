"""The Hydra door: compose conf/, freeze it to dataclasses, check the values, run the pipeline.

    python -m wm.run +scene=gothic
    python -m wm.run -m +scene=gothic variant=full,depth_only

Errors are one line on stderr (tracebacks with debug=true) and an exit code: 2 for input that cannot be run, 1 for a run that
failed, 130 after Ctrl-C. The only module that imports hydra.
"""

import contextlib
import difflib
import errno
import importlib
import logging
import os
import sys
from collections.abc import Iterator, Sequence
from dataclasses import Field, fields, is_dataclass
from pathlib import Path
from typing import Any

import hydra
from hydra.core.config_store import ConfigStore
from hydra.core.hydra_config import HydraConfig
from hydra.errors import HydraException, MissingConfigException, OverrideParseException
from hydra.types import RunMode
from omegaconf import OmegaConf
from omegaconf.errors import InterpolationToMissingValueError, MissingMandatoryValue, OmegaConfBaseException

from wm.errors import InputError
from wm.schema import RunConfig
from wm.validate import ConfigError, validate_config

FAILED, BAD_INPUT, INTERRUPTED = 1, 2, 130
OUTPUTS = "outputs"
"""Where run folders lie, as conf/config.yaml says."""
LINES = 12
"""Of a message of many lines, such as all violations of a plan, so many are said."""
_SAID = "said on stderr"
_begun: list[Path] = []
_finished: list[Path] = []
"""Folders of the runs that this process has begun, and of those that it has finished."""

_PACKAGE = Path(__file__).resolve().parent
CONF = next(folder for folder in (_PACKAGE / "conf", _PACKAGE.parent / "conf") if (folder / "config.yaml").is_file())
"""The configuration tree: inside the package in a wheel, beside it in a checkout. (What lies beside a wheel is not ours.)"""


def main() -> None:
    """The command line. Exits with 0, FAILED, BAD_INPUT or INTERRUPTED."""
    os.environ["HYDRA_FULL_ERROR"] = "1"  # Hydra then raises to here instead of printing its own report
    logging.getLogger("jax").setLevel(logging.WARNING)  # Hydra shows what is told, and JAX tells of every accelerator it lacks
    debug = "debug=true" in (argument.lower() for argument in sys.argv)
    try:
        _run_all()
    except KeyboardInterrupt:
        _say("interrupted; the same command resumes")
        _leave(INTERRUPTED)
    except Exception as error:
        if debug:
            raise
        if _SAID not in getattr(error, "__notes__", ()):
            _say(explain(error))
        sys.exit(_exit_code(error))


def _leave(code: int) -> None:
    """Ends the process now. Threads in the middle of a bake or a compilation are not waited for: every artifact is whole."""
    sys.stdout.flush()
    os._exit(code)


def freeze(composed: Any) -> RunConfig:
    """The composed tree as checked dataclasses.

    Raises:
      ConfigError: a key that the schema does not know, a value of a wrong kind or out of range, no scene, backends that do not
        go together.
    """
    from wm.synth.backends import CHOICES, mismatched  # here: `--help` needs none of it

    if OmegaConf.is_missing(composed.scene, "name"):
        raise ConfigError(_no_scene())
    for key in _unknown_keys(composed, RunConfig, ""):
        raise ConfigError(_unknown_key(key))
    config = OmegaConf.to_object(composed)
    assert isinstance(config, RunConfig)
    validate_config(config, backends=CHOICES)
    if faults := mismatched(config):
        raise ConfigError("; ".join(faults))
    return config


def load_config(overrides: Sequence[str] = ()) -> RunConfig:
    """What `python -m wm.run` would run with these arguments, e.g. `load_config(["+scene=gothic", "seed=3"])`.

    Raises:
      ConfigError: the arguments do not compose, or their values cannot be run.
    """
    with hydra.initialize_config_dir(str(CONF), version_base="1.3"):
        try:
            composed = hydra.compose("config", list(overrides))
        except (HydraException, OmegaConfBaseException) as error:
            raise ConfigError(explain(error)) from error
    return freeze(composed)


def explain(error: BaseException) -> str:
    """One line that names what is wrong, where, and what would be right."""
    cause = error.__cause__
    key = getattr(cause, "full_key", None)
    if isinstance(error, MissingConfigException) and error.missing_cfg_file:
        group, _, option = str(error.missing_cfg_file).rpartition("/")
        return f"{group}={option}: no such {group}; choose one of {', '.join(error.options or ())}"
    if isinstance(error, OverrideParseException):
        return f"cannot read the argument {error.override!r}: {_one_line(str(error).splitlines()[0])}"
    if isinstance(error, InterpolationToMissingValueError | MissingMandatoryValue):
        return _no_scene()
    if isinstance(error, HydraException) and str(error).startswith("Could not override 'scene'"):
        return f"a scene is added, not replaced: write +scene=NAME, one of {', '.join(options('scene'))}"
    if key is not None and str(cause).startswith(f"Key '{getattr(cause, 'key', None)}' not in"):
        return _unknown_key(str(key))
    if key is not None:
        return f"{key}: {_one_line(str(cause).splitlines()[0])}"
    if isinstance(error, OSError):
        return _explain_os_error(error)
    if isinstance(error, InputError | HydraException | OmegaConfBaseException):
        return _one_line(str(error)) or type(error).__name__
    return f"{type(error).__name__}: {_one_line(str(error))} (debug=true shows where)"


def options(group: str) -> tuple[str, ...]:
    """The names a configuration group offers, e.g. `options("scene")`."""
    return tuple(sorted(path.stem for path in (CONF / group).glob("*.yaml")))


def _run_all() -> None:
    """What the command line asks for; after a sweep also a table of what it made, as far as it came."""
    _begun.clear()
    _finished.clear()
    try:
        _composed_by_hydra()
    finally:
        if len(_finished) > 1:
            _print_sweep(_finished)


def _run_one(composed: Any) -> None:
    config: RunConfig | None = None
    folder = Path(HydraConfig.get().runtime.output_dir)
    try:
        config = freeze(composed)
        _begin(folder)
        importlib.import_module("wm.pipeline").run(config, folder, neighbours=_neighbours(config, folder))
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
        raise ConfigError(
            "an earlier run of this sweep has this folder, which scene, variant and seed name; where something else differs, "
            "name a folder for each, e.g. 'output=runs/${preset}' or 'output=runs/${hydra:runtime.choices.image}'"
        )
    _begun.append(folder)


def _tidy(folder: Path) -> None:
    """Removes the folders that Hydra has made for a run that never came to write anything."""
    levels = 4 if folder.parts[-4:-3] == (OUTPUTS,) else 1  # of outputs/<scene>/<variant>/<seed> all, if nothing else is there
    with contextlib.suppress(OSError):  # not empty
        for level in (folder, *folder.parents)[:levels]:
            level.rmdir()


def _neighbours(config: RunConfig, folder: Path) -> list[Path]:
    """The runs of other variants of the scene with the same seed: outputs/<scene>/*/<seed>."""
    if config.output is not None or not config.reuse or len(folder.parents) < 2:
        return []
    return sorted(other for other in folder.parents[1].glob(f"*/{config.seed}") if other != folder)


def _print_sweep(folders: Sequence[Path]) -> None:
    """One table of what a sweep has made. Launchers that start processes of their own leave it to `python -m wm.report.sweep`."""
    sweep = importlib.import_module("wm.report.sweep")
    print(f"\n{sweep.sweep_table(sweep.read_runs(folders))}")


def _explain_os_error(error: OSError) -> str:
    where = f"{error.filename}: " if error.filename else ""
    if error.errno == errno.ENOSPC:
        return f"{where}the disk is full; what is finished is kept, and the same command resumes once there is room"
    if error.errno in (errno.EACCES, errno.EPERM, errno.EROFS):
        return f"{where}no permission to write or read here; output=FOLDER names another run folder"
    if error.errno in (errno.EEXIST, errno.ENOTDIR):
        return f"{where}a file stands where a folder is needed; output=FOLDER names another run folder"
    return f"{where}{_one_line(error.strerror or str(error))}"


def _exit_code(error: BaseException) -> int:
    misplaced = isinstance(error, FileExistsError | NotADirectoryError)
    return BAD_INPUT if misplaced or isinstance(error, InputError | HydraException | OmegaConfBaseException) else FAILED


def _unknown_keys(node: Any, record: type, prefix: str) -> Iterator[str]:
    known = {field.name: field for field in fields(record)}
    for name in map(str, node):
        if name not in known:
            yield f"{prefix}{name}"
        elif (inner := _record_of(known[name])) is not None:
            yield from _unknown_keys(node[name], inner, f"{prefix}{name}.")


def _record_of(field: Field) -> type | None:
    """The dataclass that a field of the schema holds, None where it holds a plain value."""
    made = field.default_factory
    return made if isinstance(made, type) and is_dataclass(made) else None


def _unknown_key(key: str) -> str:
    record: type = RunConfig
    prefix, name = "", key
    for part in key.split(".")[:-1]:
        inner = next((_record_of(field) for field in fields(record) if field.name == part), None)
        if inner is None:
            name = part
            break
        record, prefix, name = inner, f"{prefix}{part}.", key.rpartition(".")[2]
    names = [field.name for field in fields(record)]
    near = difflib.get_close_matches(name, names, n=1)
    guess = f"did you mean {prefix}{near[0]}? " if near else ""
    return f"{key}: no such key; {guess}{prefix.rstrip('.') or 'the configuration'} has {', '.join(names)}"


def _no_scene() -> str:
    return f"no scene: add +scene=NAME, one of {', '.join(options('scene'))}; or give scene.name, scene.theme and scene.rooms"


def _one_line(text: str) -> str:
    lines = [" ".join(line.split()) for line in text.splitlines() if line.strip()]
    more = [f"and {len(lines) - LINES} more"] if len(lines) > LINES else []
    return "; ".join(lines[:LINES] + more)


def _say(line: str) -> None:
    print(f"wm: {line}", file=sys.stderr, flush=True)


def _folder(output: str | None, default: str) -> str:
    return default if output is None else os.path.abspath(output)


def _schema() -> Any:
    schema = OmegaConf.structured(RunConfig)
    schema.scene.name = "???"  # there is no default scene: a run says what it wants
    return schema


OmegaConf.register_new_resolver("wm.folder", _folder, replace=True)
ConfigStore.instance().store(name="run_config", node=_schema())
_composed_by_hydra = hydra.main(config_path=str(CONF), config_name="config", version_base="1.3")(_run_one)


if __name__ == "__main__":
    main()
