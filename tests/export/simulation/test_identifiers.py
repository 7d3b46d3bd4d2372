"""Identifiers keep to letters, digits and underscores, and each is there once."""

import re

from hypothesis import given
from hypothesis import strategies as st

from wm.export.simulation.identifiers import identifiers


@given(st.lists(st.text(max_size=6)))
def test_any_names_give_as_many_different_identifiers(names):
    given_names = identifiers(names)
    assert len({name.lower() for name in given_names}) == len(names) == len(given_names)
    assert all(re.fullmatch(r"[A-Za-z_][A-Za-z0-9_]*", name) for name in given_names)


def test_ids_stay_readable():
    assert identifiers(["hall-sofa-1", "hall_sofa_1", "3d print", "床"]) == ["hall_sofa_1", "hall_sofa_1_2", "_3d_print", "_"]
