"""The loop over steps for one set of gaussians on one device: order of the views, plans, padding, held-out error.

Tiers of work: per fit (views to the device, padding), per step (projection, plan on the host, train step), at `curve_points`
steps (held-out renders). The plan of a step is made from the parameters it is used with, so nothing here depends on timing.
"""

import contextlib
import dataclasses
import threading
from collections.abc import Callable, Iterator, Sequence
from typing import Any

import jax
import numpy as np

from wm.schema import FitSettings, RasterSettings
from wm.splat.frozen import join_columns
from wm.splat.metrics import depth_error, psnr
from wm.splat.project import Projected
from wm.splat.step import Rates, StepTerms, Target, TrainState, project_view, rasterize_view, rates_at, train_step
from wm.splat.tiles import plan_tiles
from wm.splat.training import TrainingView
from wm.types import Gaussians

Device = Any
"""A `jax.Device`, which is a variable to type checkers."""

CULLED_LOGIT = -50.0
"""Opacity logit of padding: far below any alpha cut, so that padding is projected, culled, and neither listed nor moved."""

HEADROOM = 3.0
"""Room in a plan's capacity over what the first views need: gaussians grow while they are fitted."""


@dataclasses.dataclass(frozen=True)
class FitPoint:
    """A fit at one step: means of the loss terms since the last point, and held-out error if there are such views."""

    seconds: float  # wall-clock since the fit began
    step: int  # steps of this room so far
    room: int
    loss: float
    l1: float
    dissimilarity: float  # mean 1 - SSIM
    depth: float  # metres
    psnr: float  # held-out, dB; NaN without held-out views
    m_mae: float  # held-out, metres; NaN without held-out views or without depth


class Capacity:
    """How many plan entries the compiled steps have room for: shared by all fits of a scene, only ever grown (in steps of x1.5).

    It bounds recompilation and changes no result: entries beyond a plan's own are padding.
    """

    def __init__(self) -> None:
        self._entries: int | None = None
        self._lock = threading.Lock()
        self._compiled: set[tuple[int, ...]] = set()
        self._compiling = threading.Lock()

    @property
    def entries(self) -> int | None:
        return self._entries

    def grow(self, entries: int) -> None:
        with self._lock:
            self._entries = max(self._entries or 0, entries)

    @contextlib.contextmanager
    def compiled(self, *shape: int) -> Iterator[None]:
        """Around a step of a shape: the first of its kind is alone, so that threads do not compile the same step side by side."""
        if shape in self._compiled:
            yield
            return
        with self._compiling:
            yield
            self._compiled.add(shape)


@dataclasses.dataclass(frozen=True, eq=False)
class SeenView:
    """A view on the device, and the frozen gaussians as it sees them."""

    target: Target
    frozen: Projected | None  # NumPy


@dataclasses.dataclass(frozen=True, eq=False)
class RoomFit:
    """A fit under way: what it is shown and how. The state is passed in and out."""

    views: Sequence[SeenView]
    heldout: Sequence[SeenView]
    settings: FitSettings
    raster: RasterSettings  # `depth` already set from the weight
    seed: tuple[int, ...]
    room: int
    capacity: Capacity
    clock: Callable[[], float]  # seconds since the fit began

    def run(
        self, state: TrainState, first: int, last: int, report: Callable[[int, dict], None]
    ) -> tuple[TrainState, list[FitPoint], str | None]:
        """Steps `first` to `last` (exclusive) of `settings.steps`; the state's buffers are used up.

        Returns: the state, the points of the curve that lie in this stretch, and why it stopped early (None: it did not).
        """
        points, since = [], []
        marks = curve_steps(self.settings)
        if first == 0 and 0 in marks:
            points.append(self._point(state, 0, []))
        for step in range(first, last):
            seen = self.views[view_at(self.seed, step, len(self.views))]
            state, terms = self._step(state, seen, rates_at(self.settings, step, self.settings.steps))
            if not terms.finite:
                loss = float(terms.loss)
                return state, points, f"room {self.room}, step {step}: loss {loss} or gradient not finite; kept the state before"
            since.append(terms)
            report(step + 1, {"loss": float(terms.loss)})
            if step + 1 in marks:
                points.append(self._point(state, step + 1, since))
                since = []
        return state, points, None

    def _step(self, state: TrainState, seen: SeenView, rates: Rates) -> tuple[TrainState, StepTerms]:
        camera = seen.target.camera
        projected = join_columns(host(project_view(state.gaussians, camera, raster=self.raster)), seen.frozen)
        plan = plan_with(projected, camera.width, camera.height, self.raster, self.capacity)
        normals = self.settings.normal_weight > 0
        with self.capacity.compiled(camera.width, camera.height, projected.opacity.shape[-1], len(plan.ids)):
            state, terms = train_step(state, seen.target, seen.frozen, plan, rates, raster=self.raster, normals=normals)
        return state, jax.device_get(terms)

    def _point(self, state: TrainState, step: int, since: list[StepTerms]) -> FitPoint:
        def mean(name: str) -> float:
            return float(np.mean([getattr(terms, name) for terms in since])) if since else float("nan")

        psnr, m_mae = self._heldout_error(state.gaussians)
        terms = {name: mean(name) for name in ("loss", "l1", "dissimilarity", "depth")}
        return FitPoint(seconds=self.clock(), step=step, room=self.room, **terms, psnr=psnr, m_mae=m_mae)

    def _heldout_error(self, gaussians: Gaussians) -> tuple[float, float]:
        errors = [view_error(gaussians, seen, self.raster, self.capacity) for seen in self.heldout]
        psnr, m_mae = np.mean(errors, axis=0) if errors else (float("nan"), float("nan"))
        return float(psnr), float(m_mae)


def view_error(gaussians: Gaussians, seen: SeenView, raster: RasterSettings, capacity: Capacity) -> tuple[float, float]:
    """PSNR in dB over the usable pixels of a view, and mean |depth - scaffold| in metres over those where the scaffold is hit."""
    camera = seen.target.camera
    projected = join_columns(host(project_view(gaussians, camera, raster=raster)), seen.frozen)
    plan = plan_with(projected, camera.width, camera.height, raster, capacity)
    render = rasterize_view(projected, plan, width=camera.width, height=camera.height, raster=raster)
    rgb, depth = np.asarray(render.rgb), np.asarray(render.depth)
    mask, scaffold = np.asarray(seen.target.mask), np.asarray(seen.target.depth)
    m_mae = depth_error(depth, scaffold, mask).mae if raster.depth else float("nan")
    return psnr(rgb, np.asarray(seen.target.rgb) / np.float32(255), mask), m_mae


def host(tree):
    """The arrays of a record on the host."""
    return jax.tree.map(np.asarray, tree)


def plan_with(projected, width: int, height: int, raster: RasterSettings, capacity: Capacity):
    """The plan of one image, at the shared capacity."""
    room = capacity.entries
    plan = plan_tiles(projected, width, height, raster, capacity=room)
    if room is None:
        plan = plan_tiles(projected, width, height, raster, capacity=int(len(plan.ids) * HEADROOM))
    capacity.grow(len(plan.ids))
    return plan


def curve_steps(settings: FitSettings) -> list[int]:
    """Steps after which a fit is measured: `curve_points` of them from the start to the end, denser early on."""
    if settings.curve_points < 1:
        return []
    share = np.linspace(0, 1, settings.curve_points) ** 2 if settings.curve_points > 1 else np.ones(1)
    return sorted({round(s * settings.steps) for s in share})


def view_at(seed: tuple[int, ...], step: int, views: int) -> int:
    """Which view a step is taken toward: every epoch is its own permutation, a function of the seed alone."""
    epoch, place = divmod(step, views)
    return int(np.random.default_rng(np.random.SeedSequence([*seed, epoch])).permutation(views)[place])


def to_target(view: TrainingView, device: Device) -> Target:
    """A training view on a device; what is not NumPy float32 becomes it."""
    camera = jax.tree.map(lambda x: np.asarray(x, np.float32), view.camera)
    target = Target(camera=camera, rgb=view.rgb, depth=np.asarray(view.depth, np.float32), mask=view.mask)
    return jax.device_put(target, device)


def pad_gaussians(gaussians: Gaussians, size: int) -> Gaussians:
    """Gaussians in fresh NumPy float32 arrays of `size` rows; those added are culled wherever they are seen from."""
    padded = pad_rows(gaussians, size)
    padded.opacity_logits[len(gaussians.opacity_logits) :] = CULLED_LOGIT
    return padded


def pad_rows(record, size: int):
    """A record of arrays as fresh NumPy float32 arrays with `size` rows, those added zero; scalars are left alone."""

    def pad(x):
        x = np.asarray(x)
        return np.concatenate([x.astype(np.float32), np.zeros((size - len(x), *x.shape[1:]), np.float32)]) if x.ndim else x

    return jax.tree.map(pad, record)


def unpad_rows(record, size: int):
    """The first `size` rows of every array of a record, as fresh NumPy arrays; scalars are left alone."""
    return jax.tree.map(lambda x: np.array(x)[:size].copy() if np.ndim(x) else np.array(x), record)
