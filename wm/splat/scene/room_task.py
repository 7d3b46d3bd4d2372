"""One room of a scene, one round: all that its fit reads, and the fit. Whoever holds the task can do it, in any process."""

import dataclasses
import time
from collections.abc import Callable, Mapping, Sequence
from typing import Protocol, runtime_checkable

import jax

from wm.schema import FitSettings, RasterSettings
from wm.splat.optimization.batch import Compiled, Device
from wm.splat.optimization.fitting import see_views
from wm.splat.optimization.padding import Capacity
from wm.splat.optimization.room_fit import RoomFit
from wm.splat.optimization.room_state import RoomState
from wm.splat.optimization.training import TrainingView
from wm.types import Gaussians

Report = Callable[[int, dict], None]
"""Called after every step with its number and what is worth showing."""

Keep = Callable[[Callable[[], RoomState]], None]
"""Called after every step with what gives the state on the host."""


@dataclasses.dataclass(frozen=True, eq=False)
class RoomTask:
    """A room, where it stands, and what it is fitted to. NumPy throughout."""

    room: int
    state: RoomState
    last: int  # one past the last step of the round
    views: Sequence[TrainingView]
    heldout: Sequence[TrainingView]
    neighbours: Mapping[int, Gaussians]  # other rooms that the views see, as they stood when the round began, padded
    settings: FitSettings
    raster: RasterSettings  # of `raster_for`
    seed: tuple[int, ...]  # of the scene
    rows: int  # what the room's gaussians are padded to
    columns: int  # the least that neighbours are padded to in a view; 0: a scene without neighbours
    seconds: float  # since the fit of the scene began, when the task was made


@runtime_checkable
class Place(Protocol):
    """Where rooms are fitted, one at a time."""

    def fit(self, task: RoomTask, capacity: Capacity, report: Report, keep: Keep) -> RoomState:
        """The state after the round. Raises: Interrupted, from what was raised on the way; what went wrong before."""
        ...


@dataclasses.dataclass(frozen=True)
class Here:
    """Devices of this process."""

    devices: Sequence[Device]  # the state lies on the first; batches are divided over all

    def fit(self, task: RoomTask, capacity: Capacity, report: Report, keep: Keep) -> RoomState:
        began, all_views = time.perf_counter() - task.seconds, [*task.views, *task.heldout]
        others = jax.device_put(task.neighbours, self.devices[0])  # each once, however many views see it
        behind = [[others[room] for room in sorted(set(view.sees)) if room in others] for view in all_views]
        compiled = Compiled(raster=task.raster, normals=task.settings.normal_weight > 0, capacity=capacity)
        seen = see_views(all_views, behind, task.raster, self.devices[0], lambda most: _columns(task.columns, most))
        room_fit = RoomFit(
            views=seen[: len(task.views)],
            heldout=seen[len(task.views) :],
            settings=task.settings,
            compiled=compiled,
            seed=(*task.seed, task.room),
            room=task.room,
            count=len(task.state.train.gaussians.opacity_logits),
            rows=task.rows,
            devices=self.devices,
            clock=lambda: time.perf_counter() - began,
        )
        return room_fit.run(task.state, task.last, report, keep)


def _columns(least: int, most: int) -> int:
    """Columns for neighbours, the same for all rooms if they suffice."""
    columns = least
    while 0 < columns < most:
        columns *= 2
    return columns
