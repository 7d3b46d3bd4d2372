"""What labels name: by whole words, with or without synonyms, and also where nobody has heard of the word."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from wm.synth.lifting.vocabulary import LARGEST, SYNONYMS, UNKNOWN, largest_size, sort_of

NAMES = st.sampled_from([*LARGEST, *SYNONYMS, "zebra", "gizmo"])


def test_every_name_names_itself_and_every_synonym_a_sort():
    assert all(sort_of(sort) == sort for sort in LARGEST)
    assert all(sort_of(word) == sort and sort in LARGEST for word, sort in SYNONYMS.items())
    assert all(min(size) > 0 for size in (*LARGEST.values(), UNKNOWN))


@pytest.mark.parametrize(
    ("label", "sort"),
    [("leather sofa", "sofa"), ("TV stand", "media bench"), ("brass floor lamp", "floor lamp"), ("sofabed", "sofabed"),
     ("Stack of Books", "pile of books"), ("a painting of flowers", "picture"), ("striped zebras", "zebra"), ("座椅", "座椅"),
     (" ", "")],
)  # fmt: skip
def test_labels_are_read_by_whole_words(label, sort):
    assert sort_of(label) == sort


@given(st.text(max_size=40))
def test_any_text_is_a_label(label):
    size = largest_size(label)
    assert size.shape == (3,) and (size > 0).all()
    assert (tuple(size.tolist()) == UNKNOWN) == (sort_of(label) not in LARGEST)


@given(NAMES, st.sampled_from(["old", "leather", "two", "very large"]))
def test_words_that_describe_change_nothing(name, description):
    assert sort_of(f"{description} {name}") == sort_of(name)
    assert (largest_size(f"{description} {name}") == largest_size(name)).all()
