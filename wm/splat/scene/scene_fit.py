"""Many rooms: each is a fit of its own, beside neighbours held still.

Block Jacobi: in every round each room moves its own gaussians toward its own views, and what those views see of other rooms,
through doors, is frozen as it stood when the round began. So the rooms of a round are independent tasks (room_task.py), which run
side by side in a `concurrent.futures.Executor`, and the result does not depend on which ran where or when. Cost is linear in
rooms. Rooms share compiled steps: their gaussians are padded to a few common sizes.

For each room under way there is one thread of the caller that prepares the task (the images of a room are in memory only while it
is fitted), submits it to the executor, waits for its outcome and stores that.
"""

import contextlib
import dataclasses
from collections.abc import Sequence
from concurrent.futures import Executor, ThreadPoolExecutor

import jax

from wm.host import cores
from wm.schema import FitSettings, RasterSettings
from wm.splat.optimization.batch import Device
from wm.splat.optimization.checks import check_fit
from wm.splat.optimization.curve import FitPoint
from wm.splat.optimization.fitting import Progress, seed_of
from wm.splat.optimization.padding import Capacity
from wm.splat.optimization.room_state import initial_state
from wm.splat.optimization.step import raster_for
from wm.splat.rasterizer.checks import check_raster
from wm.splat.rasterizer.projection import DEFAULTS
from wm.splat.scene.scene_progress import Checkpoints, Load, SceneProgress, Store
from wm.splat.scene.scene_rooms import RoomViews, SceneRooms
from wm.types import Gaussians


@dataclasses.dataclass(frozen=True, eq=False)
class SceneFit:
    """The result of the fit of a scene.

    Attributes:
        gaussians: by room, NumPy float32 leaves, each in the order it started in
        history: by room, then step
        stopped: one sentence for each room that ended early
    """

    gaussians: tuple[Gaussians, ...]
    history: tuple[FitPoint, ...]
    stopped: tuple[str, ...]


def fit_scene(
    gaussians: Sequence[Gaussians],
    views: RoomViews,
    *,
    settings: FitSettings,
    raster: RasterSettings = DEFAULTS,
    key: jax.Array,
    heldout: RoomViews = lambda room: (),
    load: Load = lambda round_, room: None,
    store: Store = lambda round_, room, arrays: None,
    checkpoint_seconds: float = 60.0,
    progress: Progress | None = None,
    capacity: Capacity | None = None,
    devices: Sequence[Device] | None = None,
    executor: Executor | None = None,
    workers: int | None = None,
) -> SceneFit:
    """The gaussians of every room, fitted to its views.

    Args:
        gaussians: where each room starts, by room index; not changed. A room may have none.
        views: the training views of a room, asked for in every round (so they may come from disk). `TrainingView.sees` names the
            other rooms whose gaussians a view is rendered with. A room without views keeps its gaussians.
        settings: `steps` per room in all, divided over `rounds`.
        raster: the rasterizer's constants; `depth` is set here.
        key: a JAX key. Same arguments and key, same bytes, on any number of devices and by any executor.
        heldout: a few views of a room to measure its curve on; never trained on.
        load, store: checkpoints by (round, room), the last of each counts: what was stored is not computed again, and ends in the
            same bytes. `store` is called from threads, one for each room under way.
        checkpoint_seconds: a room is stored when this long has passed since it began or was stored, and when its round ends.
        progress: called after every step of any room, one call at a time.
        capacity: of an earlier fit of the same shapes, to share what was compiled for it; None: a new one.
        devices: the devices of this process that rooms are fitted on; all of JAX's default platform if None. Rooms share them if
            there are fewer devices than rooms under way; a room has several, which divide its batches, if there are more.
        executor: runs the fit of a room in a round as one task; it is not shut down here. None: one thread per room under way.
            An executor whose workers do not share the memory of this process (a `ProcessPoolExecutor`, a cluster) fits each room
            on the first device of the worker, and tells nothing before the round of the room has ended: `progress` is then called
            once for all its steps, and there are no checkpoints within a round.
        workers: how many rooms are under way at once; None: one per core, or one per device if there are more of these.

    Returns: the gaussians, the curves and what stopped early.
    Raises: TypeError or ValueError naming what is wrong with an argument, as `fit`. The error of a room (of `views` or of the
        executor, say) once all rooms ended their round. A KeyboardInterrupt as soon as every room under way has ended its step
        (its round, where the executor does not share memory); all that was reached is stored.
    """
    check_fit(settings)
    check_raster(raster)
    rooms = SceneRooms(
        states=[initial_state(start, f"gaussians[{room}]") for room, start in enumerate(gaussians)],
        views=views,
        heldout=heldout,
        settings=settings,
        raster=raster_for(settings, raster),
        seed=seed_of(key),
        report=SceneProgress(len(gaussians) * settings.steps, progress),
        checkpoints=Checkpoints(load, store, checkpoint_seconds),
        capacity=capacity or Capacity(),
        shares=_device_shares(list(devices or jax.devices()), workers, len(gaussians)),
    )
    with contextlib.ExitStack() as stack:
        at_once = len(rooms.shares)
        pool = executor or stack.enter_context(ThreadPoolExecutor(at_once, thread_name_prefix="wm-fit"))
        callers = stack.enter_context(ThreadPoolExecutor(at_once, thread_name_prefix="wm-room"))
        largest_first = sorted(range(len(gaussians)), key=lambda room: -len(gaussians[room].opacity_logits))
        for round_ in range(settings.rounds):
            running = {room: callers.submit(rooms.after_round, round_, room, pool) for room in largest_first}
            try:
                rooms.states = [running[room].result() for room in range(len(gaussians))]
            except KeyboardInterrupt:
                rooms.halt()
                callers.shutdown(cancel_futures=True)
                raise
    return SceneFit(
        gaussians=tuple(state.train.gaussians for state in rooms.states),
        history=tuple(point for state in rooms.states for point in state.history),
        stopped=tuple(state.stopped for state in rooms.states if state.stopped),
    )


def _device_shares(devices: list[Device], workers: int | None, rooms: int) -> list[list[Device]]:
    """The devices of each of the rooms that are under way at once."""
    workers = workers or max(cores(), len(devices))
    dealt = [devices[k % len(devices)] for k in range(max(workers, len(devices)))]
    at_once = max(min(workers, rooms), 1)
    return [dealt[first::at_once] for first in range(at_once)]
