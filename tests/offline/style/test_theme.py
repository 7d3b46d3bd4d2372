"""What themes mean: any text gives a complete style, whole words decide, one text always means the same."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from wm.offline.arrangement.room_type import ROOM_TYPES, room_type
from wm.offline.style.finish import MATERIALS, SLOTS
from wm.offline.style.requests import surfaces_in
from wm.offline.style.style_sheet import rgb
from wm.offline.style.theme import style_of
from wm.offline.style.vocabulary.colors import COLORS

FAMILY = {
    "gothic revival mansion with ornate detail and dark wood": "gothic",
    "bright scandinavian apartment with pale oak": "scandinavian",
    "airy modern beach house with whitewashed boards, linen and driftwood": "coastal",
    "roman country estate with marble floors": "roman",
    "dreamlike clockwork garden pavilion of brass, moss and glowing glass": "clockwork",
    "a dreamlike wonderland": "surreal",
    "minimalist": "minimalist",
    "a Victorian townhouse": "victorian",
    "cyberpunk at night": "cyberpunk",
    "cozy cabin": "rustic",
    "baroque palace": "baroque",
    "japanese tea house": "japanese",
    "modern luxury penthouse": "modern",
    "": "neutral",
    "a submarine": "industrial",  # whose furniture it takes
    "an observatory": "neutral",
    "ungothical": "neutral",
}


@pytest.mark.parametrize("theme", FAMILY)
def test_words_select_the_family(theme):
    assert style_of(theme).family == FAMILY[theme]


@settings(deadline=None, max_examples=40)
@given(st.text(max_size=60))
def test_every_text_gives_a_complete_style(theme):
    style = style_of(theme)
    assert [slot for slot, _ in style.slots] == list(SLOTS)
    surfaces = [style.surfaces(kind) for kind in (*ROOM_TYPES.values(), "no such type")]
    finishes = [finish for _, finish in style.slots]
    finishes += [f for s in surfaces for f in (s.wall, s.floor, s.ceiling, s.trim, s.wainscot) if f is not None]
    for finish in finishes:
        assert finish.material in MATERIALS
        assert finish.colors and all(0.0 <= c <= 1.0 for color in finish.colors for c in color)
        assert finish.scale > 0 and 0 <= finish.contrast <= 1 and 0 <= finish.roughness <= 1 and 0 <= finish.wear <= 1
    assert len(style.accents) >= 5
    assert 0 <= style.light.sun_elevation <= math.pi / 2 and 0 <= style.light.sun_strength <= 1


def test_unknown_themes_differ_and_one_theme_never_does():
    first, second = style_of("a planetarium"), style_of("an observatory")
    assert first.slots != second.slots
    style_of.cache_clear()
    assert style_of("a planetarium") == first


def test_case_and_punctuation_do_not_matter():
    assert style_of("Gothic, MANSION!").slots == style_of("gothic mansion").slots


def test_words_change_what_the_family_left_open():
    assert style_of("gothic mansion at midnight").light.sun_strength < style_of("gothic mansion").light.sun_strength
    assert style_of("scandinavian flat with marble floors").surfaces("living").floor.material == "marble"
    assert style_of("scandinavian flat in red").slot("fabric").colors != style_of("scandinavian flat").slot("fabric").colors
    assert style_of("ornate roman villa").form.ornament > style_of("roman villa").form.ornament


def test_coloured_walls_do_not_dye_the_sofas():
    plain, walls, red = (style_of(f"scandinavian flat {words}") for words in ("", "with red walls", "in red"))
    assert walls.slot("fabric") == plain.slot("fabric") != red.slot("fabric")


def test_a_red_kitchen_leaves_the_other_rooms_as_they_were():
    plain, asked = style_of("scandinavian flat"), style_of("scandinavian flat with a red kitchen")
    assert asked.rooms == plain.rooms and asked.slots == plain.slots and asked.accents == plain.accents
    assert surfaces_in(asked, "bedroom", "bedroom") == plain.surfaces("bedroom")
    assert surfaces_in(asked, "bakery", "kitchen") == plain.surfaces("kitchen")  # finished like a kitchen, and none
    kitchen = surfaces_in(asked, "kitchen", "kitchen")
    assert kitchen.wall.colors[0] == rgb(COLORS["red"]) and kitchen.floor == plain.surfaces("kitchen").floor


def test_a_family_with_marble_of_its_own_keeps_it():
    assert style_of("roman villa with marble floors").surfaces("hall").floor.material == "sectile"


@pytest.mark.parametrize(
    ("theme", "family"),
    [
        ("gothic hall with brass lamps and copper roof", "gothic"),
        ("victorian study with brass lamps and a clock", "victorian"),
        ("a snug kitchen with copper pans", None),
        ("a clockmaker's house of brass and copper", "clockwork"),
    ],
)
def test_a_metal_or_a_clock_does_not_make_a_family(theme, family):
    assert style_of(theme).family == (family or style_of("a snug kitchen with pans").family)


def test_an_unknown_slot_is_named():
    with pytest.raises(KeyError, match="unobtainium"):
        style_of("gothic").slot("unobtainium")


@pytest.mark.parametrize(
    ("name", "kind"),
    [
        ("Master Bedroom", "bedroom"), ("great hall", "hall"), ("dining hall", "dining"), ("hallway", "corridor"),
        ("bath", "bathroom"), ("tea room", "living"), ("gear workshop", "workshop"), ("moon bedroom", "bedroom"),
        ("conservatory hall", "hall"), ("atrium", "hall"), ("Bathsheba", "other"), ("", "other"), ("living_room", "living"),
    ],
)  # fmt: skip
def test_room_names(name, kind):
    assert room_type(name) == kind


YELLOW = (0xE0 / 255, 0xB8 / 255, 0x3F / 255)


@pytest.mark.parametrize("place", ["", "gothic", "igloo", "space station", "rustic cabin", "roman villa", "japanese", "loft"])
def test_yellow_walls_are_yellow_in_every_room_of_every_place(place):
    style = style_of(f"{place} with yellow walls")
    assert all(surfaces.wall.colors[0] == pytest.approx(YELLOW) for _, surfaces in style.rooms)


def test_a_green_sofa_leaves_everything_else():
    plain, green = style_of("gothic mansion"), style_of("gothic mansion and a green velvet sofa")
    assert (green.rooms, green.slots, green.form, green.light) == (plain.rooms, plain.slots, plain.form, plain.light)
    (wish,) = green.wishes
    assert wish.kinds == ("sofa",) and wish.slot == "velvet" and wish.color == pytest.approx((0x4A / 255, 0x7A / 255, 0x4A / 255))


def test_an_unknown_theme_does_not_turn_for_words_that_are_known():
    plain, green = style_of("glimmerwick"), style_of("glimmerwick with a green sofa")
    assert plain.slots == green.slots and plain.rooms == green.rooms


def test_red_lanterns_have_red_shades():
    red, green, blue = style_of("ramen bar with red lanterns").slot("lamp_shade").colors[0]
    assert red > 2 * max(green, blue)


PLACES = [
    "1970s space station, orange plastic and white curved panels", "ramen bar in Tokyo at night, neon, red lanterns", "igloo",
    "submarine", "hospital", "pirate ship", "wizard's tower", "school", "bakery", "diner", "cave", "treehouse", "castle", "loft",
    "temple", "farmhouse", "library", "sauna", "egyptian", "circus",
]  # fmt: skip


def test_no_two_places_look_alike():
    looks = {}
    for place in PLACES:
        living, style = style_of(place).surfaces("living"), style_of(place)
        looks[place] = np.array([*living.wall.colors[0], *living.floor.colors[0], *style.slot("fabric").colors[0]])
    apart = {(a, b): np.abs(looks[a] - looks[b]).max() for a in PLACES for b in PLACES if a < b}
    assert min(apart.values()) > 0.12, min(apart, key=apart.get)


def test_no_carpets_and_no_wood_leave_none():
    style = style_of("1970s flat, no carpets, without wood")
    materials = {f.material for _, s in style.rooms for f in (s.wall, s.floor, s.ceiling, s.trim, s.wainscot) if f is not None}
    assert not materials & {"carpet", "wood_planks", "parquet", "herringbone", "panelling", "wood"}
    assert style.slot("dark_wood").material != "wood"
    assert any(wish.absent and "rug" in wish.kinds for wish in style.wishes)


def test_an_unwanted_color_is_gone():
    for style in (style_of("gothic mansion, no red"), style_of("chinese palace without red")):
        seen = [f.colors[0] for _, s in style.rooms for f in (s.wall, s.floor)] + [style.slot("fabric").colors[0], *style.accents]
        assert not any(r > 0.4 and r > 2 * max(g, b) for r, g, b in seen)


def test_a_compound_theme_is_neither_of_its_parts():
    ship, gothic, both = (style_of(theme) for theme in ("spaceship", "gothic", "gothic spaceship"))
    assert both.surfaces("living").wall.material == ship.surfaces("living").wall.material
    assert both.surfaces("living").wall.colors != ship.surfaces("living").wall.colors
    assert both.form.back == gothic.form.back and both.family == "gothic"
    assert both.light.outlook == "space" and both.wishes == ship.wishes  # a spaceship has no fireplace, gothic or not


@pytest.mark.parametrize(
    ("words", "less"), [("at night", True), ("in fog", True), ("by candlelight", True), ("sunny", False), ("not dark", None)]
)
def test_moods_change_the_sun(words, less):
    plain, moody = style_of("gothic mansion").light.sun_strength, style_of(f"gothic mansion, {words}").light.sun_strength
    assert moody == plain if less is None else (moody < plain) == less
