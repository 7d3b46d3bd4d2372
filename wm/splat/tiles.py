"""Which gaussians touch which tiles, front to back: planned on the host, in NumPy, once per view.

Tiers of work: per gaussian (bounds, depth sort), per (gaussian, row of tiles) (the span of the ellipse in that row), per entry
(gaussian, tile) (one counting sort by tile). An entry is listed only if the ellipse alpha = alpha_min meets the rows of pixel
centres of the tile within its columns, so a listed tile is almost always touched and an unlisted one never.

Sorts are stable: depths as two argsorts of uint16 keys, which NumPy does by radix; tiles as the conversion of a sparse matrix
from coordinates to rows, which is a counting sort. Order in a tile: by depth, equal depths by index.
"""

import math
from typing import Any

import numpy as np
from scipy.sparse import coo_array

from wm.schema import RasterSettings
from wm.splat.project import DEFAULTS, Projected
from wm.types import record

GROWTH, BASE = 1.5, 4096
"""Capacities are BASE * GROWTH^k: padded sizes that differ give few distinct shapes, hence few compilations."""

SLACK, RELATIVE_SLACK = 1e-3, 1e-6
"""Ellipses are widened by this many pixels, and by this share of their size and distance from the origin, so that rounding
never leaves out an entry that the compositing would count."""


STRIP = 1 << 14
"""Rows of tiles worked on at a time: temporaries that stay in the cache, and below the size that the allocator maps anew."""


@record
class TilePlan:
    """The entries of every tile; plain arrays, so that a plan is an argument of a jitted function.

    Tiles are taken in blocks; a lane is the place of one tile in its block.
    """

    ids: Any  # [capacity] int32 gaussian of each entry, tile by tile, front to back; n (one past the last) beyond the entries
    tile: Any  # [blocks, lanes] int32 tile of each lane, row-major index; lanes without a tile repeat one with count 0
    start: Any  # [blocks, lanes] int32 its first entry
    count: Any  # [blocks, lanes] int32 how many entries it has
    slot: Any  # [tiles] int32 the lane (blocks and lanes flattened) that holds each tile


def plan_tiles(
    projected: Projected, width: int, height: int, settings: RasterSettings = DEFAULTS, *, capacity: int | None = None
) -> TilePlan:
    """The plan of one image; it stays valid (approximately) while the gaussians move little.

    Args:
        projected: what `project` returned, on the host or on the device.
        width, height: of the image, pixels.
        settings: tile, block and alpha_min are read here.
        capacity: how many entries to make room for at least; None makes room for what there is, rounded up in steps of x1.5.
            Whatever does not fit makes it grow: nothing is ever left out.

    Returns:
        The plan, NumPy arrays.
    """
    mean, root, opacity, depth, extent = (
        np.asarray(x, np.float32)
        for x in (projected.mean2d, projected.root, projected.opacity, projected.depth, projected.extent)
    )
    columns, rows = -(-width // settings.tile), -(-height // settings.tile)
    slack = SLACK + RELATIVE_SLACK * (np.abs(mean) + extent)
    shown = (extent > 0) & (mean + extent > -slack) & (mean - extent < np.array([[width], [height]], np.float32) + slack)
    order = _front_to_back(depth, np.flatnonzero(shown.all(0) & (opacity > 0)))
    mean, root, opacity, extent = (np.take(x, order, axis=-1) for x in (mean, root, opacity, extent))
    gaussian, row = _rows_touched(mean[1], extent[1], height, settings.tile)
    first, spans = _columns_touched(gaussian, row, mean, root, opacity, extent, width, settings)
    ids = np.repeat(order[gaussian], spans)
    tile = _runs(row * np.int32(columns) + first, spans)
    # the rows of this matrix are the tiles, its columns the gaussians in the order of `ids`; no entry comes twice
    matrix = coo_array((np.ones(len(ids), np.int8), (tile, ids)), shape=(columns * rows, len(depth) + 1))
    matrix.has_canonical_format = True
    lists = matrix.tocsr()
    padded = np.full(_capacity(len(ids), capacity), len(depth), np.int32)
    padded[: len(ids)] = lists.indices
    return TilePlan(ids=padded, **_blocks(np.diff(lists.indptr), settings.block))


def _front_to_back(depth, visible):
    """Indices `visible` sorted by depth, ties by index. Depths are positive, so their bits order as they do."""
    bits = depth[visible].view(np.uint32)
    low = np.argsort(bits.astype(np.uint16), kind="stable")
    return visible[low[np.argsort((bits[low] >> 16).astype(np.uint16), kind="stable")]].astype(np.int32)


def _runs(first, lengths):
    """The integers first, first + 1, ... of every run, one run after the other."""
    ends = np.cumsum(lengths, dtype=np.int64)
    total = int(ends[-1]) if len(ends) else 0
    dtype = np.int32 if total < 2**31 else np.int64
    return np.repeat((first - (ends - lengths)).astype(dtype), lengths) + np.arange(total, dtype=dtype)


def _tile_span(low, high, size: int, tile: int):
    """First tile whose pixel centres lie in [low, high], and how many, within an image of `size` pixels."""
    first = np.ceil(np.clip(low, 0, size) - 0.5).astype(np.int32)  # pixels
    last = np.floor(np.clip(high, 0, size) - 0.5).astype(np.int32)
    return first // tile, np.where(last >= first, last // tile + 1 - first // tile, 0)


def _rows_touched(centre, half_height, height: int, tile: int):
    """(index into the given gaussians, row of tiles) of every row that an ellipse's box meets, in the given order."""
    slack = SLACK + RELATIVE_SLACK * (np.abs(centre) + half_height)
    first, spans = _tile_span(centre - half_height - slack, centre + half_height + slack, height, tile)
    return np.repeat(np.arange(len(spans), dtype=np.int32), spans), _runs(first, spans)


def _columns_touched(gaussian, row, mean, root, opacity, extent, width: int, settings: RasterSettings):
    """First column of tiles that each ellipse meets within each row of tiles, and how many.

    On (l0 x + l1 y)^2 + (l2 y)^2 = r^2 the rightmost point has y = -l0 l1 / (l1^2 + l2^2) x_max; within a band of y that does
    not contain it, x is largest at the band's end nearest to it.
    """
    l0, l1, l2 = root
    r2 = 2 * np.log(opacity / np.float32(settings.alpha_min))
    slack = SLACK + RELATIVE_SLACK * (np.abs(mean[0]) + extent[0])
    y_right = -l0 * l1 / (l1 * l1 + l2 * l2) * extent[0]
    per_gaussian = np.stack([mean[0], mean[1], l1 / l0, 1 / l0, l2, r2, y_right, slack])
    first, spans = np.empty_like(row), np.empty_like(row)
    for part in (slice(i, i + STRIP) for i in range(0, len(row), STRIP)):
        mx, my, tilt, width_of_1, l2, r2, y_right, slack = np.take(per_gaussian, gaussian[part], axis=1)
        low = row[part].astype(np.float32) * settings.tile + 0.5 - my
        high = low + (settings.tile - 1)
        left, right = (
            mx - tilt * y + sign * (width_of_1 * np.sqrt(np.maximum(r2 - (l2 * y) ** 2, 0)) + slack)
            for sign, y in ((-1, np.clip(-y_right, low, high)), (1, np.clip(y_right, low, high)))
        )
        first[part], spans[part] = _tile_span(left, right, width, settings.tile)
    return first, spans


def _capacity(entries: int, wanted: int | None) -> int:
    size = BASE if wanted is None else max(wanted, 1)
    while size < entries:
        size = math.ceil(size * GROWTH)
    return size


def _blocks(count, lanes: int) -> dict:
    """Tiles by falling length of their lists, so that the lanes of a block end together."""
    tiles = len(count)
    lanes = min(lanes, tiles)
    blocks = -(-tiles // lanes)
    start = np.cumsum(count) - count
    order = np.argsort(-count, kind="stable")
    padded = np.concatenate([order, np.full(blocks * lanes - tiles, order[-1])])
    lengths = count[padded]
    lengths[tiles:] = 0
    slot = np.empty(tiles, np.int32)
    slot[order] = np.arange(tiles, dtype=np.int32)
    shape = (blocks, lanes)
    return {
        "tile": padded.reshape(shape).astype(np.int32),
        "start": start[padded].reshape(shape).astype(np.int32),
        "count": lengths.reshape(shape).astype(np.int32),
        "slot": slot,
    }
