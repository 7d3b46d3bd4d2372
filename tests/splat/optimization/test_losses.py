"""Laws of the losses: what is masked has no say, in value and in gradient."""

import jax
import jax.numpy as jnp
import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from wm.geometry.rays.pinhole import camera_rays, make_camera
from wm.splat.optimization.losses import depth_loss, photometric_terms
from wm.splat.optimization.normal_loss import normal_loss


@jax.jit
@jax.value_and_grad
def photometric(rgb, target, mask, ssim_weight):
    l1, dissimilarity = photometric_terms(rgb, target, mask)
    return (1 - ssim_weight) * l1 + ssim_weight * dissimilarity


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


CAMERA = make_camera(np.array([1.0, 1.2, 1.5]), np.array([3.0, 2.0, 0.3]), width=24, height=16, fov_deg=60.0)
normals = jax.jit(jax.value_and_grad(normal_loss))


def plane(height=0.0, tilt=0.0):
    """Depth of the plane z = height + tilt x from CAMERA."""
    eye, rays = np.array([1.0, 1.2, 1.5]), camera_rays(CAMERA)
    normal = np.array([-tilt, 0.0, 1.0])
    return jnp.asarray(((height - eye @ normal) / (rays @ normal)).reshape(16, 24), jnp.float32), normal / np.linalg.norm(normal)


def angle_loss(depth, scaffold, mask=None):
    mask = jnp.ones(depth.shape, bool) if mask is None else mask
    return normals(depth, scaffold, mask, jnp.asarray(CAMERA.focal, jnp.float32), jnp.asarray(CAMERA.principal, jnp.float32))


def test_normals_count_the_angle_between_surfaces_and_not_their_distance():
    floor, up = plane()
    ramp, slope = plane(tilt=0.2)
    np.testing.assert_allclose(angle_loss(ramp, floor)[0], 1 - up @ slope, rtol=1e-3)
    assert float(angle_loss(plane(height=-0.3)[0], floor)[0]) < 1e-5 and float(angle_loss(1.1 * floor, floor)[0]) < 1e-5


def test_normals_have_no_say_beside_edges_where_nothing_is_hit_and_behind_the_mask():
    floor, _ = plane()
    ramp, _ = plane(tilt=0.2)
    step = floor.at[:, 12:].add(0.5)
    _, gradient = angle_loss(ramp, step)
    # pixels 11 and 12 touch the step: what only their differences read is left out
    assert np.isfinite(gradient).all() and np.asarray(gradient)[:, :9].any()
    assert float(angle_loss(ramp, floor * 0)[0]) == 0 and float(angle_loss(ramp, floor, jnp.zeros((16, 24), bool))[0]) == 0
    holes = angle_loss(ramp.at[5:9, 5:9].set(0.0), floor)
    assert np.isfinite(holes[0]) and np.isfinite(holes[1]).all()


@given(st.integers(0, 2**16), st.sampled_from([1e-6, 1.0, 1e6]), st.floats(0, 1))
@settings(max_examples=25, deadline=None)
def test_normals_of_any_depth_have_a_finite_gradient_and_none_between_holes(seed, metres, share):
    """Depths from micrometres to thousands of kilometres, rough from pixel to pixel, a share of them 0."""
    rng = np.random.default_rng(seed)
    depth = metres * rng.random((16, 24), np.float32) * (rng.random((16, 24)) >= share)
    value, gradient = angle_loss(jnp.asarray(depth, jnp.float32), plane()[0])
    assert 0 <= value <= 2 and np.isfinite(gradient).all()
    padded = np.pad(depth, 2)
    opposite = [padded[2 + 2 * i : 18 + 2 * i, 2 + 2 * j : 26 + 2 * j] for i, j in ((0, 1), (0, -1), (1, 0), (-1, 0))]
    alone = (depth == 0) & np.all([other == 0 for other in opposite], axis=0)
    assert not np.asarray(gradient)[alone].any()


def test_gradient_of_normals_against_float64_differences():
    rng = np.random.default_rng(3)
    depth, direction = 2 + 0.3 * rng.random((16, 24)), rng.normal(size=(16, 24))
    floor = np.asarray(plane()[0], np.float64)
    found = np.sum(np.asarray(angle_loss(jnp.asarray(depth, jnp.float32), plane()[0])[1], np.float64) * direction)
    with jax.enable_x64(True):
        focal, principal, everywhere = jnp.asarray(CAMERA.focal), jnp.asarray(CAMERA.principal), jnp.ones((16, 24), bool)

        def value(by):
            return float(normal_loss(jnp.asarray(depth + by * direction), jnp.asarray(floor), everywhere, focal, principal))

        numeric = (value(1e-6) - value(-1e-6)) / 2e-6
    np.testing.assert_allclose(found, numeric, rtol=1e-4)
