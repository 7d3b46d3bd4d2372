"""A room is furnished as what it was planned as, whatever words its name is made of."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from wm.offline.arrangement.programmes import PROGRAMME
from wm.offline.arrangement.room_type import ROOM_TYPES, room_type
from wm.offline.language.programme import CIRCULATION, PRIVATE, SERVICE, WET, room_kind_of
from wm.synth.room_names import CONNECTING, PHRASES, SORTS, WORDS, room_sort

KNOWN = sorted({word for words in WORDS.values() for word in words.split()} | set(PHRASES))
NAMES = st.lists(st.sampled_from([*KNOWN, "room", "master", "the", "II"]), min_size=1, max_size=4).map(" ".join)


@given(NAMES)
def test_a_room_is_furnished_as_what_it_was_planned_as(name):
    kind, furnished = room_kind_of(name), room_type(name)
    assert ROOM_TYPES[kind.name] == furnished
    assert (kind.zone == WET) == (furnished == "bathroom")
    assert (kind.zone == CIRCULATION) == (room_sort(name) in CONNECTING) <= (furnished in ("corridor", "hall", "gallery"))
    assert (kind.zone == PRIVATE) <= (furnished in ("study", "bedroom"))
    assert (kind.zone == SERVICE) <= (furnished == "utility")


def test_every_sort_of_room_can_be_planned_and_furnished():
    assert {room_kind_of(sort).name for sort in SORTS} == set(SORTS) == set(ROOM_TYPES)
    assert set(ROOM_TYPES.values()) == set(PROGRAMME)


def test_a_word_speaks_of_one_sort():
    words = [word for words in WORDS.values() for word in words.split()]
    assert len(words) == len(set(words))
    assert all(PHRASES[phrase] != room_sort(phrase.split()[1]) for phrase in PHRASES)  # otherwise the word would do


@pytest.mark.parametrize(
    ("name", "kind", "furnished"),
    [
        ("Bathhouse", "bathroom", "bathroom"), ("cloak room", "service", "utility"), ("dressing room", "service", "utility"),
        ("courtyard", "atrium", "hall"), ("banquet hall", "dining", "dining"), ("studio", "studio", "study"),
        ("pantry", "service", "utility"), ("tea room", "room", "living"), ("library corridor", "corridor", "corridor"),
        ("Throne_Room", "great hall", "hall"), ("Bathsheba", "other", "other"), ("", "other", "other"),
    ],
)  # fmt: skip
def test_names(name, kind, furnished):
    assert (room_kind_of(name).name, room_type(name)) == (kind, furnished)


@given(NAMES, NAMES)
def test_the_last_word_that_says_something_decides(first, last):
    if room_sort(last) not in ("room", "other"):
        assert room_sort(f"{first} of the {last}") == room_sort(last)
