"""Laws of the fit of one room: it gets better, repeats itself byte for byte, and stops at the last good state."""

import dataclasses

import jax
import numpy as np
import pytest

from tests.splat.rooms import SIZE, views_of
from wm.schema import FitSettings, RasterSettings
from wm.splat.cloud import initial_gaussians
from wm.splat.fit import fit
from wm.splat.frozen import visible_columns
from wm.splat.room_fit import CULLED_LOGIT, curve_steps, pad_gaussians, to_target, view_at
from wm.splat.step import project_view, rates_at, train_step

SLOW = {"lr_means": 2e-3, "lr_quats": 1e-3, "lr_scales": 5e-3, "lr_opacities": 5e-2, "lr_sh": 3e-2}
"""Rates for a dozen steps of a coarse cloud: the defaults are for many steps of a fine one."""
SETTINGS = FitSettings(spacing=0.4, detail_spacing=0.4, steps=12, curve_points=2, depth_weight=0.7, **SLOW)
RASTER = RasterSettings(chunk=1, block=16)
VIEWS, HELDOUT = views_of(), views_of(count=1, turn=0.6)
WHOLE = initial_gaussians(VIEWS, settings=SETTINGS, rng=np.random.default_rng(0))
FAR = WHOLE.means[:, 0] > SIZE[0] / 2
START, OTHER = jax.tree.map(lambda x: x[FAR], WHOLE), jax.tree.map(lambda x: x[~FAR], WHOLE)
KEY = jax.random.key(3)


def same_bytes(a, b):
    return all(x.tobytes() == y.tobytes() for x, y in zip(jax.tree.leaves(a), jax.tree.leaves(b), strict=True))


def run(start=START, views=VIEWS, settings=SETTINGS, **kwargs):
    """Half a room, beside its other half; every fit here has the same shapes, so the step is compiled once."""
    return fit(start, views, settings=settings, raster=RASTER, **{"key": KEY, "frozen": OTHER} | kwargs)


def test_a_fit_lowers_loss_and_held_out_error_and_says_when():
    seen = []
    before = jax.tree.map(np.copy, START)
    result = run(heldout=HELDOUT, progress=lambda done, total, info: seen.append((done, total, info["loss"])))
    first, last = result.history
    assert (first.step, last.step) == (0, 12) and result.stopped is None
    assert last.psnr > first.psnr + 0.3 and last.m_mae < first.m_mae
    assert np.mean([loss for *_, loss in seen[-4:]]) < np.mean([loss for *_, loss in seen[:4]])
    assert [done for done, *_ in seen] == list(range(1, 13)) and {total for _, total, _ in seen} == {12}
    assert last.seconds >= first.seconds >= 0
    assert same_bytes(before, START)  # what it was given is not changed


def test_the_key_decides_every_byte():
    assert same_bytes(run().gaussians, run().gaussians)
    assert not same_bytes(run().gaussians, run(key=jax.random.key(4)).gaussians)
    assert same_bytes(run(key=jax.random.PRNGKey(3)).gaussians, run().gaussians)


def test_steps_of_one_shape_are_compiled_once():
    run()
    traces = train_step._cache_size()
    run(settings=dataclasses.replace(SETTINGS, lr_means=1e-3, ssim_weight=0.5, steps=7, lr_final=0.5))
    assert train_step._cache_size() == traces


def test_a_loss_that_is_not_finite_stops_at_the_last_good_state():
    bad = dataclasses.replace(VIEWS[1], depth=np.full_like(VIEWS[1].depth, np.inf))
    result = run(views=[VIEWS[0], bad, *VIEWS[2:]])
    assert result.stopped is not None and "room 0, step" in result.stopped and "not finite" in result.stopped
    assert all(np.isfinite(leaf).all() for leaf in jax.tree.leaves(result.gaussians))


@pytest.mark.slow
def test_without_depth_weight_no_depth_is_rendered():
    result = run(settings=dataclasses.replace(SETTINGS, depth_weight=0.0, normal_weight=0.0, steps=2), heldout=HELDOUT)
    assert result.history[-1].depth == 0 and np.isnan(result.history[-1].m_mae) and np.isfinite(result.history[-1].psnr)


def test_frozen_gaussians_are_seen_and_not_moved():
    before = jax.tree.map(np.copy, OTHER)
    settings = dataclasses.replace(SETTINGS, steps=1)
    beside, beside_wrong = run(settings=settings), run(settings=settings, frozen=OTHER.replace(sh=-OTHER.sh))
    assert beside_wrong.history[-1].l1 > 1.3 * beside.history[-1].l1
    assert len(beside.gaussians.means) == len(START.means) and same_bytes(before, OTHER)


def test_padding_is_culled_by_every_view():
    n = len(START.means)
    padded = pad_gaussians(START, n + 37)
    assert same_bytes(jax.tree.map(lambda x: x[:n], padded), START) and (padded.opacity_logits[n:] == CULLED_LOGIT).all()
    for view in VIEWS:
        projected = project_view(padded, to_target(view, jax.devices()[0]).camera, raster=RASTER)
        assert not np.asarray(projected.opacity)[n:].any() and not np.asarray(projected.extent)[:, n:].any()


def test_frozen_gaussians_behind_the_scaffold_are_left_out():
    view, small = VIEWS[0], WHOLE.replace(log_scales=WHOLE.log_scales - 2)
    camera = to_target(view, jax.devices()[0]).camera
    projected = jax.tree.map(np.asarray, project_view(small, camera, raster=RASTER))
    shown = visible_columns(projected, view.depth)
    inside = (projected.extent > 0).all(0) & (np.abs(projected.mean2d - [[20], [12]]) < [[20], [12]]).all(0)
    assert shown.opacity.shape[0] >= inside.sum() > 0  # everything in the image is on the scaffold
    coarse = visible_columns(projected, view.depth[::2, ::2], view.depth.shape)
    assert abs(coarse.opacity.shape[0] - shown.opacity.shape[0]) <= 0.02 * shown.opacity.shape[0]
    assert visible_columns(projected, 0.2 * view.depth).opacity.shape[0] < 0.3 * inside.sum()
    assert visible_columns(projected, 0 * view.depth).opacity.shape == shown.opacity.shape


def test_every_epoch_shows_every_view_once():
    order = [view_at((1, 2), step, 5) for step in range(15)]
    assert [sorted(order[i : i + 5]) for i in (0, 5, 10)] == [[0, 1, 2, 3, 4]] * 3
    assert order[:5] != order[5:10] or order[5:10] != order[10:]
    assert order == [view_at((1, 2), step, 5) for step in range(15)]


def test_rates_fall_to_their_share_and_the_curve_spans_the_fit():
    settings = FitSettings(steps=100, lr_final=0.1, curve_points=4)
    first, last = rates_at(settings, 0, 100), rates_at(settings, 99, 100)
    np.testing.assert_allclose(last.learning.means / first.learning.means, 0.1)
    assert first.learning.sh == settings.lr_sh
    marks = curve_steps(settings)
    assert marks[0] == 0 and marks[-1] == 100 and len(marks) == 4
    assert curve_steps(dataclasses.replace(settings, curve_points=0)) == []


def test_no_views_is_an_error():
    with pytest.raises(ValueError, match="at least one view"):
        run(views=[])
