"""Stiff fits: whatever they are given they end finite, say what is wrong if something is, and keep the last good state."""

import dataclasses

import jax
import numpy as np
import pytest

from tests.splat.rooms import views_of
from wm.schema import FitSettings, RasterSettings
from wm.splat.optimization.cloud import initial_gaussians
from wm.splat.optimization.fitting import fit

SETTINGS = FitSettings(spacing=0.5, detail_spacing=0.5, steps=24, curve_points=0)
VIEWS = views_of(width=24, height=16)
START = initial_gaussians(VIEWS, settings=SETTINGS, rng=np.random.default_rng(0))
RATES = [field.name for field in dataclasses.fields(FitSettings) if field.name.startswith("lr_") and field.name != "lr_final"]


def rates_times(factor, **changes):
    rates = {name: factor * getattr(SETTINGS, name) for name in RATES}
    return dataclasses.replace(SETTINGS, **rates | changes)


def changed(view, **arrays):
    return dataclasses.replace(view, **arrays)


def run(views=VIEWS, settings=SETTINGS, start=START):
    """Every fit here has the same shapes, so a step is compiled once."""
    result = fit(start, views, settings=settings, raster=RasterSettings(chunk=1, block=16), key=jax.random.key(0))
    assert all(np.isfinite(leaf).all() for leaf in jax.tree.leaves(result.gaussians))
    return result


def mean_loss(gaussians, views=VIEWS, settings=SETTINGS):
    """Over all views: a fit that moves nothing shows every view once."""
    still = dataclasses.replace(settings, steps=len(views), curve_points=1, **dict.fromkeys(RATES, 0.0))
    return run(views, still, gaussians).history[-1].loss


def same_bytes(a, b):
    return all(x.tobytes() == y.tobytes() for x, y in zip(jax.tree.leaves(a), jax.tree.leaves(b), strict=True))


JUMPS = [changed(view, rgb=np.clip(view.rgb * gain, 0, 255).astype(np.uint8)) for view, gain in zip(VIEWS, (0.6, 1.4, 0.8, 1.2))]
QUARREL = [VIEWS[0], changed(VIEWS[0], depth=1.5 * VIEWS[0].depth), *VIEWS[1:]]
DARK = [changed(view, mask=np.zeros_like(view.mask)) for view in VIEWS]


@pytest.mark.parametrize(
    ("views", "settings"),
    [
        (VIEWS, dataclasses.replace(SETTINGS, depth_weight=100.0)),
        ([VIEWS[0]] * 4, SETTINGS),
        (VIEWS[:1], SETTINGS),
        (JUMPS, SETTINGS),
        (QUARREL, SETTINGS),
        ([DARK[0], *VIEWS[1:]], SETTINGS),
    ],
    ids=["depth weight 100", "identical views", "one view", "exposure jumps", "contradictory depth", "an empty mask"],
)
def test_a_stiff_fit_gets_better_all_the_same(views, settings):
    result = run(views, settings)
    assert result.stopped is None
    assert mean_loss(result.gaussians, views, settings) < 0.9 * mean_loss(START, views, settings)


def test_rates_ten_times_too_high_do_no_harm_that_is_not_told():
    result = run(settings=rates_times(10))
    assert result.stopped is None or "diverges" in result.stopped
    assert mean_loss(result.gaussians) < 3 * mean_loss(START)


def test_rates_a_thousand_times_too_high_diverge_and_end_where_the_fit_began():
    result = run(settings=rates_times(1000, lr_final=1.0))
    assert result.stopped is not None and "diverges" in result.stopped and "learning rates" in result.stopped
    assert "room 0, step " in result.stopped and ", view " in result.stopped and result.stopped.endswith("the state of step 0")
    assert same_bytes(result.gaussians, jax.tree.map(np.asarray, START))


def test_a_fit_that_diverges_late_ends_at_its_best_pass():
    rates = ("lr_means", "lr_quats", "lr_scales", "lr_opacities", "lr_sh")
    slow = {name: 0.1 * getattr(SETTINGS, name) for name in rates}  # at first, so that it gets better before it gets worse
    result = run(settings=dataclasses.replace(SETTINGS, **slow, lr_final=1e4))
    assert result.stopped is not None and "diverges" in result.stopped
    assert int(result.stopped.split()[-1]) in range(4, 24, 4)
    assert mean_loss(result.gaussians) < mean_loss(START)


def test_the_curve_of_a_fit_that_went_back_ends_where_it_went_back_to():
    result = run(settings=rates_times(1000, lr_final=1.0, curve_points=SETTINGS.steps + 1))
    assert result.stopped is not None and int(result.stopped.split()[-1]) == 0
    assert [point.step for point in result.history] == [0]


@pytest.mark.parametrize("value", [np.nan, np.inf])
def test_depth_that_is_not_finite_is_named_with_its_view(value):
    depth = VIEWS[2].depth.copy()
    depth[3, 4:7] = value
    result = run([*VIEWS[:2], changed(VIEWS[2], depth=depth), VIEWS[3]])
    assert result.stopped is not None and "view 2 of 4" in result.stopped and "not finite" in result.stopped
    assert "depth is not finite at 3 of its 384" in result.stopped


def test_depth_that_is_not_finite_has_no_say_behind_the_mask():
    mask = np.ones_like(VIEWS[0].mask)
    mask[:, :5] = False
    holes = [changed(VIEWS[0], depth=np.where(mask, VIEWS[0].depth, value), mask=mask) for value in (0.0, np.nan)]
    empty, unknown = (run([hole, *VIEWS[1:]]) for hole in holes)
    assert unknown.stopped is None and same_bytes(empty.gaussians, unknown.gaussians)


def test_views_without_usable_pixels_move_nothing():
    assert same_bytes(run(DARK).gaussians, jax.tree.map(np.asarray, START))


def test_gaussians_that_are_not_finite_are_refused():
    means = START.means.copy()
    means[[5, 7], 1] = np.nan
    with pytest.raises(ValueError, match=r"2 of \d+ gaussians to start from are not finite, the first at 5"):
        run(start=START.replace(means=means))
