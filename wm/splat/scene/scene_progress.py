"""Progress and checkpoints of the fit of a scene. Both are called from several threads, one per room under way."""

import dataclasses
import threading
import time
from collections.abc import Callable, Mapping

import numpy as np

from wm.splat.optimization.checkpoint import to_arrays
from wm.splat.optimization.fitting import Progress
from wm.splat.optimization.room_state import RoomState

Arrays = Mapping[str, np.ndarray]
Load = Callable[[int, int], Arrays | None]
Store = Callable[[int, int, Arrays], None]


class Halted(Exception):
    """Raised in the fits of rooms under way after the fit of the scene was interrupted."""


class SceneProgress:
    """Counts the steps of all rooms and calls `progress`, one call at a time."""

    def __init__(self, total: int, progress: Progress | None) -> None:
        self._done, self._total, self._progress, self._lock = 0, total, progress, threading.Lock()
        self._halted = False

    def step(self, info: dict) -> None:
        """One more step of a room.

        Raises: Halted after `halt`.
        """
        self._add(1, info)
        self.raise_if_halted()

    def skip(self, steps: int) -> None:
        """Counts steps that are not taken, or not reported one by one."""
        self._add(steps, {})

    def halt(self) -> None:
        """Makes every room end at its next step."""
        self._halted = True

    def raise_if_halted(self) -> None:
        """Raises: Halted after `halt`."""
        if self._halted:
            raise Halted

    def _add(self, steps: int, info: dict) -> None:
        with self._lock:
            self._done += steps
            if self._progress is not None:
                self._progress(self._done, self._total, info)


@dataclasses.dataclass(frozen=True)
class Checkpoints:
    """How the states of rooms are stored and loaded, and how often."""

    load: Load
    store: Store
    seconds: float

    def keeper(self, round_: int, room: int) -> Callable[[Callable[[], RoomState]], None]:
        """A function to call after every step of a room with one that returns its state, which is stored once per `seconds`."""
        last = time.perf_counter()

        def keep(state: Callable[[], RoomState]) -> None:
            nonlocal last
            if time.perf_counter() - last >= self.seconds:
                self.store(round_, room, to_arrays(state()))
                last = time.perf_counter()

        return keep
