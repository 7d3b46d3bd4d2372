"""Which interpreter runs a model, which script serves it, and how long it may take."""

import dataclasses
import json
import os
import pathlib
import shlex
import shutil
from typing import Any

from wm.bounds import number, setting
from wm.errors import InputError
from wm.schema import BESIDE, BackendSettings


@dataclasses.dataclass(kw_only=True, unsafe_hash=True)
class WorkerSettings(BackendSettings):
    """What every backend has whose model lives in an interpreter of its own."""

    python: str = setting("", "Interpreter with the model's packages, such as /opt/conda/envs/NAME/bin/python.", **BESIDE)
    script: str = setting("", "Python file that serves the model (docs/workers.md); empty: the one that comes with the backend.")
    options: str = setting("", "More for the script, such as 'steps=25 device=cuda:1'.")
    serves: str = setting(
        "", "Name and version of the model, 'NAME VERSION', to find kept answers without starting it; empty: it is asked."
    )
    start_seconds: float = number(900.0, 0.1, 86400, "Time in which the model must be loaded.", unit="s", **BESIDE)
    request_seconds: float = number(600.0, 0.1, 86400, "Time in which a request must be answered.", unit="s", **BESIDE)
    log: str = setting("", "File to which what the worker prints is added; empty: only the last lines show, in errors.", **BESIDE)


def worker_script(settings: WorkerSettings, shipped: pathlib.Path | None) -> pathlib.Path:
    """The script to run: that of the settings, else the one that comes with the backend.

    Raises:
      InputError: there is neither, or no such file.
    """
    if settings.script:
        script = pathlib.Path(settings.script).expanduser().resolve()
    elif shipped is not None:
        script = shipped
    else:
        raise InputError(f"{settings.backend}: script=FILE must name the Python file that serves the model (docs/workers.md)")
    if not script.is_file():
        raise InputError(f"{settings.backend}: script={settings.script} is not there")
    return script


def interpreter(settings: WorkerSettings) -> str:
    """The path of the interpreter.

    Raises:
      InputError: none is named, or it cannot be run.
    """
    if not settings.python:
        raise InputError(
            f"{settings.backend}: python=PATH must name the interpreter that has the model's packages, such as "
            "/opt/conda/envs/NAME/bin/python; kept answers alone need only serves='NAME VERSION'"
        )
    found = shutil.which(os.path.expanduser(settings.python))
    if found is None:
        raise InputError(f"{settings.backend}: python={settings.python} is no program that can be run")
    return os.path.abspath(found)  # and not its real path: a virtual environment is told by the link


def script_options(settings: WorkerSettings) -> dict[str, Any]:
    """The options in the settings by name: JSON values, or text where a value reads as none.

    Raises:
      InputError: one is not of the form key=value.
    """
    options: dict[str, Any] = {}
    for word in shlex.split(settings.options):
        key, given, value = word.partition("=")
        if not (key and given):
            raise InputError(f"{settings.backend}: options={settings.options!r} must be 'key=value key=value'; {word!r} is not")
        options[key] = _value(value)
    return options


def _value(text: str) -> Any:
    try:
        return json.loads(text)
    except ValueError:
        return text
