"""A failed image is used where its depth fits the scaffold and away from the edges it misses."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from wm.schema import VerifySettings
from wm.synth.agreement import agreement
from wm.synth.alignment import align_depth
from wm.synth.canny import depth_edges
from wm.synth.verify import verify

SETTINGS = VerifySettings()
SHAPE = (48, 80)
HIT = np.ones(SHAPE, bool)


def room(chair=True):
    depth = 5.0 - 0.02 * np.arange(SHAPE[1]) + np.zeros(SHAPE)
    depth[:, 50:] -= 1.5
    if chair:
        depth[25:40, 10:25] = 2.0
    return depth


def edges(depth):
    return depth_edges(depth, HIT, low=SETTINGS.low, high=SETTINGS.high)


def test_only_the_wrong_part_is_masked():
    scaffold, drawn = room(), room(chair=False)
    mask = agreement(scaffold, HIT, edges(scaffold), 0.2 * drawn + 3, SETTINGS)
    assert not mask[25:40, 10:25].any()
    assert not mask[24, 10:25].any()  # nor beside an edge that is missing
    assert mask[:20].all()
    assert mask[:, 30:].all()
    assert mask.mean() > 0.8


def test_a_true_image_agrees_everywhere():
    scaffold = room()
    assert agreement(scaffold, HIT, edges(scaffold), scaffold * 7 - 2, SETTINGS).all()


def test_without_an_estimate_nothing_agrees():
    scaffold = room()
    assert not agreement(scaffold, HIT, edges(scaffold), None, SETTINGS).any()
    assert not agreement(scaffold, HIT, edges(scaffold), np.full(SHAPE, np.nan), SETTINGS).any()
    assert not agreement(scaffold, ~HIT, edges(scaffold), scaffold, SETTINGS).any()


def test_pixels_without_an_estimate_do_not_agree():
    scaffold = room()
    estimate = scaffold.copy()
    estimate[:5] = np.nan
    mask = agreement(scaffold, HIT, edges(scaffold), estimate, SETTINGS)
    assert not mask[:5].any()
    assert mask[12:].all()


def test_a_flat_image_agrees_only_where_the_scaffold_is_as_deep():
    scaffold = room()
    mask = agreement(scaffold, HIT, edges(scaffold), np.ones(SHAPE), SETTINGS)
    assert 0 < mask.mean() < 0.7
    assert not verify(edges(scaffold), np.ones(SHAPE), SETTINGS).passed


@given(st.integers(0, 2**32 - 1), st.floats(0.05, 20), st.floats(-10, 10))
def test_alignment_sees_past_outliers(seed, scale, shift):
    rng = np.random.default_rng(seed)
    depth = rng.uniform(1, 6, 400)
    estimate = (depth - shift) / scale
    estimate[:80] = (rng.uniform(1, 6, 80) - shift) / scale
    found = align_depth(estimate, depth)
    assert found == pytest.approx((scale, shift), rel=0.02, abs=0.05)
