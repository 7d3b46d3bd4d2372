"""Words of a command line such as `RUN to=[navmesh,world] output=FOLDER`: one folder, and keys with their values."""

from collections.abc import Mapping, Sequence
from pathlib import Path

from wm.errors import InputError


class WordsError(InputError):
    """A word that a command does not know; the message says what would be right."""


def run_and_words(arguments: Sequence[str], keys: Mapping[str, str]) -> tuple[Path, dict[str, str]]:
    """The run folder and the values by key.

    Args:
      arguments: as typed.
      keys: the keys that the command knows, and what each is for.

    Raises:
      WordsError: no folder or more than one is given, or a key is unknown or given twice.
    """
    folders, told = [], {}
    for word in arguments:
        key, sign, value = word.partition("=")
        if not sign or Path(word).exists():
            folders.append(word)
        elif key not in keys:
            raise WordsError(f"there is no key {key!r}; keys are {', '.join(keys)}")
        elif key in told:
            raise WordsError(f"{key} is given twice")
        else:
            told[key] = value
    if len(folders) != 1 or folders[0].startswith("-"):
        given = " and ".join(map(repr, folders)) if folders else "nothing"
        raise WordsError(f"give the folder of one run, such as outputs/gothic/full/0; {given} was given")
    return Path(folders[0]), told


def listed(value: str) -> list[str]:
    """The names in a value such as `[glb,usd]` or `glb,usd`, each once, in the order given."""
    inside = value.strip().removeprefix("[").removesuffix("]")
    return list(dict.fromkeys(name for part in inside.split(",") if (name := part.strip().strip("'\""))))


def help_text(usage: str, says: str, keys: Mapping[str, str]) -> str:
    """What --help prints."""
    width = max(len(key) for key in keys)
    return "\n".join([f"usage: {usage}", "", says, "", *(f"  {key:<{width}}  {what}" for key, what in keys.items())])
