"""Resident memory of this process and of the processes that it has started.

The peak of a stage is the largest of many readings. The peak that the system keeps (`getrusage`) cannot replace them: that of a
process counts from its start and not from the stage's, and that of its children is of the largest one alone, once it has ended.
The price is that a child that begins and ends between two listings goes unseen.
"""

import time

import psutil

LIST_SECONDS = 0.5
"""Least interval between two listings of the children."""


class MemoryProbe:
    """Reads the memory of this process and of its children; cheap enough for many readings per second."""

    def __init__(self) -> None:
        self._own = psutil.Process()
        self._children: list[psutil.Process] = []
        self._listed = -float("inf")

    def resident_gib(self) -> float:
        """Resident memory now, in GiB. Children are listed at most every LIST_SECONDS, since psutil lists them by a walk over all
        processes of the machine."""
        if time.perf_counter() - self._listed > LIST_SECONDS:
            self._children, self._listed = self._own.children(), time.perf_counter()
        return sum(map(self._resident, (self._own, *self._children))) / 2**30

    def _resident(self, process: psutil.Process) -> int:
        """Bytes; 0 of a child that has ended, and of a child between fork and exec.

        Such a child shares its pages with this process, so they would be counted twice. psutil does not tell it from a program of
        its own; its command line does, which is still that of its parent. (Linux could divide a shared page between those that
        share it, `memory_full_info().pss`, but takes milliseconds per GiB to do so, and macOS cannot.)
        """
        try:
            forked = process is not self._own and process.cmdline() == self._own.cmdline()
            return 0 if forked else process.memory_info().rss
        except psutil.Error:
            return 0


def resident_gib() -> float:
    """Resident memory of this process and of those that it has started, now, in GiB."""
    return MemoryProbe().resident_gib()
