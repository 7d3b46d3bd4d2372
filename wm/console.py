"""Lines for whoever started the run. None of them can end it: a terminal may be gone, a disk full, a stream closed.

`say` writes results and notes to standard output, `warn` what went wrong to standard error.
"""

import contextlib
import os
import sys
from collections.abc import Callable
from typing import Any, NoReturn


def say(text: str) -> None:
    """Prints to standard output, as far as that is possible; where it is not, for another reason than that the reader has left,
    standard error is told once."""
    try:
        _print(sys.stdout, text)
    except BrokenPipeError:
        _silence(1)
    except (OSError, ValueError) as error:
        _silence(1)
        warn(f"wm: standard output cannot be written ({error}); the run goes on without it")


def end(command: Callable[[], int]) -> NoReturn:
    """Ends the process with the exit code of a command; Ctrl-C ends it with a line and 130 instead of a traceback."""
    try:
        code = command()
    except KeyboardInterrupt:
        warn("interrupted; the same command begins again")
        code = 130
    flush()
    sys.exit(code)


def warn(text: str) -> None:
    """Prints to standard error, as far as that is possible."""
    try:
        _print(sys.stderr, text)
    except RuntimeError:  # from a signal handler, in the middle of another line
        with contextlib.suppress(OSError):
            os.write(2, f"\n{text}\n".encode())
    except (OSError, ValueError):
        _silence(2)


def on_terminal() -> bool:
    """Whether standard error is a terminal, where lines can be drawn over."""
    try:
        return sys.stderr is not None and sys.stderr.isatty()
    except ValueError:  # closed
        return False


def open_standard_streams() -> None:
    """Gives the process a standard input, output and error where it was started without: whatever file was opened next would
    otherwise take the number of one and be written to by whoever means the stream."""
    for number in range(3):
        try:
            os.fstat(number)
        except OSError:
            os.open(os.devnull, os.O_RDWR)  # takes the lowest number that is free, which is this one
    if sys.stdout is None:
        sys.stdout = _nowhere()
    if sys.stderr is None:
        sys.stderr = _nowhere()


def flush() -> None:
    """Writes what is buffered, as far as that is possible, so that the end of the process cannot fail at it."""
    try:
        if sys.stdout is not None:
            sys.stdout.flush()
    except (OSError, ValueError, RuntimeError):  # RuntimeError: from a signal handler, in the middle of a write
        _silence(1)


def _print(stream: Any, text: str) -> None:
    if stream is None:
        return
    encoding = stream.encoding or "utf-8"
    print(text.encode(encoding, "replace").decode(encoding), file=stream, flush=True)


def _silence(number: int) -> None:
    """Sends a standard stream to nowhere from now on: what is still buffered would fail again at the end of the process."""
    stream, nowhere = sys.stdout if number == 1 else sys.stderr, _nowhere()
    with contextlib.suppress(OSError, ValueError, AttributeError):  # a stream of Python's alone has no number
        if stream.fileno() == number:
            os.dup2(nowhere.fileno(), number)
    if number == 1:
        sys.stdout = nowhere
    else:
        sys.stderr = nowhere


def _nowhere() -> Any:
    return os.fdopen(os.open(os.devnull, os.O_WRONLY), "w", encoding="utf-8")
