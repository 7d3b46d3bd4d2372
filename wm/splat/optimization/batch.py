"""The batch of views of a step, and the gradient of each of them, computed on one or several devices.

Gradients do not depend on one another, so each of d devices computes those of every d-th view of the batch, one thread per
device: projection, plan (planner.py), gradient. They are returned in the order of the batch, so their mean does not depend on d.
"""

import dataclasses
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np

from wm.schema import RasterSettings
from wm.splat.optimization.frozen import join_columns
from wm.splat.optimization.padding import Capacity, host, plan_with
from wm.splat.optimization.step import Gradient, Rates, StepTerms, Target, Trainable, project_view, rasterize_view, view_gradient
from wm.splat.optimization.training import TrainingView
from wm.splat.rasterizer.planner import plans_on_host
from wm.splat.rasterizer.projection import Projected
from wm.types import Camera, Gaussians, Render

Device = Any
"""A `jax.Device`, which is a variable to type checkers."""


def default_device() -> Device:
    """The device on which JAX computes by default: `jax.default_device`, in any of its forms, or the first device."""
    (device,) = jnp.zeros(()).devices()
    return device


@dataclasses.dataclass(frozen=True, eq=False)
class SeenView:
    """A view on the device, and the projections of the frozen gaussians in it."""

    target: Target
    frozen: Projected | None  # on the device too


@dataclasses.dataclass(frozen=True, eq=False)
class ViewLoss:
    """The loss of one view and its gradient."""

    view: int
    terms: StepTerms  # on the host
    gradient: Gradient  # on the device


@dataclasses.dataclass(frozen=True, eq=False)
class Compiled:
    """The constants for which the steps of a fit are compiled."""

    raster: RasterSettings  # of `raster_for`
    normals: bool  # whether the loss has a term of normals
    capacity: Capacity

    def loss(self, view: int, seen: SeenView, trainable: Trainable, rates: Rates, device: Device) -> ViewLoss:
        """The loss of one view and its gradient, computed on a device."""
        target, frozen, trainable = jax.device_put((seen.target, seen.frozen, trainable), device)
        own = project_view(trainable.gaussians, target.camera, raster=self.raster)
        projected, plan = self._planned(own, frozen, target.camera)
        kind = (device, target.camera.width, target.camera.height, projected.mean2d.shape[1], len(plan.ids))
        with self.capacity.compiled(*kind):
            terms, gradient = view_gradient(trainable, own, target, frozen, plan, rates, raster=self.raster, normals=self.normals)
        return ViewLoss(view=view, terms=jax.device_get(terms), gradient=gradient)

    def render(self, gaussians: Gaussians, seen: SeenView) -> Render:
        """The render of a view, on the host."""
        camera = seen.target.camera
        own = project_view(gaussians, camera, raster=self.raster)
        projected, plan = self._planned(own, seen.frozen, camera)
        return host(rasterize_view(projected, plan, width=camera.width, height=camera.height, raster=self.raster))

    def _planned(self, own: Projected, frozen: Projected | None, camera: Camera):
        """The projections of all gaussians of a view, and their plan."""
        parts = [own, frozen]
        projected = join_columns(*(map(host, parts) if plans_on_host(own, self.raster) else parts))
        return projected, plan_with(projected, camera.width, camera.height, self.raster, self.capacity)


def batch_losses(
    compiled: Compiled,
    views: Sequence[SeenView],
    batch: Sequence[int],
    trainable: Sequence[Trainable],
    rates: Rates,
    devices: Sequence[Device],
) -> list[ViewLoss]:
    """The losses of a batch of views and their gradients, in its order, gradients on the first device.

    Args:
        compiled: what the steps are compiled for.
        views: all views.
        batch: indices into them.
        trainable: per view of the batch, what its loss is differentiated with respect to.
        rates: of the step.
        devices: one or more; those beyond the size of the batch stay idle.
    """

    def share(first: int) -> list[ViewLoss]:
        mine = range(first, len(batch), len(devices))
        return [compiled.loss(batch[k], views[batch[k]], trainable[k], rates, devices[first]) for k in mine]

    workers = min(len(devices), len(batch))
    if workers == 1:
        return share(0)
    with ThreadPoolExecutor(max_workers=workers, thread_name_prefix="wm-batch") as pool:
        shares = list(pool.map(share, range(workers)))
    losses = [shares[k % len(devices)][k // len(devices)] for k in range(len(batch))]
    return [dataclasses.replace(loss, gradient=jax.device_put(loss.gradient, devices[0])) for loss in losses]


def batch_at(seed: tuple[int, ...], step: int, size: int, views: int) -> list[int]:
    """Indices of the views of a step: `size` of them, or all if there are fewer."""
    size = min(size, views)
    return [view_at(seed, visit, views) for visit in range(step * size, (step + 1) * size)]


def view_at(seed: tuple[int, ...], visit: int, views: int) -> int:
    """The index of the view of a visit: every epoch is a permutation of its own, which depends on the seed alone."""
    epoch, place = divmod(visit, views)
    return int(np.random.default_rng(np.random.SeedSequence([*seed, epoch])).permutation(views)[place])


def to_target(view: TrainingView, device: Device) -> Target:
    """A training view on a device, as float32; depth that is not finite becomes 0 where the mask leaves it out anyway."""
    camera = jax.tree.map(lambda x: np.asarray(x, np.float32), view.camera)
    depth = np.asarray(view.depth, np.float32)
    depth = np.where(view.mask | np.isfinite(depth), depth, np.float32(0))
    return jax.device_put(Target(camera=camera, rgb=view.rgb, depth=depth, mask=view.mask), device)
