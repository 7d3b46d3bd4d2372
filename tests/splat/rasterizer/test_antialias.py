"""Laws of the compensation for the blur: what the twin says, and that a gaussian's light does not depend on its size."""

import dataclasses

import jax
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.splat.scenes import SMOOTH, camera, cloud, gradients, images, jit_project, worst
from wm.schema import RasterSettings

COMPENSATED = dataclasses.replace(SMOOTH, antialias=True)
BACKGROUND = np.array([0.2, 0.5, 0.9])
SEEDS = st.integers(0, 10**6)


def small(seed):
    """Gaussians of a hundredth of a pixel to a few pixels: above and below the floor of the compensation."""
    rng = np.random.default_rng(seed)
    return cloud(seed=seed).replace(log_scales=rng.uniform(np.log(5e-4), np.log(0.5), (24, 3)))


@given(SEEDS)
@settings(max_examples=8)
def test_values_are_the_twins(seed):
    found, exact = images(small(seed), camera(seed=seed), BACKGROUND, COMPENSATED)
    np.testing.assert_allclose(found.rgb, exact.rgb, atol=1e-5)
    np.testing.assert_allclose(found.alpha, exact.alpha, atol=1e-5)


@pytest.mark.slow
@given(SEEDS)
@settings(max_examples=8)
def test_gradients_are_the_twins(seed):
    found, exact = gradients(small(seed), camera(seed=seed), BACKGROUND, COMPENSATED, seed=seed)
    assert worst(found, exact) < 3e-4


def test_the_light_of_a_small_gaussian_falls_with_its_area():
    # without compensation every gaussian far below a pixel covers the blur's area, however small it is
    view = camera(33, 33, focal=30.0)
    scales = np.array([0.2, 0.02, 0.01, 0.005])  # metres at 2 m: 3 to 0.075 px
    dots = cloud(4).replace(
        means=np.tile([0.0, 0.0, 2.0], (4, 1)), log_scales=np.log(np.repeat(scales[:, None], 3, 1)), opacity_logits=np.zeros(4)
    )
    light = {}
    for antialias in (False, True):
        projected = jit_project(dots, view, settings=dataclasses.replace(SMOOTH, antialias=antialias))
        light[antialias] = np.asarray(projected.opacity / (projected.root[0] * projected.root[2]))
    pixels = view.focal.prod() / 4 * scales**2
    np.testing.assert_allclose(light[True], 0.5 * pixels, rtol=1e-5)
    assert light[False][-1] > 0.5 * 0.3


def test_a_gaussian_without_area_has_finite_gradients_and_the_others_are_unmoved():
    flat = cloud(24)
    flat.log_scales[3] = [-1.0, -80.0, -80.0]  # a segment
    flat.log_scales[4] = -80.0  # a point
    found, exact = gradients(flat, camera(), BACKGROUND, COMPENSATED)
    assert all(np.isfinite(x).all() for x in jax.tree.leaves(found))
    assert worst(found, exact) < 3e-4


def test_it_is_off_unless_asked_for_and_costs_nothing_then():
    assert not RasterSettings().antialias
    gaussians, view = cloud(), camera()
    roots = [
        jit_project.lower(gaussians, view, settings=RasterSettings(antialias=on)).as_text().count("stablehlo.sqrt")
        for on in (False, True)
    ]
    assert roots[1] == roots[0] + 1
