"""Sums over the pixels of a tile against float64, for tiles of odd and even sides."""

import jax.numpy as jnp
import numpy as np
import pytest

from wm.splat.rasterizer._tile_sums import POWERS, moments, moments_of_rows, offsets, products_of_rows, total


@pytest.mark.parametrize("tile", [1, 2, 3, 5, 8])
def test_sums_are_those_of_float64(tile):
    rng = np.random.default_rng(tile)
    d, g = (rng.normal(size=(tile**2, count, 2)).astype(np.float32) for count in (3, 4))
    u, v = (x.astype(np.float64) for x in offsets(tile))
    by_power = np.stack([np.einsum("p,pkl->kl", u**m * v**n, d) for m, n in POWERS], 1)
    np.testing.assert_allclose(moments(moments_of_rows(jnp.asarray(d))), by_power, atol=1e-6 * tile**4)
    products = np.einsum("pkl,pjl->kjl", d, g, dtype=np.float64)
    np.testing.assert_allclose(total(products_of_rows(jnp.asarray(d), jnp.asarray(g))), products, atol=1e-6 * tile**2)


@pytest.mark.parametrize("tile", [1, 2, 3, 8])
def test_offsets_are_centred_and_row_major(tile):
    u, v = offsets(tile)
    assert u.sum() == v.sum() == 0
    np.testing.assert_array_equal(np.diff(u.reshape(tile, tile)), 1)
    np.testing.assert_array_equal(u.reshape(tile, tile), v.reshape(tile, tile).T)
