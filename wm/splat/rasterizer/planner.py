"""The choice of a planner for tile binning: on the host (tiles.py) or in the graph (tiles_traced.py), inside jit or outside.

Outside jit the plan is made between two compiled passes, where the arrays are: on the host for a CPU, on the device for an
accelerator, after a first pass that counts. Inside, where shapes are fixed before a view is known, a plan has room for a fixed
number of entries: on a CPU a callback to the host makes it, elsewhere the graph does.
"""

import dataclasses
import functools
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np

from wm.schema import RasterSettings
from wm.splat.rasterizer.projection import DEFAULTS, Projected
from wm.splat.rasterizer.tiles import Planned, TilePlan, plan_tiles
from wm.splat.rasterizer.tiles_traced import plan_tiles_on_device, plan_tiles_traced

TRACED_PER_GAUSSIAN, TRACED_PER_TILE = 16, 512
"""Capacity of a plan made under jit, entries per gaussian and per tile; shapes are fixed before anything is known about the
view."""


def plan_outside_jit(
    projected: Projected, width: int, height: int, settings: RasterSettings = DEFAULTS, *, capacity: int | None = None
) -> TilePlan:
    """The plan of one image, made where the settings say; "auto" is where the arrays are. Arguments as for `plan_tiles`."""
    plan = plan_tiles if plans_on_host(projected, settings) else plan_tiles_on_device
    return plan(projected, width, height, settings, capacity=capacity)


def plans_on_host(projected: Any, settings: RasterSettings) -> bool:
    """Whether `plan_outside_jit` plans on the host: NumPy arrays and those on a CPU are there already."""
    if settings.planner != "auto":
        return settings.planner == "host"
    devices = {device.platform for x in jax.tree.leaves(projected) if isinstance(x, jax.Array) for device in x.devices()}
    return devices <= {"cpu"}


def plan_inside_jit(projected: Projected, width: int, height: int, settings: RasterSettings = DEFAULTS) -> TilePlan:
    """The plan of one image under jit, grad or vmap, with room for TRACED_PER_GAUSSIAN and TRACED_PER_TILE.

    Raises:
        ValueError: while running, when the view needs more room (XLA may wrap it).
    """
    projected = jax.lax.stop_gradient(projected)
    planners = {
        name: functools.partial(plan, width=width, height=height, settings=settings)
        for name, plan in (("host", _plan_by_callback), ("traced", _plan_in_graph))
    }
    if settings.planner == "auto":
        return jax.lax.platform_dependent(projected, cpu=planners["host"], default=planners["traced"])
    return planners[settings.planner](projected)


def _capacity(planned: Planned) -> int:
    n, tiles = planned.gaussians, planned.tiles
    return max(min(n * tiles, TRACED_PER_GAUSSIAN * n + TRACED_PER_TILE * tiles), 1)


def _plan_by_callback(projected: Projected, width: int, height: int, settings: RasterSettings) -> TilePlan:
    planned = Planned(width, height, settings.tile, projected.opacity.shape[0])
    tiles, capacity = planned.tiles, _capacity(planned)
    lanes = min(settings.block, tiles)
    shapes = {"ids": (capacity,), "slot": (tiles,)} | dict.fromkeys(("tile", "start", "count"), (-(-tiles // lanes), lanes))
    result = TilePlan(of=planned, **{name: jax.ShapeDtypeStruct(shape, np.int32) for name, shape in shapes.items()})
    plan = functools.partial(_plan_within, width=width, height=height, settings=settings, capacity=capacity)
    return jax.pure_callback(plan, result, projected, vmap_method="sequential")


def _plan_within(projected: Projected, *, width: int, height: int, settings: RasterSettings, capacity: int) -> TilePlan:
    plan = plan_tiles(projected, width, height, settings, capacity=capacity)
    _refuse(plan.count.sum(), capacity)
    return plan


def _plan_in_graph(projected: Projected, width: int, height: int, settings: RasterSettings) -> TilePlan:
    capacity = _capacity(Planned(width, height, settings.tile, projected.opacity.shape[0]))
    traced = plan_tiles_traced(projected, width, height, settings, capacity=capacity)

    def complain(needed):
        return jax.pure_callback(
            functools.partial(_refuse, capacity=capacity), jax.ShapeDtypeStruct((), np.int32), needed, vmap_method="sequential"
        )

    # The host is called only when the capacity does not suffice, so that no device waits for it and several devices do not
    # deadlock. (Under vmap a branch becomes a selection: then it is called for every view.)
    nothing = jax.lax.cond(traced.needed > capacity, complain, jnp.zeros_like, traced.needed)
    return dataclasses.replace(traced.plan, ids=traced.plan.ids + nothing)


def _refuse(needed, capacity: int):
    """Raises unless a plan has room for what it needs; else 0."""
    if needed > capacity:
        raise ValueError(
            f"render inside jit or grad has room for {capacity} (gaussian, tile) entries and this view has {int(needed)}: "
            "plan it outside (project, plan_tiles, rasterize), which has no limit"
        )
    return np.int32(0)
