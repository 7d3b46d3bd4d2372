"""The executors that can fit rooms, by the name that a configuration selects (`executor=...`)."""

from collections.abc import Callable, Mapping
from concurrent.futures import Executor, ThreadPoolExecutor

from wm.host import cores


def _threads(workers: int) -> Executor:
    return ThreadPoolExecutor(workers, thread_name_prefix="wm-fit")


EXECUTORS: Mapping[str, Callable[[int], Executor]] = {"threads": _threads}
"""Name -> a function that makes an executor for so many rooms at a time. The names are the options of `executor` in wm.schema."""


def room_executor(name: str, workers: int) -> Executor:
    """A new executor. The caller shuts it down, for example by `with`."""
    return EXECUTORS[name](workers)


def worker_count(asked: int | None) -> int:
    """Number of rooms that are fitted at a time: `asked`, or one per core if that is None."""
    return asked or cores()
