"""A room is furnished as what it was planned as, whatever words its name is made of."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from wm.offline.arrangement.programmes import PROGRAMME
from wm.offline.arrangement.room_type import FINISHES, ROOM_TYPES, finish_type, room_type
from wm.offline.arrangement.rooms_equipped import EQUIPPED
from wm.offline.language.programme import CIRCULATION, WET, room_kind_of
from wm.synth.room_names import CONNECTING, FOREIGN, OTHER, PHRASES, ROOM, SORTS, WORDS, room_sort, unknown_rooms

KNOWN = sorted({word for words in WORDS.values() for word in words.split()} | set(PHRASES))
NAMES = st.lists(st.sampled_from([*KNOWN, "room", "master", "the", "II"]), min_size=1, max_size=4).map(" ".join)


@given(NAMES)
def test_a_room_is_furnished_as_what_it_was_planned_as(name):
    kind, furnished = room_kind_of(name), room_type(name)
    assert ROOM_TYPES[kind.name] == furnished
    assert (kind.zone == WET) == (furnished in ("bathroom", "wc", "sauna"))
    assert (kind.zone == CIRCULATION) == (room_sort(name) in CONNECTING)
    assert (kind.zone == CIRCULATION) <= (furnished in ("corridor", "hall", "gallery", "entrance"))


def test_every_sort_of_room_can_be_planned_furnished_and_finished():
    assert {room_kind_of(sort).name for sort in SORTS if sort != OTHER} | {OTHER} == set(SORTS) == set(ROOM_TYPES)
    assert set(ROOM_TYPES.values()) == {*PROGRAMME, *EQUIPPED} and not PROGRAMME.keys() & EQUIPPED.keys()
    assert {finish_type(kind) for kind in ROOM_TYPES.values()} == {*PROGRAMME, "utility", "other"}
    assert set(FINISHES) <= set(EQUIPPED)


def test_there_are_many_sorts_and_each_has_a_name():
    assert len(SORTS) >= 60
    assert {room_sort(word) for word in KNOWN} >= set(SORTS) - {ROOM, OTHER}
    assert all(room_sort(sort) == sort for sort in SORTS)


def test_a_word_speaks_of_one_sort():
    words = [word for words in WORDS.values() for word in words.split()]
    assert len(words) == len(set(words))
    foreign = [word for words in FOREIGN.values() for word in words.split()]
    assert len(foreign) == len(set(foreign)) and not set(foreign) & set(words)
    assert all(PHRASES[phrase] != room_sort(phrase.split()[1]) for phrase in PHRASES)  # otherwise the word would do


@pytest.mark.parametrize(
    ("name", "kind", "furnished"),
    [
        ("Bathhouse", "bathroom", "bathroom"), ("cloak room", "cloakroom", "cloakroom"), ("dressing room", "closet", "closet"),
        ("courtyard", "atrium", "hall"), ("banquet hall", "dining", "dining"), ("studio", "studio", "study"),
        ("pantry", "pantry", "pantry"), ("tea room", "tea room", "living"), ("library corridor", "corridor", "corridor"),
        ("Throne_Room", "throne room", "throne room"), ("Bathsheba", "other", "other"), ("", "other", "other"),
        ("utility room", "service", "utility"), ("great hall", "great hall", "hall"), ("blue room", "room", "other"),
        ("home cinema", "cinema", "cinema"), ("guest wc", "wc", "wc"), ("walk-in closet", "closet", "closet"),
        ("music school classroom", "classroom", "classroom"), ("server room", "server room", "server room"),
        ("home office", "study", "study"), ("office", "office", "office"), ("Stables", "stable", "stable"),
        ("Nurseries", "nursery", "nursery"), ("hall of mirrors", "hall", "hall"), ("games room", "games", "games"),
        ("musicroom", "music", "music"), ("Operating theatre", "surgery", "surgery"), ("garden", "garden", "garden"),
    ],
)  # fmt: skip
def test_names(name, kind, furnished):
    assert (room_kind_of(name).name, room_type(name)) == (kind, furnished)


@pytest.mark.parametrize(
    ("name", "sort"),
    [
        ("Küche", "kitchen"), ("Kueche", "kitchen"), ("Schlafzimmer", "bedroom"), ("Gäste-WC", "wc"), ("Waschküche", "laundry"),
        ("Büro", "office"), ("Hobbyraum", "workshop"), ("Raum 3", "room"), ("salle de bain", "bathroom"), ("chambre", "bedroom"),
        ("salle à manger", "dining"), ("garde-manger", "pantry"), ("salon", "living"), ("entrée", "entrance"),
        ("baño", "bathroom"), ("cocina", "kitchen"), ("habitación", "bedroom"), ("sótano", "cellar"),
        ("salle de jeux", "playroom"),
        ("COMEDOR", "dining"),
    ],
)  # fmt: skip
def test_common_names_in_german_french_and_spanish(name, sort):
    assert room_sort(name) == sort


@given(NAMES, NAMES)
def test_the_last_word_that_says_something_decides(first, last):
    if room_sort(last) not in ("room", "other"):
        assert room_sort(f"{first} of the {last}") == room_sort(last)


@given(NAMES, st.sampled_from(["{}s", "The {}", "{} 2", "{}!", "  {}  "]))
def test_plurals_numbers_and_marks_change_nothing(name, form):
    if room_sort(name) not in ("room", "other") and name.split()[-1] not in ("the", "II", "room", "master"):
        assert room_sort(form.format(name).upper()) == room_sort(name)


@given(st.text(max_size=30))
def test_any_text_is_a_name(name):
    assert room_sort(name) in SORTS


def test_names_that_do_not_say_what_a_room_is_for_are_told_once_and_in_order():
    names = ["kitchen", "zorblax", "Raum 3", "hall", "zorblax", "gym", "blue room"]
    assert unknown_rooms(names) == ["zorblax", "Raum 3", "blue room"]
    assert unknown_rooms(["kitchen", "Küche"]) == []
