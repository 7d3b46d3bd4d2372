"""What fits the rooms of a scene: processes if they are asked for, and the shapes that rooms are compiled for."""

import dataclasses
import os
from collections.abc import Iterator, Sequence
from contextlib import contextmanager

import jax

from wm.host import cores
from wm.schema import RunConfig
from wm.splat.optimization.padding import Capacity
from wm.splat.scene.room_worker import RoomWorker, room_workers
from wm.stages.scene import Scene


@dataclasses.dataclass(frozen=True, eq=False)
class Fitters:
    """Shared by the rehearsal, the fit, and, for the capacity, the renders after it."""

    capacity: Capacity
    workers: Sequence[RoomWorker]  # none: rooms are fitted in this process


@contextmanager
def fitters(config: RunConfig, scene: Scene) -> Iterator[Fitters]:
    """Fitters for the block. Their processes start when they are first given a room, and end with the block."""
    painted = {view.room for view in scene.views}
    with room_workers(worker_count(config.workers, len(painted))) as workers:
        yield Fitters(capacity=Capacity(), workers=workers)


def worker_count(asked: int | None, rooms: int) -> int:
    """As many as asked for, but no more than there are rooms; none on an accelerator, which all rooms share.

    Asked for None, one a core; but a single one would have nothing for it.
    """
    if os.name != "posix" or jax.default_backend() != "cpu":
        return 0
    if asked is not None:
        return min(asked, rooms)
    count = min(cores(), rooms)
    return count if count > 1 else 0
