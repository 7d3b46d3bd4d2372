"""What `wm --help` and `wm --version` say: every key with its meaning, unit and range, as the fields themselves declare them.

    wm --help                    all of it
    wm --help fit                one group; `wm --help fit.steps` one key; `wm --help variant` what can be chosen
    wm --help image=like_closed  the keys of a backend that is not the default
    wm --completion bash         the script that completes names, flags and keys at TAB

It loads nothing heavy (wm.cli.keys).
"""

import dataclasses
import difflib
import re
import shutil
import textwrap
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import wm
from wm.cli.command_line import FLAGS, OWN_ANSWERS
from wm.cli.completion import completion
from wm.cli.keys import Choices, Section, choices_of, default_choices, sections_of
from wm.validate import ConfigError

_COLUMN = 34
_EXAMPLES = """\
wm gothic                                       a scene by its name
wm gothic preset=draft seed=1                   faster and coarser; another house
wm --theme "a children's library, bright" --rooms "hall, kitchen, bedroom"
wm gothic --plan my.json --output mine          a floor plan of your own; a folder of your own
wm -m gothic variant=full,depth_only            one run for each, in a row
wm --help fit | fit.steps | variant | gothic    a group, a key, what can be chosen, one choice
"""
_CLOSING = """\
The run folder is outputs/<scene>/<variant>/<seed>/; the same command resumes a stopped run. debug=true shows tracebacks.
--cfg job prints the composed configuration, --config-dir FOLDER adds YAML files of your own, --hydra-help lists Hydra's flags.
Completion at TAB: eval "$(wm --completion bash)" in ~/.bashrc."""


def asks_for_help(arguments: Sequence[str]) -> bool:
    """Whether the command line wants an answer, and no run."""
    return not set(OWN_ANSWERS).isdisjoint(arguments)


def answer(arguments: Sequence[str], conf: Path) -> str:
    """The text that the command line asks for.

    Args:
      arguments: of the command line, with one of OWN_ANSWERS among them.
      conf: the configuration tree of the package.

    Raises:
      ConfigError: there is no such group, key or choice.
      BackendError: a chosen backend cannot be imported, where its source does not say its settings.
    """
    if "--version" in arguments:
        return f"wm {wm.__version__}"
    topics, chosen, extra = _asked(arguments)
    folders = [conf, *extra]
    choices = choices_of(folders)
    if any(group in choices and name not in choices[group] for group, name in chosen.items()):
        raise ConfigError(_unknown_choice(chosen, choices))
    chosen = {**default_choices(conf), **chosen}
    sections = list(sections_of(chosen, choices))
    if "--completion" in arguments:
        return completion(topics, sections, choices)
    if topics:
        return "\n\n".join(_of_topic(topic, sections, choices, chosen) for topic in topics)
    parts = [_opening(), *(_of_group(group, choices[group]) for group in choices), *map(_of_section, sections), _CLOSING]
    return "\n\n".join(parts)


def _asked(arguments: Sequence[str]) -> tuple[list[str], dict[str, str], list[Path]]:
    """The topics, the choices GROUP=NAME, and the folders of --config-dir that a command line names."""
    topics, chosen, folders = [], {}, []
    rest = list(arguments)
    while rest:
        argument, equals, value = rest.pop(0).partition("=")
        if argument in ("--config-dir", "-cd"):
            folders.append(Path(value if equals or not rest else rest.pop(0)))
        elif argument in FLAGS:
            topics.append(FLAGS[argument].key)
        elif equals:
            topics.append(argument.lstrip("+"))
            chosen[argument.lstrip("+")] = value
        elif not argument.startswith("-"):
            topics.append(argument)
    return list(dict.fromkeys(topics)), chosen, folders


def _of_topic(topic: str, sections: Sequence[Section], choices: Choices, chosen: Mapping[str, str]) -> str:
    name, _, key = topic.partition(".")
    section = next((section for section in sections if section.name == name), None)
    own = sections[0].keys
    parts = []
    if not key and name in choices:
        parts.append(_of_group(name, choices[name]))
    if section and not key:
        parts.append(_of_section(section))
    elif section and key in section.keys:
        parts.append(_of_key(section, key))
    elif not key and name in own:
        parts.append(_of_key(sections[0], name))
    elif not section and not key:
        parts += [f"{group}={name}\n{_file(files[name])}" for group, files in choices.items() if name in files]
    if not parts:
        raise ConfigError(_of_another(topic, choices, chosen) or _unknown_topic(topic, sections, choices))
    return "\n\n".join(parts)


def _opening() -> str:
    flags = [_line(f"{name} {flag.value}", f"{flag.help} Short for {flag.key}=") for name, flag in FLAGS.items()]
    flags += [_line("-m", "A sweep: values with commas between are a run each."), _line("--version", "The version of wm.")]
    examples = textwrap.indent(_EXAMPLES, "  ")
    return f"wm: a theme in words becomes a navigable multi-room 3D scene.\n\n{examples}\nFlags\n" + "\n".join(flags)


def _of_group(group: str, files: Mapping[str, Path]) -> str:
    title = "scene: wm NAME, or +scene=NAME" if group == "scene" else f"{group}: choose with {group}=NAME"
    return "\n".join([title, *(_line(name, _summary(path)) for name, path in files.items())])


def _of_section(section: Section) -> str:
    return "\n".join([section.title, *(_of_key(section, key) for key in section.keys)])


def _of_key(section: Section, key: str) -> str:
    field = section.keys[key]
    meaning = field.metadata.get("help", "")
    name = f"{section.name}.{key}" if section.name else key
    value = f"={_written(section.defaults[key])}" if section.defaults else ""
    return _line(f"{name}{value}", f"{meaning} [{_values(field)}]")


def _values(field: Any) -> str:
    """What a field may hold, in words."""
    bounds, options, unit = (field.metadata.get(name) for name in ("bounds", "options", "unit"))
    if options:
        return " | ".join(options)
    if bounds is not None:
        interval, comma, null = bounds.span.partition(", ")
        return "integer, " * bounds.whole + interval + (f" {unit}" if unit else "") + comma + null
    if isinstance(field.default, bool):
        return "true | false"
    return "list of names" if field.default is dataclasses.MISSING else "text"


def _written(value: Any) -> str:
    """A value as the command line takes it."""
    if value is None or isinstance(value, bool):
        return {None: "null", True: "true", False: "false"}[value]
    return f"{value:g}" if isinstance(value, float) else str(value)


def _line(left: str, right: str) -> str:
    """Two columns, the right one wrapped to the terminal."""
    width = max(60, min(shutil.get_terminal_size((120, 24)).columns, 130))
    lines = textwrap.wrap(right, width - _COLUMN - 2) or [""]
    head = [f"  {left}"] if len(left) >= _COLUMN else []
    first = " " * (_COLUMN + 2) if head else f"  {left}".ljust(_COLUMN + 2)
    return "\n".join([*head, *((first + lines[0]).rstrip(), *(" " * (_COLUMN + 2) + line for line in lines[1:]))])


def _summary(path: Path) -> str:
    """What a YAML says of itself: its theme, or the first sentence of the comment that opens it."""
    text = path.read_text("utf-8")
    if theme := re.search(r"^theme: *(.+)$", text, re.MULTILINE):
        return theme[1]
    lines = (line.lstrip("# ") for line in text.splitlines() if line.startswith("# ") and not line.startswith("# @"))
    return re.split(r"(?<=[.]) ", " ".join(lines), maxsplit=1)[0].removesuffix(".")


def _file(path: Path) -> str:
    return textwrap.indent(path.read_text("utf-8").rstrip(), "  ")


def _unknown_choice(chosen: Mapping[str, str], choices: Choices) -> str:
    group, name = next((group, name) for group, name in chosen.items() if group in choices and name not in choices[group])
    return f"{group}={name}: no such {group}; {_guess(name, choices[group])}choose one of {', '.join(choices[group])}"


def _of_another(topic: str, choices: Choices, chosen: Mapping[str, str]) -> str:
    """What to say of a key that only backends which are not chosen have; "" if none has it."""
    group, _, key = topic.partition(".")
    has = [
        name
        for name in choices.get(group, ())
        if any(section.name == group and key in section.keys for section in sections_of({**chosen, group: name}, choices))
    ]
    return f"{topic} is a key of {group}={', '.join(has)}; wm --help {topic} {group}={has[0]} explains it" if has else ""


def _unknown_topic(topic: str, sections: Sequence[Section], choices: Choices) -> str:
    keys = [f"{section.name}.{key}".lstrip(".") for section in sections for key in section.keys]
    groups = [*(section.name for section in sections if section.name), *choices]
    names = [name for files in choices.values() for name in files]
    known = dict.fromkeys([*groups, *keys, *names])
    return f"{topic}: no such group, key or choice; {_guess(topic, known)}groups are {', '.join(dict.fromkeys(groups))}"


def _guess(word: str, known: Any) -> str:
    near = difflib.get_close_matches(word, list(known), n=1)
    return f"did you mean {near[0]}? " if near else ""
