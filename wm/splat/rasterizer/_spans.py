"""Tile binning of ellipses: the arithmetic that the plans on the host and in the graph share, for NumPy and JAX alike.

A span is a first tile and how many from there. `xp` is the array module, numpy or jax.numpy.
"""

from types import ModuleType
from typing import Any

from wm.schema import RasterSettings

SLACK, RELATIVE_SLACK = 1e-3, 1e-6
"""Ellipses are widened by this many pixels, and by this share of their size and distance from the origin, so that rounding
never drops an entry whose alpha is not 0."""


def slack(centre, half: Any, xp: ModuleType):
    """By how many pixels an ellipse of this centre and half width is widened."""
    return SLACK + RELATIVE_SLACK * (xp.abs(centre) + half)


def tile_span(low, high, size: int, tile: int, xp: ModuleType):
    """First tile whose pixel centres lie in [low, high], and how many, within an image of `size` pixels."""
    first = xp.ceil(xp.clip(low, 0, size) - 0.5).astype(xp.int32)  # pixels
    last = xp.floor(xp.clip(high, 0, size) - 0.5).astype(xp.int32)
    return first // tile, xp.where(last >= first, last // tile + 1 - first // tile, 0)


def chord_terms(mean, root, opacity, extent, settings: RasterSettings, xp: ModuleType):
    """What `chord` needs of each ellipse, [8, n].

    On (l0 x + l1 y)^2 + (l2 y)^2 = r^2 the rightmost point has y = -l0 l1 / (l1^2 + l2^2) x_max.
    """
    l0, l1, l2 = root
    r2 = 2 * xp.log(opacity / xp.float32(settings.alpha_min))
    y_right = -l0 * l1 / (l1 * l1 + l2 * l2) * extent[0]
    return xp.stack([mean[0], mean[1], l1 / l0, 1 / l0, l2, r2, y_right, slack(mean[0], extent[0], xp)])


def chord(terms, row, tile: int, xp: ModuleType):
    """Leftmost and rightmost x of ellipses within rows of tiles; where a row misses its ellipse, wrong by no more than its width.

    Within a band of y that does not contain the rightmost point, x is largest at the band's end nearest to it.
    """
    mx, my, tilt, width_of_1, l2, r2, y_right, margin = terms
    low = row.astype(xp.float32) * tile + 0.5 - my
    high = low + (tile - 1)
    left, right = (
        mx - tilt * y + sign * (width_of_1 * xp.sqrt(xp.maximum(r2 - (l2 * y) ** 2, 0)) + margin)
        for sign, y in ((-1, xp.clip(-y_right, low, high)), (1, xp.clip(y_right, low, high)))
    )
    return left, right


def blocks(count, order, lanes: int, xp: ModuleType) -> dict:
    """tile, start and count of a plan: tiles by falling length of their lists (`order`), so that a block's lanes end together."""
    tiles = len(count)
    lanes = min(lanes, tiles)
    padding = -tiles % lanes
    start = xp.cumsum(count) - count
    padded = xp.concatenate([order, xp.broadcast_to(order[-1:], (padding,))])
    lengths = xp.where(xp.arange(tiles + padding) < tiles, count[padded], 0)
    columns = {"tile": padded, "start": start[padded], "count": lengths}
    return {name: x.reshape(-1, lanes).astype(xp.int32) for name, x in columns.items()}
