"""Intervals cover what they promise, by closed forms, exact sums and simulation."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.stats import binom

from wm.study.intervals import CONFIDENCE, bootstrapped_mean, exact_share


def test_the_share_of_all_has_the_closed_form():
    for number in (1, 6, 31):
        found = exact_share(number, number, number)
        assert found.high == 1 and found.low == pytest.approx(0.025 ** (1 / number), rel=1e-9)


def test_the_papers_30_of_31_are_its_96_8_percent():
    found = exact_share(30, 31, 31)
    assert round(100 * found.value, 1) == 96.8
    # P(X >= 30 | low) and P(X <= 30 | high) are each 2.5 %
    assert binom.sf(29, 31, found.low) == pytest.approx(0.025, rel=1e-6)
    assert binom.cdf(30, 31, found.high) == pytest.approx(0.025, rel=1e-6)


@given(st.integers(1, 40), st.floats(0.01, 0.99))
def test_exact_intervals_cover_at_least_what_they_promise(number, share):
    intervals = [exact_share(hits, number, number) for hits in range(number + 1)]
    covered = sum(binom.pmf(hits, number, share) for hits, found in enumerate(intervals) if found.low <= share <= found.high)
    assert covered >= CONFIDENCE - 1e-9


@given(st.integers(1, 60), st.data())
def test_preferring_the_other_mirrors_the_interval(number, data):
    hits = data.draw(st.integers(0, number))
    one, other = exact_share(hits, number, number), exact_share(number - hits, number, number)
    assert (one.low, one.high) == pytest.approx((1 - other.high, 1 - other.low), abs=1e-9)


answers = st.lists(st.tuples(st.integers(0, 8), st.integers(1, 5).map(float)), min_size=1, max_size=40)


@given(answers, st.randoms())
def test_the_order_of_answers_does_not_matter_and_the_mean_is_inside(given_answers, random):
    found = bootstrapped_mean(given_answers, seed=3, resamples=200)
    mixed = given_answers[:]
    random.shuffle(mixed)
    assert repr(bootstrapped_mean(mixed, seed=3, resamples=200)) == repr(found)
    assert found.value == pytest.approx(np.mean([value for _, value in given_answers]))
    assert (found.answers, found.participants) == (len(given_answers), len({who for who, _ in given_answers}))
    if found.participants > 1:
        assert min(v for _, v in given_answers) <= found.low <= found.high <= max(v for _, v in given_answers)


@given(answers, st.integers(-3, 3))
def test_the_interval_moves_with_the_answers(given_answers, shift):
    one = bootstrapped_mean(given_answers, seed=0, resamples=100)
    moved = bootstrapped_mean([(who, value + shift) for who, value in given_answers], seed=0, resamples=100)
    if one.participants > 1:
        # participants are sorted by their sums, which a shift may order anew: the same interval up to the resampling's noise
        assert moved.value == pytest.approx(one.value + shift)
        assert moved.high - moved.low <= 5


def test_nothing_and_one_participant_have_no_interval():
    assert math.isnan(bootstrapped_mean([], seed=0).value) and math.isnan(exact_share(0, 0, 0).value)
    one = bootstrapped_mean([("a", 3.0), ("a", 5.0)], seed=0)
    assert one.value == 4 and math.isnan(one.low) and math.isnan(one.high)


def test_answers_that_are_all_the_same_have_an_interval_of_no_width():
    found = bootstrapped_mean([(who, 4.0) for who in range(5)], seed=0, resamples=100)
    assert (found.low, found.value, found.high) == (4, 4, 4)


def test_bootstrap_intervals_cover_the_mean_of_participants_who_differ():
    """Each participant has a level of their own, and 1 to 4 answers around it. Of 400 studies of 31 participants the
    promised 95 % are covered to within 4 deviations of 400 draws (1.1 % each), below and above."""
    rng, covered, studies = np.random.default_rng(0), 0, 400
    for _ in range(studies):
        given_answers = [
            (who, float(v)) for who in range(31) for v in rng.normal(3 + rng.normal(0, 0.8), 0.6, size=rng.integers(1, 5))
        ]
        found = bootstrapped_mean(given_answers, seed=1, resamples=400)
        covered += found.low <= 3 <= found.high
    assert 0.906 <= covered / studies <= 0.994


def test_answers_of_one_participant_are_not_taken_as_independent():
    """Ten equal answers of each of eight participants say no more than one of each."""
    levels = [1.0, 2.0, 2.0, 3.0, 3.0, 4.0, 4.0, 5.0]
    once = bootstrapped_mean(list(enumerate(levels)), seed=0)
    often = bootstrapped_mean([(who, level) for who, level in enumerate(levels) for _ in range(10)], seed=0)
    assert (once.low, once.high) == pytest.approx((often.low, often.high))
