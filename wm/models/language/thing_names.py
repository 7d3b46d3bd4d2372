"""The names of things in a model's answer: short nouns, each once, as a segmentation model that takes text wants them."""

import json
import re
from collections.abc import Iterator
from typing import Any

MOST_THINGS = 30
"""Names that are kept of an answer. A segmentation model looks at an image once for each."""
_MOST_WORDS = 5
_MOST_LETTERS = 40
"""Names of more words or letters are left out: SAM 3 reads 32 tokens of a name, and one letter may be a token of its own there,
less the two that begin and end it; longer ones are sentences."""


class ThingNamesError(ValueError):
    """An answer holds no list of names."""


def things_schema() -> dict[str, Any]:
    """The JSON schema of the answer."""
    names = {"type": "array", "items": {"type": "string"}}
    return {"type": "object", "properties": {"things": names}, "required": ["things"], "additionalProperties": False}


def thing_names(text: str) -> list[str]:
    """The names in an answer, in its order, in lower case, each once; whatever is no short name is left out.

    Args:
      text: JSON as `things_schema` has it, or just the list, whatever is written around it.

    Raises:
      ThingNamesError: there is no such JSON in it.
    """
    for value in _values(text):
        listed = value.get("things") if isinstance(value, dict) else value
        if isinstance(listed, list):
            names = [" ".join(name.lower().replace("_", " ").split()) for name in listed if isinstance(name, str)]
            return list(dict.fromkeys(name for name in names if _is_short_name(name)))[:MOST_THINGS]
    raise ThingNamesError("the answer holds no list of names")


def _values(text: str) -> Iterator[Any]:
    """The JSON values that begin at a bracket and do not lie within another."""
    decoder, end = json.JSONDecoder(), 0
    for match in re.finditer(r"[{\[]", text):
        if match.start() >= end:
            try:
                value, end = decoder.raw_decode(text, match.start())
            except (json.JSONDecodeError, RecursionError):
                continue
            yield value


def _is_short_name(name: str) -> bool:
    return 0 < len(name) <= _MOST_LETTERS and len(name.split()) <= _MOST_WORDS and name.isprintable() and name[0].isalnum()
