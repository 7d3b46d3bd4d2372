"""What files of other trainers hold and other programs turn on: colours below 0, discs, floors from knee height, strict JAX."""

import contextlib

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from tests.splat.scenes import camera, cloud
from wm.schema import RasterSettings
from wm.splat import render
from wm.splat.rasterizer._reference import render_reference
from wm.types import Camera, Gaussians

LEAVES = ("means", "quats", "log_scales", "opacity_logits", "sh")


def float32(gaussians):
    return Gaussians(**{name: np.asarray(getattr(gaussians, name), np.float32) for name in LEAVES})


@pytest.mark.parametrize("degree", [pytest.param(0, marks=pytest.mark.slow), 1])
def test_colours_below_0_are_0_and_have_no_gradient(degree):
    gaussians, view = float32(cloud(degree=degree)), camera()
    gaussians.sh[::2, 0, 1] = -9
    black = float32(gaussians)
    black.sh[::2, :, 1] = 0
    black.sh[::2, 0, 1] = -0.5 / 0.28209479177387814
    np.testing.assert_allclose(render(gaussians, view).rgb, render(black, view).rgb, atol=1e-6)
    weights = jnp.asarray(np.random.default_rng(0).normal(size=(view.height, view.width, 3)), jnp.float32)
    gradient = jax.grad(lambda g: (weights * render(g, view).rgb).sum())(gaussians)
    assert (np.asarray(gradient.sh)[::2, :, 1] == 0).all() and (np.asarray(gradient.sh)[1::2, :, 1] != 0).any()


@pytest.mark.parametrize("axes", [[0], [1], [2], [0, 1], [0, 1, 2]])
@pytest.mark.parametrize("antialias", [False, True])
def test_discs_are_drawn_as_gaussians_as_good_as_flat(axes, antialias):
    settings = RasterSettings(antialias=antialias)
    flat, thin, view = float32(cloud()), float32(cloud()), camera()
    flat.log_scales[:, axes], thin.log_scales[:, axes] = -np.inf, -25

    def loss(gaussians, view):
        seen = render(gaussians, view, settings=settings)
        return (seen.rgb**2).sum() + seen.depth.sum()

    assert np.asarray(render(flat, view, settings=settings).alpha).max() > 0.1 or antialias
    np.testing.assert_allclose(render(flat, view, settings=settings).rgb, render(thin, view, settings=settings).rgb, atol=1e-5)
    found, wanted = (jax.grad(loss, argnums=(0, 1), allow_int=True)(g, view) for g in (flat, thin))
    for a, b in zip(jax.tree.leaves(found), jax.tree.leaves(wanted)):
        assert np.isfinite(a).all()
        np.testing.assert_allclose(a, b, atol=1e-4 * max(1, np.abs(b).max()))


def floor(below, ahead, size):
    return Gaussians(
        means=np.array([[0.1, below, ahead]], np.float32),
        quats=np.array([[1, 0.02, 0, 0.05]], np.float32),
        log_scales=np.log(np.array([[size, 0.002, size]], np.float32)),
        opacity_logits=np.array([5], np.float32),
        sh=np.ones((1, 1, 3), np.float32),
    )


FLOORS = [(0.3, 2.0, 1.0), (0.3, 3.0, 3.0), (0.1, 1.0, 0.5), (0.5, 0.3, 20.0)]


@pytest.mark.parametrize("place", FLOORS)
def test_depth_lies_in_front_of_the_camera_however_large_and_slanted_a_gaussian(place):
    view = Camera(T_cam_world=np.eye(4), focal=np.full(2, 60.0), principal=np.array([40.0, 30.0]), width=80, height=60)
    settings = RasterSettings()
    seen = render(floor(*place), view, settings=settings)
    covered = np.asarray(seen.alpha) > 0
    assert covered.any() and np.asarray(seen.depth)[covered].min() >= settings.near * (1 - 1e-3)


@pytest.mark.parametrize("place", FLOORS[:3])
def test_limited_depth_and_its_gradient_are_the_twins(place):
    view = camera()
    weights = np.random.default_rng(1).normal(size=(view.height, view.width))

    def gradient(draw, gaussians):
        return jax.grad(lambda g: (draw(g, view).depth * weights).sum())(gaussians)

    found = gradient(render, floor(*place))
    with jax.enable_x64(True):
        wanted = gradient(render_reference, jax.tree.map(lambda x: jnp.asarray(x, jnp.float64), floor(*place)))
        depth = np.asarray(render_reference(floor(*place), view).depth)
    np.testing.assert_allclose(render(floor(*place), view).depth, depth, rtol=1e-3, atol=1e-3)
    for name in LEAVES:
        a, b = (np.asarray(getattr(x, name), np.float64) for x in (found, wanted))
        np.testing.assert_allclose(a, b, rtol=2e-3, atol=2e-3 * max(1.0, np.abs(b).max()))


STRICT = {"jax_numpy_rank_promotion": "raise", "jax_numpy_dtype_promotion": "strict"}


@contextlib.contextmanager
def switched(values):
    before = {name: getattr(jax.config, name) for name in values}
    try:
        for name, value in values.items():
            jax.config.update(name, value)
        yield
    finally:
        for name, value in before.items():
            jax.config.update(name, value)


@pytest.mark.parametrize("planner", ["host", pytest.param("traced", marks=pytest.mark.slow)])
def test_it_promotes_neither_ranks_nor_types(planner):
    gaussians, view = float32(cloud(degree=1)), jax.tree.map(lambda x: np.asarray(x, np.float32), camera())
    settings, behind = RasterSettings(antialias=True, planner=planner), np.ones(3, np.float32)

    def loss(gaussians, view):
        seen = render(gaussians, view, background=behind, settings=settings)
        return seen.rgb.mean() + seen.depth.mean()

    usual = jax.grad(loss, argnums=(0, 1))(gaussians, view)
    with switched(STRICT):
        jax.clear_caches()  # what was traced before was not checked
        strict = jax.grad(loss, argnums=(0, 1))(gaussians, view)
    jax.tree.map(np.testing.assert_array_equal, strict, usual)
