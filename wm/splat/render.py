"""One call from gaussians to an image: project, plan, rasterize."""

import functools

import jax
import numpy as np
from jax.core import Tracer
from jaxtyping import Array, Float

from wm.schema import RasterSettings
from wm.splat.composite import rasterize
from wm.splat.project import DEFAULTS, Projected, project
from wm.splat.tiles import TilePlan, plan_tiles
from wm.types import Camera, Gaussians, Render

TRACED_PER_GAUSSIAN, TRACED_PER_TILE = 16, 512
"""Entries that a plan made under jit has room for; shapes are fixed there before anything is known about the view."""

_project = jax.jit(project, static_argnames="settings")
_rasterize = jax.jit(rasterize, static_argnames=("width", "height", "settings"))


def render(
    gaussians: Gaussians,
    camera: Camera,
    *,
    background: Float[Array, "3"] | Float[Array, "h w 3"] | Float[np.ndarray, "3"] | Float[np.ndarray, "h w 3"] | None = None,
    settings: RasterSettings = DEFAULTS,
) -> Render:
    """What a camera sees of gaussians; differentiable in the gaussians, the camera's arrays and the background.

    Outside jit the tiles are planned on the host between two jitted passes. Under jit, grad or vmap they are planned by a
    callback to the host, which works on one device; with several, call `project`, `plan_tiles` and `rasterize` yourself.

    Args:
        gaussians: n gaussians in world space; n may be 0.
        camera: where they are seen from; any image size from 1 x 1.
        background: colour behind everything, one or one a pixel; None is black.
        settings: the constants of the rasterizer, static under jit.

    Returns:
        Colour, expected depth and alpha, on the device.

    Raises:
        ValueError: under tracing, when a view has more entries than a traced plan has room for (XLA may wrap it). Nothing is
            ever left out of the image.
    """
    size = (camera.width, camera.height)
    projected = _project(gaussians, camera, settings=settings)
    if any(isinstance(x, Tracer) for x in jax.tree.leaves(projected)):
        plan = _plan_traced(jax.lax.stop_gradient(projected), *size, settings)
    else:
        plan = plan_tiles(projected, *size, settings)
    return _rasterize(projected, plan, *size, settings=settings, background=background)


def _plan_traced(projected: Projected, width: int, height: int, settings: RasterSettings) -> TilePlan:
    n = projected.opacity.shape[0]
    tiles = -(-width // settings.tile) * -(-height // settings.tile)
    capacity = max(min(n * tiles, TRACED_PER_GAUSSIAN * n + TRACED_PER_TILE * tiles), 1)
    lanes = min(settings.block, tiles)
    shapes = {"ids": (capacity,), "slot": (tiles,)} | dict.fromkeys(("tile", "start", "count"), (-(-tiles // lanes), lanes))
    result = TilePlan(**{name: jax.ShapeDtypeStruct(shape, np.int32) for name, shape in shapes.items()})
    plan = functools.partial(_plan_within, width=width, height=height, settings=settings, capacity=capacity)
    return jax.pure_callback(plan, result, projected, vmap_method="sequential")


def _plan_within(projected: Projected, *, width: int, height: int, settings: RasterSettings, capacity: int) -> TilePlan:
    plan = plan_tiles(projected, width, height, settings, capacity=capacity)
    if len(plan.ids) > capacity:
        raise ValueError(
            f"render under jit has room for {capacity} (gaussian, tile) entries and this view has {plan.count.sum()}: plan it "
            "outside jit (project, plan_tiles, rasterize), which has no limit"
        )
    return plan
