"""Laws of the rendered image and of its derivative, against the float64 twin and against themselves.

A compilation costs more than everything else here, so the scenes share a few shapes.
"""

import dataclasses
import functools

import chex
import jax
import jax.numpy as jnp
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.splat.scenes import (
    SMOOTH,
    camera,
    cloud,
    cotangent,
    dot,
    fast_gradient,
    gradients,
    images,
    jit_project,
    jit_reference,
    to_float32,
    to_float64,
    worst,
)
from wm.schema import RasterSettings
from wm.splat import plan_tiles, project, rasterize, render
from wm.splat.optimization.losses import depth_loss, photometric_terms
from wm.splat.optimization.normal_loss import normal_loss
from wm.splat.rasterizer import planner
from wm.splat.rasterizer._reference import render_reference
from wm.types import Camera, Gaussians, Render

DEFAULT = RasterSettings()
BACKGROUND = np.array([0.2, 0.5, 0.9])
SEEDS = st.integers(0, 10**6)


@given(SEEDS, st.sampled_from([(21, 13, 3), (1, 1, 1), (65, 9, 2)]))
@settings(max_examples=9, deadline=None)
def test_values_are_the_twins(seed, case):
    # in the smooth interior only rounding is left: 1e-7 relative a gaussian, some tens of them
    *size, degree = case
    found, exact = images(cloud(seed=seed, degree=degree), camera(*size, seed=seed), BACKGROUND)
    np.testing.assert_allclose(found.rgb, exact.rgb, atol=1e-5)
    np.testing.assert_allclose(found.alpha, exact.alpha, atol=1e-5)
    np.testing.assert_allclose(found.depth * found.alpha, exact.depth * exact.alpha, atol=3e-5)


@given(SEEDS)
@settings(max_examples=8, deadline=None)
def test_gradients_are_the_twins(seed):
    found, exact = gradients(cloud(seed=seed, degree=3), camera(seed=seed), BACKGROUND, seed=seed)
    assert worst(found, exact) < 3e-4


@given(SEEDS)
@settings(max_examples=10, deadline=None)
def test_at_the_cuts_few_pixels_flip_and_by_little(seed):
    # default constants, opaque gaussians: alpha crosses 1/255 and 0.99, pixels finish; rounding decides at the edges
    found, exact = images(cloud(seed=seed, degree=3, opaque=9.0), camera(seed=seed), BACKGROUND, DEFAULT)
    error = np.abs(found.rgb - exact.rgb).max(-1)
    assert (error > 1e-5).mean() <= 0.01 and error.max() < 2e-2


@pytest.mark.slow  # test_unpleasant.py has the same of scenes that are worse, by default
@given(SEEDS)
@settings(max_examples=8, deadline=None)
def test_gradients_at_the_cuts(seed):
    found, exact = gradients(cloud(seed=seed, degree=3, opaque=9.0), camera(seed=seed), BACKGROUND, DEFAULT, seed=seed)
    for a, b in zip(jax.tree.leaves(found), jax.tree.leaves(exact)):
        error = np.abs(a - b) / max(np.abs(b).max(), 1e-6)
        assert np.quantile(error, 0.9) < 1e-3 and error.max() < 5e-2


def test_pose_gradient_against_finite_differences():
    gaussians, view, weights, h = cloud(seed=1, degree=3), camera(seed=4), cotangent(camera()), 1e-5
    steps = [(i, j) for i in range(3) for j in range(4)]
    with jax.enable_x64(True):

        def value(step, by):
            T = view.T_cam_world.copy()
            T[step] += by
            moved = Camera(T_cam_world=T, focal=view.focal, principal=view.principal, width=view.width, height=view.height)
            return float(dot(jit_reference(gaussians, moved, background=BACKGROUND, settings=SMOOTH), weights))

        numeric = np.array([(value(step, h) - value(step, -h)) / (2 * h) for step in steps])
    found = fast_gradient(*to_float32((gaussians, view, BACKGROUND, weights)), settings=SMOOTH)[1].T_cam_world
    np.testing.assert_allclose([found[step] for step in steps], numeric, atol=1e-3 * np.abs(numeric).max())


def whole_loss(image: Render, view: Camera):
    """What a step of the fit minimises, toward some image and some tilted wall."""
    rng, dtype = np.random.default_rng(0), image.rgb.dtype
    target, mask = jnp.asarray(rng.random((13, 21, 3)), dtype), jnp.asarray(rng.random((13, 21)) < 0.9)
    scaffold = jnp.asarray(1 / np.linspace(0.7, 0.9, 21) + np.zeros((13, 1)), dtype)
    l1, dissimilarity = photometric_terms(image.rgb, target, mask)
    normal = normal_loss(image.depth, scaffold, mask, jnp.asarray(view.focal, dtype), jnp.asarray(view.principal, dtype))
    return 0.8 * l1 + 0.2 * dissimilarity + 1.5 * depth_loss(image.depth, scaffold, mask) + 0.3 * normal


def test_gradient_of_the_whole_loss_against_finite_differences():
    # large gaussians: every pixel is covered, so that depth is defined everywhere
    gaussians, view, h = cloud(seed=3, degree=3), camera(seed=4), 1e-6
    gaussians = to_float32(gaussians.replace(log_scales=gaussians.log_scales + 1.5))
    image = render(gaussians, view, background=BACKGROUND, settings=SMOOTH)
    weights = jax.jit(jax.grad(lambda image: whole_loss(image, view)))(image)
    found = to_float64(fast_gradient(gaussians, *to_float32((view, BACKGROUND)), weights, settings=SMOOTH))
    with jax.enable_x64(True):
        loss = jax.jit(lambda image: whole_loss(image, view))
        start = to_float64((gaussians, to_float32(view)))
        for name in ("means", "quats", "log_scales", "opacity_logits", "sh", "T_cam_world"):
            k = int(name == "T_cam_world")
            step = np.random.default_rng(5).normal(size=getattr(start[k], name).shape)
            step[3:] *= 1 - k  # the last row of a pose is not read

            def value(by, name=name, k=k, step=step):
                moved = list(start)
                moved[k] = dataclasses.replace(start[k], **{name: getattr(start[k], name) + by * step})
                return float(loss(jit_reference(*moved, background=BACKGROUND, settings=SMOOTH)))

            slope = getattr(found[k], name)
            assert abs((slope * step).sum() - (value(h) - value(-h)) / (2 * h)) < 1e-3 * np.linalg.norm(slope), name


@given(SEEDS, st.permutations(range(24)))
@settings(max_examples=10, deadline=None)
def test_order_of_the_gaussians_changes_nothing(seed, order):
    gaussians, view = cloud(seed=seed, degree=3), camera(seed=seed)
    shuffled = jax.tree.map(lambda x: x[np.array(order)], gaussians)
    chex.assert_trees_all_equal(render(gaussians, view), render(shuffled, view))


@pytest.mark.slow
def test_gradients_are_the_same_for_any_tile_chunk_and_block():
    arguments = to_float32((cloud(degree=3, opaque=9.0), camera(seed=8), BACKGROUND, cotangent(camera())))
    split = RasterSettings(tile=4, chunk=3, block=2)
    assert worst(fast_gradient(*arguments, settings=split), fast_gradient(*arguments, settings=DEFAULT)) < 1e-4


@given(SEEDS, st.floats(-2.0, 20.0))
@settings(max_examples=10, deadline=None)
def test_alpha_and_depth_stay_in_their_ranges(seed, opaque):
    gaussians, view = cloud(seed=seed, degree=3, opaque=opaque), camera(seed=seed)
    image = render(gaussians, view, settings=RasterSettings(slanted=False))
    assert (image.alpha >= 0).all() and (image.alpha <= 1).all()
    shown = np.asarray(image.alpha > 0)
    depth = np.asarray(jit_project(gaussians, view).depth)
    inside = np.asarray(image.depth)[shown]
    assert (inside > depth.min() * (1 - 1e-4)).all() and (inside < depth.max() * (1 + 1e-4)).all()
    assert (np.asarray(image.depth)[~shown] == 0).all()


def test_the_depth_of_discs_on_a_plane_converges_to_that_of_the_plane_at_least_with_the_square_of_their_size():
    view = Camera(T_cam_world=np.eye(4), focal=np.full(2, 18.0), principal=np.array([10.5, 6.5]), width=21, height=13)
    plane = np.array([0.5, -0.3, 2.0])  # z = 2 + 0.5 x - 0.3 y
    x, y = (np.mgrid[0:13, 0:21] + 0.5 - np.array([6.5, 10.5])[:, None, None])[::-1] / 18.0
    exact = plane[2] / (1 - plane[0] * x - plane[1] * y)

    def error(size, **options):
        image = render(_discs(plane, size), view, settings=RasterSettings(blur=1e-4, **options))
        return np.abs(np.asarray(image.depth) - exact)[np.asarray(image.alpha) > 0.5].mean()

    assert error(0.1) / error(0.05) > 4
    assert error(0.1) < 0.1 * error(0.1, slanted=False)


def _discs(plane, size: float, n: int = 2400) -> Gaussians:
    """Discs on z = c + a x + b y in front of the origin, as thin as paper."""
    rng = np.random.default_rng(0)
    means = rng.uniform(-1.5, 1.5, (n, 3))
    means[:, 2] = plane[2] + means[:, :2] @ plane[:2]
    normal = np.array([-plane[0], -plane[1], 1.0]) / np.linalg.norm([*plane[:2], 1.0])
    quat = np.array([1 + normal[2], -normal[1], normal[0], 0.0])  # turns the z axis to the normal
    return Gaussians(
        means=means,
        quats=np.tile(quat, (n, 1)),
        log_scales=np.log(np.tile([size, size, 1e-4], (n, 1))),
        opacity_logits=np.full(n, 0.5),
        sh=np.zeros((n, 1, 3)),
    )


def test_planned_and_rasterized_step_by_step_outside_jit_it_is_the_same_image():
    gaussians, view = to_float32((cloud(degree=3), camera()))
    projected = project(gaussians, view)
    plan = plan_tiles(projected, view.width, view.height)
    image = rasterize(projected, plan, view.width, view.height)
    chex.assert_trees_all_close(image, render(gaussians, view), atol=1e-6)


def test_one_colour_and_one_depth_everywhere_give_that_colour_and_depth():
    gaussians = cloud(degree=3, opaque=9.0)
    sh = np.zeros((24, 16, 3))
    color = np.array([0.1, 0.6, 0.3])
    sh[:, 0] = (color - 0.5) / 0.28209479177387814
    gaussians = gaussians.replace(sh=sh, means=gaussians.means * [1, 1, 0] + [0, 0, 3.0])
    image = render(gaussians, camera(), background=color, settings=RasterSettings(slanted=False))
    np.testing.assert_allclose(image.rgb, np.broadcast_to(color, image.rgb.shape), atol=1e-6)
    shown = np.asarray(image.alpha > 0)
    assert shown.any()
    np.testing.assert_allclose(np.asarray(image.depth)[shown], 3.0, rtol=1e-4)


@pytest.mark.parametrize("logit", [-50.0, -6.0])
def test_an_invisible_gaussian_changes_nothing(logit):
    gaussians = cloud(degree=3)
    gaussians.opacity_logits[5] = logit
    without = jax.tree.map(lambda x: np.delete(x, 5, 0), gaussians)
    chex.assert_trees_all_equal(render(gaussians, camera()), render(without, camera()))


def test_no_gaussians_show_the_background():
    background = np.random.default_rng(0).random((13, 21, 3))
    image = render(cloud(0), camera(), background=background)
    np.testing.assert_allclose(image.rgb, background, rtol=1e-6)
    assert (image.alpha == 0).all() and (image.depth == 0).all()
    found = fast_gradient(*to_float32((cloud(0), camera(), background, cotangent(camera()))), settings=DEFAULT)
    assert found[0].means.shape == (0, 3)
    np.testing.assert_allclose(found[2], cotangent(camera()).rgb, rtol=1e-6)
    assert all(np.isfinite(x).all() for x in jax.tree.leaves(found))


def test_depth_can_be_left_out():
    image = render(cloud(degree=3), camera(), settings=RasterSettings(depth=False))
    chex.assert_trees_all_equal(image.rgb, render(cloud(degree=3), camera()).rgb)
    assert (image.depth == 0).all()


def test_a_broken_gaussian_leaves_image_and_gradients_whole():
    view, lost = camera(seed=5), [3, 7, 8, 9, 10, 11]
    whole, broken = cloud(degree=3), cloud(degree=3)
    whole.opacity_logits[lost] = -50.0
    broken.means[3], broken.means[7], broken.means[11] = (
        np.nan,
        [0.1, 0, -3],
        -view.T_cam_world[:3, :3].T @ view.T_cam_world[:3, 3],
    )
    broken.quats[8], broken.log_scales[9], broken.sh[10] = np.nan, np.inf, np.nan
    chex.assert_trees_all_equal(render(broken, view), render(whole, view))
    rest = to_float32((view, BACKGROUND, cotangent(view)))
    found = fast_gradient(to_float32(broken), *rest, settings=DEFAULT)
    assert all((np.asarray(x)[lost] == 0).all() for x in jax.tree.leaves(found[0]))
    assert worst(found, fast_gradient(to_float32(whole), *rest, settings=DEFAULT)) < 1e-5


def test_jit_and_vmap_agree_with_the_plain_call():
    gaussians, view = to_float32(cloud(degree=3)), to_float32(camera())
    plain = render(gaussians, view)
    chex.assert_trees_all_close(jax.jit(render)(gaussians, view), plain, atol=1e-6)
    shifts = jnp.array([[0.0, 0, 0], [0.1, 0, 0], [0, -0.2, 0.1]])

    @functools.partial(jax.vmap, in_axes=(0, None))
    @functools.partial(jax.value_and_grad, has_aux=True)
    def several(shift, gaussians):
        image = render(gaussians.replace(means=gaussians.means + shift), view)
        return dot(image, to_float32(cotangent(camera()))), image

    (_, seen), found = jax.jit(several)(shifts, gaussians)
    for k, shift in enumerate(shifts):
        moved = gaussians.replace(means=gaussians.means + shift)
        chex.assert_trees_all_close(jax.tree.map(lambda x, k=k: x[k], seen), render(moved, view), atol=1e-5)
        alone = fast_gradient(*to_float32((moved, view, np.zeros(3), cotangent(camera()))), settings=DEFAULT)[0].means.sum(0)
        np.testing.assert_allclose(found[k], alone, rtol=1e-3)


def test_plans_of_any_size_compile_a_bounded_number_of_times():
    view = to_float32(camera(40, 24))
    chex.clear_trace_counter()
    traced = jax.jit(chex.assert_max_traces(lambda p, plan: rasterize(p, plan, 40, 24).alpha, n=2))
    base, entries = to_float32(cloud(300)), []
    for scale in (-3.0, -1.5, -1.0, -0.7, -0.5, 0.0):
        projected = jit_project(base.replace(log_scales=jnp.full((300, 3), scale)), view)
        plan = plan_tiles(projected, 40, 24)
        entries.append(int(plan.count.sum()))
        traced(projected, plan)
    assert len(set(entries)) > 4


def test_a_plan_is_data():
    # the plan of one state renders a state near it almost exactly: that is what lets a fit reuse it
    gaussians, view = to_float32(cloud(degree=3)), to_float32(camera())
    moved = gaussians.replace(means=gaussians.means + 1e-4)
    plan = plan_tiles(jit_project(gaussians, view), 21, 13)
    image = jax.jit(lambda g, plan: rasterize(project(g, view), plan, 21, 13))(moved, plan)
    np.testing.assert_allclose(image.rgb, render(moved, view).rgb, atol=1e-2)


def test_a_view_too_full_for_a_traced_plan_says_so(monkeypatch):
    monkeypatch.setattr(planner, "TRACED_PER_GAUSSIAN", 0)
    monkeypatch.setattr(planner, "TRACED_PER_TILE", 1)
    with pytest.raises(Exception, match="plan it outside"):
        jax.block_until_ready(jax.jit(lambda g: render(g, camera()).alpha)(to_float32(cloud(degree=3))))


def test_the_twin_refuses_float32():
    with pytest.raises(RuntimeError, match="enable_x64"):
        render_reference(cloud(2), camera())


def test_two_gaussians_in_a_row_by_hand():
    # one pixel, two wide gaussians: C = o1 c1 + (1 - o1) o2 c2 + (1 - o1) (1 - o2) white
    wide = Gaussians(
        means=np.array([[0.0, 0.0, 1.0], [0.0, 0.0, 2.0]]),
        quats=np.tile([1.0, 0, 0, 0], (2, 1)),
        log_scales=np.full((2, 3), 3.0),
        opacity_logits=np.log([0.25 / 0.75, 0.5 / 0.5]),
        sh=(np.array([[[1.0, 0, 0]], [[0, 1.0, 0]]]) - 0.5) / 0.28209479177387814,
    )
    view = Camera(T_cam_world=np.eye(4), focal=np.ones(2), principal=np.full(2, 0.5), width=1, height=1)
    for image in (render(wide, view, background=np.ones(3)), _twin(wide, view)):
        np.testing.assert_allclose(image.rgb[0, 0], [0.25 + 0.375, 0.375 + 0.375, 0.375], rtol=1e-5)
        np.testing.assert_allclose(image.depth[0, 0], (0.25 * 1 + 0.375 * 2) / 0.625, rtol=1e-5)


def _twin(gaussians, view):
    with jax.enable_x64(True):
        return to_float64(jit_reference(gaussians, view, background=np.ones(3)))
