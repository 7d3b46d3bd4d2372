"""One step of the fit: render a view, compare (`view_gradient`), then move the gaussians (`move`).

The first is compiled once per combination of padded sizes (gaussians, frozen gaussians, plan capacity) and image size, the second
once per number of gaussians and of views in a batch; everything that changes from step to step or from fit to fit is an argument.
"""

import dataclasses
import functools
from collections.abc import Sequence
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
import optax

from wm.compiler_options import UNPARTITIONED
from wm.schema import FitSettings, RasterSettings
from wm.splat.optimization.exposure import expose
from wm.splat.optimization.losses import depth_loss, photometric_terms
from wm.splat.optimization.normal_loss import normal_loss
from wm.splat.rasterizer.compositing import rasterize
from wm.splat.rasterizer.projection import Projected, project, project_vjp
from wm.splat.rasterizer.tiles import TilePlan
from wm.types import Camera, Gaussians, Render

_adam = optax.scale_by_adam(b1=0.5, b2=0.99, eps=1e-15)
"""A fit sees each view a few times only: the usual means over 10 and 1000 steps forget too slowly (experiments/fit_defaults)."""


@jax.tree_util.register_dataclass
@dataclasses.dataclass(frozen=True, eq=False)
class TrainState:
    """Gaussians and the moments of their gradients, on one device."""

    gaussians: Any
    moments: Any  # optax.ScaleByAdamState


@jax.tree_util.register_dataclass
@dataclasses.dataclass(frozen=True, eq=False)
class Target:
    """The image and depth that a view should show, on the device: `TrainingView` without what only the host needs."""

    camera: Any
    rgb: Any  # [h, w, 3] uint8
    depth: Any  # [h, w] float32, 0: no scaffold
    mask: Any  # [h, w] bool


@jax.tree_util.register_dataclass
@dataclasses.dataclass(frozen=True, eq=False)
class Trainable:
    """What the loss of a view is differentiated with respect to."""

    gaussians: Any
    exposure: Any = None  # [2, 3] of exposure.py; None: the render is compared as it is


@jax.tree_util.register_dataclass
@dataclasses.dataclass(frozen=True, eq=False)
class Gradient:
    """The derivative of a view's loss."""

    trainable: Any  # Trainable
    centres: Any  # [2, n] with respect to the projected centres, per pixel


@jax.tree_util.register_dataclass
@dataclasses.dataclass(frozen=True, eq=False)
class Rates:
    """Learning rates per leaf (already decayed) and the weights of the loss in one step. Scalars, traced."""

    learning: Any  # Gaussians of floats
    exposure: Any
    ssim: Any
    depth: Any
    normal: Any


@jax.tree_util.register_dataclass
@dataclasses.dataclass(frozen=True, eq=False)
class StepTerms:
    """The loss of one view and its terms before a step, and which parts of its gradient were finite."""

    loss: Any
    l1: Any
    dissimilarity: Any  # mean 1 - SSIM
    depth: Any  # metres
    normal: Any  # mean 1 - cosine
    finite: Any  # Trainable of bool


def raster_for(settings: FitSettings, raster: RasterSettings) -> RasterSettings:
    """The rasterizer's constants for a fit: depth is rendered if, and only if, a term of its loss reads it."""
    return dataclasses.replace(raster, depth=settings.depth_weight > 0 or settings.normal_weight > 0)


def start_state(gaussians: Gaussians) -> TrainState:
    """The state before the first step: its moments are zero."""
    mu, nu = (jax.tree.map(np.zeros_like, gaussians) for _ in range(2))
    return TrainState(gaussians=gaussians, moments=adam_state(np.zeros((), np.int32), mu, nu))


def adam_state(count: Any, mu: Any, nu: Any) -> optax.ScaleByAdamState:
    """Adam's state from the number of steps and the first and second moments, records like the gaussians."""
    return optax.ScaleByAdamState(count=count, mu=mu, nu=nu)


def rates_at(settings: FitSettings, step: int, steps: int) -> Rates:
    """The rates of a step: learning rates fall geometrically to `lr_final` of themselves over the fit."""
    decay = settings.lr_final ** (step / max(steps - 1, 1))
    learning = Gaussians(
        means=settings.lr_means * decay,
        quats=settings.lr_quats * decay,
        log_scales=settings.lr_scales * decay,
        opacity_logits=settings.lr_opacities * decay,
        sh=settings.lr_sh * decay,
    )
    return Rates(
        learning=learning,
        exposure=settings.lr_exposure * decay,
        ssim=settings.ssim_weight,
        depth=settings.depth_weight,
        normal=settings.normal_weight,
    )


@functools.partial(jax.jit, static_argnames="raster", compiler_options=UNPARTITIONED)
def project_view(gaussians: Gaussians, camera: Camera, *, raster: RasterSettings) -> Projected:
    """`project`, compiled."""
    return project(gaussians, camera, raster)


@functools.partial(jax.jit, static_argnames=("width", "height", "raster"), compiler_options=UNPARTITIONED)
def rasterize_view(projected: Projected, plan: TilePlan, *, width: int, height: int, raster: RasterSettings) -> Render:
    """`rasterize`, compiled."""
    return rasterize(projected, plan, width, height, raster)


@functools.partial(jax.jit, static_argnames=("raster", "normals"), compiler_options=UNPARTITIONED)
def view_gradient(
    trainable: Trainable,
    own: Projected,
    target: Target,
    frozen: Projected | None,
    plan: TilePlan,
    rates: Rates,
    *,
    raster: RasterSettings,
    normals: bool,
) -> tuple[StepTerms, Gradient]:
    """The loss of one view and its gradient.

    Args:
        trainable: what the loss is differentiated with respect to. For a leaf that is None nothing is computed or compiled.
        own: its gaussians as this view sees them, of `project_view`.
        target: the view.
        frozen: other gaussians as this view sees them: rendered, not moved.
        plan: of the projections of the gaussians and of the frozen ones, in that order.
        rates: of this step; the weights are read here.
        raster: without `depth` the loss has no depth term.
        normals: whether it has a term of normals, which needs depth.
    """

    camera = target.camera

    def objective(own: Projected, exposure):
        render = rasterize(own, plan, camera.width, camera.height, raster, frozen=frozen)
        rgb = render.rgb if exposure is None else expose(render.rgb, exposure)
        l1, dissimilarity = photometric_terms(rgb, target.rgb.astype(jnp.float32) / 255, target.mask)
        depth = depth_loss(render.depth, target.depth, target.mask) if raster.depth else jnp.float32(0)
        normal = jnp.float32(0)
        if raster.depth and normals:
            normal = normal_loss(render.depth, target.depth, target.mask, camera.focal, camera.principal)
        loss = (1 - rates.ssim) * l1 + rates.ssim * dissimilarity + rates.depth * depth + rates.normal * normal
        return loss, (l1, dissimilarity, depth, normal)

    value_and_grad = jax.value_and_grad(objective, argnums=(0, 1), has_aux=True)
    (loss, (l1, dissimilarity, depth, normal)), (g_own, g_exposure) = value_and_grad(own, trainable.exposure)
    gradient = Trainable(gaussians=project_vjp(trainable.gaussians, camera, own, g_own, raster), exposure=g_exposure)
    finite = jax.tree.map(lambda leaf: jnp.isfinite(leaf).all(), gradient)
    terms = StepTerms(loss=loss, l1=l1, dissimilarity=dissimilarity, depth=depth, normal=normal, finite=finite)
    return terms, Gradient(trainable=gradient, centres=g_own.mean2d)


@functools.partial(jax.jit, donate_argnums=0, compiler_options=UNPARTITIONED)
def move(state: TrainState, gradients: Sequence[Gaussians], learning: Gaussians) -> TrainState:
    """The state after one step along the mean of finite gradients; the state's buffers are donated.

    Args:
        state: the state before.
        gradients: one per view of the batch, on the state's device.
        learning: learning rates per leaf.
    """
    gradient = jax.tree.map(lambda *leaves: sum(leaves[1:], leaves[0]) / len(leaves), *gradients)
    updates, moments = _adam.update(gradient, state.moments)
    moved = jax.tree.map(lambda x, u, rate: x - rate * u, state.gaussians, updates, learning)
    return TrainState(gaussians=moved, moments=moments)
