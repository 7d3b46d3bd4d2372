"""Rooms fitted in processes of their own, a core each.

XLA runs all programs of a process on one pool of threads, and Python all that is between them under one lock, which two rooms
hardly notice (experiments/splat_speed) and many cores may. So a worker (wm.process), held to one core, is given a room at a time,
with all that its fit reads. After every step it tells its caller, and waits to be told to go on, to hand over its state, or to
end: the caller alone counts, stores, and hears Ctrl-C. The bytes are those of a fit here.
"""

import contextlib
import dataclasses
import os
import tempfile
import threading
from collections.abc import Callable, Iterator
from multiprocessing.connection import Connection
from typing import Any

import jax

from wm.process import WorkerProcess, portable
from wm.splat.optimization.padding import Capacity
from wm.splat.optimization.room_fit import Interrupted
from wm.splat.optimization.room_state import RoomState
from wm.splat.scene.room_task import Here, Keep, Report, RoomTask

_GO_ON, _STATE, _END = "go on", "state", "end"
"""What a worker is told after a step."""


class WorkerClosed(Exception):
    """A worker was closed while it fitted a room, or before."""


@dataclasses.dataclass(frozen=True)
class _Stepped:
    """A step was taken: what `Report` is called with; or None: it is time for `Keep`."""

    report: tuple[int, dict] | None


@dataclasses.dataclass(frozen=True)
class _Finished:
    """The round has ended."""

    state: RoomState
    entries: int | None  # of the capacity by then


@dataclasses.dataclass(frozen=True)
class _Broken:
    """It was ended early."""

    state: RoomState | None  # as in `Interrupted`; None: something was wrong before the first step
    resumable: bool
    error: BaseException | None  # None: it was told to end


class RoomWorker:
    """A `Place` that is another process. It is started when it is given its first room, and again after it died."""

    def __init__(self, core: int | None = None, compiled: str | None = None, scratch: str | None = None) -> None:
        """Nothing yet.

        Args:
            core: that it is held to; None: any.
            compiled: a folder in which workers find what others have compiled; None: each compiles for itself.
            scratch: a folder that is to go if the caller is killed.
        """
        # However many devices the caller has asked JAX for: a worker has one core, and one room at a time.
        self._environment = {"JAX_PLATFORMS": "cpu", "JAX_NUM_CPU_DEVICES": "1"}
        if compiled is not None:
            self._environment |= {"JAX_COMPILATION_CACHE_DIR": compiled, "JAX_PERSISTENT_CACHE_MIN_COMPILE_TIME_SECS": "0.2"}
        self._core, self._scratch, self._process, self._closed = core, scratch, None, False
        self._turn, self._changing = threading.Lock(), threading.Lock()

    def fit(self, task: RoomTask, capacity: Capacity, report: Report, keep: Keep) -> RoomState:
        """The state after the round, once earlier tasks are done.

        Raises: Interrupted and what went wrong, as it would here; RuntimeError naming the room if the process has died;
            WorkerClosed.
        """
        with self._turn:
            process = self._started()
            try:
                process.pipes[0].send((task, capacity.entries))
                ended, refused = _attend(process.pipes[0], report, keep)
            except (EOFError, OSError) as error:
                code = process.exit_code(patience=5.0)  # before it is told to end: it has its own reason
                self._stop()
                if self._closed:
                    raise WorkerClosed from None
                raise RuntimeError(_died(task.room, code)) from error
            except BaseException:  # it waits for an answer that will not come
                self._stop()
                raise
        if isinstance(ended, _Finished):
            _grow(capacity, ended.entries)
            return ended.state
        if ended.state is not None:
            raise Interrupted(ended.state, resumable=ended.resumable) from refused or ended.error
        assert ended.error is not None
        raise ended.error

    def close(self) -> None:
        """Ends the process, whatever it is doing, for good."""
        self._closed = True
        self._stop()

    def _started(self) -> WorkerProcess:
        with self._changing:
            if self._closed:
                raise WorkerClosed
            if self._process is not None and self._process.popen.poll() is not None:  # it has died since its last room
                self._process.close()
                self._process = None
            if self._process is None:
                self._process = WorkerProcess(__name__, core=self._core, environment=self._environment, scratch=self._scratch)
            return self._process

    def _stop(self) -> None:
        with self._changing:
            process, self._process = self._process, None
        if process is not None:
            process.close()


@contextlib.contextmanager
def room_workers(count: int) -> Iterator[list[RoomWorker]]:
    """Workers on cores of their own as far as there are any; closed after the block.

    They share what they compile: in the folder that JAX_COMPILATION_CACHE_DIR names, else in one that ends with them.
    """
    cores = sorted(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else [None]
    named = os.environ.get("JAX_COMPILATION_CACHE_DIR")
    temporary = tempfile.TemporaryDirectory(prefix="wm-compiled-", ignore_cleanup_errors=True) if count and not named else None
    with temporary or contextlib.nullcontext() as scratch:
        workers = [RoomWorker(cores[k % len(cores)], named or scratch, scratch) for k in range(count)]
        try:
            yield workers
        finally:
            for worker in workers:
                worker.close()


def _died(room: int, code: int | None) -> str:
    why = "killed, as the system does where memory runs out; fewer workers need less" if code == -9 else f"exit code {code}"
    return f"the process that fitted room {room} has ended: {why}"


def _attend(pipe: Connection, report: Report, keep: Keep) -> tuple[_Finished | _Broken, BaseException | None]:
    """Calls `report` and `keep` as the worker steps, until its task has ended; also what one of them raised to end it."""

    def state() -> RoomState:
        pipe.send(_STATE)
        return pipe.recv()

    refused = None
    while isinstance(said := pipe.recv(), _Stepped):
        try:
            keep(state) if said.report is None else report(*said.report)
        except BaseException as error:
            refused = error
        pipe.send(_GO_ON if refused is None else _END)
    return said, refused


class _ToldToEnd(Exception):
    """The caller wants no further step."""


def serve(pipes: list[Connection]) -> None:
    """Fits the rooms that arrive, one after the other, until the pipe is closed."""
    (pipe,), capacity, here = pipes, Capacity(), Here(jax.devices()[:1])
    with contextlib.suppress(EOFError, OSError):
        while True:
            task, entries = pipe.recv()
            _grow(capacity, entries)
            pipe.send(_done(task, here, capacity, pipe))


def _done(task: RoomTask, here: Here, capacity: Capacity, pipe: Connection) -> _Finished | _Broken:
    def report(done: int, info: dict) -> None:
        ask(_Stepped((done, info)))

    def keep(state: Callable[[], RoomState]) -> None:
        ask(_Stepped(None), state)

    def ask(said: _Stepped, state: Any = None) -> None:
        pipe.send(said)
        while (told := pipe.recv()) == _STATE:
            pipe.send(state())
        if told == _END:
            raise _ToldToEnd

    try:
        return _Finished(here.fit(task, capacity, report, keep), capacity.entries)
    except Interrupted as interrupted:
        cause = interrupted.__cause__
        error = None if cause is None or isinstance(cause, _ToldToEnd) else portable(cause)
        return _Broken(interrupted.state, interrupted.resumable, error)
    except Exception as error:
        return _Broken(None, False, portable(error))


def _grow(capacity: Capacity, entries: int | None) -> None:
    if entries is not None:
        capacity.grow(entries)
