"""Settings of this process that make a run faster, and the number of its cores. They never change results."""

import contextlib
import ctypes
import os

# From glibc's malloc.h. New pages are expensive on virtual machines: returning each large array to the system and allocating it
# again took a third of the time of a fit (and nine tenths of the time of the projection's gradient). glibc refuses a threshold
# above 32 MiB, and arrays of a fit are larger, so mmap is turned off altogether.
_M_TRIM_THRESHOLD, _M_TOP_PAD, _M_MMAP_MAX, _M_ARENA_MAX = -1, -2, -4, -8


def prepare_process() -> None:
    """Makes glibc keep freed memory for reuse. Does nothing with another C library."""
    with contextlib.suppress(OSError, AttributeError, TypeError):  # not glibc
        libc = ctypes.CDLL(None)
        libc.mallopt(_M_ARENA_MAX, 1)
        libc.mallopt(_M_MMAP_MAX, 0)
        libc.mallopt(_M_TRIM_THRESHOLD, 2**31 - 1)
        libc.mallopt(_M_TOP_PAD, 64 << 20)


def cores() -> int:
    """Number of cores that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
