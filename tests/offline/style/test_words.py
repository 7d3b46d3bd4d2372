"""What is read out of themes: requests, negation, families, and which words are reported."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from wm.offline.style.lexicon import words_of
from wm.offline.style.reading import Request
from wm.offline.style.vocabulary.colors import COLORS
from wm.offline.style.words import read_theme, toned


def asked(theme):
    return [(r.target, r.color, r.material) for r in read_theme(theme).requests]


RED, YELLOW, GREEN, WHITE, ORANGE = (COLORS[name] for name in ("red", "yellow", "green", "white", "orange"))


@pytest.mark.parametrize(
    ("theme", "requests"),
    [
        ("yellow walls", [("wall", YELLOW, "")]),
        ("walls painted yellow", [("wall", YELLOW, "")]),
        ("the walls are yellow", [("wall", YELLOW, "")]),
        ("walls of red brick", [("wall", RED, "brick")]),
        ("a green velvet sofa", [("sofa", GREEN, "velvet")]),
        ("green couches", [("sofa", GREEN, "")]),
        ("red lanterns", [("lamp", RED, "")]),
        ("marble floors and a green sofa", [("floor", "", "marble"), ("sofa", GREEN, "")]),
        ("orange plastic and white curved panels", [("furniture", ORANGE, "plastic"), ("wall", WHITE, "panelling")]),
        ("dark green walls", [("wall", toned(GREEN, "dark"), "")]),
        ("brick", [("wall", "", "brick")]),
        ("walls, sofas and floors", []),
    ],
)
def test_what_is_asked_of_what(theme, requests):
    assert asked(theme) == requests


@pytest.mark.parametrize(
    ("theme", "request_"),
    [
        ("a red kitchen", Request("wall", color=RED, room="kitchen")),
        ("a flat with a dark green dining room", Request("wall", color=toned(GREEN, "dark"), room="dining")),
        ("yellow bedrooms", Request("wall", color=YELLOW, room="bedroom")),
        ("a brick kitchen", Request("wall", material="brick", room="kitchen")),
        ("a marble bathroom", Request("floor", material="marble", room="bathroom")),
        ("white bathroom floors", Request("floor", color=WHITE, room="bathroom")),
    ],
)
def test_a_color_before_the_name_of_a_room_is_that_rooms(theme, request_):
    reading = read_theme(theme)
    assert reading.requests == (request_,)
    assert not reading.palette and not reading.unknown


@pytest.mark.parametrize("theme", ["a red restaurant", "a red family home", "a red room", "a red gallery", "red rooms"])
def test_a_color_before_the_name_of_a_place_is_all_of_its(theme):
    reading = read_theme(theme)
    assert reading.palette == (RED,) and not reading.requests


def test_what_is_unwanted_of_a_room_is_no_request_for_it():
    assert not read_theme("no red kitchen").requests


def test_two_colors_of_one_thing():
    (request,) = read_theme("red and white curtains").requests
    assert (request.target, request.color, request.second) == ("curtain", RED, WHITE)


def test_a_color_for_nothing_in_particular_joins_the_palette():
    assert read_theme("a flat in red, green").palette == (RED, GREEN)
    assert read_theme("yellow walls").palette == ()


@pytest.mark.parametrize(
    ("theme", "field", "value"),
    [
        ("no carpets", "unwanted_materials", ("carpet",)),
        ("without wood or leather", "unwanted_materials", ("wood", "leather")),
        ("no red", "unwanted_colors", (RED,)),
        ("no curtains or rugs", "requests", (Request("curtain", absent=True), Request("rug", absent=True))),
        ("carpet-free", "unwanted_materials", ("carpet",)),
        ("not dark", "moods", ()),
        ("not gothic", "families", ()),
        ("no curtains, red walls", "requests", (Request("curtain", absent=True), Request("wall", color=RED))),
        ("no curtains but red walls", "requests", (Request("curtain", absent=True), Request("wall", color=RED))),
    ],
)
def test_negation(theme, field, value):
    reading = read_theme(theme)
    assert getattr(reading, field) == value
    assert reading.used and not reading.unknown


@pytest.mark.parametrize(
    ("theme", "families"),
    [
        ("gothic spaceship", ["space", "gothic"]),
        ("1970s space station", ["space", "seventies"]),
        ("japanese scandinavian flat", ["japanese", "scandinavian"]),
        ("modern beach house", ["coastal"]),
        ("ramen bar in Tokyo", ["ramen"]),
        ("pirate ship", ["ship"]),
        ("a flat", []),
    ],
)
def test_families(theme, families):
    reading = read_theme(theme)
    assert [name for name, _ in reading.families] == families
    assert not families or sum(share for _, share in reading.families) == pytest.approx(1)


def test_unknown_words_are_told_and_fillers_are_not():
    reading = read_theme("a frobnicated igloo with the glimmerwick, and yellow walls")
    assert reading.unknown == ("frobnicated", "glimmerwick")
    assert reading.used == ("igloo", "yellow walls")


def test_words_without_effect_are_told():
    assert read_theme("modern gothic house").idle == ("modern",)
    assert read_theme("igloo with walls").idle == ("walls",)


@given(st.text(max_size=80))
def test_every_text_can_be_read_and_no_word_is_in_two_lists(theme):
    reading = read_theme(theme)
    used = {word for phrase in reading.used for word in phrase.split()}
    texts = {part for word in words_of(theme) for part in word.text.split()}
    assert used | set(reading.unknown) <= texts


WORDS = st.sampled_from(
    [
        "no",
        "without",
        "red",
        "green",
        "walls",
        "sofa",
        "of",
        "brick",
        "and",
        ",",
        "gothic",
        "ship",
        "night",
        "dark",
        "oak",
        "floor",
        "with",
        "not",
        "carpets",
        "frob",
    ]
)


@given(st.lists(WORDS, max_size=12))
def test_any_order_of_words_can_be_read(words):
    theme = " ".join(words)
    reading = read_theme(theme)
    assert all(request.target for request in reading.requests)
    assert ("frob" in reading.unknown) == ("frob" in words)
