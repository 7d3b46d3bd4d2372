"""Laws of the losses: what is masked has no say, in value and in gradient."""

import jax
import jax.numpy as jnp
import numpy as np

from wm.splat.losses import depth_loss, photometric_loss

photometric = jax.jit(jax.value_and_grad(lambda rgb, target, mask, w: photometric_loss(rgb, target, mask, ssim_weight=w)))


def images(seed=0):
    rng = np.random.default_rng(seed)
    rgb, target = (jnp.asarray(rng.random((10, 12, 3)), jnp.float32) for _ in range(2))
    return rgb, target, jnp.asarray(rng.random((10, 12)) < 0.7)


def test_photometric_is_zero_for_the_image_itself_and_l1_without_ssim():
    rgb, target, mask = images()
    assert abs(float(photometric(target, target, mask, 0.2)[0])) < 1e-6
    expected = np.abs(np.asarray(rgb) - np.asarray(target))[np.asarray(mask)].mean()
    np.testing.assert_allclose(photometric(rgb, target, mask, 0.0)[0], expected, rtol=1e-6)


def test_what_is_rendered_behind_the_mask_has_no_say():
    rgb, target, mask = images(1)
    noise = jnp.where(mask[..., None], rgb, 0.123)
    value, gradient = photometric(rgb, target, mask, 0.2)
    np.testing.assert_allclose(value, photometric(noise, target, mask, 0.2)[0], rtol=1e-6)
    assert not np.asarray(gradient)[~np.asarray(mask)].any() and np.asarray(gradient)[np.asarray(mask)].any()


def test_an_empty_mask_costs_nothing():
    rgb, target, mask = images(2)
    value, gradient = photometric(rgb, target, mask & False, 0.2)
    assert float(value) == 0 and not np.asarray(gradient).any()


def test_depth_counts_metres_where_the_scaffold_is_hit():
    mask = jnp.ones((4, 5), bool).at[0].set(False)
    scaffold = jnp.full((4, 5), 3.0).at[:, 0].set(0.0)
    np.testing.assert_allclose(depth_loss(jnp.full((4, 5), 2.5), scaffold, mask), 0.5, rtol=1e-6)
    gradient = np.asarray(jax.grad(depth_loss)(jnp.full((4, 5), 2.5), scaffold, mask))
    assert not gradient[0].any() and not gradient[:, 0].any()
    np.testing.assert_allclose(gradient[1:, 1:], -1 / 12, rtol=1e-6)
    assert float(depth_loss(scaffold, scaffold * 0, mask)) == 0
