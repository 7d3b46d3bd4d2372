"""The executors that rooms can be fitted by, by the name that a configuration selects (`executor=...`)."""

from collections.abc import Callable, Mapping
from concurrent.futures import Executor, ThreadPoolExecutor

from wm.host import cores


def _threads(workers: int) -> Executor:
    return ThreadPoolExecutor(workers, thread_name_prefix="wm-fit")


EXECUTORS: Mapping[str, Callable[[int], Executor]] = {"threads": _threads}
"""Name -> a function that makes the executor for a number of rooms at once. The names are those of `executor` in wm.schema."""


def room_executor(name: str, workers: int) -> Executor:
    """A new executor, which the caller shuts down (`with` does)."""
    return EXECUTORS[name](workers)


def worker_count(asked: int | None) -> int:
    """How many rooms are fitted at once: as many as asked for; asked for None, one per core."""
    return asked or cores()
