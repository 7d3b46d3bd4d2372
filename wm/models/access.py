"""What a backend needs from outside, touched only when it is used: a package of an extra, and a secret of the environment."""

import importlib
import os
from typing import Any

from wm.services.faults import MissingExtraError, MissingKeyError


def optional_module(name: str, extra: str) -> Any:
    """A module of a package that an extra of wm installs.

    Raises:
      MissingExtraError: it is not installed.
    """
    try:
        return importlib.import_module(name)
    except ModuleNotFoundError as error:
        missing = error.name or name
        raise MissingExtraError(f"{missing} is not installed: pip install 'wm[{extra}]'") from error


def secret(variable: str) -> str:
    """The value of an environment variable.

    Raises:
      MissingKeyError: it is not set, or empty, or has characters that no key has. Libraries would show it in their errors.
    """
    value = os.environ.get(variable, "").strip()
    if not value:
        raise MissingKeyError(f"the environment variable {variable} is not set; it holds the key of the service")
    if not (value.isascii() and value.isprintable()) or " " in value:
        raise MissingKeyError(
            f"the environment variable {variable} holds no key: it has a line break, a space or a character that no key has"
        )
    return value
