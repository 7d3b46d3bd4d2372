"""The words of the command line: METHOD=PATH and key=value."""

import difflib
import pathlib
from collections.abc import Sequence
from dataclasses import dataclass, field

from wm.errors import InputError


@dataclass
class Words:
    """What was typed, sorted."""

    options: dict[str, str] = field(default_factory=dict)  # keys that the command knows
    methods: dict[str, pathlib.Path] = field(default_factory=dict)  # METHOD=PATH
    paths: list[pathlib.Path] = field(default_factory=list)  # words without "="

    def text(self, key: str, default: str) -> str:
        """An option, or what stands for it."""
        return self.options.get(key, default)

    def number(self, key: str, default: int, *, least: int = 0) -> int:
        """An option that is a whole number, or what stands for it.

        Raises:
          InputError: it is none, or smaller than `least`.
        """
        if key not in self.options:
            return default
        text = self.options[key]
        if not (text.isascii() and text.isdigit() and len(text) < 10 and int(text) >= least):
            raise InputError(f"{key}={text}: it wants a whole number of at least {least}")
        return int(text)


def sorted_words(words: Sequence[str], keys: Sequence[str]) -> Words:
    """Sorts what was typed by the keys that the command knows; other words with "=" are METHOD=PATH.

    Raises:
      InputError: a word is given twice, or a METHOD=PATH names nothing that is there; the message says what was perhaps meant.
    """
    found = Words()
    for word in words:
        name, sign, value = word.partition("=")
        if not sign:
            found.paths.append(pathlib.Path(word))
        elif name in found.options or name in found.methods:
            raise InputError(f"{name}= is given twice")
        elif name in keys:
            found.options[name] = value
        elif not name or not value or not pathlib.Path(value).exists():
            near = difflib.get_close_matches(name, keys, n=1)
            meant = f"did you mean {near[0]}=?" if near else f"keys are {', '.join(keys)}"
            raise InputError(f"{word}: no video or folder is there; {meant}")
        else:
            found.methods[name] = pathlib.Path(value)
    return found
