"""Worker processes, for work that Python's interpreter lock or a shared pool of threads would slow down. POSIX only.

A worker is this module run as a program: it calls `serve(pipes)` of a given module, which returns when the pipes are closed. It
is started as a new program and neither forked nor spawned, so that it does not need the caller's `__main__` and shares no lock
with the caller's threads. It runs in a session of its own, so that Ctrl-C reaches the caller only, which then ends the worker.
It also ends if the caller is killed: its standard input is a pipe whose other end the caller holds.
"""

import contextlib
import importlib
import os
import pickle
import subprocess
import sys
import threading
import traceback
import weakref
from multiprocessing.connection import Connection, Pipe

from wm.host import prepare_process


class WorkerProcess:
    """A running worker process, and the caller's ends of its pipes."""

    def __init__(self, module: str, *, lanes: int = 1) -> None:
        """Starts a worker.

        Args:
            module: name of a module with a function `serve(pipes)`.
            lanes: number of pipes.
        """
        pairs = [Pipe() for _ in range(lanes)]
        theirs = [pipe.fileno() for _, pipe in pairs]
        paths = {"PYTHONPATH": os.pathsep.join(filter(None, sys.path))}  # so that the worker imports the same wm
        command = [sys.executable, "-m", __name__, module, *map(str, theirs)]
        variables = os.environ | paths
        self.popen = subprocess.Popen(command, stdin=subprocess.PIPE, pass_fds=theirs, env=variables, start_new_session=True)
        for _, pipe in pairs:
            pipe.close()
        self.pipes: list[Connection] = [pipe for pipe, _ in pairs]
        self.close = weakref.finalize(self, _end, self.popen, self.pipes)

    def exit_code(self, *, patience: float) -> int | None:
        """Waits up to `patience` seconds for the worker to end.

        Returns:
          Its exit code, or minus the number of the signal that ended it; None if it is still running.
        """
        with contextlib.suppress(subprocess.TimeoutExpired):
            return self.popen.wait(patience)
        return None


def portable(error: BaseException) -> BaseException:
    """A copy of an error, with its traceback as a note, for another process; a RuntimeError if the error cannot be pickled."""
    try:
        sent = pickle.loads(pickle.dumps(error))
    except Exception:
        sent = RuntimeError(f"{type(error).__name__}: {error}")
    sent.add_note("".join(["in a process of its own:\n", *traceback.format_exception(error)]))
    return sent


def _end(popen: subprocess.Popen, pipes: list[Connection]) -> None:
    popen.terminate()
    popen.communicate()
    for pipe in pipes:  # only now, since a thread that waits at a pipe must first see that the worker has ended
        pipe.close()


def _end_with_the_caller() -> None:
    """Ends this process when its standard input is closed. Nothing is written to it, so that means that the caller has ended."""
    os.read(0, 1)
    os._exit(1)


def _main(module: str, *pipes: str) -> None:
    watch = threading.Thread(target=_end_with_the_caller, daemon=True)
    watch.start()
    prepare_process()
    importlib.import_module(module).serve([Connection(int(number)) for number in pipes])
    watch.join()  # the pipes have closed because the caller has ended


if __name__ == "__main__":
    _main(*sys.argv[1:])
