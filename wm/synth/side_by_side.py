"""Work on several rooms at the same time, which ends as a whole: when one fails, the others stop at their next turn.

Threads are daemons. A process that is interrupted ends at once, without waiting for requests that are under way.
"""

import contextlib
import dataclasses
import queue
import threading
from collections.abc import Callable, Iterator, Sequence
from typing import TypeVar

import numpy as np

from wm.services.retries import PAUSE
from wm.synth.backends import DepthBackend, ImageBackend, ImageRequest, ImageResult
from wm.types import Camera

Item = TypeVar("Item")
Result = TypeVar("Result")


class RoomStoppedError(Exception):
    """Another room has failed or the run was interrupted: this room ends here, without a word."""


class Turns:
    """What the rooms do one at a time, and whether they should still do anything."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._stopped = threading.Event()

    @contextlib.contextmanager
    def turn(self) -> Iterator[None]:
        """While this is held, no other room has a turn. Raises: RoomStoppedError after `stop`."""
        with self._lock:
            self.check()
            yield

    def check(self) -> None:
        """Raises: RoomStoppedError after `stop`."""
        self.pause(0.0)

    def pause(self, seconds: float) -> None:
        """Waits. Raises: RoomStoppedError after `stop`, as soon as it is called."""
        if self._stopped.wait(seconds):
            raise RoomStoppedError

    def stop(self) -> None:
        """No turn begins any more. A turn that is under way is waited for."""
        with self._lock:
            self._stopped.set()


def side_by_side(work: Callable[[Item], Result], items: Sequence[Item], turns: Turns, *, at_once: int) -> list[Result]:
    """`work(item)` for every item, in the order of the items, with at most `at_once` under way.

    With one at a time, everything happens in the calling thread. After a failure the others are waited for: they stop at their
    next turn, when the answer that they wait for is there, and at once while they wait to send a request again.

    Raises:
      Exception: what `work` raised first.
      KeyboardInterrupt: at once. What is under way is left to its threads, which have no more turns.
    """
    if at_once <= 1 or len(items) <= 1:
        return [work(item) for item in items]
    results: dict[int, Result] = {}
    failures: queue.SimpleQueue[BaseException] = queue.SimpleQueue()
    waiting: queue.SimpleQueue[tuple[int, Item]] = queue.SimpleQueue()
    for pair in enumerate(items):
        waiting.put(pair)

    def run() -> None:
        with contextlib.suppress(queue.Empty, RoomStoppedError):
            while True:
                turns.check()
                place, item = waiting.get_nowait()
                try:
                    results[place] = work(item)
                except RoomStoppedError:
                    raise
                except BaseException as error:
                    failures.put(error)
                    turns.stop()

    threads = [threading.Thread(target=run, name=f"wm-room-{k}", daemon=True) for k in range(min(at_once, len(items)))]
    try:
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
    except BaseException:
        turns.stop()
        raise
    if not failures.empty():
        raise failures.get()
    return [results[place] for place in range(len(items))]


@dataclasses.dataclass(frozen=True, eq=False)
class ImagesUntilStopped:
    """An image backend that is not asked any more once the rooms are stopped."""

    backend: ImageBackend
    turns: Turns

    def generate(self, request: ImageRequest) -> ImageResult:
        """As the backend. Raises: RoomStoppedError."""
        self.turns.check()
        before = PAUSE.set(self.turns.pause)
        try:
            return self.backend.generate(request)
        finally:
            PAUSE.reset(before)


@dataclasses.dataclass(frozen=True, eq=False)
class DepthInTurn:
    """A depth backend that several rooms share, asked one call at a time."""

    backend: DepthBackend
    _lock: threading.Lock = dataclasses.field(default_factory=threading.Lock)

    def estimate(self, result: ImageResult, *, camera: Camera, seed: int) -> np.ndarray | None:
        """As the backend."""
        with self._lock:
            return self.backend.estimate(result, camera=camera, seed=seed)
