"""A parallel map over threads that yields its results in order."""

import collections
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import Future, ThreadPoolExecutor
from typing import TypeVar

from wm.host import cores

Item = TypeVar("Item")
Result = TypeVar("Result")

AHEAD = 2
"""Results per core that may be pending: enough to keep every core busy, and few enough to bound memory."""


def in_order(work: Callable[[Item], Result], items: Iterable[Item]) -> Iterator[Result]:
    """`work(item)` for every item, in the order of the items, with one thread per core."""
    pending: collections.deque[Future[Result]] = collections.deque()
    with ThreadPoolExecutor(cores(), thread_name_prefix="wm-ordered") as pool:
        try:
            for item in items:
                pending.append(pool.submit(work, item))
                if len(pending) > AHEAD * cores():
                    yield pending.popleft().result()
            while pending:
                yield pending.popleft().result()
        finally:
            for future in pending:
                future.cancel()
