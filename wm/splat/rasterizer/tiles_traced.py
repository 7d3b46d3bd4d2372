"""Tile binning inside the graph, for accelerators and for several devices: no callback, fixed sizes.

Gaussians are sorted by depth, the bounding box of each is unrolled into (gaussian, tile) entries, those that miss the ellipse are
dropped, and a stable sort by tile leaves every tile's list front to back. The lists are those of the host's plan; room is needed
for the boxes, which hold more entries than the ellipses. Work: O(n log n) and O(capacity log capacity) per view.
"""

import functools
from typing import Any

import jax
import jax.numpy as jnp

from wm.schema import RasterSettings
from wm.splat.rasterizer._spans import blocks, chord, chord_terms, slack, tile_span
from wm.splat.rasterizer.projection import DEFAULTS, Projected
from wm.splat.rasterizer.tiles import Planned, TilePlan, padded_capacity
from wm.types import record

COUNTABLE = 2.0**30
"""Entries beyond which a 32-bit sum may have wrapped."""


@record
class TracedPlan:
    """A plan and whether it is whole: `plan` may be used only where `needed` is at most the capacity.

    Attributes:
        plan: TilePlan of JAX arrays
        needed: [] int32: the room that the view needs
    """

    plan: Any
    needed: Any


def plan_tiles_traced(
    projected: Projected, width: int, height: int, settings: RasterSettings = DEFAULTS, *, capacity: int
) -> TracedPlan:
    """The plan of one image, under jit, vmap, lax.map or shard_map, on any device.

    Args:
        projected: what `project` returned.
        width, height: of the image, pixels.
        settings: tile, block and alpha_min are read here.
        capacity: how many entries of gaussians' boxes there is room for, at least 1; static.

    Returns:
        The plan and the room it needed. A plan that needed more than there was leaves gaussians out; the caller must
        refuse it, as `render` does.
    """
    projected = jax.tree.map(lambda x: jax.lax.stop_gradient(jnp.asarray(x, jnp.float32)), projected)
    n = projected.opacity.shape[0]
    planned = Planned(width, height, settings.tile, n)
    ids, in_tile, needed = _entries(projected, width, height, settings, capacity)
    in_tile, ids = jax.lax.sort((in_tile, ids), num_keys=1, is_stable=True)
    # unrolled: one kernel on a GPU, where the loop of a binary search is fifty launches
    ends = jnp.searchsorted(in_tile, jnp.arange(planned.tiles + 1, dtype=jnp.int32), method="scan_unrolled").astype(jnp.int32)
    ids = jnp.where(in_tile < planned.tiles, ids, n)
    return TracedPlan(plan=TilePlan(ids=ids, of=planned, **_blocks(jnp.diff(ends), settings.block)), needed=needed)


def plan_tiles_on_device(
    projected: Projected, width: int, height: int, settings: RasterSettings = DEFAULTS, *, capacity: int | None = None
) -> TilePlan:
    """The plan of one image, outside jit but on the device: entries are counted first, so that there is room for all.

    Args:
        projected, width, height, settings: as for `plan_tiles_traced`.
        capacity: how many entries to make room for at least, as for `plan_tiles`.

    Raises:
        ValueError: there are more entries than 32 bits count.
    """
    needed = int(_room(projected, width, height, settings))
    if needed > COUNTABLE:
        raise ValueError(f"the gaussians' boxes meet more than {COUNTABLE:.0f} tiles in all; smaller gaussians would be right")
    return _plan(projected, width, height, settings, padded_capacity(needed, capacity))


@functools.partial(jax.jit, static_argnums=(1, 2, 3))
def _room(projected: Projected, width: int, height: int, settings: RasterSettings):
    (_, across), (_, down), _ = _boxes(projected, width, height, settings)
    return _total(across * down)


@functools.partial(jax.jit, static_argnums=(1, 2, 3, 4))
def _plan(projected: Projected, width: int, height: int, settings: RasterSettings, capacity: int) -> TilePlan:
    return plan_tiles_traced(projected, width, height, settings, capacity=capacity).plan


def _entries(projected: Projected, width: int, height: int, settings: RasterSettings, capacity: int):
    """Gaussian and tile of every entry of the boxes, front to back, and how many there are.

    Those that miss their ellipse, and all beyond the last, have a tile one past the end.
    """
    n, tile = projected.opacity.shape[0], settings.tile
    columns, rows = -(-width // tile), -(-height // tile)
    order = jnp.argsort(projected.depth, stable=True).astype(jnp.int32)
    front_to_back = jax.tree.map(lambda x: x[..., order], projected)
    (left, across), (top, down), terms = _boxes(front_to_back, width, height, settings)
    which, within, needed = _unrolled(across * down, capacity)
    # a last gaussian for the entries beyond the last
    terms, left, across, top = (jnp.pad(x, (*((0, 0),) * (x.ndim - 1), (0, 1))) for x in (terms, left, across, top))
    breadth = jnp.maximum(across[which], 1)
    row, column = top[which] + within // breadth, left[which] + within % breadth
    first, span = tile_span(*chord(terms[:, which], row, tile, jnp), width, tile, jnp)
    met = (which < n) & (column >= first) & (column < first + span)
    return jnp.append(order, jnp.int32(n))[which], jnp.where(met, row * columns + column, columns * rows), needed


def _boxes(projected: Projected, width: int, height: int, settings: RasterSettings):
    """Spans of columns and of rows of tiles that each ellipse's box meets, none for what is not shown, and its chord's terms."""
    mean, extent = projected.mean2d, projected.extent
    shown = (projected.opacity > 0) & (extent > 0).all(0)
    reach = extent + slack(mean, extent, jnp)
    spans = [tile_span(mean[i] - reach[i], mean[i] + reach[i], size, settings.tile, jnp) for i, size in ((0, width), (1, height))]
    opacity, root = jnp.where(shown, projected.opacity, settings.alpha_min), jnp.where(shown, projected.root, 1.0)
    terms = chord_terms(mean, root, opacity, extent, settings, jnp)
    return *((first, jnp.where(shown, span, 0)) for first, span in spans), terms


def _unrolled(lengths, capacity: int):
    """Of every entry of the runs of these lengths, laid end to end: which run, place in it; and their number.

    Entries beyond the last belong to a run one past the end.
    """
    lengths = jnp.append(lengths, 0).astype(jnp.int32)
    ends = jnp.cumsum(lengths, dtype=jnp.int32)
    which = jnp.repeat(jnp.arange(len(lengths), dtype=jnp.int32), lengths, total_repeat_length=capacity)
    entry = jnp.arange(capacity, dtype=jnp.int32)
    which = jnp.where(entry < ends[-1], which, len(lengths) - 1)
    return which, entry - (ends - lengths)[which], _total(lengths)


def _total(lengths):
    """The sum of lengths, or the largest integer where 32 bits may not hold it."""
    total = jnp.sum(lengths.astype(jnp.float32))
    return jnp.where(total > COUNTABLE, jnp.iinfo(jnp.int32).max, jnp.sum(lengths, dtype=jnp.int32))


def _blocks(count, lanes: int) -> dict:
    order = jnp.argsort(-count, stable=True).astype(jnp.int32)
    slot = jnp.zeros_like(order).at[order].set(jnp.arange(len(order), dtype=jnp.int32))
    return {**blocks(count, order, lanes, jnp), "slot": slot}
