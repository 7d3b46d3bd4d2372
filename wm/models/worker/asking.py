"""A worker's answers through the run's services: kept like those of any other model, so that nothing is computed twice."""

import io
import json
import pathlib
import zipfile
from collections.abc import Mapping
from typing import Any

import numpy as np

from wm.artifacts.digests import content_digest
from wm.errors import InputError
from wm.models.worker.settings import WorkerSettings, interpreter, script_options, worker_script
from wm.models.worker.worker import ARRAYS, VALUES, ModelWorker, ServedModel, WorkerProgram
from wm.services.faults import ServiceError
from wm.services.records import Quote, ServiceAnswer, ServiceRequest
from wm.services.retries import with_retries
from wm.services.services import Services


class WorkerModel:
    """The model of one backend. Copies with other services (`with_services`) ask the same worker."""

    def __init__(self, settings: WorkerSettings, options: Mapping[str, Any], shipped: pathlib.Path | None = None):
        """The model that `settings` select. Nothing is started yet.

        Args:
          settings: interpreter, script, limits.
          options: what the script is told when it starts beside the options in the settings; JSON values. Every answer depends
            on them.
          shipped: the script that comes with the backend; None for none.

        Raises:
          InputError: there is no such script, no such interpreter, or `serves` is not a name and a version.
        """
        self.settings, self.options = settings, {**options, **script_options(settings)}
        self.script = worker_script(settings, shipped)
        self._own_script = "" if self.script == shipped else content_digest(self.script.read_bytes())
        self._declared = _declared(settings)
        if self._declared is None:
            interpreter(settings)  # said now and not after hours; kept answers need none
        self.services = Services()
        self._workers: list[ModelWorker] = []

    def with_services(self, services: Services) -> "WorkerModel":
        other = WorkerModel.__new__(WorkerModel)
        vars(other).update(vars(self))
        other.services = services
        return other

    def quote(self) -> Quote:
        """What a request costs: seconds that nobody knows beforehand, no money."""
        return self.services.quote(self._declared.model if self._declared else self.settings.backend, paid=False)

    def ask(self, request: Mapping[str, Any], arrays: Mapping[str, np.ndarray]) -> ServiceAnswer:
        """The kept or new answer to a request (`ModelWorker.ask`).

        Raises:
          RefusedError, ReplayError, ServiceError: see `Services.ask`.
        """
        served = self._declared or self._asked_served()
        told = {"version": served.version, "script": self._own_script, "options": self.options, "request": dict(request)}
        content = told | {f"array {name}": array for name, array in arrays.items()}
        asked = ServiceRequest(backend=self.settings.backend, model=served.model, content=content, paid=False)
        return self.services.ask(asked, lambda: self._sent(served, request, arrays))

    def close(self) -> None:
        """Ends the worker. Asking again starts a new one."""
        for worker in self._workers:
            worker.close()

    def _sent(self, served: ServedModel, request: Mapping[str, Any], arrays: Mapping[str, np.ndarray]) -> ServiceAnswer:
        worker = self._worker()
        found = worker.describe()
        if found != served:
            worker.close()
            raise InputError(
                f"{self.settings.backend}: serves='{served.model} {served.version}', and the worker serves "
                f"'{found.model} {found.version}'"
            )
        return worker.ask(request, arrays)

    def _asked_served(self) -> ServedModel:
        worker = self._worker()
        return with_retries(worker.describe, self.services.retries, self.settings.backend, waiting=self.services.say)

    def _worker(self) -> ModelWorker:
        if not self._workers:
            settings = self.settings
            program = WorkerProgram(
                python=interpreter(settings), script=self.script, options=self.options, start_seconds=settings.start_seconds,
                request_seconds=settings.request_seconds, log=settings.log,
            )  # fmt: skip
            self._workers.append(ModelWorker(program))
        return self._workers[0]


def answer_values(answer: ServiceAnswer) -> dict[str, Any]:
    """The JSON values of an answer by name."""
    return json.loads(answer.files[VALUES])


def answer_arrays(answer: ServiceAnswer) -> dict[str, np.ndarray]:
    """The arrays of an answer by name.

    Raises:
      ServiceError: their file cannot be read, or holds Python objects.
    """
    if ARRAYS not in answer.files:
        return {}
    try:
        with np.load(io.BytesIO(answer.files[ARRAYS]), allow_pickle=False) as held:
            return dict(held)
    except (ValueError, OSError, zipfile.BadZipFile) as error:
        raise ServiceError(f"the worker's {ARRAYS} cannot be read: {error}") from error


def _declared(settings: WorkerSettings) -> ServedModel | None:
    if not settings.serves:
        return None
    model, _, version = settings.serves.strip().rpartition(" ")
    if not model:
        raise InputError(f"{settings.backend}: serves={settings.serves!r} must be 'NAME VERSION', as the worker tells them")
    return ServedModel(model, version)
