"""Texts of the configuration that come out of the environment (`${oc.env:NAME}`), such as keys of services.

They are used as they are and shown as where they come from: a manifest, a report or a message never holds one.
"""

import hashlib
import os
import re
from collections.abc import Iterable
from typing import Any

_NAMES = re.compile(r"oc\.env:\s*['\"]?([A-Za-z_][A-Za-z0-9_]*)")
_SHORTEST = 4
"""Shorter texts are replaced in a message only where they stand in quotes: they may be part of any word."""


class EnvironmentText(str):
    """A text, and where in the environment it comes from. Its `repr`, as messages show it, is the latter."""

    source: str

    def __new__(cls, value: str, source: str) -> "EnvironmentText":
        text = super().__new__(cls, value)
        text.source = source
        return text

    def __repr__(self) -> str:
        return repr(self.source)

    def __reduce__(self) -> tuple:
        return EnvironmentText, (str(self), self.source)


def environment_values(texts: Iterable[str]) -> dict[str, str]:
    """The values of the environment's variables that these texts interpolate, each with what stands for it."""
    names = {name for text in texts for name in _NAMES.findall(text)}
    return {value: f"${{oc.env:{name}}}" for name in sorted(names) if (value := os.environ.get(name))}


def masked(message: str, values: dict[str, str]) -> str:
    """A message in which values of `environment_values` are replaced by what stands for them."""
    for value in sorted(values, key=len, reverse=True):
        source = values[value]
        message = message.replace(value, source) if len(value) >= _SHORTEST else message.replace(f"'{value}'", f"'{source}'")
    return message


def shown(text: str) -> str:
    """A text as a reader may see it."""
    return text.source if isinstance(text, EnvironmentText) else text


def shown_identity(value: Any) -> Any:
    """JSON-like values as a manifest may hold them: a text out of the environment is named by its source, and by 4 hex digits of
    its digest, which tell that it has changed and are too few to find it by guessing."""
    if isinstance(value, EnvironmentText):
        return f"{value.source} ({hashlib.sha256(str(value).encode()).hexdigest()[:4]})"
    if isinstance(value, dict):
        return {key: shown_identity(inner) for key, inner in value.items()}
    return [shown_identity(inner) for inner in value] if isinstance(value, list | tuple) else value
