"""The plan made in the graph has the lists of the plan made on the host, and says when it has no room."""

import functools

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.splat.rasterizer.test_tiles import lists
from tests.splat.scenes import KINDS, camera, cloud, jit_project, to_float32, troubled
from wm.schema import RasterSettings
from wm.splat import plan_tiles, plan_tiles_on_device, plan_tiles_traced, render
from wm.splat.rasterizer import planner
from wm.splat.rasterizer.tiles_traced import _unrolled

SEEDS = st.integers(0, 10**6)
CONSTANTS = RasterSettings(block=4)


@functools.partial(jax.jit, static_argnums=(1, 2, 3))
def traced(projected, width, height, capacity):
    return plan_tiles_traced(projected, width, height, CONSTANTS, capacity=capacity)


@given(SEEDS, st.lists(st.integers(0, len(KINDS) - 1), max_size=4, unique=True))
@settings(max_examples=15)
def test_the_lists_are_the_hosts(seed, kinds):
    projected = jit_project(troubled(seed, kinds, degree=0), camera(40, 27))
    found = traced(projected, 40, 27, 24 * 20)
    host = plan_tiles(projected, 40, 27, CONSTANTS)
    plan = jax.tree.map(np.asarray, found.plan)
    assert int(host.count.sum()) <= int(plan.count.sum()) <= int(found.needed) <= 24 * 20
    for tile, ids in lists(host, 20).items():
        # logarithm and root are rounded differently on the host: an entry at the very edge, within the slack, may differ
        mine = lists(plan, 20)[tile].tolist()
        assert [i for i in mine if i in ids] == [i for i in ids.tolist() if i in mine] and len(set(mine) ^ set(ids.tolist())) <= 1
    assert (np.diff(plan.count.ravel()[:20]) <= 0).all() and (plan.tile.ravel()[plan.slot] == np.arange(20)).all()


@pytest.mark.parametrize("n", [0, 1])
def test_nothing_to_show(n):
    projected = jit_project(cloud(n).replace(opacity_logits=np.full(n, -50.0)), camera(40, 27))
    found = traced(projected, 40, 27, 8)
    assert int(found.needed) == 0 and (np.asarray(found.plan.ids) == n).all() and not np.asarray(found.plan.count).any()


def test_planned_on_the_device_a_view_is_counted_first():
    projected = jit_project(cloud(40), camera(40, 27))
    wanted = plan_tiles(projected, 40, 27, CONSTANTS)
    plan = plan_tiles_on_device(projected, 40, 27, CONSTANTS, capacity=8)  # too little: it grows
    mine, hosts = lists(jax.tree.map(np.asarray, plan), 20), lists(wanted, 20)
    assert {tile: ids.tolist() for tile, ids in mine.items()} == {tile: ids.tolist() for tile, ids in hosts.items()}
    assert 8 < len(plan.ids) < 40 * 20
    assert len(plan_tiles_on_device(projected, 40, 27, CONSTANTS, capacity=5000).ids) == 5000


def test_more_entries_than_32_bits_count_are_refused_on_the_device():
    everywhere = jax.tree.map(lambda x: jnp.repeat(x[..., :1], 2**13, axis=-1), jit_project(cloud(1, opaque=8.0), camera(8, 8)))
    everywhere = everywhere.replace(extent=jnp.full((2, 2**13), 1e6), opacity=jnp.ones(2**13))
    with pytest.raises(ValueError, match="smaller gaussians"):
        plan_tiles_on_device(everywhere, 8 * 2**9, 8 * 2**9, CONSTANTS)


def test_room_is_counted_even_where_32_bits_are_not_enough():
    which, within, needed = jax.jit(_unrolled, static_argnums=1)(jnp.full(24, 2**27, jnp.int32), 8)
    assert int(needed) == 2**31 - 1  # 3.2e9
    which, within, needed = jax.jit(_unrolled, static_argnums=1)(jnp.array([2, 0, 3], jnp.int32), 8)
    assert which.tolist() == [0, 0, 2, 2, 2, 3, 3, 3] and within[:5].tolist() == [0, 1, 0, 1, 2] and int(needed) == 5


TRACED = RasterSettings(planner="traced")


@given(SEEDS, st.lists(st.integers(0, len(KINDS) - 1), max_size=4, unique=True))
@settings(max_examples=10)
def test_the_image_is_the_same(seed, kinds):
    gaussians, view = to_float32(troubled(seed, kinds)), to_float32(camera())
    plain, found = render(gaussians, view), render(gaussians, view, settings=TRACED)
    for a, b in zip(jax.tree.leaves(plain), jax.tree.leaves(found)):
        np.testing.assert_array_equal(a, b)


def test_a_view_without_room_is_refused(monkeypatch):
    monkeypatch.setattr(planner, "_capacity", lambda *_: 3)
    with pytest.raises(Exception, match=r"room for 3 .* this view has"):
        jax.block_until_ready(jax.jit(lambda g: render(g, camera(22, 13), settings=TRACED).alpha)(to_float32(cloud(degree=3))))
