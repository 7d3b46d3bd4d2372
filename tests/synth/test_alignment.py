"""Disagreement knows neither scale nor shift, forgives a shifted silhouette, and finds what is missing, added or moved."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from wm.synth.alignment import align_depth, disagreement

SHAPE = (60, 90)


def room(chair=(30, 20), depth=2.0):
    out = np.repeat(5.0 - 0.01 * np.arange(SHAPE[1])[None], SHAPE[0], axis=0)
    if chair is not None:
        i, j = chair
        out[i : i + 15, j : j + 15] = depth
    return out


def apart(scaffold, estimate, radius=2, tolerance=0.1):
    return disagreement(scaffold, estimate, radius=radius, tolerance=tolerance)


@given(st.floats(0.05, 20), st.floats(-10, 10))
def test_scale_and_shift_are_not_known_and_do_not_matter(scale, shift):
    assert not apart(room(), scale * room() + shift).any()


@given(st.floats(0.05, 20), st.floats(-10, 10), st.sampled_from([lambda z: -z, lambda z: 1 / z, lambda z: -np.log(z)]))
def test_front_and_back_are_not_confused(scale, shift, falling):
    """No scale is negative: of an estimate that falls where the depth rises only the depth's median is left."""
    depth = room().ravel()
    assert align_depth(scale * falling(depth) + shift, depth) == (0.0, np.median(depth))
    assert apart(room(), scale * falling(room()) + shift)[32:43, 22:33].all()  # the chair, but for its silhouette


@given(st.integers(0, 2**32 - 1), st.integers(2, 200))
def test_an_alignment_is_no_worse_than_the_depths_median(seed, count):
    """Whatever the estimate: the least sum of absolute differences is at most that of scale 0."""
    rng = np.random.default_rng(seed)
    estimate, depth = rng.normal(size=count), rng.uniform(1, 5, count)
    scale, shift = align_depth(estimate, depth)
    assert scale >= 0
    differences = np.abs(scale * estimate + shift - depth).sum()
    assert differences <= np.abs(depth - np.median(depth)).sum() + 2e-3 * count * depth.max()  # absolute to a thousandth


@pytest.mark.parametrize("drawn", [None, (30, 60), (5, 20)])
def test_what_is_missing_or_elsewhere_disagrees_and_nothing_else(drawn):
    found = apart(room(), room(drawn))
    changed = np.abs(room(drawn) - room()) > 0.1 * room()
    assert not found[~changed].any()
    assert found[changed].mean() > 0.5  # all but the pixels near the other's silhouette


def test_a_silhouette_may_be_off_by_the_radius():
    assert not apart(room((30, 20)), room((31, 22))).any()
    assert apart(room((30, 20)), room((31, 24))).any()


def test_where_nothing_is_hit_nothing_disagrees_and_where_nothing_is_estimated_all_does():
    scaffold, estimate = room(), room()
    scaffold[:5] = 0
    estimate[-5:] = np.nan
    found = apart(scaffold, estimate)
    assert not found[:-5].any()
    assert found[-5:].all()
    assert (apart(scaffold, np.full(SHAPE, np.nan)) == (scaffold > 0)).all()


def hall():
    """A depth that varies as much as in a room seen along a wall. Without that, far and large look alike."""
    return np.repeat(6.0 - 0.045 * np.arange(SHAPE[1])[None], SHAPE[0], axis=0)


def furnished(*chairs):
    out = hall()
    for i, j in chairs:
        out[i : i + 15, j : j + 15] = np.minimum(out[i : i + 15, j : j + 15], 1.5)
    return out


@given(st.lists(st.tuples(st.integers(0, 45), st.integers(0, 75)), max_size=5), st.floats(0.05, 20), st.floats(-10, 10))
def test_furniture_in_front_of_an_empty_room_is_no_disagreement_where_it_may_be_added(chairs, scale, shift):
    estimate = scale * furnished(*chairs) + shift
    assert not disagreement(hall(), estimate, radius=2, tolerance=0.1, adds=True).any()


@given(
    st.lists(st.tuples(st.integers(0, 45), st.integers(0, 75)), max_size=5),
    st.sampled_from([lambda z: -z, lambda z: 1 / z, lambda z: -np.log(z)]),
)
def test_front_and_back_are_not_confused_where_things_may_be_added_either(chairs, falling):
    found = disagreement(hall(), falling(furnished(*chairs)), radius=0, tolerance=0.01, adds=True)
    assert found.mean() > 0.2


def test_what_lies_behind_the_scaffold_disagrees_where_things_may_be_added():
    gone = hall()
    gone[10:22, 20:36] *= 2  # a piece of wall is open
    found = disagreement(hall(), gone, radius=2, tolerance=0.1, adds=True)
    assert found[13:19, 23:33].all() and found.mean() < 0.06
