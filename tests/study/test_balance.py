"""Laws of the balanced design: equal showings after any number of participants, nothing twice in one hand."""

import random
from collections import Counter
from itertools import accumulate, pairwise

import pytest
from hypothesis import given
from hypothesis import strategies as st

from wm.study.balance import Deck, Sides, dealt


@st.composite
def designs(draw):
    strata, size = draw(st.integers(1, 6)), draw(st.integers(1, 5))
    items = [[(stratum, number) for number in range(size)] for stratum in range(strata)]
    return items, draw(st.integers(0, strata * size)), draw(st.integers(1, 40)), random.Random(draw(st.integers(0, 10**6)))


def spread(counts, things):
    numbers = [counts[thing] for thing in things]
    return max(numbers) - min(numbers)


@given(designs())
def test_after_any_number_of_participants_all_items_and_all_strata_were_seen_equally(design):
    strata, each, hands, rng = design
    items = [item for stratum in strata for item in stratum]
    for seen in accumulate(map(Counter, dealt(strata, each, hands, rng))):
        by_stratum = Counter()
        for (stratum, _), number in seen.items():
            by_stratum[stratum] += number
        assert spread(seen, items) <= 1
        assert spread(by_stratum, range(len(strata))) <= 1


@given(designs())
def test_a_participant_sees_nothing_twice_and_each_stratum_equally(design):
    strata, each, hands, rng = design
    for hand in dealt(strata, each, hands, rng):
        assert len(set(hand)) == len(hand) == each
        assert spread(Counter(stratum for stratum, _ in hand), range(len(strata))) <= 1


@given(designs())
def test_a_participant_who_sees_everything_sees_it_once(design):
    strata, _, hands, rng = design
    items = sorted(item for stratum in strata for item in stratum)
    assert all(sorted(hand) == items for hand in dealt(strata, len(items), hands, rng))


def test_a_deck_has_no_more_different_cards_than_it_has():
    with pytest.raises(ValueError, match="3 different cards of 2"):
        Deck([1, 2], random.Random(0)).take(3)


@given(designs())
def test_sides_change_from_showing_to_showing_and_are_equal_over_a_whole_deck(design):
    strata, _, rounds, rng = design
    sides = Sides(strata, rng)
    shown = {item: [] for stratum in strata for item in stratum}
    for _ in range(rounds):
        for stratum in strata:
            lefts = [sides.next_left(item) for item in stratum]
            assert abs(2 * sum(lefts) - len(stratum)) <= 1
            for item, left in zip(stratum, lefts):
                shown[item].append(left)
    assert all(a != b for one in shown.values() for a, b in pairwise(one))


def test_over_seeds_no_side_is_favoured():
    lefts = [Sides([["a", "b", "c"]], random.Random(seed)).next_left("a") for seed in range(400)]
    assert 150 < sum(lefts) < 250  # 200 +- 5 standard deviations
