"""Tile binning: the gaussians of every tile, front to back, on the host in NumPy, once per view (in the graph: tiles_traced.py).

Tiers of work: per gaussian (bounds, depth sort), per (gaussian, row of tiles) (the span of the ellipse in that row), per entry
(gaussian, tile) (one counting sort by tile). An entry is listed only if the ellipse alpha = alpha_min meets the rows of pixel
centres of the tile within its columns, so a listed tile is almost always touched and an unlisted one never.

Sorts are stable: depths as two argsorts of uint16 keys, which NumPy does by radix; tiles as the conversion of a sparse matrix
from coordinates to rows, which is a counting sort. Order in a tile: by depth, equal depths by index.
"""

import dataclasses
import math
from typing import Any, NamedTuple

import jax
import numpy as np
from scipy.sparse import coo_array

from wm.schema import RasterSettings
from wm.splat.rasterizer._spans import blocks, chord, chord_terms, slack, tile_span
from wm.splat.rasterizer.projection import DEFAULTS, Projected

GROWTH, BASE = 1.5, 4096
"""Capacities are BASE * GROWTH^k: padded sizes that differ give few distinct shapes, hence few compilations."""

STRIP = 1 << 14
"""(gaussian, row of tiles) pairs per strip: temporaries then stay in the cache, below the size that the allocator maps anew."""


class Planned(NamedTuple):
    """The image size, tile size and number of gaussians that a plan was made for.

    Attributes:
        width, height: of the image, pixels
        tile: edge of a tile, pixels
        gaussians: their number
    """

    width: int
    height: int
    tile: int
    gaussians: int

    @property
    def tiles(self) -> int:
        return -(-self.width // self.tile) * -(-self.height // self.tile)


@jax.tree_util.register_dataclass
@dataclasses.dataclass(frozen=True, eq=False)
class TilePlan:
    """The entries of every tile, as plain arrays, so that a plan is an argument of a jitted function; only `of` is static.

    Tiles are taken in blocks; a lane is the place of one tile in its block.

    Attributes:
        ids: [capacity] int32 gaussian of each entry, tile by tile, front to back; n (one past the last) beyond the entries
        tile: [blocks, lanes] int32 tile of each lane, row-major index; lanes without a tile repeat one with count 0
        start: [blocks, lanes] int32 its first entry
        count: [blocks, lanes] int32 how many entries it has
        slot: [tiles] int32 the lane (blocks and lanes flattened) that holds each tile
        of: what the plan was made for
    """

    ids: Any
    tile: Any
    start: Any
    count: Any
    slot: Any
    of: Planned = dataclasses.field(metadata={"static": True})


def plan_tiles(
    projected: Projected, width: int, height: int, settings: RasterSettings = DEFAULTS, *, capacity: int | None = None
) -> TilePlan:
    """The plan of one image; it stays valid (approximately) while the gaussians move little.

    Args:
        projected: what `project` returned, on the host or on the device.
        width, height: of the image, pixels.
        settings: tile, block and alpha_min are read here.
        capacity: how many entries to make room for at least; None makes room for what there is, rounded up in steps of x1.5.
            It grows if that does not suffice: no entry is ever dropped.

    Returns:
        The plan, NumPy arrays.
    """
    mean, root, opacity, depth, extent = (
        np.asarray(x, np.float32)
        for x in (projected.mean2d, projected.root, projected.opacity, projected.depth, projected.extent)
    )
    columns, rows = -(-width // settings.tile), -(-height // settings.tile)
    order = _front_to_back(depth, _shown(mean, extent, opacity, width, height))
    mean, root, opacity, extent = (np.take(x, order, axis=-1) for x in (mean, root, opacity, extent))
    gaussian, row = _rows_touched(mean[1], extent[1], height, settings.tile)
    terms = chord_terms(mean, root, opacity, extent, settings, np)
    first, spans = _columns_touched(gaussian, row, terms, width, settings.tile)
    strip, tile = _runs(row * np.int32(columns) + first, spans)
    ids = np.take(order[gaussian], strip)
    # the rows of this matrix are the tiles, its columns the gaussians in the order of `ids`; no entry comes twice
    matrix = coo_array((np.ones(len(ids), np.int8), (tile, ids)), shape=(columns * rows, len(depth) + 1))
    matrix.has_canonical_format = True
    lists = matrix.tocsr()
    padded = np.full(padded_capacity(len(ids), capacity), len(depth), np.int32)
    padded[: len(ids)] = lists.indices
    planned = Planned(width, height, settings.tile, len(depth))
    return TilePlan(ids=padded, of=planned, **_blocks(np.diff(lists.indptr), settings.block))


def plan_views(projected: Projected, width: int, height: int, settings: RasterSettings = DEFAULTS) -> TilePlan:
    """The plans of several views of one size, stacked on a first axis: what `rasterize` under vmap or shard_map takes.

    Args:
        projected: of `project` under vmap or shard_map: every leaf has a first axis of views, at least one.
        width, height, settings: as for `plan_tiles`, the same for all views.

    Returns:
        The plans, NumPy arrays with a first axis of views, with room for the fullest of them.
    """
    on_host = jax.tree.map(np.asarray, projected)
    parts = [jax.tree.map(lambda x, k=k: x[k], on_host) for k in range(len(on_host.opacity))]
    plans = [plan_tiles(part, width, height, settings) for part in parts]
    capacity = max(len(plan.ids) for plan in plans)
    n = on_host.opacity.shape[1]
    ids = [np.pad(plan.ids, (0, capacity - len(plan.ids)), constant_values=n) for plan in plans]
    return jax.tree.map(lambda *leaves: np.stack(leaves), *(dataclasses.replace(plan, ids=row) for plan, row in zip(plans, ids)))


def padded_capacity(entries: int, wanted: int | None) -> int:
    """The capacity for a number of entries: what is wanted (None: BASE), times 1.5 until it suffices."""
    size = BASE if wanted is None else max(wanted, 1)
    while size < entries:
        size = math.ceil(size * GROWTH)
    return size


def _shown(mean, extent, opacity, width: int, height: int):
    """Indices of the ellipses that reach into the image."""
    visible = np.flatnonzero(opacity > 0)
    mean, extent = (np.take(x, visible, axis=-1) for x in (mean, extent))
    reach = extent + slack(mean, extent, np)
    shown = (extent > 0) & (mean + reach > 0) & (mean - reach < np.array([[width], [height]], np.float32))
    return visible[shown.all(0)]


def _front_to_back(depth, visible):
    """Indices `visible` sorted by depth, ties by index. Depths are positive, so their bits order as they do."""
    bits = depth[visible].view(np.uint32)
    low = np.argsort(bits.astype(np.uint16), kind="stable")
    return visible[low[np.argsort((bits[low] >> 16).astype(np.uint16), kind="stable")]].astype(np.int32)


def _runs(first, lengths):
    """(which run, integer) of the integers first, first + 1, ... of every run, one run after the other."""
    ends = np.cumsum(lengths, dtype=np.int64)
    total = int(ends[-1]) if len(ends) else 0
    run = np.repeat(np.arange(len(lengths)), lengths)
    dtype = np.int32 if total < 2**31 else np.int64
    return run, np.take((first - (ends - lengths)).astype(dtype), run) + np.arange(total, dtype=dtype)


def _rows_touched(centre, half_height, height: int, tile: int):
    """(index into the given gaussians, row of tiles) of every row that an ellipse's box meets, in the given order."""
    reach = half_height + slack(centre, half_height, np)
    first, spans = tile_span(centre - reach, centre + reach, height, tile, np)
    return _runs(first, spans)


def _columns_touched(gaussian, row, terms, width: int, tile: int):
    """First column of tiles that each ellipse meets within each row of tiles, and how many."""
    first, spans = np.empty_like(row), np.empty_like(row)
    for part in (slice(i, i + STRIP) for i in range(0, len(row), STRIP)):
        left, right = chord(np.take(terms, gaussian[part], axis=1), row[part], tile, np)
        first[part], spans[part] = tile_span(left, right, width, tile, np)
    return first, spans


def _blocks(count, lanes: int) -> dict:
    order = np.argsort(-count, kind="stable")
    slot = np.empty(len(count), np.int32)
    slot[order] = np.arange(len(count), dtype=np.int32)
    return {**blocks(count, order, lanes, np), "slot": slot}
