"""Work on many things at once, results in order."""

import collections
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import Future, ThreadPoolExecutor
from typing import TypeVar

from wm.host import cores

Item = TypeVar("Item")
Result = TypeVar("Result")

AHEAD = 2
"""Results a core may be ahead of the one that is awaited: bounds memory, and keeps all of them busy."""


def in_order(work: Callable[[Item], Result], items: Iterable[Item]) -> Iterator[Result]:
    """`work(item)` for every item, in the items' order, on one thread per core."""
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
