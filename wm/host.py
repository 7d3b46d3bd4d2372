"""Settings of this process that a run wants, whatever it computes. They change times and never results."""

import contextlib
import ctypes
import os

# glibc's malloc.h. Fresh pages are costly on virtual machines: giving every large array back to the system and faulting it in
# anew took a third of the time of a fit (and nine tenths of the gradient of the projection alone). A threshold above 32 MiB is
# refused, so mapping is turned off altogether: arrays of the fit are larger.
_M_TRIM_THRESHOLD, _M_TOP_PAD, _M_MMAP_MAX, _M_ARENA_MAX = -1, -2, -4, -8


def prepare_process() -> None:
    """Keeps freed memory for reuse, where the C library is glibc."""
    with contextlib.suppress(OSError, AttributeError, TypeError):  # another C library: its own defaults
        libc = ctypes.CDLL(None)
        libc.mallopt(_M_ARENA_MAX, 1)
        libc.mallopt(_M_MMAP_MAX, 0)
        libc.mallopt(_M_TRIM_THRESHOLD, 2**31 - 1)
        libc.mallopt(_M_TOP_PAD, 64 << 20)


def cores() -> int:
    """Cores this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
