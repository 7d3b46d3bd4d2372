"""Sums over the pixels of a tile, [pixels, ...] in row-major order: along its rows first, then down.

Every array ends in the tiles of a block (lanes), which fill the vectors. Sums are written out as trees of halves, which XLA fuses
with the products before them, and whose rounding grows with the logarithm of their length.
"""

import math
from collections.abc import Iterable

import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

POWERS = ((0, 0), (1, 0), (0, 1), (2, 0), (1, 1), (0, 2))
"""Of u and of v in the six moments, (u, v) the place of a pixel from the centre of its tile."""


def offsets(tile: int) -> tuple[Float[np.ndarray, "pixels"], Float[np.ndarray, "pixels"]]:
    """Pixel centres from the centre of their tile, row-major: u, v [pixels]."""
    v, u = np.meshgrid(_along(tile), _along(tile), indexing="ij")
    return u.ravel(), v.ravel()


def moments_of_rows(d: Float[Array, "pixels chunk lanes"]) -> Float[Array, "rows chunk 3 lanes"]:
    """Sums of d times 1, u, u^2 along every row."""
    d = _by_rows(d)
    powers = _along(d.shape[1])[:, None, None] ** np.arange(3, dtype=np.float32)[:, None]
    return total(d[:, i, :, None] * power[None, None] for i, power in enumerate(powers))


def moments(sums: Float[Array, "rows chunk 3 lanes"]) -> Float[Array, "chunk 6 lanes"]:
    """Sums over the tile times u^m v^n, (m, n) as in POWERS, from those of `moments_of_rows`."""
    v = _along(len(sums))
    return jnp.stack([total(row[:, m] * y**n for row, y in zip(sums, v)) for m, n in POWERS], 1)


def products_of_rows(
    w: Float[Array, "pixels chunk lanes"], g: Float[Array, "pixels features lanes"]
) -> Float[Array, "rows chunk features lanes"]:
    """Sums of every w times every g along every row."""
    w, g = _by_rows(w), _by_rows(g)
    return total(w[:, i, :, None] * g[:, i, None] for i in range(w.shape[1]))


def total(terms: Iterable[Float[Array, "*shape"]]) -> Float[Array, "*shape"]:
    """The sum of arrays, or of one along its first axis."""
    terms = list(terms)
    while len(terms) > 1:
        half = len(terms) // 2
        terms = [a + b for a, b in zip(terms[:half], terms[half:])] + terms[2 * half :]
    return terms[0]


def _along(tile: int):
    """Pixel centres along a side of a tile, from its middle, pixels."""
    return np.arange(tile, dtype=np.float32) + np.float32(0.5 - tile / 2)


def _by_rows(x):
    """[pixels, ...] as [rows, pixels of a row, ...]."""
    tile = math.isqrt(len(x))
    return x.reshape(tile, tile, *x.shape[1:])
