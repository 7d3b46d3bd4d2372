"""What labels say of how things are held."""

import pytest

from wm.geometry.support import covers_windows, is_plural, is_structure, support_of
from wm.synth.procedural.furniture import KINDS


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
        ("wooden chairs", "floor"),
    ],
)  # fmt: skip
def test_whole_words_decide(label, support):
    assert support_of(label, (1.0, 1.0, 1.0)) == support


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
