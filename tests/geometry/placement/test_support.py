"""What labels say of how things are held."""

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from wm.geometry.placement.support import _NOUNS, covers_windows, is_plural, is_structure, singular_words, support_of
from wm.offline.furniture import KINDS

SIZE = (1.0, 1.0, 1.0)
kinds = st.sampled_from(sorted(KINDS))
adjectives = st.lists(st.sampled_from(("large", "indoor", "old", "Persian", "outdoor", "stained-glass")), max_size=3)
structures = st.sampled_from(("wall", "floor", "ceiling", "door", "doorway", "window", "archway", "passage", "baseboard", "room"))
nouns = [noun for named in _NOUNS.values() for noun in named]
letters = st.text("abcdefghijklmnopqrstuvwxyz", min_size=1, max_size=4)


@given(adjectives, kinds, st.booleans())
def test_words_that_say_nothing_of_holding_change_nothing(before, kind, shout):
    label = " ".join([*before, kind])
    assert support_of(label.upper() if shout else label, KINDS[kind].high) == KINDS[kind].support
    assert not is_structure(label)


@given(adjectives, structures, st.booleans())
def test_the_last_word_makes_a_part_of_the_building(before, noun, several):
    assert is_structure(" ".join([*before, noun + "s" * several]))


@given(structures, letters, letters, st.sampled_from(("plant", "lamp", "stand", "sofa")))
def test_a_word_inside_a_word_is_no_word(noun, head, tail, thing):
    for inside in (head + noun, noun + tail, head + noun + tail):
        assume(singular_words(inside)[0] not in (noun, "floor", "wall", "doorway", "standing", "mounted"))
        assert not is_structure(f"{inside} {thing}")
        assert support_of(f"{inside} {thing}", SIZE) == support_of(thing, SIZE)


@given(st.text(max_size=30), st.tuples(*[st.floats(1e-3, 10)] * 3), st.floats(0, 3))
def test_every_label_and_size_rests_on_something(label, size, low):
    held = support_of(label, size, low)
    assert held in ("floor", "flat", "wall", "ceiling", "object")
    assert support_of(f"  {label.upper()} ", size, low) == support_of(label.upper(), size, low)


@pytest.mark.parametrize("kind", KINDS)
def test_every_kind_of_furniture_is_held_as_its_builder_says(kind):
    assert support_of(kind, KINDS[kind].high) == KINDS[kind].support


@pytest.mark.parametrize(
    ("label", "support"),
    [
        ("tv stand", "floor"), ("TV", "object"), ("floor lamp", "floor"), ("table lamp", "object"), ("desk lamp", "object"),
        ("large indoor plant", "floor"), ("wall clock", "wall"), ("grandfather clock", "floor"), ("ceiling fan", "ceiling"),
        ("hanging lamps", "ceiling"), ("stack of books", "object"), ("vase of flowers", "object"), ("door mat", "flat"),
        ("wall-mounted television", "wall"), ("floor cushion", "floor"), ("bookshelves", "floor"), ("Persian rug", "flat"),
        ("wooden chairs", "floor"), ("painting of flowers", "wall"), ("picture of a window", "wall"),
        ("chest of drawers", "floor"), ("statue of a standing horse", "floor"), ("bowl of fruit", "object"),
        ("set of wall shelves", "wall"), ("suit of armour", "floor"), ("of", "floor"), ("pile of", "floor"),
    ],
)  # fmt: skip
def test_whole_words_decide(label, support):
    assert support_of(label, (1.0, 1.0, 1.0)) == support


def plural(noun: str) -> str:
    """By the rules of English; shelf is the only noun here in -f."""
    if noun.endswith("y"):
        return noun[:-1] + "ies"
    if noun.endswith("shelf"):
        return noun[:-1] + "ves"
    return noun + ("es" if noun.endswith(("ch", "sh", "x", "ss")) else "s")


@pytest.mark.parametrize("noun", nouns)
def test_several_are_held_as_one_is(noun):
    assert singular_words(plural(noun)) == [noun] and is_plural(plural(noun)) and not is_plural(noun)
    assert support_of(plural(noun), SIZE) == support_of(noun, SIZE)


@pytest.mark.parametrize(
    ("several", "one"),
    [
        ("benches", "bench"), ("couches", "couch"), ("stoves", "stove"), ("torches", "torch"), ("knives", "knife"),
        ("boxes", "box"), ("sleeves", "sleeve"), ("bookshelves", "bookshelf"), ("glasses", "glass"), ("dishes", "dish"),
        ("vases", "vase"), ("ties", "tie"), ("leaves", "leaf"),
    ],
)  # fmt: skip
def test_plurals_that_are_not_just_an_s_more(several, one):
    assert singular_words(several) == [one] == singular_words(one)


@given(st.sampled_from(nouns), st.sampled_from([*nouns, "door", "window", "wall", "horse", "fruit", "drawers"]), st.booleans())
def test_what_is_shown_or_held_is_not_the_thing(noun, content, several):
    label = f"{plural(noun) if several else noun} of a {content}"
    assert support_of(label, SIZE) == support_of(noun, SIZE)
    assert not is_structure(label) and is_plural(label) == several


@given(st.sampled_from(("pile", "stacks", "set", "pair", "bunch", "large collection")), st.sampled_from(nouns))
def test_words_that_count_name_nothing(counted, noun):
    label = f"{counted} of {plural(noun)}"
    assert support_of(label, SIZE) == support_of(noun, SIZE)
    assert is_plural(label) and not is_structure(label)
    assert is_structure(f"{counted} of windows") and not is_structure(f"{counted} of photos of windows")


@pytest.mark.parametrize(
    ("size", "low", "support"),
    [
        ((2.0, 1.5, 0.01), 0.0, "flat"),
        ((0.8, 0.03, 0.6), 1.2, "wall"),
        ((0.2, 0.2, 0.3), 0.8, "object"),
        ((1.0, 1.0, 1.0), 0.0, "floor"),
    ],
)
def test_where_no_word_tells_the_shape_does(size, low, support):
    assert support_of("gizmo", size, low) == support
    assert support_of("", size, low) == support


def test_parts_of_the_building_are_named_by_the_last_word():
    assert all(map(is_structure, ("door", "wooden doors", "stained glass window", "brick wall", "ceiling")))
    assert not any(map(is_structure, ("floor lamp", "wall shelf", "large indoor plant", "door mat", "window seat", "")))


def test_plurals_and_coverings():
    assert all(map(is_plural, ("curtains", "dried flowers"))) and not any(map(is_plural, ("sofa", "glass", "")))
    assert covers_windows("velvet curtains") and not covers_windows("picture")
