"""Settings of this process that a run wants, whatever it computes. They change times and never results."""

import contextlib
import ctypes
import os

# glibc's malloc.h. Fresh pages are costly on virtual machines: giving every large array back to the system and faulting it in
# anew took a third of the time of a fit (and nine tenths of the gradient of the projection alone).
_M_TRIM_THRESHOLD, _M_TOP_PAD, _M_MMAP_THRESHOLD, _M_ARENA_MAX = -1, -2, -3, -8
_LARGEST_MMAP_THRESHOLD = 32 << 20  # glibc refuses more


def prepare_process() -> None:
    """Keeps freed memory for reuse, where the C library is glibc."""
    with contextlib.suppress(OSError, AttributeError):  # another C library: its own defaults
        libc = ctypes.CDLL(None)
        libc.mallopt(_M_ARENA_MAX, 1)
        libc.mallopt(_M_MMAP_THRESHOLD, _LARGEST_MMAP_THRESHOLD)
        libc.mallopt(_M_TRIM_THRESHOLD, 2**31 - 1)
        libc.mallopt(_M_TOP_PAD, 64 << 20)


def cores() -> int:
    """Cores this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
