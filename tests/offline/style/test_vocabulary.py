"""Laws of the vocabulary: every word leads somewhere, every material and colour exists."""

import re

import pytest

from wm.offline.furniture import KINDS
from wm.offline.style.families import FAMILIES
from wm.offline.style.finish import MATERIALS, OUTLOOKS, SLOTS
from wm.offline.style.lexicon import FAMILY_OF_WORD, HINTS, lemma_of, words_of
from wm.offline.style.style_sheet import StyleSheet, rgb
from wm.offline.style.vocabulary.colors import COLOR_SYNONYMS, COLORS, TONES
from wm.offline.style.vocabulary.materials import MATERIAL_SYNONYMS, MATERIAL_WORDS, SORTS
from wm.offline.style.vocabulary.moods import MOOD_OF_WORD
from wm.offline.style.vocabulary.phrases import FILLERS, PHRASES
from wm.offline.style.vocabulary.targets import TARGET_SYNONYMS, TARGETS

CODE = re.compile(r"[0-9a-f]{6}")


def test_the_vocabulary_has_some_hundreds_of_words():
    assert len(COLORS) >= 60
    tables = (COLORS, COLOR_SYNONYMS, MATERIAL_WORDS, MATERIAL_SYNONYMS, TARGETS, TARGET_SYNONYMS, MOOD_OF_WORD, FAMILY_OF_WORD)
    assert len(set().union(*tables)) >= 700


def test_every_color_is_one():
    codes = [*COLORS.values(), *(code for code, _ in TONES.values())]
    codes += [code for word in MATERIAL_WORDS.values() for code in word.codes]
    assert all(CODE.fullmatch(code) for code in codes)
    assert all(0 < share < 1 for _, share in TONES.values())


def test_no_two_colors_are_the_same_by_accident():
    twins = [code for code in COLORS.values() if list(COLORS.values()).count(code) > 1]
    assert set(twins) <= {COLORS["gold"], COLORS["sand"]}  # golden, sandy


@pytest.mark.parametrize("name", MATERIAL_WORDS)
def test_every_material_word_names_what_there_is(name):
    word = MATERIAL_WORDS[name]
    assert {word.wall, word.floor} - {""} <= MATERIALS.keys()
    assert word.slot in SLOTS and word.sort in SORTS and word.target in TARGETS
    assert word.scale > 0 and 0 <= word.roughness <= 1


def test_synonyms_resolve():
    assert set(COLOR_SYNONYMS.values()) <= COLORS.keys()
    assert set(MATERIAL_SYNONYMS.values()) <= MATERIAL_WORDS.keys()
    assert set(TARGET_SYNONYMS.values()) <= TARGETS.keys()
    assert not COLOR_SYNONYMS.keys() & COLORS.keys()
    assert not MATERIAL_SYNONYMS.keys() & MATERIAL_WORDS.keys()


def test_targets_name_what_there_is():
    for target in TARGETS.values():
        assert set(target.kinds) <= KINDS.keys()
        assert set(target.slots) <= set(SLOTS)
        assert target.surface in ("", "wall", "floor", "ceiling", "trim")


def test_phrases_mean_a_known_word():
    tables = (COLORS, COLOR_SYNONYMS, MATERIAL_WORDS, MATERIAL_SYNONYMS, TARGETS, TARGET_SYNONYMS, MOOD_OF_WORD, FAMILY_OF_WORD)
    known = set().union(*tables, FILLERS)
    assert {meaning for meaning in PHRASES.values() if meaning not in known} == set()


def test_hints_are_words_of_families():
    assert FAMILY_OF_WORD.keys() | MOOD_OF_WORD.keys() | MATERIAL_WORDS.keys() >= HINTS


def test_fillers_mean_nothing_else():
    tables = (COLORS, MATERIAL_WORDS, TARGETS, FAMILY_OF_WORD)
    assert FILLERS & set().union(*tables) == set()


@pytest.mark.parametrize("name", FAMILIES)
def test_places_name_what_there_is(name):
    sheet: StyleSheet = FAMILIES[name]
    assert not sheet.kin or (sheet.kin in FAMILIES and not FAMILIES[sheet.kin].kin)
    assert {slot for slot, _ in sheet.slots} <= set(SLOTS)
    assert set(sheet.without) <= KINDS.keys()
    assert sheet.light.outlook in OUTLOOKS
    assert all(rgb(code) for code in sheet.accents) and len(sheet.accents) >= 5


@pytest.mark.parametrize(
    ("token", "lemma"),
    [("walls", "wall"), ("shelves", "shelf"), ("wizard's", "wizard"), ("bakeries", "bakery"), ("benches", "bench"),
     ("glass", "glass"), ("frobs", "frobs"), ("1970s", "1970s"), ("children’s", "children"), ("knives", "knives")],
)  # fmt: skip
def test_lemmas(token, lemma):
    assert lemma_of(token) == lemma


def test_words_that_belong_together_are_one_but_not_over_a_comma():
    assert [word.lemma for word in words_of("A space station, tree houses")] == ["a", "spaceship", "treehouse"]
    assert [word.lemma for word in words_of("space, station")] == ["space", "station"]
