"""Laws of refinement: as many gaussians as before, hardly another image, and what moved starts afresh."""

import dataclasses

import jax
import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from tests.splat.scenes import camera
from wm.schema import FitSettings, RasterSettings
from wm.splat import render
from wm.splat.optimization.refinement import choose, halves, is_due, no_residual, observe, refine
from wm.splat.optimization.step import TrainState, adam_state
from wm.types import Gaussians

SETTINGS = FitSettings(refine_every=4, refine_share=0.25, refine_dead=0.05, steps=16)
N = 40


def cloud(opacity=None, seed=0):
    """Gaussians apart from each other in front of the camera, a quarter of them dead."""
    rng = np.random.default_rng(seed)
    x, y = np.meshgrid(np.linspace(-1.2, 1.2, 8), np.linspace(-0.7, 0.7, 5))
    logits = rng.uniform(0.0, 3.0, N) if opacity is None else np.full(N, np.log(opacity / (1 - opacity)))
    logits[::4] = -6.0 - np.arange(10)
    leaves = {
        "means": np.stack([x.ravel(), y.ravel(), rng.uniform(2.0, 3.0, N)], 1),
        "quats": rng.normal(size=(N, 4)),
        "log_scales": rng.normal(-1.9, 0.3, (N, 3)),
        "opacity_logits": logits,
        "sh": rng.normal(size=(N, 1, 3)),
    }
    return Gaussians(**{name: leaf.astype(np.float32) for name, leaf in leaves.items()})


def state_of(gaussians):
    ones = jax.tree.map(np.ones_like, gaussians)
    return TrainState(gaussians=gaussians, moments=adam_state(np.int32(7), ones, ones))


def pulled(seed=1):
    return observe(no_residual(N), np.random.default_rng(seed).normal(size=(2, N)).astype(np.float32))


def covariance(gaussians, weight):
    """Of a mixture, about its centre."""
    R = Rotation.from_quat(gaussians.quats, scalar_first=True).as_matrix()
    own = R @ (np.exp(2 * gaussians.log_scales.astype(np.float64))[:, :, None] * R.transpose(0, 2, 1))
    away = gaussians.means - (weight @ gaussians.means)
    return np.einsum("n,nij->ij", weight, own + away[:, :, None] * away[:, None])


def test_halves_have_the_centre_and_the_covariance_of_the_whole():
    whole = cloud()
    for k in range(5):
        one = jax.tree.map(lambda x, k=k: x[k : k + 1], whole)
        both = jax.tree.map(lambda *xs: np.concatenate(xs), *halves(one))
        np.testing.assert_allclose(both.means.mean(0), one.means[0], atol=1e-6)
        np.testing.assert_allclose(covariance(both, np.full(2, 0.5)), covariance(one, np.ones(1)), rtol=1e-4, atol=1e-7)


@pytest.mark.parametrize("opacity", [0.2, 0.6, 0.95])
def test_the_image_hardly_changes_at_the_moment_of_refinement(opacity):
    before = cloud(opacity)
    after = refine(state_of(before), pulled(), SETTINGS).gaussians
    settings = RasterSettings(chunk=1, block=16)
    without = before.replace(opacity_logits=before.opacity_logits.copy())
    without.opacity_logits[choose(before, pulled(), SETTINGS)[1]] = -9
    first, second, third = (
        np.asarray(render(g, camera(48, 32, focal=40.0), settings=settings).rgb) for g in (before, after, without)
    )
    change = np.abs(second - first)
    assert (after.means != before.means).any() and change.max() < 0.3 * np.abs(first).max()
    assert change.mean() < 0.2 * np.abs(third - first).mean()  # of what would change if what is split were lost


@pytest.mark.parametrize("opacity", [0.1, 0.5, 0.9, 0.98])
def test_halves_are_as_deep_as_the_whole(opacity):
    whole = jax.tree.map(lambda x: x[1:2], cloud(opacity))
    low, high = halves(whole)
    x = np.linspace(-8, 8, 2001)  # along the axis, in standard deviations of the whole

    def depth(centre, width, logit):
        return -np.log1p(-np.exp(-0.5 * ((x - centre) / width) ** 2) / (1 + np.exp(-logit)))

    pair = sum(depth(c, 0.75**0.5, half.opacity_logits[0]) for c, half in ((-0.5, low), (0.5, high)))
    np.testing.assert_allclose(pair.sum(), depth(0, 1, whole.opacity_logits[0]).sum(), rtol=2e-3)


def test_the_faintest_go_to_where_the_residual_pulls_most():
    gaussians, residual = cloud(), pulled()
    dead, split = choose(gaussians, residual, SETTINGS)
    assert len(dead) == len(split) == N // 4 and set(dead) == set(range(0, N, 4)) and not set(dead) & set(split)
    assert dead[0] == 36  # the faintest
    rest = np.setdiff1d(np.arange(N), [*dead, *split])
    assert residual.gradient_norm[split].min() >= residual.gradient_norm[rest].max()
    few = dataclasses.replace(SETTINGS, refine_share=0.1)
    assert [len(found) for found in choose(gaussians, residual, few)] == [4, 4]


def test_what_moved_starts_without_moments_and_the_rest_is_untouched():
    before = state_of(cloud())
    after = refine(before, pulled(), SETTINGS)
    dead, split = choose(before.gaussians, pulled(), SETTINGS)
    moved = np.zeros(N, bool)
    moved[[*dead, *split]] = True
    for moment in (after.moments.mu, after.moments.nu):
        assert all(not leaf[moved].any() and (leaf[~moved] == 1).all() for leaf in jax.tree.leaves(moment))
    for old, new in zip(jax.tree.leaves(before.gaussians), jax.tree.leaves(after.gaussians), strict=True):
        assert old.shape == new.shape and old.dtype == new.dtype and (old[~moved] == new[~moved]).all()


def test_without_dead_gaussians_or_residual_nothing_happens():
    alive = state_of(cloud().replace(opacity_logits=np.ones(N, np.float32)))
    for state, residual in ((alive, pulled()), (state_of(cloud()), no_residual(N))):
        after = refine(state, residual, SETTINGS)
        assert all((a == b).all() for a, b in zip(jax.tree.leaves(after), jax.tree.leaves(state), strict=True))


def test_a_visit_that_does_not_show_a_gaussian_does_not_count():
    shift = np.zeros((2, 3), np.float32)
    shift[:, 1] = (3, 4)
    residual = observe(observe(no_residual(3), shift), 0 * shift)
    assert residual.gradient_norm.tolist() == [0, 5, 0] and residual.visits.tolist() == [0, 1, 0]


def test_refinement_comes_every_so_many_steps_and_ends_before_the_fit():
    assert [step for step in range(1, 17) if is_due(SETTINGS, step)] == [4, 8, 12]
    assert not any(is_due(FitSettings(steps=16), step) for step in range(1, 17))
