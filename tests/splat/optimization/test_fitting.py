"""Laws of the fit of one room: it gets better, repeats itself byte for byte, and stops at the last good state."""

import dataclasses
import math
import os
import subprocess
import sys

import jax
import numpy as np
import pytest

from tests.splat.rooms import SIZE, look, views_of
from wm.schema import FitSettings, RasterSettings
from wm.splat.optimization.batch import batch_at, to_target, view_at
from wm.splat.optimization.cloud import initial_gaussians
from wm.splat.optimization.curve import curve_steps
from wm.splat.optimization.fitting import FitError, fit, seed_of
from wm.splat.optimization.frozen import visible_columns
from wm.splat.optimization.padding import CULLED_LOGIT, HEADROOM, pad_gaussians
from wm.splat.optimization.step import project_view, rates_at, view_gradient
from wm.splat.rasterizer.tiles import BASE, GROWTH, plan_tiles

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
    assert last.psnr > first.psnr + 0.3 and last.m_mae < first.m_mae and 0 < last.n_ang_deg < 180
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
    traces = view_gradient._cache_size()
    run(settings=dataclasses.replace(SETTINGS, lr_means=1e-3, ssim_weight=0.5, steps=7, lr_final=0.5))
    assert view_gradient._cache_size() == traces


def entries(gaussians, view):
    """How many entries the plan of a view lists."""
    projected = project_view(gaussians, to_target(view, jax.devices()[0]).camera, raster=RASTER)
    ids = plan_tiles(jax.tree.map(np.asarray, projected), view.camera.width, view.camera.height, RASTER).ids
    return int((ids < len(gaussians.opacity_logits)).sum())


@pytest.mark.slow
def test_views_that_list_far_more_than_the_first_compile_few_steps():
    """Capacity grows in steps of x1.5 and never shrinks: what is compiled is bounded by the logarithm of its growth, not by the
    number of views. The gaussians hardly move, so that what a view lists stays as it is."""
    crowd = jax.tree.map(lambda x: np.concatenate([x] * 24), START.replace(log_scales=START.log_scales + 1))
    away = [look([1.9, 0.6 + 0.3 * k, 1.3], [0.0, 0.6 + 0.3 * k, 1.3]) for k in range(6)]
    across = [look([0.5 + 0.3 * k, 1.5, 1.3], [4.0, 1.5, 1.3]) for k in range(4)]
    views = [away[0], *across, *away[1:]]
    few, most = entries(crowd, views[0]), max(entries(crowd, view) for view in views)
    room = HEADROOM * BASE  # what the first view makes room for
    assert few < BASE and most > GROWTH * room
    key = next(key for key in map(jax.random.key, range(100)) if view_at(seed_of(key), 0, len(views)) == 0)
    still = dict.fromkeys(SLOW, 1e-9)
    settings = dataclasses.replace(SETTINGS, steps=2 * len(views), curve_points=0, **still)
    before = view_gradient._cache_size()
    assert run(crowd, views, settings, frozen=None, key=key).stopped is None
    compiled = view_gradient._cache_size() - before
    assert 2 <= compiled <= 1 + math.ceil(math.log(most / room, GROWTH))


def test_a_loss_that_is_not_finite_stops_at_the_last_good_state():
    bad = dataclasses.replace(VIEWS[1], depth=np.full_like(VIEWS[1].depth, np.inf))
    result = run(views=[VIEWS[0], bad, *VIEWS[2:]])
    assert result.stopped is not None and "room 0, step" in result.stopped and "not finite" in result.stopped
    assert all(np.isfinite(leaf).all() for leaf in jax.tree.leaves(result.gaussians))


@pytest.mark.slow
def test_without_depth_weight_no_depth_is_rendered():
    result = run(settings=dataclasses.replace(SETTINGS, depth_weight=0.0, normal_weight=0.0, steps=2), heldout=HELDOUT)
    assert result.history[-1].depth == 0 and np.isfinite(result.history[-1].psnr)
    assert np.isnan(result.history[-1].m_mae) and np.isnan(result.history[-1].n_ang_deg)


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


def test_batches_of_an_epoch_show_every_view_once_and_never_more_views_than_there_are():
    visits = [view for step in range(3) for view in batch_at((1, 2), step, 2, 6)]
    assert sorted(visits) == list(range(6)) and visits == [view_at((1, 2), visit, 6) for visit in range(6)]
    assert sorted(batch_at((1, 2), 5, 9, 4)) == [0, 1, 2, 3]


def test_a_batch_of_equal_views_is_one_view():
    settings = dataclasses.replace(SETTINGS, steps=4)
    twice = run(views=[VIEWS[0]] * 2, settings=dataclasses.replace(settings, batch=2))
    once = run(views=VIEWS[:1], settings=settings)
    for a, b in zip(jax.tree.leaves(twice.gaussians), jax.tree.leaves(once.gaussians), strict=True):
        np.testing.assert_allclose(a, b, atol=2e-5)  # the move is compiled for another number of gradients


def test_who_computes_a_batch_changes_no_byte():
    settings = dataclasses.replace(SETTINGS, steps=4, batch=3)
    alone, shared = (run(settings=settings, devices=jax.devices()[:1] * count) for count in (1, 2))
    assert same_bytes(alone.gaussians, shared.gaussians)
    assert not same_bytes(alone.gaussians, run(settings=dataclasses.replace(settings, batch=1)).gaussians)


@pytest.mark.slow
def test_two_devices_give_the_bytes_of_one():
    code = (
        "import dataclasses, jax; from tests.splat.optimization import test_fitting as t; from wm.splat import SceneRenderer;"
        "settings = dataclasses.replace(t.SETTINGS, steps=4, batch=3); n, found = len(t.START.means), set();"
        "lie = lambda *_: found.update(d for x in jax.live_arrays() if x.shape == (n, 4) for d in x.devices());"
        "second = jax.default_device(jax.devices()[1]); second.__enter__();"
        "other = t.run(settings=settings, progress=lie); found.add(SceneRenderer([t.START], t.RASTER)._device);"
        "second.__exit__(None, None, None);"
        "one, two = (t.run(settings=settings, devices=jax.devices()[:count]) for count in (1, 2));"
        "same = [t.same_bytes(one.gaussians, fit.gaussians) for fit in (two, other)];"
        "print(len(jax.devices()), *same, *(device.id for device in found))"
    )
    env = os.environ | {"JAX_NUM_CPU_DEVICES": "2", "JAX_PLATFORMS": "cpu"}
    found = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, env=env, check=True)
    assert found.stdout.split() == ["2", "True", "True", "1"]  # the last: JAX's default device is where a fit computes


def test_an_error_of_the_callback_is_raised_with_what_was_reached():
    def fail(done, total, info):
        if done == 3:
            raise ZeroDivisionError("a chart without an axis")

    with pytest.raises(FitError, match=r"room 0, step 3: ZeroDivisionError: a chart without an axis") as caught:
        run(progress=fail)
    assert isinstance(caught.value.__cause__, ZeroDivisionError)
    interrupted = caught.value.fit
    assert interrupted.stopped == str(caught.value) and not same_bytes(interrupted.gaussians, START)


def test_an_interrupt_keeps_what_was_reached_which_is_what_an_undisturbed_fit_has_then():
    def interrupt(done, total, info):
        if done == 6:
            raise KeyboardInterrupt

    halfway = run(settings=dataclasses.replace(SETTINGS, lr_final=1.0), progress=interrupt)
    assert halfway.stopped == "room 0, step 6: interrupted"
    assert same_bytes(halfway.gaussians, run(settings=dataclasses.replace(SETTINGS, lr_final=1.0, steps=6)).gaussians)


def test_a_fit_with_refinement_keeps_its_number_and_repeats_itself():
    faint = START.replace(opacity_logits=np.where(np.arange(len(START.means)) % 5, START.opacity_logits, -5).astype(np.float32))
    settings = dataclasses.replace(SETTINGS, refine_every=4, refine_share=0.2)
    once, again, never = (run(faint, settings=s) for s in (settings, settings, dataclasses.replace(settings, refine_every=50)))
    assert same_bytes(once.gaussians, again.gaussians) and len(once.gaussians.means) == len(START.means)
    moved = np.linalg.norm(once.gaussians.means - never.gaussians.means, axis=1)
    assert (moved[::5] > 0.3).mean() > 0.5 and once.stopped is None
