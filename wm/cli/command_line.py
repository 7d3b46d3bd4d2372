"""What people type, as the overrides that Hydra reads: a scene by its name, flags, and text as it stands.

    wm gothic                                            +scene=gothic
    wm --theme "a children's library, bright"            scene.theme='a children\\'s library, bright'
    wm 'scene.theme=a children'"'"'s library, bright'    the same
    wm --rooms "hall, kitchen"                           scene.rooms=['hall','kitchen']

Hydra's grammar gives commas, quotes and brackets a meaning of their own. In a few keys they are text here, because whoever typed
them has quoted them for the shell already:

- `scene.theme` is text, also its commas in a sweep. Hydra reads it where it is one quoted string ('...' or "..."), a function
  that makes a sweep (choice(...), shuffle(...), sort(...), tag(...)) or, in a sweep, quoted strings with commas between. Each
  ${...} stays an interpolation.
- `scene.rooms` is a list, with brackets or without. Its names are text between commas; a name that is one quoted string is read
  by Hydra. In a sweep [...],[...] and the functions above stay as they are.
- `output`, `plan.file` and other keys of files are text where Hydra cannot read them (`my plan (2).json`, `maison-d'été`), but
  for null, quoted strings, the functions above and, in a sweep, values with commas between.

After a flag everything is text; only `--output` and `--plan` keep ${...}, which names a folder for each run of a sweep. All other
arguments are Hydra's. Standard library only.
"""

import difflib
import hashlib
import re
import unicodedata
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, fields

from wm.schema import RunConfig
from wm.validate import ConfigError

_NAME_LENGTH = 48
_QUOTED = r"""(?:'(?:[^'\\]|\\.)*'|"(?:[^"\\]|\\.)*")"""
_QUOTED_LIST = rf"{_QUOTED}(?:\s*,\s*{_QUOTED})+"
_FUNCTION = r"(?:choice|shuffle|sort|tag)\(.*\)"
_INTERPOLATION = r"\$\{[^${}]+(?:\$\{[^${}]+\}[^${}]*)*\}"
_LISTS = r"\[.*\](?:\s*,\s*\[.*\])+"
_ELEMENT = re.compile(rf"\s*(?:(?P<quoted>{_QUOTED})\s*(?=,|\Z)|(?P<text>[^,]*))(?:,|\Z)", re.DOTALL)
_OVERRIDE = re.compile(r"(?P<key>\+{0,2}(?P<name>scene\.theme|scene\.rooms|output|\w+\.file))=(?P<value>.*)", re.DOTALL)


@dataclass(frozen=True)
class Flag:
    """A flag that stands for a key."""

    key: str
    value: str
    """What it wants, in a word."""
    help: str


FLAGS: Mapping[str, Flag] = {
    "--theme": Flag("scene.theme", "TEXT", "What the scene should be, in words."),
    "--rooms": Flag("scene.rooms", "LIST", 'Its rooms, with commas between: "hall, kitchen, bedroom".'),
    "--name": Flag("scene.name", "NAME", "Its name, and that of its folder; without one, the words of the theme."),
    "--seed": Flag("seed", "NUMBER", "Another number, another house."),
    "--preset": Flag("preset", "NAME", "How fine and how long: draft, standard or paper."),
    "--output": Flag("output", "FOLDER", "The run folder; without one, outputs/<scene>/<variant>/<seed>."),
    "--plan": Flag("plan.file", "FILE", "A floor plan of your own."),
}

_SHOWN = ("all", "config", "defaults", "defaults-tree", "plugins", "searchpath")
HYDRA_FLAGS: Mapping[str, tuple[str, ...] | None] = {
    **dict.fromkeys(("--hydra-help", "--resolve", "--run", "-r", "--multirun", "-m", "--shell-completion", "-sc"), None),
    **dict.fromkeys(("--package", "-p", "--config-path", "-cp", "--config-name", "-cn", "--config-dir", "-cd"), ()),
    **dict.fromkeys(("--cfg", "-c"), ("job", "hydra", "all")),
    **dict.fromkeys(("--info", "-i"), _SHOWN),
    "--experimental-rerun": (),
}
"""Hydra's own flags, and the values of each: None where it has none, empty where any will do. `--info` may also stand alone."""

_MODES = ("--run", "-r", "--multirun", "-m", "--cfg", "-c", "--info", "-i", "--shell-completion", "-sc")
OWN_ANSWERS = ("--help", "-h", "--version", "--completion")
"""Flags that are answered without a run (wm.cli.help)."""


def translated(arguments: Sequence[str]) -> list[str]:
    """The arguments as Hydra reads them: overrides, and after them Hydra's own flags, since its parser wants overrides in a row.

    Raises:
      ConfigError: a flag that is unknown or lacks its value, or a word that is no scene's name.
    """
    sweep = not {"-m", "--multirun"}.isdisjoint(arguments)
    scene = ""
    overrides: list[str] = []
    flags: list[str] = []
    rest = list(arguments)
    while rest:
        argument = rest.pop(0)
        flag, equals, value = argument.partition("=")
        if flag in FLAGS:
            overrides.append(_of_flag(flag, value if equals else _next_value(flag, rest)))
        elif flag in HYDRA_FLAGS:
            flags += _of_hydras_flag(argument, rest)
        elif argument.startswith("-"):
            raise ConfigError(_unknown_flag(flag))
        elif equals or argument.startswith("~"):
            overrides.append(_of_override(argument, sweep))
        else:
            overrides.append(_of_word(argument, scene))
            scene = argument
    if len(modes := [flag for flag in flags if flag.partition("=")[0] in _MODES]) > 1:
        raise ConfigError(f"{' and '.join(modes)} ask for different things; one of them at a time")
    return [*overrides, *flags]


def scene_name(theme: str) -> str:
    """The name of a scene that has none: the words of its theme in a-z, 0-9 and '_', cut between words; never empty.

    A theme that has none of these letters, such as one in Japanese, gets a number of its own.
    """
    plain = unicodedata.normalize("NFKD", theme.casefold()).encode("ascii", "ignore").decode()
    words = re.findall(r"[a-z0-9]+", plain.replace("'", ""))
    name = ""
    for word in words:
        if name and len(name) + 1 + len(word) > _NAME_LENGTH:
            break
        name = f"{name}_{word}".strip("_")[:_NAME_LENGTH]
    return name or f"theme_{hashlib.sha256(theme.encode('utf-8', 'replace')).hexdigest()[:8]}"


def quoted(text: str) -> str:
    """Text as a string in Hydra's grammar, whose ${...} OmegaConf resolves."""
    escaped = re.sub(r"(\\*)'", r"\1\1\\'", text)
    return "'" + re.sub(r"(\\+)\Z", r"\1\1", escaped) + "'"


def literal(text: str) -> str:
    """Text as a string in Hydra's grammar that arrives as it stands, ${ included."""
    return quoted(re.sub(r"(\\*)\$\{", r"\1\1\\${", text))


def _of_flag(flag: str, value: str) -> str:
    key = FLAGS[flag].key
    if flag == "--rooms":
        return f"{key}=[{','.join(literal(name.strip()) for name in value.split(',') if name.strip())}]"
    if flag in ("--output", "--plan"):
        return f"{key}={quoted(value)}"
    return f"{key}={literal(value) if flag in ('--theme', '--name') else value}"


def _of_hydras_flag(argument: str, rest: list[str]) -> list[str]:
    """A flag of Hydra's with the value that it takes from the rest."""
    flag, equals, value = argument.partition("=")
    values = HYDRA_FLAGS[flag]
    if values is None or (flag in ("--info", "-i") and not equals and rest[:1] not in [[name] for name in values]):
        return [argument]
    value = value if equals else _next_value(flag, rest)
    if values and value not in values:
        raise ConfigError(f"{flag} {value}: choose one of {', '.join(values)}")
    return [argument] if equals else [flag, value]


def _next_value(flag: str, rest: list[str]) -> str:
    if not rest or rest[0].partition("=")[0] in (*FLAGS, *HYDRA_FLAGS, *OWN_ANSWERS):
        raise ConfigError(f"{flag} lacks its value: write {flag} {FLAGS[flag].value if flag in FLAGS else 'VALUE'}")
    return rest.pop(0)


def _of_override(argument: str, sweep: bool) -> str:
    match = _OVERRIDE.fullmatch(argument)
    if match is None:
        return argument
    value = {"scene.theme": _words, "scene.rooms": _rooms}.get(match["name"], _path)(match["value"], sweep)
    return f"{match['key']}={value}"


def _words(value: str, sweep: bool) -> str:
    forms = (_QUOTED, _FUNCTION, *([_QUOTED_LIST] if sweep else []))
    return value if _is(value, *forms) else _text(value)


def _rooms(value: str, sweep: bool) -> str:
    value = value.strip()
    if _is(value, _FUNCTION, _INTERPOLATION, *([_LISTS] if sweep else [])):
        return value
    inside = value[1:-1] if value.startswith("[") and value.endswith("]") else value
    return f"[{','.join(_elements(inside))}]"


def _path(value: str, sweep: bool) -> str:
    readable = re.fullmatch(r"[\w/\\.+$%*@?|: -]*", re.sub(_INTERPOLATION, "", value), re.ASCII)
    swept = sweep and "," in value
    return value if readable or swept or _is(value, _QUOTED, _FUNCTION) else _text(value)


def _elements(inside: str) -> Iterator[str]:
    for match in _ELEMENT.finditer(inside):
        if match["quoted"] is not None:
            yield match["quoted"]
        elif match["text"].strip():
            yield _text(match["text"].strip())


def _text(value: str) -> str:
    """Text in Hydra's grammar, in which whole ${...} stay interpolations."""
    return quoted(value) if re.search(_INTERPOLATION, value) else literal(value)


def _is(value: str, *forms: str) -> bool:
    return any(re.fullmatch(rf"\s*{form}\s*", value, re.DOTALL) for form in forms)


def _of_word(word: str, scene: str) -> str:
    """A word without '=': the name of a scene, or of several for a sweep."""
    if word.partition(".")[0] in {field.name for field in fields(RunConfig)} - {"scene"}:
        raise ConfigError(f"{word}: write {word}=VALUE; `wm --help {word}` says what it may be")
    if scene:
        raise ConfigError(
            f"{word!r}: the scene is {scene!r} already; settings are KEY=VALUE, and a text of several words is quoted, as in "
            '--theme "a snug cabin"'
        )
    if not re.fullmatch(r"[\w./-]+(,[\w./-]+)*", word, re.ASCII):
        raise ConfigError(f'{word!r}: no name of a scene; a theme in words is --theme "a snug cabin" --rooms "hall, kitchen"')
    return f"+scene={word}"


def _unknown_flag(flag: str) -> str:
    known = [*FLAGS, *(name for name in (*HYDRA_FLAGS, *OWN_ANSWERS) if name.startswith("--"))]
    near = difflib.get_close_matches(flag, known, n=1)
    guess = f"did you mean {near[0]}? " if near else ""
    return f"{flag}: no such flag; {guess}flags are {', '.join(FLAGS)}, and -m for a sweep; all else is KEY=VALUE (wm --help)"
