"""Words of a theme, and what a single one of them may mean."""

import dataclasses
import functools
import re

from wm.offline.style.families import FAMILIES
from wm.offline.style.vocabulary.colors import COLOR_SYNONYMS, COLORS, TONES, VIVID
from wm.offline.style.vocabulary.materials import MATERIAL_SYNONYMS, MATERIAL_WORDS
from wm.offline.style.vocabulary.moods import MOOD_OF_WORD
from wm.offline.style.vocabulary.phrases import FILLERS, LISTED, NEGATIONS, PHRASES
from wm.offline.style.vocabulary.targets import TARGET_SYNONYMS, TARGETS

_HINTS = """
brass copper clock clean luxury hotel office urban villa temple museum theatre cinema tea country library garage neon
dreamlike dreamy magical enchanted whimsical fairy dream psychedelic clinic captain deck boat cozy cosy royal opulent
classical imperial mechanical gears gear sea island ocean cottage space ward keep cell spell lab mine spa inn workshop
empire english british french ancient glamour vintage retro sleek mountain harbour harbor coast doll alley opera robot lair
forum mod underground antique regal ballroom western ghost future garden floral tokyo kyoto osaka paris london vienna venice
berlin athens rome newyork stockholm copenhagen oslo shanghai beijing havana marrakech istanbul miami
"""
HINTS = frozenset(_HINTS.split())
"""Words that say nothing of a family unless another of its words is there, or no other family is named."""

BREAKS = frozenset({"with", "but", "yet", "plus"})
"""Words that end what an adjective or a negation reaches."""

FAMILY_OF_WORD: dict[str, tuple[str, ...]] = {}
for _name, _sheet in FAMILIES.items():
    for _word in _sheet.words:
        FAMILY_OF_WORD[_word] = (*FAMILY_OF_WORD.get(_word, ()), _name)


@dataclasses.dataclass(frozen=True)
class Word:
    """One word, or several that mean one."""

    text: str  # as it was written, in lower case
    lemma: str  # as the vocabulary has it; the text where it has none
    ends: bool  # a comma, a full stop or the like follows

    @property
    def color(self) -> str:
        """Hexadecimal code of the colour that it names; "" for none."""
        return COLORS.get(COLOR_SYNONYMS.get(self.lemma, self.lemma), "")

    @property
    def material(self) -> str:
        """Key of MATERIAL_WORDS; "" for none."""
        word = MATERIAL_SYNONYMS.get(self.lemma, self.lemma)
        return word if word in MATERIAL_WORDS else ""

    @property
    def target(self) -> str:
        """Key of TARGETS; "" for none."""
        word = TARGET_SYNONYMS.get(self.lemma, self.lemma)
        return word if word in TARGETS else ""

    @property
    def families(self) -> tuple[str, ...]:
        return FAMILY_OF_WORD.get(self.lemma, ())

    @property
    def mood(self) -> str:
        """Key of MOODS; "" for none."""
        return MOOD_OF_WORD.get(self.lemma, "")

    @property
    def tone(self) -> str:
        """The word where it changes the tone of a colour after it; "" for none."""
        return self.lemma if self.lemma in TONES or self.lemma in VIVID else ""


@functools.cache
def _known() -> frozenset[str]:
    parts = (COLORS, COLOR_SYNONYMS, TONES, VIVID, MATERIAL_WORDS, MATERIAL_SYNONYMS, TARGETS, TARGET_SYNONYMS, MOOD_OF_WORD)
    return frozenset().union(*(frozenset(part) for part in (*parts, FAMILY_OF_WORD, FILLERS, NEGATIONS)))


def words_of(text: str) -> list[Word]:
    """The words of a theme in their order; those that belong together as one."""
    tokens = re.findall(r"[^\W_]+(?:['’][^\W_]+)?|[,.;:!?()\n]", text.lower())
    plain: list[tuple[str, bool]] = []
    for token in tokens:
        if token[0].isalnum():
            plain.append((token, False))
        elif plain:
            plain[-1] = (plain[-1][0], True)
    words, k = [], 0
    while k < len(plain):
        for length in (3, 2):
            run = plain[k : k + length]
            key = tuple(_stem(token) for token, _ in run)
            exact = tuple(token for token, _ in run)
            meaning = PHRASES.get(exact) or PHRASES.get(key)
            if len(run) == length and meaning and not any(ends for _, ends in run[:-1]):
                words.append(Word(" ".join(exact), meaning, run[-1][1]))
                k += length
                break
        else:
            words.append(Word(plain[k][0], lemma_of(plain[k][0]), plain[k][1]))
            k += 1
    return words


def negated(words: list[Word]) -> list[bool]:
    """Of each word whether a negation before it reaches it; "carpet-free" negates backwards."""
    reached, active, since = [], False, 0
    for word in words:
        if word.lemma in NEGATIONS:
            active, since = True, 0
            reached.append(False)
            continue
        if word.lemma in BREAKS or (word.lemma == "and" and since > 0):
            active = False
        reached.append(active)
        since += word.lemma not in LISTED
        if word.ends:
            active = False
    for k, word in enumerate(words):
        if word.lemma == "free" and k:
            reached[k - 1] = True
    return reached


def lemma_of(token: str) -> str:
    """The form of a word that the vocabulary has: itself, or without a plural's or a possessive's ending."""
    bare = re.sub(r"['’](s|re|ve|ll|d|t)?$", "", token)
    for form in (bare, *_singulars(bare)):
        if form in _known():
            return form
    return bare


def _stem(token: str) -> str:
    bare = re.sub(r"['’]s?$", "", token)
    return bare[:-1] if bare.endswith("s") and not bare.endswith("ss") else bare


def _singulars(word: str) -> list[str]:
    forms = []
    if word.endswith("ies"):
        forms.append(f"{word[:-3]}y")
    if word.endswith("ves"):
        forms += [f"{word[:-3]}f", f"{word[:-3]}fe"]
    if word.endswith("es"):
        forms.append(word[:-2])
    if word.endswith("s") and not word.endswith("ss"):
        forms.append(word[:-1])
    return forms
