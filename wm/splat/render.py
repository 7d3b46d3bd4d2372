"""One call from gaussians to an image: project, plan, rasterize.

Outside jit the plan is made on the host between two compiled passes. Inside, where shapes are fixed before a view is known, it
has room for a fixed number of entries: on a CPU a callback to the host makes it, elsewhere the graph does (tiles_traced.py).
"""

import functools

import jax
import jax.numpy as jnp
import numpy as np
from jax.core import Tracer

from wm.schema import RasterSettings
from wm.splat._wide import jit_wide
from wm.splat.checks import check_background, check_camera, check_types, check_values
from wm.splat.composite import rasterize
from wm.splat.project import DEFAULTS, Projected, project
from wm.splat.tiles import TilePlan, plan_tiles
from wm.splat.tiles_traced import plan_tiles_traced
from wm.types import Background, Camera, Gaussians, Render

TRACED_PER_GAUSSIAN, TRACED_PER_TILE = 16, 512
"""Entries that a plan made under jit has room for; shapes are fixed there before anything is known about the view."""

_project = jax.jit(project, static_argnames="settings")  # wide vectors gain nothing here
_rasterize = jit_wide(rasterize, ("width", "height", "settings"))


def render(
    gaussians: Gaussians,
    camera: Camera,
    *,
    background: Background | None = None,
    settings: RasterSettings = DEFAULTS,
    checked: bool = False,
) -> Render:
    """What a camera sees of gaussians; differentiable in the gaussians, the camera's arrays and the background.

    It may be called inside jit, grad and vmap, over cameras too. The callback by which a CPU plans there works on one device:
    inside shard_map over several, one view at a time under `settings.planner` "traced", or plan between two sharded passes:

        projected = shard(jax.vmap(project, (None, 0)))(gaussians, cameras)
        plans = plan_views(projected, width, height)                                  # on the host, outside jit
        see = lambda gaussians, camera, plan: rasterize(project(gaussians, camera), plan, width, height)
        images = shard(jax.vmap(see, (None, 0, 0)))(gaussians, cameras, plans)

    `shard` is jit of shard_map with `check_vma=False`, since loops here start from constants. On a CPU with AVX-512 a jit of the
    caller's gains a fifth from `compiler_options=wm.splat.WIDE`; called on its own, this function takes them by itself.

    Args:
        gaussians: n gaussians in world space; n may be 0. One that is not finite is left out, unless `checked`.
        camera: where they are seen from; any image size from 1 x 1.
        background: colour behind everything, one or one a pixel; None is black.
        settings: the constants of the rasterizer, static under jit.
        checked: refuse whatever is not finite; inside jit by `jax.experimental.checkify`, which the caller then applies:
            `error, image = checkify.checkify(jax.jit(lambda g: render(g, camera, checked=True)))(gaussians); error.throw()`.

    Returns:
        Colour, expected depth and alpha, float32 on the device.

    Raises:
        TypeError: an array does not hold floating-point numbers.
        ValueError: a shape is wrong, or the camera is not finite where its numbers are there to be seen. Under tracing, when a
            view has more entries than a traced plan has room for (XLA may wrap it). Nothing is ever left out of the image.
    """
    check_types(gaussians, camera, settings)
    if background is not None:
        check_background(background, camera)
    if checked:
        check_values(gaussians, camera, background)
    size = (camera.width, camera.height)
    check_camera(camera)
    projected = _project(gaussians, camera, settings=settings)
    if any(isinstance(x, Tracer) for x in jax.tree.leaves(projected)):
        plan = _plan_traced(jax.lax.stop_gradient(projected), *size, settings)
    else:
        plan = _plan_eager(projected, *size, settings)
    return _rasterize(projected, plan, *size, settings=settings, background=background)


def _plan_eager(projected: Projected, width: int, height: int, settings: RasterSettings) -> TilePlan:
    if settings.planner != "traced":
        return plan_tiles(projected, width, height, settings)
    return _plan_in_graph_jitted(projected, width, height, settings)


def _plan_traced(projected: Projected, width: int, height: int, settings: RasterSettings) -> TilePlan:
    planners = {
        name: functools.partial(plan, width=width, height=height, settings=settings)
        for name, plan in (("host", _plan_by_callback), ("traced", _plan_in_graph))
    }
    if settings.planner == "auto":
        return jax.lax.platform_dependent(projected, cpu=planners["host"], default=planners["traced"])
    return planners[settings.planner](projected)


def _capacity(n: int, width: int, height: int, settings: RasterSettings) -> int:
    tiles = -(-width // settings.tile) * -(-height // settings.tile)
    return max(min(n * tiles, TRACED_PER_GAUSSIAN * n + TRACED_PER_TILE * tiles), 1)


def _plan_by_callback(projected: Projected, width: int, height: int, settings: RasterSettings) -> TilePlan:
    tiles = -(-width // settings.tile) * -(-height // settings.tile)
    capacity = _capacity(projected.opacity.shape[0], width, height, settings)
    lanes = min(settings.block, tiles)
    shapes = {"ids": (capacity,), "slot": (tiles,)} | dict.fromkeys(("tile", "start", "count"), (-(-tiles // lanes), lanes))
    result = TilePlan(**{name: jax.ShapeDtypeStruct(shape, np.int32) for name, shape in shapes.items()})
    plan = functools.partial(_plan_within, width=width, height=height, settings=settings, capacity=capacity)
    return jax.pure_callback(plan, result, projected, vmap_method="sequential")


def _plan_within(projected: Projected, *, width: int, height: int, settings: RasterSettings, capacity: int) -> TilePlan:
    plan = plan_tiles(projected, width, height, settings, capacity=capacity)
    _refuse(plan.count.sum(), capacity)
    return plan


def _plan_in_graph(projected: Projected, width: int, height: int, settings: RasterSettings) -> TilePlan:
    capacity = _capacity(projected.opacity.shape[0], width, height, settings)
    traced = plan_tiles_traced(projected, width, height, settings, capacity=capacity)

    def complain(needed):
        return jax.pure_callback(
            functools.partial(_refuse, capacity=capacity), jax.ShapeDtypeStruct((), np.int32), needed, vmap_method="sequential"
        )

    # the host hears of it only when there is no room, so that no device waits for it and several devices do not deadlock
    nothing = jax.lax.cond(traced.needed > capacity, complain, jnp.zeros_like, traced.needed)
    return traced.plan.replace(ids=traced.plan.ids + nothing)


_plan_in_graph_jitted = jax.jit(_plan_in_graph, static_argnums=(1, 2, 3))


def _refuse(needed, capacity: int):
    """Raises unless a plan has room for what it needs; else 0."""
    if needed > capacity:
        raise ValueError(
            f"render under jit has room for {capacity} (gaussian, tile) entries and this view has {int(needed)}: plan it "
            "outside jit (project, plan_tiles, rasterize), which has no limit"
        )
    return np.int32(0)
