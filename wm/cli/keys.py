"""Every key and choice of a run, as the fields and the YAML files themselves declare them.

The keys of a backend are read from its source, and from the YAML that chooses it: importing it would load JAX, and help and
completion should be there at once. Only a backend whose settings cannot be read so is imported.
"""

import ast
import dataclasses
import importlib.util
import re
from collections.abc import Iterator, Mapping, Sequence
from importlib.machinery import PathFinder
from pathlib import Path
from typing import Any

from wm import schema
from wm.bounds import choice, number, setting
from wm.schema import BackendSettings, RunConfig

Choices = Mapping[str, Mapping[str, Path]]
"""The YAML files of conf/: group, name, path."""

_FACTORIES = {"choice": choice, "number": number, "setting": setting}


@dataclasses.dataclass(frozen=True)
class Section:
    """The keys of one group."""

    name: str
    """What its keys begin with; empty for those of the run itself."""
    title: str
    keys: Mapping[str, dataclasses.Field[Any]]
    defaults: Mapping[str, Any]
    """The values of its keys where nothing else is said; none of a scene's, since there is no default scene."""


def choices_of(folders: Sequence[Path]) -> Choices:
    """The files of each group in these configuration trees, scenes first."""
    found: dict[str, dict[str, Path]] = {"scene": {}}
    for path in sorted(path for folder in folders for path in folder.glob("*/*.yaml")):
        found.setdefault(path.parent.name, {})[path.stem] = path
    return found


def default_choices(conf: Path) -> dict[str, str]:
    """What config.yaml chooses of each group."""
    lines = (conf / "config.yaml").read_text("utf-8")
    return dict(re.findall(r"^ +- (\w+): (\w+)", lines, re.MULTILINE))


def sections_of(chosen: Mapping[str, str], choices: Choices) -> Iterator[Section]:
    """All keys of a run: those without a group first, then the groups in the order of RunConfig.

    Args:
      chosen: one name for each group of backends.

    Raises:
      BackendError: a chosen backend cannot be imported, where its source does not say its settings.
    """
    run = {field.name: field for field in dataclasses.fields(RunConfig)}
    plain = {name: field for name, field in run.items() if not _is_group(field)}
    defaults = dataclasses.asdict(RunConfig())
    yield Section("", "The run as a whole", plain, {name: defaults[name] for name in plain})
    for name, field in run.items():
        if name not in plain and isinstance(field.default_factory, type):
            backend = issubclass(field.default_factory, BackendSettings)
            file = choices[name][chosen[name]] if backend else None
            yield _of_backend(name, chosen[name], file) if file else _of_record(name, field.default_factory)


def _is_group(field: dataclasses.Field[Any]) -> bool:
    """Whether a field holds keys of its own; a list of names does not."""
    return field.default is dataclasses.MISSING and field.default_factory is not list


def _of_record(name: str, record: type) -> Section:
    keys = {field.name: field for field in dataclasses.fields(record)}
    title = (record.__doc__ or "").partition("\n")[0].rstrip(".")
    written = "" if title.startswith(f"{record.__name__}(") else title  # dataclasses put their own where there is none
    defaults = {} if name == "scene" else {key: getattr(record(), key) for key in keys}
    return Section(name, f"{name}: {written}".removesuffix(": "), keys, defaults)


def _of_backend(group: str, name: str, path: Path) -> Section:
    """The keys of a backend with the values of the YAML that chooses it."""
    said = dict(re.findall(r"^(\w+): *([^#\n]*?) *(?:#.*)?$", path.read_text("utf-8"), re.MULTILINE))
    title, keys = _declared(said["backend"]) if "backend" in said else ("", {})
    defaults = {key: _value(said[key]) if key in said else field.default for key, field in keys.items()}
    return Section(group, f"{group}={name}: {title}", keys, defaults)


def _value(text: str) -> str | bool | None:
    """What a scalar of YAML says, as help shows it: without quotes, None for null; numbers stay as they are written."""
    named: dict[str, bool | None] = {"null": None, "true": True, "false": False}
    return named[text] if text in named else text.strip("\"'")


def _declared(path: str) -> tuple[str, dict[str, dataclasses.Field[Any]]]:
    """What the Settings of a backend's module say of themselves, and their fields but for the path."""
    try:
        tree = ast.parse(_source(path))
        settings = next(node for node in tree.body if isinstance(node, ast.ClassDef) and node.name == "Settings")
        title, keys = ast.get_docstring(settings), _inherited(settings) | dict(_literal_fields(settings))
    except (OSError, SyntaxError, ValueError, TypeError, KeyError, AttributeError, StopIteration):
        from wm.synth.registry import backend_module  # here: it loads JAX

        record = backend_module(path).Settings
        title, keys = record.__doc__, {field.name: field for field in dataclasses.fields(record)}
    return (title or "").partition("\n")[0].rstrip("."), {name: field for name, field in keys.items() if name != "backend"}


def _inherited(settings: ast.ClassDef) -> dict[str, dataclasses.Field[Any]]:
    """The fields that a record of settings has from the record of wm.schema that it extends. Raises: AttributeError, KeyError."""
    (base,) = settings.bases
    return {field.name: field for field in dataclasses.fields(vars(schema)[ast.unparse(base).rpartition(".")[2]])}


def _source(path: str) -> str:
    """The source of a module, found without importing its packages. Raises: OSError, AttributeError."""
    root, *below = path.split(".")
    spec = importlib.util.find_spec(root)
    for name in below:
        if spec is None or spec.submodule_search_locations is None:
            break
        spec = PathFinder.find_spec(f"{spec.name}.{name}", spec.submodule_search_locations)
    if spec is None or spec.origin is None or spec.name != path:
        raise OSError(f"no source of {path}")
    return Path(spec.origin).read_text("utf-8")


def _literal_fields(settings: ast.ClassDef) -> Iterator[tuple[str, Any]]:
    """The fields of a record that are declared by wm.bounds in literals. Raises: ValueError, KeyError, AttributeError."""
    for node in settings.body:
        if isinstance(node, ast.AnnAssign) and isinstance(node.target, ast.Name) and node.target.id != "backend":
            call: Any = node.value
            words = {word.arg: ast.literal_eval(word.value) for word in call.keywords if word.arg}
            yield node.target.id, _FACTORIES[call.func.id](*map(ast.literal_eval, call.args), **words)
