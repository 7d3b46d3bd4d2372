"""The loop over steps for one set of gaussians: batches, the divergence monitor, refinement, the curve.

Tiers of work: per fit (views to the device, padding), per step (batch.py, then one move), per `refine_every` steps
(refinement.py, on the host), at `curve_points` steps (held-out renders). The plan of a step is made from the parameters it is
used with, so nothing here depends on timing. A state is replaced, never changed in place, so an exception at any point leaves a
whole state behind.
"""

import dataclasses
from collections.abc import Callable, Sequence

import jax
import numpy as np

from wm.compiler_options import UNPARTITIONED
from wm.schema import FitSettings
from wm.splat.metrics import depth_error, normal_error, normals_from_depth, psnr
from wm.splat.optimization.batch import Compiled, Device, SeenView, ViewLoss, batch_at, batch_losses
from wm.splat.optimization.curve import HELDOUT, MEANS, FitPoint, curve_steps
from wm.splat.optimization.diagnosis import TERMS, divergence, not_finite, weighted_terms
from wm.splat.optimization.divergence_monitor import DivergenceMonitor, diverges, monitor_step, monitor_visit, start_monitor
from wm.splat.optimization.exposure import move_exposure, no_exposure
from wm.splat.optimization.normal_loss import smooth_pixels
from wm.splat.optimization.padding import host, pad_gaussians, pad_rows, unpad_rows
from wm.splat.optimization.refinement import is_due, no_residual, observe, refine
from wm.splat.optimization.room_state import NOTHING_SINCE, RoomState
from wm.splat.optimization.step import Rates, Trainable, TrainState, move, rates_at, start_state
from wm.types import Gaussians

_smooth_pixels = jax.jit(smooth_pixels, compiler_options=UNPARTITIONED)


class Interrupted(Exception):
    """An exception ended the loop of steps, and is the cause of this one; `state` is that between the last two steps."""

    def __init__(self, state: RoomState, *, resumable: bool) -> None:
        super().__init__(f"step {state.step}")
        self.state, self.resumable = state, resumable


@dataclasses.dataclass(frozen=True, eq=False)
class RoomFit:
    """The constants of a fit under way: its views, settings and devices. The state is passed in and out."""

    views: Sequence[SeenView]
    heldout: Sequence[SeenView]
    settings: FitSettings
    compiled: Compiled
    seed: tuple[int, ...]
    room: int
    count: int  # gaussians
    rows: int  # the number of rows to which they are padded
    devices: Sequence[Device]  # the state lies on the first; a batch is divided over all
    clock: Callable[[], float]  # seconds since the fit began

    def run(
        self,
        state: RoomState,
        last: int,
        report: Callable[[int, dict], None],
        keep: Callable[[Callable[[], RoomState]], None] = lambda state: None,
    ) -> RoomState:
        """The state after the steps up to `last` (exclusive) of `settings.steps`, or after fewer and with a reason.

        Args:
            state: the state before the first of these steps, on the host.
            last: one past the last step.
            report: called after every step with its number and a dict of values worth showing.
            keep: called after every step with a function that returns the state on the host, from which the same bytes follow.

        Raises: Interrupted, whose cause is whatever was raised on the way.
        """
        state = self._begin(state)
        try:
            while state.step < last and state.stopped is None:
                state = self._step(state)
                if state.stopped is None:
                    report(state.step, {"loss": float(state.since[-1][0])})
                    state = self._measured(state)
                    keep(lambda state=state: self._on_host(state))
        except BaseException as error:
            lost = any(leaf.is_deleted() for leaf in jax.tree.leaves(state.train))  # between donating the buffers and the result
            whole = self._best(state) if lost else state
            raise Interrupted(self._on_host(whole), resumable=not lost) from error
        if state.stopped is None and diverges(state.running_monitor, ended=True):
            state = self._stopped(state, state.running_monitor.bad_view, divergence(state.running_monitor))
        return dataclasses.replace(self._on_host(state), monitor=None)

    def _begin(self, state: RoomState) -> RoomState:
        """The state on the device, padded, with exposures, residual and monitor as the settings ask for."""
        exposed = self.settings.exposure and state.exposure is None
        refined = self.settings.refine_every > 0 and state.residual is None
        state = dataclasses.replace(
            state,
            train=self._on_device(state.train),
            exposure=no_exposure(len(self.views)) if exposed else state.exposure,
            residual=no_residual(self.count) if refined else state.residual,
            monitor=state.monitor or start_monitor(state.train.gaussians, state.step, len(self.views), len(TERMS)),
        )
        return self._measured(state)

    def _on_device(self, train: TrainState) -> TrainState:
        padded = pad_rows(train, self.rows)
        return jax.device_put(dataclasses.replace(padded, gaussians=pad_gaussians(train.gaussians, self.rows)), self.devices[0])

    def _on_host(self, state: RoomState) -> RoomState:
        return dataclasses.replace(state, train=unpad_rows(state.train, self.count))

    def _step(self, state: RoomState) -> RoomState:
        rates = rates_at(self.settings, state.step, self.settings.steps)
        batch = batch_at(self.seed, state.step, self.settings.batch, len(self.views))
        trainable = [self._trainable(state, state.train.gaussians, view) for view in batch]
        losses = batch_losses(self.compiled, self.views, batch, trainable, rates, self.devices)
        for loss in losses:
            reason = not_finite(loss.terms, self.views[loss.view].target)
            if reason:
                return self._stopped(state, loss.view, reason)
        state = dataclasses.replace(state, monitor=self._monitored(state, losses, rates))
        if diverges(state.running_monitor):
            return self._stopped(state, state.running_monitor.bad_view, divergence(state.running_monitor))
        return self._refined(self._moved(state, losses, rates))

    def _trainable(self, state: RoomState, gaussians: Gaussians, view: int) -> Trainable:
        """The trainable parameters of a view: these gaussians, and its exposure if the settings ask for it."""
        return Trainable(gaussians=gaussians, exposure=None if state.exposure is None else state.exposure[view])

    def _monitored(self, state: RoomState, losses: Sequence[ViewLoss], rates: Rates) -> DivergenceMonitor:
        monitor = state.running_monitor
        for loss in losses:

            def measure(view: int = loss.view, best: Gaussians = monitor.best) -> np.ndarray:
                trainable = self._trainable(state, pad_gaussians(best, self.rows), view)
                loss = self.compiled.loss(view, self.views[view], trainable, rates, self.devices[0])
                return weighted_terms(loss.terms, self.settings)

            monitor = monitor_visit(monitor, loss.view, weighted_terms(loss.terms, self.settings), measure)
        return monitor

    def _moved(self, state: RoomState, losses: Sequence[ViewLoss], rates: Rates) -> RoomState:
        exposure, residual = state.exposure, state.residual
        for loss in losses:
            if exposure is not None:
                exposure = move_exposure(exposure, loss.view, np.asarray(loss.gradient.trainable.exposure), rates.exposure)
            if residual is not None:
                residual = observe(residual, np.asarray(loss.gradient.centres)[:, : self.count])
        means = np.mean([[getattr(loss.terms, name) for name in MEANS] for loss in losses], axis=0)
        train, step = move(state.train, [loss.gradient.trainable.gaussians for loss in losses], rates.learning), state.step + 1
        return dataclasses.replace(
            state,
            train=train,
            step=step,
            exposure=exposure,
            residual=residual,
            since=np.append(state.since, [means], axis=0),
            monitor=monitor_step(state.running_monitor, step, lambda: unpad_rows(train.gaussians, self.count)),
        )

    def _refined(self, state: RoomState) -> RoomState:
        if state.residual is None or not is_due(self.settings, state.step):
            return state
        train = refine(unpad_rows(state.train, self.count), state.residual, self.settings)
        return dataclasses.replace(state, train=self._on_device(train), residual=no_residual(self.count))

    def _stopped(self, state: RoomState, view: int, reason: str) -> RoomState:
        """The last good state with the reason: the best state if any of the last visits was bad, else this one."""
        kept = self._best(state) if state.running_monitor.recent.any() else state
        where = f"room {self.room}, step {state.step}, view {view} of {len(self.views)}"
        return dataclasses.replace(kept, stopped=f"{where}: {reason}; kept the state of step {kept.step}")

    def _best(self, state: RoomState) -> RoomState:
        """The best state, without the curve of later steps. No fit goes on from here, so exposure and residual are not kept."""
        step = state.running_monitor.best_step
        return RoomState(
            train=jax.device_put(start_state(pad_gaussians(state.running_monitor.best, self.rows)), self.devices[0]),
            step=step,
            history=tuple(point for point in state.history if point.step <= step),
            monitor=state.monitor,
        )

    def _measured(self, state: RoomState) -> RoomState:
        """The state with one more point of the curve, if one is due."""
        done = state.history[-1].step if state.history else -1
        if done == state.step or state.step not in curve_steps(self.settings):
            return state
        means = state.since.mean(axis=0) if len(state.since) else np.full(len(MEANS), np.nan)
        errors = [view_error(self.compiled, state.train.gaussians, seen) for seen in self.heldout]
        heldout = np.mean(errors, axis=0) if errors else np.full(len(HELDOUT), np.nan)
        values = dict(zip((*MEANS, *HELDOUT), map(float, (*means, *heldout))))
        point = FitPoint(seconds=self.clock(), step=state.step, room=self.room, **values)
        return dataclasses.replace(state, history=(*state.history, point), since=NOTHING_SINCE)


def view_error(compiled: Compiled, gaussians: Gaussians, seen: SeenView) -> tuple[float, float, float]:
    """The errors of one view that HELDOUT names: PSNR over its usable pixels, M-MAE over those where the scaffold is hit, N-Ang
    over those where the scaffold is smooth, with its normals from the same differences of its depth."""
    render = compiled.render(gaussians, seen)
    target = host(seen.target)
    value = psnr(np.clip(render.rgb, 0, 1), target.rgb / np.float32(255), target.mask)
    if not compiled.raster.depth:
        return value, float("nan"), float("nan")
    inner = np.zeros_like(target.mask)
    if min(inner.shape) >= 3:
        inner[1:-1, 1:-1] = np.asarray(_smooth_pixels(target.depth)) & target.mask[1:-1, 1:-1]
    normals = normals_from_depth(target.depth, target.camera)
    return (
        value,
        depth_error(render.depth, target.depth, target.mask).mae,
        normal_error(render.depth, target.camera, normals, inner).angle,
    )
