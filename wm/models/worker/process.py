"""A running worker: a program of another interpreter that answers lines of JSON with lines of JSON. POSIX only.

It runs in a session of its own, so that Ctrl-C reaches the caller only, which then ends it. Its standard input is a pipe whose
other end the caller alone holds: when that closes, because the caller has ended in whatever way, the worker ends by itself.
What is not of the protocol on its standard output is kept with what it prints (a launcher may greet before Python starts).
"""

import contextlib
import json
import os
import pathlib
import selectors
import signal
import subprocess
import time
import weakref
from collections.abc import Mapping
from typing import Any

from wm.models.worker.folder import LOG, ExchangeFolder

_SERVE = pathlib.Path(__file__).with_name("serve.py")
_OURS = ("PYTHONPATH", "PYTHONHOME", "PYTHONSTARTUP", "VIRTUAL_ENV")
"""Variables that lead Python to the packages of the caller's interpreter."""
_LONGEST = 1 << 20
"""Bytes after which a line that has not ended is not one of the protocol."""
_STRAYED_BYTES, _STRAYED_LINES = 1 << 24, 1000
"""What is put up with beside the protocol on the standard output."""
_TAIL_LINES, _TAIL_BYTES = 12, 4096
_PATIENCE = 5.0
"""Seconds in which a process that has closed its standard output must have ended; then it is killed."""


class EndedError(Exception):
    """A worker process has ended; the message says how."""

    def __init__(self, code: int):
        super().__init__(f"its process was ended by {_signal(-code)}" if code < 0 else f"its process ended with exit code {code}")
        self.by_signal = code < 0


class SilentError(Exception):
    """A worker process does not answer."""


class RunningWorker:
    """A worker process, its pipes and its folder. One call at a time."""

    def __init__(self, python: str, script: pathlib.Path, log: str = ""):
        """Starts the process.

        Args:
          python: the path of the interpreter.
          script: the file that serves the model (wm.models.worker.serve).
          log: the file to which what the process prints is added; empty: one in the folder, which is removed with it.

        Raises:
          OSError: the interpreter cannot be run, or the log cannot be written.
        """
        self.folder = ExchangeFolder()
        try:
            self._log = pathlib.Path(log).expanduser() if log else self.folder.path / LOG
            self._log.parent.mkdir(parents=True, exist_ok=True)
            with self._log.open("ab") as printed:
                self._printed_from = printed.tell()
                self.popen = subprocess.Popen(
                    [python, "-u", str(_SERVE), str(script), str(self.folder.path)],
                    stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=printed, bufsize=0, env=_variables(python),
                    start_new_session=True,
                )  # fmt: skip
        except BaseException:
            self.folder.remove()
            raise
        self._calls, self._buffer, self._strayed = 0, b"", (0, 0)
        self.close = weakref.finalize(self, _end, self.popen, self.folder)

    def call(self, name: str, values: Mapping[str, Any], *, seconds: float) -> dict[str, Any]:
        """The reply to one line. After an error of this function the process is of no further use.

        Args:
          name: "describe", "load" or "answer".
          values: the other entries of the line, JSON values.
          seconds: within which the reply must come.

        Raises:
          EndedError: the process has ended.
          SilentError: no reply came in time.
        """
        self._calls += 1
        until = time.monotonic() + seconds
        assert self.popen.stdin is not None
        with contextlib.suppress(OSError):  # if the process has ended, `_line` says so
            self.popen.stdin.write((json.dumps({"id": self._calls, "call": name, **values}) + "\n").encode())
        while True:
            line = self._line(until, seconds)
            reply = _parsed(line)
            if reply is not None and reply.get("id") == self._calls:
                return reply
            self._keep(line)

    @property
    def number(self) -> int:
        """The number of the next call."""
        return self._calls + 1

    def printed(self) -> str:
        """The last lines that the process has printed, after a colon and a line break; empty if there are none."""
        try:
            with self._log.open("rb") as log:
                size = log.seek(0, os.SEEK_END)
                log.seek(max(self._printed_from, size - _TAIL_BYTES))
                text = log.read().decode(errors="replace")
        except OSError:
            return ""
        lines = [line.rpartition("\r")[2].rstrip() for line in text.splitlines() if line.strip()]  # of a progress bar the last
        return ":\n  " + "\n  ".join(lines[-_TAIL_LINES:]) if lines else ""

    def _keep(self, line: bytes) -> None:
        """Adds a line that is not of the protocol to what was printed."""
        self._strayed = self._strayed[0] + len(line), self._strayed[1] + 1
        if self._strayed[0] > _STRAYED_BYTES or self._strayed[1] > _STRAYED_LINES:
            raise SilentError("it prints without end, and nothing of the protocol")
        with self._log.open("ab") as printed:
            printed.write(line + b"\n")

    def _line(self, until: float, seconds: float) -> bytes:
        """The next line on the standard output, or as much of it as a line may hold."""
        assert self.popen.stdout is not None
        with selectors.DefaultSelector() as selector:
            selector.register(self.popen.stdout, selectors.EVENT_READ)
            while b"\n" not in self._buffer and len(self._buffer) < _LONGEST:
                left = until - time.monotonic()
                if left <= 0 or not selector.select(left):
                    raise SilentError(f"it has not answered within {seconds:g} s")
                part = os.read(self.popen.stdout.fileno(), 1 << 16)
                if not part:
                    raise EndedError(_ended(self.popen, _PATIENCE))
                self._buffer += part
        line, _, self._buffer = self._buffer.partition(b"\n")
        return line


def _end(popen: subprocess.Popen, folder: ExchangeFolder) -> None:
    """Ends a process and its children, and removes its folder."""
    assert popen.stdin is not None and popen.stdout is not None
    popen.stdin.close()
    _ended(popen, 0.0)
    popen.stdout.close()
    folder.remove()


def _ended(popen: subprocess.Popen, patience: float) -> int:
    """The exit code of a process that has ended within `patience` seconds, or is killed; its child processes are killed too."""
    if popen.returncode is None:
        until = time.monotonic() + patience
        # it is not reaped yet, since its number stands for the group of its child processes until then
        while os.waitid(os.P_PID, popen.pid, os.WEXITED | os.WNOHANG | os.WNOWAIT) is None and time.monotonic() < until:
            time.sleep(0.01)
        with contextlib.suppress(ProcessLookupError, PermissionError):
            os.killpg(popen.pid, signal.SIGKILL)
    return popen.wait()


def _variables(python: str) -> dict[str, str]:
    """The environment of a worker: the caller's, without what belongs to the caller's interpreter. Programs beside the worker's
    own interpreter are found first."""
    kept = {name: value for name, value in os.environ.items() if name not in _OURS}
    return kept | {"PATH": os.pathsep.join(filter(None, [os.path.dirname(python), os.environ.get("PATH", "")]))}


def _parsed(line: bytes) -> dict[str, Any] | None:
    """The reply that a line holds; None for a line that is not one of the protocol."""
    try:
        reply = json.loads(line)
    except ValueError:
        return None
    return reply if isinstance(reply, dict) else None


def _signal(number: int) -> str:
    try:
        return signal.Signals(number).name
    except ValueError:
        return f"signal {number}"
