"""A process of its own for what Python's interpreter lock, or one pool of threads, would hold up here. POSIX only.

A worker is this module run as a program: it serves the pipes it was given with the `serve(pipes)` of a module, until they are
closed. It is started by name and neither forked nor spawned, so that it needs nothing of the caller's `__main__` and shares no
lock with the caller's threads. It has a session of its own, since Ctrl-C is for the caller, which then ends it; and it ends with
the caller, however that comes about: of its standard input, a pipe, the caller holds the other end.
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
    """A running worker, and our ends of its pipes."""

    def __init__(self, module: str, *, lanes: int = 1) -> None:
        """Starts it.

        Args:
            module: the name of one that has `serve(pipes)`.
            lanes: how many pipes there are.
        """
        pairs = [Pipe() for _ in range(lanes)]
        theirs = [pipe.fileno() for _, pipe in pairs]
        paths = {"PYTHONPATH": os.pathsep.join(filter(None, sys.path))}  # this wm, wherever it was imported from
        command = [sys.executable, "-m", __name__, module, *map(str, theirs)]
        variables = os.environ | paths
        self.popen = subprocess.Popen(command, stdin=subprocess.PIPE, pass_fds=theirs, env=variables, start_new_session=True)
        for _, pipe in pairs:
            pipe.close()
        self.pipes: list[Connection] = [pipe for pipe, _ in pairs]
        self.close = weakref.finalize(self, _end, self.popen, self.pipes)

    def exit_code(self, *, patience: float) -> int | None:
        """Of a worker whose pipes have closed, as soon as it has ended; None: not within `patience` seconds. Negative: the signal
        that ended it."""
        with contextlib.suppress(subprocess.TimeoutExpired):
            return self.popen.wait(patience)
        return None


def portable(error: BaseException) -> BaseException:
    """An error as another process can be sent it, with a note of where it was raised: itself, if pickling keeps it."""
    try:
        sent = pickle.loads(pickle.dumps(error))
    except Exception:
        sent = RuntimeError(f"{type(error).__name__}: {error}")
    sent.add_note("".join(["in a process of its own:\n", *traceback.format_exception(error)]))
    return sent


def _end(popen: subprocess.Popen, pipes: list[Connection]) -> None:
    popen.terminate()
    popen.communicate()
    for pipe in pipes:  # now that whoever waits at one has been told that it ended
        pipe.close()


def _end_with_the_caller() -> None:
    """Waits for the end of standard input, which nothing is ever written to: whatever is under way then is for nobody."""
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
