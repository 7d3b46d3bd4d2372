"""Which gaussians touch which tiles, front to back: planned on the host, in NumPy, once per view.

Tiers of work: per gaussian (bounds, depth sort), per (gaussian, row of tiles) (the span of the ellipse in that row), per entry
(gaussian, tile) (radix sort by tile). An entry is listed only if the ellipse alpha = alpha_min meets the pixel centres of the
tile's rows within its columns, so a listed tile is almost always touched and an unlisted one never.

Sorts are stable argsorts of uint16 keys, which NumPy does by radix. Order in a tile: by depth, equal depths by index.
"""

from typing import Any

import numpy as np

from wm.schema import RasterSettings
from wm.splat.project import DEFAULTS, Projected
from wm.types import record

GROWTH, BASE = 1.5, 4096
"""Capacities are BASE * GROWTH^k: padded sizes that differ give few distinct shapes, hence few compilations."""

SLACK = 1e-3
"""Pixels by which ellipses are widened here, so that rounding never leaves out an entry that the compositing would count."""


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
        np.asarray(x) for x in (projected.mean2d, projected.root, projected.opacity, projected.depth, projected.extent)
    )
    tile = settings.tile
    columns, rows = -(-width // tile), -(-height // tile)
    order = _front_to_back(depth, np.flatnonzero((extent[0] > 0) & (opacity > 0)))
    gaussian, row = _rows_touched(mean[1, order], extent[1, order], height, tile)
    first, last = _columns_touched(order[gaussian], row, mean, root, opacity, extent, width, settings)
    spans = last - first
    entry = np.repeat(np.arange(len(spans)), spans)
    column = np.arange(len(entry)) - np.repeat(np.cumsum(spans) - spans, spans) + first[entry]
    key = row[entry] * columns + column
    by_tile = _radix_argsort(key, columns * rows)
    ids = order[gaussian[entry[by_tile]]]
    padded = np.full(_capacity(len(ids), capacity), mean.shape[1], np.int32)
    padded[: len(ids)] = ids
    return TilePlan(ids=padded, **_blocks(np.bincount(key, minlength=columns * rows), settings.block))


def _front_to_back(depth, visible):
    """Indices `visible` sorted by depth, ties by index. Depths are positive, so their bits order as they do."""
    bits = np.ascontiguousarray(depth[visible], np.float32).view(np.uint32)
    low = np.argsort(bits.astype(np.uint16), kind="stable")
    return visible[low[np.argsort((bits[low] >> 16).astype(np.uint16), kind="stable")]]


def _radix_argsort(key, size: int):
    """Stable argsort of integers below `size`."""
    order = np.argsort(key.astype(np.uint16), kind="stable")
    if size > 1 << 16:
        order = order[np.argsort((key[order] >> 16).astype(np.uint16), kind="stable")]
    return order


def _tile_span(low, high, size: int, tile: int):
    """First tile and one past the last whose pixel centres lie in [low, high], within an image of `size` pixels."""
    first = np.ceil(np.clip(low - SLACK, 0, size) - 0.5).astype(np.int64)  # pixels
    last = np.floor(np.clip(high + SLACK, 0, size) - 0.5).astype(np.int64)
    return first // tile, np.where(last >= first, last // tile + 1, first // tile)


def _rows_touched(centre, half_height, height: int, tile: int):
    """(index into the given gaussians, row of tiles) of every row that an ellipse's box meets, in the given order."""
    first, last = _tile_span(centre - half_height, centre + half_height, height, tile)
    spans = last - first
    gaussian = np.repeat(np.arange(len(spans)), spans)
    return gaussian, np.arange(len(gaussian)) - np.repeat(np.cumsum(spans) - spans, spans) + first[gaussian]


def _columns_touched(ids, row, mean, root, opacity, extent, width: int, settings: RasterSettings):
    """First and one past the last column of tiles that each ellipse meets within each row of tiles.

    On (l0 x + l1 y)^2 + (l2 y)^2 = r^2 the rightmost point has y = -l0 l1 / (l1^2 + l2^2) x_max; within a band of y that does
    not contain it, x is largest at the band's end nearest to it.
    """
    l0, l1, l2 = root[:, ids].astype(np.float64)
    mx, my = mean[:, ids].astype(np.float64)
    half = extent[0, ids].astype(np.float64)
    r2 = 2 * np.log(opacity[ids].astype(np.float64) / settings.alpha_min)
    low = row * settings.tile + 0.5 - my
    high = low + settings.tile - 1
    y_right = -l0 * l1 / (l1 * l1 + l2 * l2) * half
    reach = []
    for sign in (-1, 1):
        y = np.clip(sign * y_right, low, high)
        reach.append(mx + (sign * np.sqrt(np.maximum(r2 - (l2 * y) ** 2, 0)) - l1 * y) / l0)
    return _tile_span(reach[0], reach[1], width, settings.tile)


def _capacity(entries: int, wanted: int | None) -> int:
    size = BASE if wanted is None else max(wanted, 1)
    while size < entries:
        size = int(size * GROWTH)
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
