"""The libraries of the extra `simulation`, imported when they are needed."""

import importlib
from typing import Any

from wm.export.records import ExportError


def library(name: str) -> Any:
    """A module by its dotted name.

    Raises:
      ExportError: it is not installed.
    """
    try:
        return importlib.import_module(name)
    except ModuleNotFoundError as error:
        needed = "MJCF, URDF and OpenUSD need packages of their own: pip install -e '.[simulation]'"
        raise ExportError(f"{name.partition('.')[0]} is not installed; {needed}") from error
