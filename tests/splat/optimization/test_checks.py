"""Bad arguments of a fit are named: where, what, and what would be right."""

import inspect

import jax
import numpy as np
import pytest

from tests.splat.rooms import views_of
from tests.splat.scenes import cloud
from wm.schema import FitSettings, RasterSettings
from wm.splat import fit, fit_scene, initial_gaussians
from wm.splat.optimization.fitting import seed_of


def with_value(settings, name, value):
    """Settings with a value that the annotations of the tests' constructor might refuse."""
    object.__setattr__(settings, name, value)
    return settings


@pytest.mark.parametrize(
    "name, value",
    [
        *((name, value) for name in ("batch", "rounds") for value in (0, 1.0)),
        *((name, -1) for name in ("steps", "refine_every", "curve_points", "sh_degree")),
        *(("opacity", value) for value in (0.0, 1.0, np.nan)),
        *((name, np.nan) for name in ("spacing", "ssim_weight", "depth_weight", "normal_weight", "lr_means", "lr_final")),
        *((name, 1.5) for name in ("ssim_weight", "refine_share", "refine_dead")),
        *((name, 0.0) for name in ("spacing", "detail_spacing", "lr_final")),
    ],
)
def test_numbers_of_a_fit_without_meaning_are_named(name, value):
    settings = with_value(FitSettings(), name, value)
    calls = (
        lambda: fit(cloud(4), [], settings=settings, key=jax.random.key(0)),
        lambda: fit_scene([cloud(4)], lambda room: [], settings=settings, key=jax.random.key(0)),
        lambda: initial_gaussians([], settings=settings, rng=np.random.default_rng(0)),
    )
    for call in calls:
        with pytest.raises(ValueError, match=rf"fit\.{name} is {value!r}; an? (number|integer) in [\[(]"):
            call()


def test_arguments_of_a_fit_are_named():
    views, settings, key = views_of(count=1), FitSettings(), jax.random.key(0)
    short, whole, raster = cloud(4).replace(quats=np.ones((3, 4))), cloud(4), RasterSettings(near=-1.0)
    with pytest.raises(ValueError, match=r"settings\.near is -1\.0"):
        fit(whole, views, settings=settings, raster=raster, key=key)
    with pytest.raises(ValueError, match=r"settings\.near is -1\.0"):
        fit_scene([whole], lambda room: views, settings=settings, raster=raster, key=key)
    with pytest.raises(ValueError, match=r"leaves of gaussians have different lengths .*'quats': 3"):
        fit(short, views, settings=settings, key=key)
    with pytest.raises(ValueError, match=r"leaves of frozen have different lengths"):
        fit(whole, views, settings=settings, key=key, frozen=short)
    with pytest.raises(ValueError, match=r"leaves of gaussians\[1\] have different lengths"):
        fit_scene([whole, short], lambda room: views, settings=settings, key=key)
    with pytest.raises(TypeError, match=r"the key is a int; a JAX key"):
        inspect.unwrap(seed_of)(0)  # as users have it, without the checks of the annotations that tests add
