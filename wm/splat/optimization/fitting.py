"""`fit`: gaussians optimised toward views of one room, or of anything else that the views show together."""

import dataclasses
import time
from collections.abc import Callable, Sequence

import jax
import jax.numpy as jnp
import numpy as np

from wm.schema import FitSettings, RasterSettings
from wm.splat.optimization.batch import Compiled, Device, SeenView, default_device, to_target
from wm.splat.optimization.checks import check_fit
from wm.splat.optimization.curve import FitPoint
from wm.splat.optimization.frozen import join_columns, pad_columns, visible_columns
from wm.splat.optimization.padding import Capacity, host, pad_gaussians
from wm.splat.optimization.room_fit import Interrupted, RoomFit
from wm.splat.optimization.room_state import RoomState, initial_state
from wm.splat.optimization.step import project_view, raster_for
from wm.splat.optimization.training import TrainingView
from wm.splat.rasterizer.checks import check_gaussians, check_raster
from wm.splat.rasterizer.projection import DEFAULTS
from wm.types import Gaussians

Progress = Callable[[int, int, dict], None]
"""Called with (steps done, steps in all, a dict of values worth showing) after every step."""


@dataclasses.dataclass(frozen=True, eq=False)
class Fit:
    """The result of a fit.

    Attributes:
        gaussians: NumPy float32 leaves, in the order of those it started from
        history: error against time up to these gaussians, without points of later steps that were discarded
        stopped: why it ended early, in one sentence; None: it ran to its end
    """

    gaussians: Gaussians
    history: tuple[FitPoint, ...]
    stopped: str | None


class FitError(RuntimeError):
    """An exception, of `progress` for example, ended a fit, and is the cause of this one; `fit` is what was reached."""

    def __init__(self, message: str, fit: Fit) -> None:
        super().__init__(message)
        self.fit = fit


def fit(
    gaussians: Gaussians,
    views: Sequence[TrainingView],
    *,
    settings: FitSettings,
    raster: RasterSettings = DEFAULTS,
    key: jax.Array,
    frozen: Gaussians | None = None,
    heldout: Sequence[TrainingView] = (),
    progress: Progress | None = None,
    devices: Sequence[Device] | None = None,
) -> Fit:
    """Gaussians moved so that their renders agree with the views and their depth with the scaffold.

    Args:
        gaussians: where to start; not changed. On host or device.
        views: what they should look like; at least one.
        settings: steps, learning rates, weights of the loss, points of the curve. (`rounds` is for `fit_scene`.)
        raster: the rasterizer's constants; `depth` is set here: without depth weight no depth is rendered.
        key: a JAX key; the order of the views follows from it. Same key, same bytes.
        frozen: gaussians that are rendered too and not moved. Those well behind the scaffold of a view are left out (frozen.py).
        heldout: views to measure the curve on; never trained on.
        progress: called after every step.
        devices: where to compute; JAX's default device if None. Several share the views of a batch, and change no byte.

    Returns: the gaussians and the curve. Where a loss or gradient is not finite, or the loss diverges (divergence_monitor.py),
        the fit ends early with the last good state, or the best, and `stopped` names room, step, view and term; never NaN. A
        KeyboardInterrupt ends it likewise.
    Raises: TypeError or ValueError that names what is wrong with an argument: no views, a number of the settings out of its
        range, gaussians of other shapes or not finite, no key. FitError from any other exception on the way.
    """
    check_fit(settings)
    check_raster(raster)
    if not views:
        raise ValueError("a fit needs at least one view")
    if frozen is not None:
        check_gaussians(frozen, "frozen")
    start, seed, raster = initial_state(gaussians), seed_of(key), raster_for(settings, raster)
    devices = list(devices or [default_device()])
    started = time.perf_counter()
    behind = [] if frozen is None else [jax.device_put(pad_gaussians(frozen, len(frozen.opacity_logits)), devices[0])]
    shown = see_views([*views, *heldout], [behind] * (len(views) + len(heldout)), raster, devices[0])
    room_fit = RoomFit(
        views=shown[: len(views)],
        heldout=shown[len(views) :],
        settings=settings,
        compiled=Compiled(raster=raster, normals=settings.normal_weight > 0, capacity=Capacity()),
        seed=seed,
        room=views[0].room,
        count=len(gaussians.opacity_logits),
        rows=len(gaussians.opacity_logits),
        devices=devices,
        clock=lambda: time.perf_counter() - started,
    )

    def report(done: int, info: dict) -> None:
        if progress is not None:
            progress(done, settings.steps, info)

    try:
        return _result(room_fit.run(start, settings.steps, report))
    except Interrupted as interrupted:
        cause, reached = interrupted.__cause__, interrupted.state
        where = f"room {room_fit.room}, step {reached.step}"
        if isinstance(cause, KeyboardInterrupt):
            return _result(dataclasses.replace(reached, stopped=f"{where}: interrupted"))
        message = f"{where}: {type(cause).__name__}: {cause}"
        raise FitError(message, _result(dataclasses.replace(reached, stopped=message))) from cause


def _result(state: RoomState) -> Fit:
    return Fit(gaussians=state.train.gaussians, history=state.history, stopped=state.stopped)


def see_views(
    views: Sequence[TrainingView],
    frozen: Sequence[Sequence[Gaussians]],
    raster: RasterSettings,
    device: Device,
    columns_for: Callable[[int], int] = lambda most: most,
) -> list[SeenView]:
    """Views on a device, each with the projections of the frozen gaussians that it sees.

    Args:
        views: n views.
        frozen: for each view, sets of gaussians on the device.
        raster: the rasterizer's constants.
        device: where the arrays are put.
        columns_for: maps the largest number of columns that one view needs to the number to which all are padded; 0: no columns.
    """
    targets = [to_target(view, device) for view in views]
    parts = [
        [visible_columns(host(project_view(others, target.camera, raster=raster)), view.depth) for others in sets]
        for view, target, sets in zip(views, targets, frozen)
    ]
    seen = [join_columns(*sets) if sets else None for sets in parts]
    columns = columns_for(max((part.opacity.shape[-1] for part in seen if part is not None), default=0))
    padded = [jax.device_put(pad_columns(part, columns), device) if columns else None for part in seen]
    return [SeenView(target=target, frozen=part) for target, part in zip(targets, padded)]


def seed_of(key: jax.Array) -> tuple[int, ...]:
    """The integers of a JAX key, typed or raw.

    Raises: TypeError for anything else.
    """
    if not isinstance(key, jax.Array | np.ndarray):
        raise TypeError(f"the key is a {type(key).__name__}; a JAX key, such as jax.random.key(0), would be right")
    data = jax.random.key_data(key) if jnp.issubdtype(key.dtype, jax.dtypes.prng_key) else key
    return tuple(int(word) for word in np.asarray(data).ravel())
