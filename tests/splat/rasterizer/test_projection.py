"""Laws of the projection: ellipses, culling, harmonics, and gradients that stay finite where no direction exists."""

import functools

import chex
import jax
import jax.numpy as jnp
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.splat.scenes import camera, cloud, jit_project, to_float32
from wm.geometry import project_points
from wm.schema import RasterSettings
from wm.splat import project
from wm.splat.rasterizer._reference import _image_axes
from wm.splat.rasterizer.harmonics import harmonics
from wm.splat.rasterizer.projection import project_vjp


def test_means_go_where_the_camera_sends_points():
    gaussians, view = cloud(40), camera(seed=3)
    found = jit_project(gaussians, view)
    uv, depth = project_points(view, gaussians.means)
    np.testing.assert_allclose(found.mean2d.T, uv, atol=2e-5)
    np.testing.assert_allclose(found.depth, depth, rtol=1e-6)


def test_root_is_the_cholesky_factor_of_the_inverse_covariance():
    # a round gaussian on the axis: Sigma = (focal s / z)^2 + blur on each axis, no tilt
    view = camera(8, 8, focal=20.0)
    one = cloud(1).replace(means=np.array([[0.0, 0.0, 2.0]]), log_scales=np.full((1, 3), np.log(0.1)))
    l0, l1, l2 = np.asarray(jit_project(one, view).root[:, 0])
    np.testing.assert_allclose([l0, l2], [(1.0 + 0.3) ** -0.5, (1.1**2 + 0.3) ** -0.5], rtol=1e-6)
    assert abs(l1) < 1e-7


@given(st.integers(0, 10**6))
@settings(max_examples=10, deadline=None)
def test_needles_keep_their_digits(seed):
    # condition number 1e8 before the blur: the naive determinant xx yy - xy^2 has no digit left in float32
    rng = np.random.default_rng(seed)
    thin = cloud(8, seed=seed).replace(log_scales=np.log(np.stack([np.full(8, 3.0), *rng.uniform(3e-4, 1e-3, (2, 8))], 1)))
    view = camera(640, 480, focal=500.0)
    found = np.asarray(jit_project(thin, view).root, np.float64)
    with jax.enable_x64(True):
        exact = _root64(thin, view)
    np.testing.assert_allclose(found, exact, rtol=2e-3, atol=1e-5)


def _root64(gaussians, view):
    R, t = view.T_cam_world[:3, :3], view.T_cam_world[:3, 3]
    M = np.asarray(_image_axes(gaussians, R, gaussians.means @ R.T + t, view, RasterSettings())[0])
    sigma = M @ M.transpose(0, 2, 1) + 0.3 * np.eye(2)
    return np.stack([np.linalg.cholesky(np.linalg.inv(sigma))[:, i, j] for i, j in ((0, 0), (1, 0), (1, 1))])


CULLED = {
    "behind the camera": {"means": [[0.1, 0.2, -2.0]]},
    "at the camera's centre": {"means": [[0.0, 0.0, 0.0]]},
    "nearer than near": {"means": [[0.0, 0.0, 0.04]]},
    "NaN mean": {"means": [[np.nan, 0.0, 2.0]]},
    "NaN depth": {"means": [[0.0, 0.0, np.nan]]},
    "infinite mean": {"means": [[np.inf, 0.0, 2.0]]},
    "NaN quat": {"quats": [[1.0, np.nan, 0.0, 0.0]]},
    "NaN scale": {"log_scales": [[np.nan, 0.0, 0.0]]},
    "overflowing scale": {"log_scales": [[100.0, 0.0, 0.0]]},
    "NaN opacity": {"opacity_logits": [np.nan]},
    "opacity 0": {"opacity_logits": [-50.0]},
    "opacity logit -inf": {"opacity_logits": [-np.inf]},
    "infinite scale": {"log_scales": [[np.inf, 0.0, 0.0]]},
    "infinite quat": {"quats": [[1.0, np.inf, 0.0, 0.0]]},
    "opacity below the cut": {"opacity_logits": [-6.0]},
    "NaN colour": {"sh": [[[np.nan, 0.0, 0.0]]]},
    "infinite colour": {"sh": [[[0.0, -np.inf, 0.0]]]},
}


@jax.jit
@functools.partial(jax.grad, argnums=(0, 1))
def _gradient(gaussians, view):
    seen = project(gaussians, view)
    return sum(x.sum() for x in (seen.mean2d, seen.root, seen.opacity, seen.color, seen.depth))


def _with_first(fields):
    """A cloud whose first gaussian has these fields."""
    fields = {name: np.concatenate([np.asarray(value), getattr(cloud(4), name)[1:]]) for name, value in fields.items()}
    return to_float32(cloud(4).replace(**fields))


def test_an_opacity_logit_of_infinity_is_that_of_opacity_1():
    """The one number that is not finite and means something: files have it, as the logit of 1."""
    infinite, finite = (_with_first({"opacity_logits": [logit]}) for logit in (np.inf, 50.0))
    view = to_float32(camera())
    assert jit_project(infinite, view).opacity[0] == 1
    chex.assert_trees_all_equal(jit_project(infinite, view), jit_project(finite, view))
    gradients = [_gradient(gaussians, view) for gaussians in (infinite, finite)]
    chex.assert_trees_all_equal(*gradients)
    assert np.isfinite(gradients[0][0].opacity_logits).all()


@pytest.mark.parametrize("case", CULLED)
def test_culled_gaussians_have_no_opacity_no_extent_and_no_gradient(case):
    gaussians, view = _with_first(CULLED[case]), to_float32(camera())
    found = jit_project(gaussians, view)
    assert all(np.isfinite(x).all() for x in jax.tree.leaves(found))
    assert found.opacity[0] == 0 and (found.extent[:, 0] == 0).all()
    assert (found.opacity[1:] > 0).all() and (found.extent[:, 1:] > 0).all()

    by_gaussians, by_camera = _gradient(gaussians, view)
    assert all(np.isfinite(x).all() for x in jax.tree.leaves((by_gaussians, by_camera)))
    assert all((x[0] == 0).all() for x in jax.tree.leaves(by_gaussians))


@pytest.mark.parametrize(
    "raster", [pytest.param(RasterSettings(), marks=pytest.mark.slow), RasterSettings(antialias=True, depth=False)]
)
def test_the_derivative_beside_a_known_result_is_the_derivative(raster):
    gaussians, view = to_float32(cloud(40, degree=2)), to_float32(camera(seed=3))
    projected, pull = jax.vjp(lambda gaussians: project(gaussians, view, raster), gaussians)
    cotangent = jax.tree.map(lambda x: jnp.cos(jnp.arange(x.size, dtype=x.dtype)).reshape(x.shape), projected)
    chex.assert_trees_all_equal(project_vjp(gaussians, view, projected, cotangent, raster), *pull(cotangent))


def test_zero_quaternion_is_the_identity_with_zero_gradient():
    gaussians = to_float32(cloud(4).replace(quats=np.array([[0.0] * 4, [1.0, 0, 0, 0], [1.0, 2, 3, 4], [4.0, 3, 2, 1]])))
    gaussians = gaussians.replace(
        means=gaussians.means.at[1].set(gaussians.means[0]), log_scales=gaussians.log_scales.at[1].set(gaussians.log_scales[0])
    )
    found = jit_project(gaussians, camera())
    np.testing.assert_array_equal(found.root[:, 0], found.root[:, 1])
    gradient = _gradient(gaussians, to_float32(camera()))[0].quats
    assert (gradient[0] == 0).all() and np.isfinite(gradient).all() and (gradient[2] != 0).any()


@given(st.integers(0, 10**6), st.floats(1e-3, 1e3))
@settings(max_examples=10, deadline=None)
def test_length_of_the_quaternion_changes_nothing(seed, factor):
    gaussians = cloud(6, seed=seed)
    scaled = gaussians.replace(quats=gaussians.quats * factor)
    np.testing.assert_allclose(jit_project(gaussians, camera()).root, jit_project(scaled, camera()).root, rtol=2e-4, atol=1e-5)


def test_extent_is_where_alpha_falls_to_the_cut():
    found = jit_project(cloud(30), camera(seed=2))
    l0, l1, l2 = np.asarray(found.root, np.float64)
    angle = np.linspace(0, 2 * np.pi, 2000)[:, None]
    radius = np.sqrt(2 * np.log(255 * np.asarray(found.opacity, np.float64)))
    dy = radius * np.sin(angle) / l2
    dx = (radius * np.cos(angle) - l1 * dy) / l0
    np.testing.assert_allclose(found.extent, [dx.max(0), dy.max(0)], rtol=1e-4)


def test_harmonics_are_orthonormal():
    u, w = np.polynomial.legendre.leggauss(8)
    phi = 2 * np.pi * np.arange(16) / 16
    z, azimuth = (x.ravel() for x in np.meshgrid(u, phi, indexing="ij"))
    weight = np.repeat(w, 16) * 2 * np.pi / 16
    r = np.sqrt(1 - z * z)
    directions = jnp.asarray(np.stack([r * np.cos(azimuth), r * np.sin(azimuth), z]), jnp.float32)
    basis = np.stack([np.broadcast_to(Y, z.shape) for Y in harmonics(directions, 3)])
    np.testing.assert_allclose((basis * weight) @ basis.T, np.eye(16), atol=1e-6)


def test_a_wrong_number_of_harmonics_is_named():
    with pytest.raises(ValueError, match="5 coefficients"):
        jit_project(cloud(2).replace(sh=np.zeros((2, 5, 3))), camera())
