"""Work on many things at once, results in order."""

import collections
import queue
from collections.abc import Callable, Iterable, Iterator, Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from typing import TypeVar

Worker = TypeVar("Worker")
Item = TypeVar("Item")
Result = TypeVar("Result")

AHEAD = 2
"""Results a worker may be ahead of the one that is awaited: bounds memory, and keeps all of them busy."""


def in_order(
    work: Callable[[Worker, Item], Result], items: Iterable[Item], workers: Sequence[Worker]
) -> Iterator[Result]:
    """`work(worker, item)` for every item, in the items' order; each worker does one at a time, in a thread."""
    free: queue.SimpleQueue[Worker] = queue.SimpleQueue()
    for worker in workers:
        free.put(worker)

    def one(item: Item) -> Result:
        worker = free.get()
        try:
            return work(worker, item)
        finally:
            free.put(worker)

    pending: collections.deque[Future[Result]] = collections.deque()
    with ThreadPoolExecutor(len(workers), thread_name_prefix="wm-ordered") as pool:
        try:
            for item in items:
                pending.append(pool.submit(one, item))
                if len(pending) > AHEAD * len(workers):
                    yield pending.popleft().result()
            while pending:
                yield pending.popleft().result()
        finally:
            for future in pending:
                future.cancel()
