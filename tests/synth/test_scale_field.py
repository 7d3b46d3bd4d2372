"""A smooth drift of scale is found and divided out; a thing is none of it, and the field stays within its bound."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from wm.synth.scale_field import REACH, scale_field

SHAPE = (54, 96)
ALL = np.ones(SHAPE, bool)


def coordinates():
    return np.meshgrid(np.linspace(-1, 1, SHAPE[1]), np.linspace(-1, 1, SHAPE[0]))


def drift(seed, degree, reach):
    """The exponential of a random polynomial whose largest absolute value is `reach`."""
    x, y = coordinates()
    rng = np.random.default_rng(seed)
    terms = [rng.normal() * x**a * y**b for a in range(degree + 1) for b in range(degree + 1 - a)]
    logs = sum(terms, np.zeros(SHAPE))
    return np.exp(reach * logs / np.abs(logs).max())


def room():
    x, y = coordinates()
    return 4 + x + 0.5 * y


@given(st.integers(0, 2**32 - 1), st.integers(1, 5), st.floats(0, REACH))
def test_a_drift_of_its_degree_is_found(seed, degree, reach):
    true = drift(seed, degree, reach)
    np.testing.assert_allclose(scale_field(room() * true, room(), ALL, degree=degree), true, rtol=1e-6)


@given(st.integers(0, 2**32 - 1), st.integers(16, 64), st.integers(9, 31), st.floats(0.3, 3))
def test_a_thing_away_from_the_borders_hardly_bends_the_field(seed, left, top, factor):
    true = drift(seed, 4, 0.15)
    wrong = room() * true
    wrong[top : top + 14, left : left + 16] *= factor
    field = scale_field(wrong, room(), ALL, degree=4)
    assert np.abs(field / true - 1).max() < 0.1
    assert np.median(np.abs(field / true - 1)) < 0.01


@given(st.integers(0, 2**32 - 1), st.integers(0, 8))
def test_whatever_the_estimate_the_field_is_bounded(seed, degree):
    wild = np.random.default_rng(seed).lognormal(0, 2, SHAPE)
    assert (np.abs(np.log(scale_field(wild, room(), ALL, degree=degree))) <= REACH + 1e-12).all()


@pytest.mark.parametrize("known", [0, 1, 14])
def test_too_few_pixels_give_no_field(known):
    valid = np.zeros(SHAPE, bool)
    valid.ravel()[:known] = True
    np.testing.assert_array_equal(scale_field(2 * room(), room(), valid, degree=4), 1)


def test_what_is_not_valid_is_not_followed():
    valid = coordinates()[0] < 0.5
    wrong = np.where(valid, room(), 30.0)
    np.testing.assert_allclose(scale_field(wrong, room(), valid, degree=2), 1, rtol=1e-6)
    np.testing.assert_array_equal(scale_field(1.1 * room(), room(), ALL, degree=0), 1)
