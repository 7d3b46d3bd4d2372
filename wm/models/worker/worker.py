"""A model in another interpreter: its process is started when it is needed, and again when it has died or hangs.

    describe, load   an error of the script, or an exit, ends the run with one clear error: no retry installs a package
    answer           a process that died, hangs, or ran out of memory is ended, and the request may be sent again
                     (TransientError), _TRIES times in all; then, and for an error of the script at once, one clear error
                     (ServiceError)

Each error ends with the last lines that the process has printed.
"""

import dataclasses
import json
import pathlib
import threading
from collections.abc import Mapping
from typing import Any

import numpy as np

from wm.models.worker.process import EndedError, RunningWorker, SilentError
from wm.services.faults import ServiceError, TransientError
from wm.services.records import ServiceAnswer

_TRIES = 3
"""Processes in succession that may die or hang before that is taken to be the request's fault."""
VALUES, ARRAYS = "values.json", "arrays.npz"
"""Names of an answer's JSON values and arrays among its files."""


@dataclasses.dataclass(frozen=True)
class WorkerProgram:
    """What a worker runs, and its limits of time."""

    python: str  # path of the interpreter
    script: pathlib.Path
    options: Mapping[str, Any]  # for the script: JSON values
    start_seconds: float
    request_seconds: float
    log: str = ""  # file that what it prints is added to; empty for none


@dataclasses.dataclass(frozen=True)
class ServedModel:
    """The model that a worker says it serves."""

    model: str
    version: str


class ModelWorker:
    """A model in another interpreter. Several threads may ask; it answers one at a time."""

    def __init__(self, program: WorkerProgram):
        self.program = program
        self._running: RunningWorker | None = None
        self._loaded, self._failures = False, 0
        self._turn = threading.Lock()

    def describe(self) -> ServedModel:
        """The model and its version, by a process that has not loaded it yet.

        Raises:
          ServiceError: the script cannot be run.
          TransientError: the process was killed.
        """
        with self._turn:
            return self._described()

    def ask(self, request: Mapping[str, Any], arrays: Mapping[str, np.ndarray]) -> ServiceAnswer:
        """The answer to one request, its values and arrays among its files (VALUES, ARRAYS).

        Args:
          request: JSON values.
          arrays: by name.

        Raises:
          TransientError: the process died, hung, or ran out of memory.
          ServiceError: the script cannot be run, or it raised an error; the same process may answer other requests.
        """
        with self._turn:
            served = self._described()
            self._load()
            running = self._running
            assert running is not None
            try:
                name = running.folder.put(running.number, arrays)
                reply = self._call("answer", {"request": dict(request), "arrays": name}, self.program.request_seconds)
                files = self._files(reply)
            except OSError as error:
                raise self._gave_up(f"its files cannot be exchanged: {error}") from error
            self._failures = 0
        if "refused" in reply:
            return ServiceAnswer(refusal=str(reply["refused"]), model_version=served.version)
        return ServiceAnswer(files=files, model_version=served.version, usage={"requests": 1.0})

    def close(self) -> None:
        """Ends the process, and with it gives back the device's memory. Asking again starts a new one."""
        running, self._running, self._loaded = self._running, None, False
        if running is not None:
            running.close()

    def _described(self) -> ServedModel:
        if self._running is None:
            self._start()
        return self._served

    def _start(self) -> None:
        program = self.program
        try:
            self._running = RunningWorker(program.python, program.script, program.log)
        except OSError as error:
            raise self._gave_up(f"{program.python} cannot be started: {error}") from error
        reply = self._call("describe", {"options": dict(program.options)}, program.start_seconds)
        told = reply.get("done")
        model, version = (told.get(name) if isinstance(told, dict) else None for name in ("model", "version"))
        if not (isinstance(model, str) and isinstance(version, str) and model and version):
            raise self._gave_up(f'describe() gave {told!r}; {{"model": name, "version": text}} would be right')
        self._served = ServedModel(model, version)

    def _load(self) -> None:
        if not self._loaded:
            self._call("load", {}, self.program.start_seconds)
            self._loaded = True

    def _call(self, name: str, values: Mapping[str, Any], seconds: float) -> dict[str, Any]:
        """The reply of the running process, which ends with everything that is not a reply."""
        running = self._running
        assert running is not None
        try:
            reply = running.call(name, values, seconds=seconds)
        except (EndedError, SilentError) as fault:
            if isinstance(fault, EndedError) and not fault.by_signal and name != "answer":
                raise self._gave_up(f"{fault} in {name}()") from fault
            raise self._failed(f"{fault} in {name}()") from fault
        except BaseException:  # such as Ctrl-C: its reply would be taken for that to the next request
            self.close()
            raise
        if "exhausted" in reply:
            raise self._failed(f"{name}() ran out of memory: {reply['exhausted']}")
        if "error" in reply and name == "answer":
            self._failures = 0
            raise ServiceError(self._told(f"{name}() raised {reply['error']}"))
        if "error" in reply:
            raise self._gave_up(f"{name}() raised {reply['error']}")
        return reply

    def _files(self, reply: dict[str, Any]) -> dict[str, bytes]:
        running = self._running
        assert running is not None
        done = reply.get("done", {})
        try:
            files = running.folder.take(done.get("files", ()))
        except ValueError as error:
            raise self._gave_up(str(error)) from error
        return {VALUES: json.dumps(done.get("values", {})).encode(), **files}

    def _failed(self, fault: str) -> Exception:
        """Ends the process. The error of a fault that a new process may not have, until it has had it too often."""
        self._failures += 1
        if self._failures >= _TRIES:
            return self._gave_up(f"{fault}, {self._failures} times in succession")
        error = TransientError(self._told(fault))
        self.close()
        return error

    def _gave_up(self, fault: str) -> ServiceError:
        """Ends the process. The error of a fault that a new process would have too."""
        error = ServiceError(self._told(fault))
        self._failures = 0
        self.close()
        return error

    def _told(self, fault: str) -> str:
        printed = self._running.printed() if self._running is not None else ""
        last = f"; it printed last{printed}" if printed else ""
        return f"the worker {self.program.script.name} of {self.program.python}: {fault}{last}"
