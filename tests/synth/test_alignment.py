"""Disagreement knows neither scale nor shift, forgives a shifted silhouette, and finds what is missing, added or moved."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from wm.synth.alignment import disagreement

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
