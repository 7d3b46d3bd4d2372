"""Laws of the plan: nothing that counts is left out, order, capacity, any image size."""

import jax
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.splat.scenes import camera, cloud, jit_project
from wm.schema import RasterSettings
from wm.splat import plan_tiles


def lists(plan, tiles):
    """Entries of each tile, from the plan."""
    found = {}
    for tile, start, count in zip(plan.tile.ravel(), plan.start.ravel(), plan.count.ravel()):
        if count or tile not in found:
            found[int(tile)] = plan.ids[start : start + count]
    assert sorted(found) == list(range(tiles))
    return found


@given(st.integers(0, 10**6), st.sampled_from([(40, 24), (1, 1), (17, 30)]))
@settings(max_examples=12, deadline=None)
def test_every_pixel_that_counts_is_listed_and_in_order(seed, size):
    width, height = size
    view = camera(width, height, seed=seed)
    projected = jax.tree.map(lambda x: np.asarray(x, np.float64), jit_project(cloud(30, seed=seed), view))
    constants = RasterSettings(block=4)
    columns, rows = -(-width // 8), -(-height // 8)
    listed = lists(plan_tiles(projected, width, height, constants), columns * rows)
    l0, l1, l2 = projected.root
    for tile, ids in listed.items():
        x = np.arange(tile % columns * 8, min((tile % columns + 1) * 8, width)) + 0.5
        y = np.arange(tile // columns * 8, min((tile // columns + 1) * 8, height)) + 0.5
        dx, dy = x[None, :, None] - projected.mean2d[0], y[:, None, None] - projected.mean2d[1]
        alpha = projected.opacity * np.exp(-0.5 * ((l0 * dx + l1 * dy) ** 2 + (l2 * dy) ** 2))
        assert set(np.flatnonzero((alpha >= 1 / 255).any((0, 1)))) <= set(ids.tolist())
        depth = projected.depth[ids]
        assert (np.diff(depth) >= 0).all()


def test_equal_depths_go_by_index():
    gaussians = cloud(50)
    gaussians = gaussians.replace(means=gaussians.means * [1, 1, 0] + [0, 0, 2.0])
    plan = plan_tiles(jit_project(gaussians, camera()), 21, 13)
    for ids in lists(plan, 6).values():
        assert (np.diff(ids) > 0).all()


def test_more_tiles_than_a_16_bit_key_holds():
    width, height, constants = 300, 260, RasterSettings(tile=1)
    view = camera(width, height, focal=200.0)
    pixels = np.array([[10, 3], [290, 100], [150, 218], [20, 257]]) + 0.5
    rays = np.concatenate([(pixels - view.principal) / view.focal, np.ones((4, 1))], 1)
    gaussians = cloud(4).replace(means=rays * 2, log_scales=np.full((4, 3), -7.0), opacity_logits=np.full(4, 2.0))
    plan = plan_tiles(jit_project(gaussians, view), width, height, constants)
    listed = np.flatnonzero(plan.count.ravel())
    for tile, start, count in zip(*(x.ravel()[listed] for x in (plan.tile, plan.start, plan.count))):
        centre = pixels[plan.ids[start : start + count]]
        assert np.abs(centre - [tile % width + 0.5, tile // width + 0.5]).max() < 3
    assert set(plan.ids[plan.ids < 4]) == set(range(4)) and plan.slot.shape == (78000,)


def test_capacity_grows_in_steps_and_never_truncates():
    projected = jit_project(cloud(60), camera(64, 48))
    entries = int(plan_tiles(projected, 64, 48).count.sum())
    sizes = {len(plan_tiles(projected, 64, 48, capacity=c).ids) for c in (1, 2, 10, entries, entries * 3)}
    assert min(sizes) >= entries and len(sizes) <= 5
    assert len(plan_tiles(projected, 64, 48, capacity=entries * 3).ids) == entries * 3
    for capacity in (1, entries, None):
        plan = plan_tiles(projected, 64, 48, capacity=capacity)
        assert plan.count.sum() == entries and (plan.ids[entries:] == 60).all()


@pytest.mark.parametrize("n", [0, 5])
def test_nothing_to_show(n):
    gaussians = cloud(n).replace(opacity_logits=np.full(n, -50.0))
    plan = plan_tiles(jit_project(gaussians, camera()), 21, 13)
    assert plan.count.sum() == 0 and len(plan.ids) > 0
