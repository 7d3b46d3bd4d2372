"""Before the first folder is made: what the command line asks for is composed and checked, of a sweep every row.

Hydra makes a run's folder before the run can look at its configuration, and starts the first row of a sweep before it composes
the last.
"""

import contextlib
import dataclasses
import importlib
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

from hydra._internal.config_search_path_impl import ConfigSearchPathImpl
from hydra._internal.core_plugins.basic_sweeper import BasicSweeper
from hydra._internal.hydra import Hydra
from hydra._internal.utils import create_config_search_path, get_args_parser
from hydra.core.global_hydra import GlobalHydra
from hydra.core.hydra_config import HydraConfig
from hydra.core.override_parser.overrides_parser import OverridesParser
from hydra.types import RunMode
from omegaconf import OmegaConf, open_dict, read_write

from wm.cli.composition import CONF, freeze, refused
from wm.schema import RunConfig
from wm.validate import ConfigError


@dataclasses.dataclass(frozen=True, eq=False)
class PlannedRun:
    """A run that the command line asks for."""

    config: RunConfig
    folder: Path  # absolute
    missing: tuple[Path, ...]  # it and the folders above it that are not there yet, the deepest first


def planned_runs(arguments: Sequence[str]) -> list[PlannedRun]:
    """The runs that `python -m wm.run` with these arguments is going to make, all of them checked.

    Returns:
      One for each row of a sweep; none if the arguments ask for something else than runs, or for a sweeper that chooses its rows
      as it goes.

    Raises:
      ConfigError: a run cannot be run, or two would share a folder; of a sweep the message names the row.
      PlanError: the floor plan of one cannot be used.
    """
    asked = get_args_parser().parse_args(list(arguments))
    if asked.help or asked.hydra_help or asked.cfg or asked.info or asked.shell_completion or asked.config_path:
        return []
    if asked.experimental_rerun:
        return []
    name = asked.config_name or "config"
    with _hydra(asked.config_dir) as hydra, refused(asked.overrides):
        if asked.multirun or hydra.get_mode(name, asked.overrides) == RunMode.MULTIRUN:
            return _rows(hydra, name, asked.overrides)
        composed = hydra.compose_config(name, asked.overrides, run_mode=RunMode.RUN, with_log_configuration=False)
        return [_planned(composed, "hydra.run.dir")]


def _rows(hydra: Hydra, name: str, overrides: list[str]) -> list[PlannedRun]:
    sweep = hydra.compose_config(name, overrides, run_mode=RunMode.MULTIRUN, with_log_configuration=False)
    if not str(sweep.hydra.sweeper._target_).endswith(BasicSweeper.__name__):
        return []
    parameters = [f"{key}={value}" for key, value in (sweep.hydra.sweeper.params or {}).items()]
    parser = OverridesParser.create(config_loader=hydra.config_loader)
    task: Any = OmegaConf.to_container(sweep.hydra.overrides.task, resolve=False)
    rows = BasicSweeper.split_arguments(parser.parse_overrides([*parameters, *task]), None)[0]
    planned: dict[Path, PlannedRun] = {}
    for number, row in enumerate(rows):
        with refused(row, f"row {number + 1} of the sweep ({' '.join(row)}): " if len(rows) > 1 else ""):
            composed = hydra.config_loader.load_sweep_config(sweep, row)
            with open_dict(composed):
                composed.hydra.job.id, composed.hydra.job.num = str(number), number
            run = _planned(composed, "hydra.sweep.dir", "hydra.sweep.subdir")
            if run.folder in planned:
                raise shared_folder()
            planned[run.folder] = run
    return list(planned.values())


def shared_folder() -> ConfigError:
    """The error of a run whose folder an earlier run of its sweep has."""
    return ConfigError(
        "an earlier run of this sweep has this folder, which scene, variant and seed name; where something else differs, "
        "name a folder for each, e.g. 'output=runs/${preset}' or 'output=runs/${hydra:runtime.choices.image}'"
    )


def _planned(composed: Any, *folder_keys: str) -> PlannedRun:
    with _as_current(composed):
        task = composed.copy()
        with read_write(task), open_dict(task):
            del task["hydra"]
        config = freeze(task)
        if config.plan.file is not None:
            reading = importlib.import_module("wm.geometry.plan.loading").read_plan_file
            reading(
                Path(config.plan.file), repair=config.plan.repair, unreachable=config.plan.unreachable, storey=config.plan.storey
            )
        if config.export:
            importlib.import_module("wm.export.targets").check_targets(config.export)
        folder = Path.cwd().joinpath(*(str(OmegaConf.select(composed, key)) for key in folder_keys))
    missing = tuple(level for level in (folder, *folder.parents) if not level.exists())
    return PlannedRun(config=config, folder=folder, missing=missing)


@contextlib.contextmanager
def _hydra(config_dir: str | None) -> Iterator[Hydra]:
    """Hydra with our configuration tree, and the folder of `--config-dir` before it."""
    path = create_config_search_path(str(CONF))
    if config_dir is not None:
        if not Path(config_dir).is_dir():
            raise ConfigError(f"--config-dir {config_dir}: no such folder")
        assert isinstance(path, ConfigSearchPathImpl)
        path.prepend(provider="command-line", path=f"file://{Path(config_dir).resolve()}")
    try:
        yield Hydra.create_main_hydra2(task_name="run", config_search_path=path)
    finally:
        GlobalHydra.instance().clear()


@contextlib.contextmanager
def _as_current(composed: Any) -> Iterator[None]:
    """`${hydra:...}` reads from this configuration."""
    current: Any = HydraConfig.instance()
    before = current.cfg
    current.set_config(composed)
    try:
        yield
    finally:
        current.cfg = before
