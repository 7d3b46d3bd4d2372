"""Ctrl-C and SIGTERM, heard also where Python would lose them.

Python turns Ctrl-C into a KeyboardInterrupt wherever the main thread is. Where that is a callback of the garbage collector, the
error is printed and forgotten, and JAX registers such a callback when it is imported.
"""

import contextlib
import signal
import threading
from collections.abc import Callable, Iterator
from types import FrameType

_SIGNALS = (signal.SIGINT, signal.SIGTERM)
BY_SIGNAL = 128
"""The exit code of a process that a signal has ended is this and the number of the signal."""


@contextlib.contextmanager
def ending(leave: Callable[[int], None]) -> Iterator[None]:
    """Within the block SIGINT and SIGTERM call `leave` with an exit code; a signal that is ignored (`nohup`) stays so."""
    if threading.current_thread() is not threading.main_thread():  # only that one may set handlers, and gets the signals
        yield
        return

    def handle(number: int, frame: FrameType | None) -> None:
        leave(BY_SIGNAL + number)

    before = {number: signal.getsignal(number) for number in _SIGNALS}
    for number in _SIGNALS:
        if before[number] != signal.SIG_IGN:
            signal.signal(number, handle)
    try:
        yield
    finally:
        for number, handler in before.items():
            if handler is not None:  # None: not set by Python, so it cannot be set again
                signal.signal(number, handler)
