"""Laws of work by blocks: the same bytes as at once, whatever the number of gaussians, and dead blocks cost a CPU nothing."""

import chex
import jax
import jax.numpy as jnp
import numpy as np
import pytest

from tests.splat.scenes import camera, cloud, to_float32
from wm.schema import RasterSettings
from wm.splat import Projected, plan_tiles, project, rasterize
from wm.splat.optimization.frozen import join_columns
from wm.splat.xla.blocks import BLOCK, in_blocks


def sines(x, factor):
    """[n, 2] and [n] to [2, n]."""
    return (jnp.sin(x) * factor[:, None]).T


@pytest.mark.parametrize("n", [0, 1, BLOCK - 1, BLOCK, BLOCK + 1, 3 * BLOCK + 5])
def test_by_blocks_and_at_once_are_the_same_bytes(n):
    x, factor = jnp.asarray(np.random.default_rng(n).normal(size=(n, 2)), jnp.float32), jnp.linspace(1, 2, n + 3)

    @jax.jit
    def blocks(x, factor):
        return in_blocks(sines, lambda *_: jnp.bool_(True), [x, factor], [0, 0], out_axis=-1)

    np.testing.assert_array_equal(blocks(x, factor), jax.jit(sines)(x, factor[:n]))


def test_dead_blocks_leave_what_was_there_and_the_first_result_comes_where_it_is_told():
    x = jnp.ones(3 * BLOCK).at[BLOCK : 2 * BLOCK].set(-1.0)
    before = jnp.full(3 * BLOCK + 4, 7.0)
    found = in_blocks(lambda x: x + 1, lambda x: (x > 0).any(), [x], [0], out_axis=0, into=before, at=3)
    dead = 7.0 if jax.default_backend() == "cpu" else 0.0  # elsewhere all is done at once
    np.testing.assert_array_equal(found[3:-1], jnp.where(x > 0, 2.0, dead))
    np.testing.assert_array_equal(found[jnp.array([0, 1, 2, -1])], 7.0)


@pytest.fixture(scope="module")
def many():
    """More gaussians than a block, the middle ones faint, seen by a camera."""
    gaussians, view = to_float32(cloud(2 * BLOCK + 77, seed=5)), to_float32(camera(seed=3))
    logits = gaussians.opacity_logits.at[BLOCK - 10 : 2 * BLOCK - 70].set(-20.0)
    return gaussians.replace(opacity_logits=logits, log_scales=gaussians.log_scales - 2), view


def test_gaussians_are_projected_as_if_there_were_no_others(many):
    gaussians, view = many
    few = np.array([0, 5, BLOCK - 11, BLOCK, 2 * BLOCK - 71, 2 * BLOCK - 70, 2 * BLOCK + 76])
    see = jax.jit(lambda gaussians: jax.vjp(lambda gaussians: project(gaussians, view), gaussians)[0])
    alone = see(jax.tree.map(lambda x: x[few], gaussians))
    chex.assert_trees_all_close(jax.tree.map(lambda x: x[..., few], see(gaussians)), alone, rtol=1e-6)

    def slope(gaussians, cotangent):
        return jax.vjp(lambda gaussians: project(gaussians, view), gaussians)[1](cotangent)[0]

    ones = jax.tree.map(jnp.ones_like, see(gaussians))
    of_few = jax.jit(slope)(jax.tree.map(lambda x: x[few], gaussians), jax.tree.map(lambda x: x[..., few], ones))
    chex.assert_trees_all_close(jax.tree.map(lambda x: x[few], jax.jit(slope)(gaussians, ones)), of_few, rtol=1e-5, atol=1e-6)


def test_frozen_gaussians_are_rendered_like_others_and_have_no_derivative(many):
    gaussians, view = many
    settings, n = RasterSettings(), BLOCK + 30
    projected = jax.jit(lambda gaussians: project(gaussians, view))(gaussians)
    own, frozen = (jax.tree.map(lambda x, part=part: x[..., part], projected) for part in (slice(0, n), slice(n, None)))
    plan = plan_tiles(projected, view.width, view.height, settings)

    def value(own: Projected, frozen: Projected | None):
        image = rasterize(own, plan, view.width, view.height, settings, frozen=frozen)
        return (image.rgb**2).sum() + image.depth.sum() + image.alpha.sum()

    apart, (by_own, by_frozen) = jax.jit(jax.value_and_grad(value, argnums=(0, 1)))(own, frozen)
    joined, by_all = jax.jit(jax.value_and_grad(value))(join_columns(own, frozen), None)
    np.testing.assert_allclose(apart, joined, rtol=1e-6)
    chex.assert_trees_all_close(by_own, jax.tree.map(lambda x: x[..., :n], by_all), rtol=1e-5, atol=1e-5)
    chex.assert_trees_all_equal(by_frozen, jax.tree.map(jnp.zeros_like, frozen))
    assert all(np.asarray(x).any() for x in (by_all.mean2d[:, n:], by_all.color[:, n:]))
