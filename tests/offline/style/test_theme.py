"""What themes mean: any text gives a complete style, whole words decide, one text always means the same."""

import math

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from wm.offline.arrangement.room_type import ROOM_TYPES, room_type
from wm.offline.style.finish import MATERIALS, SLOTS
from wm.offline.style.theme import style_of

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
    "a submarine": "neutral",
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
    first, second = style_of("a submarine"), style_of("an observatory")
    assert first.slots != second.slots
    style_of.cache_clear()
    assert style_of("a submarine") == first


def test_case_and_punctuation_do_not_matter():
    assert style_of("Gothic, MANSION!").slots == style_of("gothic mansion").slots


def test_words_change_what_the_family_left_open():
    assert style_of("gothic mansion at midnight").light.sun_strength < style_of("gothic mansion").light.sun_strength
    assert style_of("scandinavian flat with marble floors").surfaces("living").floor.material == "marble"
    assert (
        style_of("scandinavian flat with red sofas").slot("fabric").colors != style_of("scandinavian flat").slot("fabric").colors
    )
    assert style_of("ornate roman villa").form.ornament > style_of("roman villa").form.ornament


def test_coloured_walls_do_not_dye_the_sofas():
    plain, walls, sofas = (style_of(f"scandinavian flat {words}") for words in ("", "with red walls", "with red sofas"))
    assert walls.slot("fabric") == plain.slot("fabric") != sofas.slot("fabric")


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
