"""Krippendorff's alpha: his own worked examples, and laws."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from wm.study.agreement import krippendorff_alpha


def units(*raters):
    """What was given to each unit; a dot stands for no answer."""
    return [[value for value in unit if value != "."] for unit in zip(*(rater.split() for rater in raters))]


# Krippendorff, Computing Krippendorff's Alpha-Reliability, 2011: sections A, B and C.
MEG_AND_OWEN = units("0 1 0 0 0 0 0 0 1 0", "1 1 1 0 0 1 0 0 0 0")
BEN_AND_GERRY = units("a a b b d c c c e d d a", "b a b b b c c c e d d d")
FOUR_OBSERVERS = units(
    "1 2 3 3 2 1 4 1 2 . . .",
    "1 2 3 3 2 2 4 1 2 5 . 3",
    ". 3 3 3 2 3 4 2 2 5 1 .",
    "1 2 3 3 2 4 4 1 2 5 1 .",
)


@pytest.mark.parametrize(
    ("data", "level", "published"),
    [
        (MEG_AND_OWEN, "nominal", 0.095),
        (BEN_AND_GERRY, "nominal", 0.692),
        (FOUR_OBSERVERS, "nominal", 0.743),
        (FOUR_OBSERVERS, "ordinal", 0.815),
    ],
)
def test_published_examples(data, level, published):
    assert round(krippendorff_alpha(data, level), 3) == published


ratings = st.lists(st.lists(st.integers(1, 5), max_size=5), max_size=12)
levels = st.sampled_from(["nominal", "ordinal"])


@given(ratings, levels)
def test_it_is_at_most_one_and_undefined_only_where_nothing_varies(data, level):
    found = krippendorff_alpha(data, level)
    values = {value for unit in data if len(unit) > 1 for value in unit}
    assert (found is None) == (len(values) < 2)
    assert found is None or found <= 1 + 1e-12


@given(st.lists(st.tuples(st.integers(1, 5), st.integers(2, 6)), min_size=2, max_size=10), levels)
def test_perfect_agreement_is_one(data, level):
    found = krippendorff_alpha([[value] * raters for value, raters in data], level)
    assert found is None if len({value for value, _ in data}) == 1 else found == pytest.approx(1)


@given(ratings, levels, st.randoms())
def test_neither_the_order_of_raters_nor_that_of_units_matters(data, level, random):
    mixed = [random.sample(unit, len(unit)) for unit in random.sample(data, len(data))]
    assert krippendorff_alpha(mixed, level) == pytest.approx(krippendorff_alpha(data, level), nan_ok=True)


@given(ratings, st.permutations(range(1, 6)))
def test_names_have_no_order(data, names):
    renamed = [[names[value - 1] for value in unit] for unit in data]
    assert krippendorff_alpha(renamed, "nominal") == pytest.approx(krippendorff_alpha(data, "nominal"), nan_ok=True)


@given(ratings)
def test_ranks_may_be_stretched_and_turned_around(data):
    turned = [[-(value**3) for value in unit] for unit in data]
    assert krippendorff_alpha(turned, "ordinal") == pytest.approx(krippendorff_alpha(data, "ordinal"), nan_ok=True)


@pytest.mark.parametrize("level", ["nominal", "ordinal"])
def test_shuffled_answers_agree_by_chance_only(level):
    rng = np.random.default_rng(0)
    found = [krippendorff_alpha(rng.integers(1, 6, size=(40, 5)).tolist(), level) for _ in range(100)]
    assert abs(np.mean(found)) < 0.01 and np.std(found) < 0.06


def test_two_who_always_disagree_are_below_chance():
    assert krippendorff_alpha([[0, 1], [1, 0], [0, 1]], "nominal") < 0
