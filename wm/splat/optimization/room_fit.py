"""The loop over steps for one set of gaussians: batches, the watch over the loss, refinement, the curve.

Tiers of work: per fit (views to the device, padding), per step (batch.py, then one move), per `refine_every` steps (refine.py, on
the host), at `curve_points` steps (held-out renders). The plan of a step is made from the parameters it is used with, so nothing
here depends on timing. A state is replaced, never changed: whatever interrupts the loop leaves a whole one behind.
"""

import dataclasses
from collections.abc import Callable, Sequence

import jax
import numpy as np

from wm.schema import FitSettings
from wm.splat.metrics import depth_error, normal_error, normals_from_depth, psnr
from wm.splat.optimization.batch import Compiled, Device, SeenView, ViewLoss, batch_at, batch_losses
from wm.splat.optimization.curve import HELDOUT, MEANS, FitPoint, curve_steps
from wm.splat.optimization.exposure import move_exposure, no_exposure
from wm.splat.optimization.normal_loss import smooth_pixels
from wm.splat.optimization.padding import host, pad_gaussians, pad_rows, unpad_rows
from wm.splat.optimization.refinement import is_due, no_residual, observe, refine
from wm.splat.optimization.room_state import NOTHING_SINCE, RoomState
from wm.splat.optimization.step import WHOLE, Moving, Rates, TrainState, move, rates_at, start_state
from wm.splat.optimization.trouble import TERMS, divergence, not_finite, weighted
from wm.splat.optimization.watch import Watch, diverges, start_watch, watch_step, watch_visit
from wm.types import Gaussians

_smooth_pixels = jax.jit(smooth_pixels, compiler_options=WHOLE)


class Interrupted(Exception):
    """Something ended the loop of steps, and is the cause of this; `state` is where it stood, between two steps."""

    def __init__(self, state: RoomState, *, resumable: bool) -> None:
        super().__init__(f"step {state.step}")
        self.state, self.resumable = state, resumable


@dataclasses.dataclass(frozen=True, eq=False)
class RoomFit:
    """A fit under way: what it is shown and how. The state is passed in and out."""

    views: Sequence[SeenView]
    heldout: Sequence[SeenView]
    settings: FitSettings
    compiled: Compiled
    seed: tuple[int, ...]
    room: int
    count: int  # gaussians
    rows: int  # and what they are padded to
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
            state: where to go on, on the host.
            last: one past the last step.
            report: called after every step with its number and what is worth showing.
            keep: called after every step with what gives the state on the host, from which the same bytes follow.

        Raises: Interrupted, from whatever was raised on the way.
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
            lost = any(leaf.is_deleted() for leaf in jax.tree.leaves(state.train))  # between giving buffers up and the result
            whole = self._best(state) if lost else state
            raise Interrupted(self._on_host(whole), resumable=not lost) from error
        if state.stopped is None and diverges(state.watched, ended=True):
            state = self._stopped(state, state.watched.bad_view, divergence(state.watched))
        return dataclasses.replace(self._on_host(state), watch=None)

    def _begin(self, state: RoomState) -> RoomState:
        """The state on the device, padded, with all that the settings ask for."""
        exposed = self.settings.exposure and state.exposure is None
        refined = self.settings.refine_every > 0 and state.residual is None
        state = dataclasses.replace(
            state,
            train=self._on_device(state.train),
            exposure=no_exposure(len(self.views)) if exposed else state.exposure,
            residual=no_residual(self.count) if refined else state.residual,
            watch=state.watch or start_watch(state.train.gaussians, state.step, len(self.views), len(TERMS)),
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
        moving = [self._moving(state, state.train.gaussians, view) for view in batch]
        losses = batch_losses(self.compiled, self.views, batch, moving, rates, self.devices)
        for loss in losses:
            reason = not_finite(loss.terms, self.views[loss.view].target)
            if reason:
                return self._stopped(state, loss.view, reason)
        state = dataclasses.replace(state, watch=self._watched(state, losses, rates))
        if diverges(state.watched):
            return self._stopped(state, state.watched.bad_view, divergence(state.watched))
        return self._refined(self._moved(state, losses, rates))

    def _moving(self, state: RoomState, gaussians: Gaussians, view: int) -> Moving:
        """What the gradient of a view is by: these gaussians, and what else the settings ask for."""
        return Moving(gaussians=gaussians, exposure=None if state.exposure is None else state.exposure[view])

    def _watched(self, state: RoomState, losses: Sequence[ViewLoss], rates: Rates) -> Watch:
        watch = state.watched
        for loss in losses:

            def measure(view: int = loss.view, best: Gaussians = watch.best) -> np.ndarray:
                moving = self._moving(state, pad_gaussians(best, self.rows), view)
                return weighted(self.compiled.loss(view, self.views[view], moving, rates, self.devices[0]).terms, self.settings)

            watch = watch_visit(watch, loss.view, weighted(loss.terms, self.settings), measure)
        return watch

    def _moved(self, state: RoomState, losses: Sequence[ViewLoss], rates: Rates) -> RoomState:
        exposure, residual = state.exposure, state.residual
        for loss in losses:
            if exposure is not None:
                exposure = move_exposure(exposure, loss.view, np.asarray(loss.gradient.moving.exposure), rates.exposure)
            if residual is not None:
                residual = observe(residual, np.asarray(loss.gradient.centres)[:, : self.count])
        means = np.mean([[getattr(loss.terms, name) for name in MEANS] for loss in losses], axis=0)
        train, step = move(state.train, [loss.gradient.moving.gaussians for loss in losses], rates.learning), state.step + 1
        return dataclasses.replace(
            state,
            train=train,
            step=step,
            exposure=exposure,
            residual=residual,
            since=np.append(state.since, [means], axis=0),
            watch=watch_step(state.watched, step, lambda: unpad_rows(train.gaussians, self.count)),
        )

    def _refined(self, state: RoomState) -> RoomState:
        if state.residual is None or not is_due(self.settings, state.step):
            return state
        train = refine(unpad_rows(state.train, self.count), state.residual, self.settings)
        return dataclasses.replace(state, train=self._on_device(train), residual=no_residual(self.count))

    def _stopped(self, state: RoomState, view: int, reason: str) -> RoomState:
        """The last good state with the reason: the best one if the last visits were bad, else this one."""
        kept = self._best(state) if state.watched.recent.any() else state
        where = f"room {self.room}, step {state.step}, view {view} of {len(self.views)}"
        return dataclasses.replace(kept, stopped=f"{where}: {reason}; kept the state of step {kept.step}")

    def _best(self, state: RoomState) -> RoomState:
        """The best state, without anything of the steps after it. No fit goes on from here: tone and residual are not kept."""
        step = state.watched.best_step
        return RoomState(
            train=jax.device_put(start_state(pad_gaussians(state.watched.best, self.rows)), self.devices[0]),
            step=step,
            history=tuple(point for point in state.history if point.step <= step),
            watch=state.watch,
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
    """What HELDOUT names, of one view: PSNR over its usable pixels, M-MAE over those where the scaffold is hit, N-Ang over those
    where it is smooth, its normals by the same differences of its own depth."""
    render = compiled.render(gaussians, seen)
    target = host(seen.target)
    value = psnr(render.rgb, target.rgb / np.float32(255), target.mask)
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
