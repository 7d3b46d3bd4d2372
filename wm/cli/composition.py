"""From conf/ and what the command line says to one checked record: Hydra composes, `freeze` makes dataclasses of it.

A YAML that says `backend: some.module` brings that module's `Settings` as the schema of its group: its keys are checked like all
others, by name and type here, by range in wm.validate. That holds for the folders of `--config-dir` as well.
"""

import contextlib
import difflib
import os
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import fields, is_dataclass
from pathlib import Path
from typing import Any

import hydra
from hydra._internal.core_plugins.file_config_source import FileConfigSource
from hydra._internal.sources_registry import SourcesRegistry
from hydra.core.config_store import ConfigStore
from hydra.core.plugins import Plugins
from hydra.errors import ConfigCompositionException, HydraException, MissingConfigException, OverrideParseException
from hydra.plugins.config_source import ConfigResult
from omegaconf import DictConfig, OmegaConf, open_dict
from omegaconf.errors import InterpolationToMissingValueError, MissingMandatoryValue, OmegaConfBaseException

from wm.cli.command_line import quoted, scene_name, translated
from wm.environment import EnvironmentText, environment_values, masked
from wm.errors import InputError
from wm.schema import RunConfig
from wm.services.faults import ServiceError
from wm.validate import ConfigError, validate_config

LINES = 12
"""Of a message of many lines, such as all violations of a plan, so many are said."""
_WORD = 200
"""Characters of one word that a message quotes."""

_PACKAGE = Path(__file__).resolve().parents[1]
CONF = next(folder for folder in (_PACKAGE / "conf", _PACKAGE.parent / "conf") if (folder / "config.yaml").is_file())
"""The configuration tree: inside the package in a wheel, beside it in a checkout. (What lies beside a wheel is not ours.)"""


class BackendSource(FileConfigSource):
    """Hydra's reader of YAML files, for files that select a backend too.

    Hydra has a public seam for sources of other schemes but not for the schema of a file, so this takes the place of the reader
    behind `file://`; the version of Hydra is bounded for it.
    """

    def load_config(self, config_path: str) -> ConfigResult:
        result = super().load_config(config_path)
        config = result.config
        if isinstance(config, DictConfig) and (path := config.get("backend")) is not None:
            result.config = _typed(config, config_path, str(path))
        return result


def register() -> None:
    """Tells Hydra of the schema, of files that select backends, of `wm.folder`, which names the run folder, and of
    `wm.scene_name`. Done once, when this module is imported."""
    OmegaConf.register_new_resolver("wm.scene_name", scene_name, replace=True)
    Plugins.instance()  # registers Hydra's own sources first
    SourcesRegistry.instance().types["file"] = BackendSource
    ConfigStore.instance().store(name="run_config", node=_schema())
    OmegaConf.register_new_resolver("wm.folder", _folder, replace=True)


def _folder(output: str | None, default: str) -> str:
    return default if output is None else os.path.abspath(output)


def freeze(composed: Any) -> RunConfig:
    """The composed tree as checked dataclasses.

    Raises:
      ConfigError: a key that the schema does not know, a value of a wrong kind or out of range, no scene, backends that do not
        go together.
    """
    raw = OmegaConf.to_container(composed, resolve=False)
    with refused(_texts(raw)):
        return _frozen(composed, raw)


def _frozen(composed: Any, raw: Any) -> RunConfig:
    from wm.synth.registry import mismatches, misplaced  # here: `--help` needs none of it

    if OmegaConf.is_missing(composed.scene, "theme"):
        raise ConfigError(_no_scene())
    for key in _unknown_keys(composed, ""):
        raise ConfigError(_unknown_key(key, composed))
    config = OmegaConf.to_object(composed)
    if not isinstance(config, RunConfig):
        raise ConfigError("the configuration is not that of a run; arguments change its keys and cannot replace it")
    _mark(config, raw, environment_values(_texts(raw)))
    validate_config(config)
    if faults := list(misplaced(config)) or mismatches(config):
        raise ConfigError("; ".join(faults))
    return config


def load_config(overrides: Sequence[str] = (), *, config_dir: Path | str | None = None) -> RunConfig:
    """What `wm` would run with these arguments, e.g. `load_config(["gothic", "seed=3"])` or `load_config(["+scene=gothic"])`.

    Args:
      overrides: what stands after `wm`; wm.cli.command_line says what may be typed.
      config_dir: a folder with further YAML files, as `--config-dir` names one.

    Raises:
      ConfigError: the arguments do not compose, or their values cannot be run.
    """
    where = [] if config_dir is None else [f"hydra.searchpath=['file://{Path(config_dir).resolve()}']"]
    with hydra.initialize_config_dir(str(CONF), version_base="1.3"), refused(overrides):
        composed = hydra.compose("config", [*where, *translated(overrides)])
    return freeze(composed)


@contextlib.contextmanager
def refused(texts: Iterable[str], where: str = "") -> Iterator[None]:
    """Makes a ConfigError of one line of whatever composing these arguments raises.

    Hydra, OmegaConf and the settings of backends raise a dozen types of errors for values that they cannot use, and quote them:
    what the texts interpolate from the environment is masked.

    Args:
      texts: the arguments, or the texts of the configuration.
      where: precedes the message.
    """
    try:
        yield
    except Exception as error:
        known = isinstance(error, InputError | HydraException | OmegaConfBaseException)
        text = explain(error) if known else f"the arguments cannot be used: {one_line(str(error)) or type(error).__name__}"
        said = where + masked(text, environment_values(texts))
        if isinstance(error, InputError) and said == text:
            raise
        raise ConfigError(said) from None  # a traceback of the cause would show what is masked here


def explain(error: BaseException) -> str:
    """One line that says what is wrong with a composition, or with a run."""
    cause = error if getattr(error, "full_key", None) else error.__cause__
    key = getattr(cause, "full_key", None) or None
    if isinstance(error, MissingConfigException) and error.missing_cfg_file:
        group, _, option = str(error.missing_cfg_file).rpartition("/")
        known = error.options or ()
        return f"{group}={option}: no such {group}; {_guess(option, known)}choose one of {', '.join(known)}"
    if isinstance(error, OverrideParseException):
        return _unreadable(error.override, one_line(str(error).splitlines()[0]))
    if isinstance(error, InterpolationToMissingValueError | MissingMandatoryValue):
        return _no_scene()
    if isinstance(error, HydraException) and str(error).startswith("Could not override 'scene'"):
        return f"a scene is added, not replaced: type wm NAME or write +scene=NAME, one of {', '.join(options('scene'))}"
    if key is not None and str(cause).startswith(f"Key '{getattr(cause, 'key', None)}' not in"):
        return _unknown(str(key), getattr(cause, "object_type", None))
    if key is not None:
        return f"{key}: {one_line(str(cause).splitlines()[0])}"
    if isinstance(error, InputError | ServiceError | HydraException | OmegaConfBaseException):
        return one_line(str(error)) or type(error).__name__
    return f"{type(error).__name__}: {one_line(str(error))} (debug=true shows where)"


def options(group: str) -> tuple[str, ...]:
    """The names a configuration group offers, e.g. `options("scene")`."""
    return tuple(sorted(path.stem for path in (CONF / group).glob("*.yaml")))


def one_line(text: str) -> str:
    """A message of several lines as one, its last lines counted where there are more than LINES, and endless words cut."""
    lines = [" ".join(map(_cut, line.split())) for line in text.splitlines() if line.strip()]
    more = [f"and {len(lines) - LINES} more"] if len(lines) > LINES else []
    return "; ".join(lines[:LINES] + more)


def _cut(word: str) -> str:
    return word if len(word) <= _WORD else f"{word[:_WORD]}..."


def _typed(yaml: Any, config_path: str, path: str) -> Any:
    """The values of a YAML on top of the settings of the backend that it names."""
    from wm.synth.registry import BackendError, backend_module  # here: only who selects a backend needs it

    defaults = yaml.pop("defaults", None)
    try:
        settings = OmegaConf.structured(backend_module(path).Settings)
        typed = OmegaConf.merge(settings, yaml)
    except BackendError as error:
        raise ConfigCompositionException(f"{config_path}.yaml: {error}") from error
    except OmegaConfBaseException as error:
        # no cause: `explain` would take the key, which is one of this file alone, for one of the whole configuration
        raise ConfigCompositionException(f"{config_path}.yaml: {one_line(str(error).splitlines()[0])}") from None
    if defaults is not None:
        with open_dict(typed):
            typed.defaults = defaults
    return typed


def _texts(tree: Any) -> Iterator[str]:
    """All texts among JSON-like values."""
    if isinstance(tree, str):
        yield tree
    for inner in tree.values() if isinstance(tree, dict) else tree if isinstance(tree, list) else ():
        yield from _texts(inner)


def _mark(record: Any, raw: Any, values: dict[str, str]) -> None:
    """Makes an EnvironmentText of every text of a record that comes out of the environment.

    Args:
      raw: the same tree before interpolation; a text where the whole of it is interpolated.
      values: of `environment_values`: a text that interpolates another key is known by them.
    """
    for field in fields(record):
        value, source = getattr(record, field.name), raw.get(field.name) if isinstance(raw, dict) else raw
        if is_dataclass(value):
            _mark(value, source, values)
        elif isinstance(value, list):
            sources = source if isinstance(source, list) else [source] * len(value)
            setattr(record, field.name, [_marked(inner, text, values) for inner, text in zip(value, sources)])
        else:
            setattr(record, field.name, _marked(value, source, values))


def _marked(value: Any, source: Any, values: dict[str, str]) -> Any:
    interpolated = isinstance(value, str) and isinstance(source, str) and "${" in source
    if interpolated and ("oc.env" in source or any(hidden in value for hidden in values)):
        return EnvironmentText(value, source)
    return value


def _unknown_keys(node: Any, prefix: str) -> Iterator[str]:
    record = OmegaConf.get_type(node)
    known = {field.name for field in fields(record)} if is_dataclass(record) else set()
    for name in map(str, node):
        if name not in known:
            yield f"{prefix}{name}"
        elif is_dataclass(OmegaConf.get_type(node, name)):
            yield from _unknown_keys(node[name], f"{prefix}{name}.")


def _unknown_key(key: str, composed: Any) -> str:
    return _unknown(key, OmegaConf.get_type(OmegaConf.select(composed, key.rpartition(".")[0]) if "." in key else composed))


def _unknown(key: str, record: Any) -> str:
    """What to say of a key that its record does not have."""
    prefix, _, name = key.rpartition(".")
    names = [field.name for field in fields(record)] if is_dataclass(record) else []
    guess = _guess(name, names, f"{prefix}{'.' * bool(prefix)}")
    return f"{key}: no such key; {guess}{prefix or 'the configuration'} has {', '.join(names) or 'no keys of its own'}"


def _guess(word: str, known: Sequence[str], prefix: str = "") -> str:
    """A question for a word that is close to a known one."""
    near = difflib.get_close_matches(word, known, n=1)
    return f"did you mean {prefix}{near[0]}? " if near else ""


def _unreadable(argument: str, reason: str) -> str:
    key, equals, value = argument.partition("=")
    quoting = f"; a text is quoted, within what the shell quotes: {key}={quoted(value)}" if equals else ""
    return one_line(f"cannot read the argument {argument!r}: {reason}{quoting}")


def _no_scene() -> str:
    return (
        f"no scene: type wm NAME or add +scene=NAME, one of {', '.join(options('scene'))}; or say what it should be: "
        'wm --theme "a snug cabin" --rooms "hall, kitchen, bedroom"'
    )


def _schema() -> Any:
    schema = OmegaConf.structured(RunConfig)
    schema.scene.theme = "???"  # there is no default scene: a run says what it wants
    schema.scene.name = "${wm.scene_name:${scene.theme}}"
    return schema


register()
