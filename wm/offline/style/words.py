"""A theme's words read into a ThemeReading: families, colours, materials, moods, and what is asked for what.

Colours, materials and tones in a row wait for a noun: "dark green velvet sofa" is one request. Without a noun a colour joins the
palette and a material goes where it usually is; before one room's name ("a red kitchen") both are that room's. "of", "in",
"painted" and the like lead from a noun back to its colours and materials: "walls of red brick". "no", "without" and the like turn
what follows, up to a comma, into what is not wanted.
"""

import colorsys
import dataclasses
import functools

from wm.offline.style.families import FAMILIES
from wm.offline.style.lexicon import BREAKS, HINTS, Word, negated, words_of
from wm.offline.style.reading import Request, ThemeReading
from wm.offline.style.style_sheet import hex_code, mix_rgb, rgb
from wm.offline.style.vocabulary.colors import TONES, VIVID
from wm.offline.style.vocabulary.materials import MATERIAL_WORDS
from wm.offline.style.vocabulary.phrases import FILLERS, NEGATIONS, POSTFIX, ROOM_NOUNS
from wm.offline.style.vocabulary.targets import TARGETS
from wm.synth.room_names import OTHER, ROOM, room_sort

NEUTRAL = "modern"
OWN: dict[str, frozenset[str]] = {
    "coastal": frozenset({"whitewashed", "board", "linen", "driftwood"}),
    "clockwork": frozenset({"brass", "moss", "glass", "copper", "glowing"}),
    "scandinavian": frozenset({"oak", "pine", "wool"}),
    "roman": frozenset({"marble", "terracotta", "frescoed", "fresco", "mosaic"}),
    "japanese": frozenset({"tatami", "bamboo", "paper"}),
    "ice": frozenset({"ice", "snow", "icy", "frozen", "snowy"}),
    "cave": frozenset({"rock", "stone", "rocky"}),
    "space": frozenset({"plastic", "panel"}),
}
"""Materials that a family is made of already: naming them changes nothing of it."""


@dataclasses.dataclass
class _Pending:
    """Adjectives that wait for their noun."""

    colors: list[str] = dataclasses.field(default_factory=list)
    materials: list[str] = dataclasses.field(default_factory=list)
    tone: str = ""
    room: str = ""  # sort of room that their noun is in: "red kitchen walls"
    places: list[int] = dataclasses.field(default_factory=list)  # of their words

    def __bool__(self) -> bool:
        return bool(self.colors or self.materials or self.tone)


@functools.lru_cache(maxsize=256)
def read_theme(theme: str) -> ThemeReading:
    """The meaning of a theme; the same text always has the same."""
    words = words_of(theme)
    reader = _Reader(words)
    reader.read()
    return reader.reading()


class _Reader:
    """Goes through the words once; the only state is what was found so far."""

    def __init__(self, words: list[Word]) -> None:
        self.words = words
        self.negated = negated(words)
        self.families = _families(words, self.negated)
        self.own = frozenset().union(*(OWN.get(name, frozenset()) for name, _ in self.families[:1]))
        self.palette: list[str] = []
        self.unwanted_colors: list[str] = []
        self.unwanted_materials: list[str] = []
        self.requests: list[Request] = []
        self.moods: list[str] = []
        self.wood_tone = ""
        self.used: set[int] = set()
        self.known: set[int] = set()
        self.pending = _Pending()
        self.last_target: tuple[str, int] | None = None  # a noun that is still to be told its colour, and its place

    def read(self) -> None:
        named = {part for name, _ in self.families for part in (name, FAMILIES[name].kin)}
        for k, word in enumerate(self.words):
            if word.families:
                self.known.add(k)
                if self.negated[k] or named & set(word.families):
                    self.used.add(k)
            self._take(k, word)
            if word.ends:
                self._flush()
                self.last_target = None
        self._flush()

    def _take(self, k: int, word: Word) -> None:
        after = self.words[k + 1] if k + 1 < len(self.words) and not word.ends else None
        if self._is_own(k, word):
            self.used.add(k)
            self.known.add(k)
        elif word.lemma in BREAKS:
            self._flush()
            self.last_target = None
        elif word.lemma in POSTFIX:
            if self.pending and not word.target and word.lemma != "of":
                self._flush()
        elif word.lemma == "and":
            if self.pending.materials and not (after and (after.target or after.material) and not after.color):
                self._flush()
        elif word.tone and after is not None and self._goes_on(after):
            self.pending.tone = self.pending.tone or word.tone
            self.pending.places.append(k)
        elif word.target and not word.material:
            self._noun(k, word.target)
        elif word.color:
            self._adjective(k, self.pending.colors, word.color)
        elif word.material:
            self._adjective(k, self.pending.materials, word.material)
        elif word.mood:
            self.known.add(k)
            self.used.add(k)
            self.moods += [] if self.negated[k] else [word.mood]
        elif (self.pending.colors or self.pending.materials) and (room := self._room(k)):
            self._of_room(k, room)

    def _room(self, k: int) -> str:
        """The sort of room that a word names, alone or with "room" after it; "" where it names none, or a whole place."""
        word = self.words[k]
        alone = word.text.endswith(("room", "rooms")) or not {word.text, word.text.removesuffix("s")}.isdisjoint(ROOM_NOUNS)
        if word.families or self.negated[k] or not (alone or self._before_room(k)):
            return ""
        sort = room_sort(f"{word.text} room" if self._before_room(k) else word.text)
        return "" if sort in (ROOM, OTHER) else sort

    def _before_room(self, k: int) -> bool:
        return not self.words[k].ends and k + 1 < len(self.words) and self.words[k + 1].lemma in ("room", "rooms")

    def _of_room(self, k: int, sort: str) -> None:
        """Colours and materials of one room: of its walls, or of the thing in it that is named next."""
        last = k + 1 if self._before_room(k) else k
        self.pending.places += range(k, last + 1)
        self.pending.room = sort
        after = self.words[last + 1] if last + 1 < len(self.words) and not self.words[last].ends else None
        if after is None or not after.target:
            material = MATERIAL_WORDS[self.pending.materials[-1]].target if self.pending.materials else "wall"
            self._ask(material if TARGETS[material].surface else "")

    def _is_own(self, k: int, word: Word) -> bool:
        """Whether the family is made of this anyway, or it is the surface of which that was just said."""
        if self.negated[k] or self.pending.colors or self.pending.materials:
            return False
        said = k > 0 and self.words[k - 1].lemma in self.own and not self.words[k - 1].ends and word.target in ("wall", "floor")
        return word.lemma in self.own or said

    def _goes_on(self, word: Word) -> bool:
        return bool(word.color or word.material or word.target or word.tone)

    def _adjective(self, k: int, waiting: list[str], value: str) -> None:
        waiting.append(value)
        self.pending.places.append(k)

    def _noun(self, k: int, target: str) -> None:
        """A noun that colours and materials are asked for; alone it waits for those that follow it."""
        self.known.add(k)
        if self.negated[k]:
            self.used.add(k)
            if self.pending:
                self._flush()
            else:
                self.requests.append(Request(target, absent=True))
        elif self.pending:
            self.pending.places.append(k)
            self._ask(target)
            self.last_target = None
        else:
            self.last_target = (target, k)

    def _flush(self) -> None:
        """Adjectives whose noun never came."""
        if not self.pending:
            self.pending = _Pending()
            return
        if any(self.negated[k] for k in self.pending.places):
            self.unwanted_colors += self.pending.colors
            self.unwanted_materials += [MATERIAL_WORDS[name].sort for name in self.pending.materials]
            self._done()
        elif self.last_target is not None:
            self.pending.places.append(self.last_target[1])
            self._ask(self.last_target[0])
            self.last_target = None
        elif self.pending.materials:
            self._ask("")
        elif self.pending.colors:
            self.palette += [toned(color, self.pending.tone) for color in self.pending.colors]
            self._done()
        else:  # a tone before a word that took none: "dark" of a "dark tower"
            self._done()

    def _ask(self, target: str) -> None:
        waiting = self.pending
        colors = [toned(color, waiting.tone) for color in waiting.colors]
        material = waiting.materials[-1] if waiting.materials else ""
        if material == "wood" and not colors and not target:
            self.wood_tone = {"dark": "dark", "deep": "dark", "light": "light", "pale": "light"}.get(waiting.tone, "")
            if self.wood_tone:
                self._done()
                return
        target = target or MATERIAL_WORDS[material].target
        if material and waiting.tone and not colors:
            colors = [toned(MATERIAL_WORDS[material].codes[0], waiting.tone)]
        if not (material or colors):
            base = {"dark": "4a4542", "deep": "4a4542"}.get(waiting.tone, "e4ddd0")
            colors = [base]
        first, second = (*colors, "", "")[:2]
        if target == "panel":
            target, material = "wall", material or "panelling"
            if material == "panelling" and any(name == "space" for name, _ in self.families):
                material = "plastic"
        room = waiting.room if TARGETS[target].surface else ""
        self.requests.append(Request(target, color=first, second=second, material=material, room=room))
        for extra in waiting.materials[:-1]:
            self.requests.append(Request(MATERIAL_WORDS[extra].target, material=extra))
        self._done()

    def _done(self) -> None:
        self.used.update(self.pending.places)
        self.known.update(self.pending.places)
        self.pending = _Pending()

    def reading(self) -> ThemeReading:
        self._mark()
        idle = sorted(self.known - self.used)
        unknown = [
            word.text for k, word in enumerate(self.words)
            if k not in self.known and word.lemma not in FILLERS and word.lemma not in NEGATIONS and len(word.text) > 1
        ]  # fmt: skip
        return ThemeReading(
            families=self.families,
            palette=tuple(dict.fromkeys(self.palette)),
            unwanted_colors=tuple(dict.fromkeys(self.unwanted_colors)),
            unwanted_materials=tuple(dict.fromkeys(self.unwanted_materials)),
            requests=tuple(self.requests),
            wood_tone=self.wood_tone,
            moods=tuple(dict.fromkeys(self.moods)),
            used=tuple(_phrases(self.words, self.used)),
            idle=tuple(dict.fromkeys(self.words[k].text for k in idle)),
            unknown=tuple(dict.fromkeys(unknown)),
        )

    def _mark(self) -> None:
        """Words between used ones that shape them, and negations before them, count as used."""
        for k, word in enumerate(self.words):
            if word.target and k not in self.known:
                self.known.add(k)
            if word.lemma in NEGATIONS and any(j in self.used for j in range(k + 1, min(k + 4, len(self.words)))):
                self.used.add(k)


def _families(words: list[Word], negated: list[bool]) -> tuple[tuple[str, float], ...]:
    """The families that make the theme's looks, with their share of the votes: one, a place and a style, or the two strongest.

    Of equally strong ones the first to be named comes first. The neutral family counts only where no other is named: a modern
    beach house is a beach house.
    """
    votes: dict[str, list[int]] = {}
    for k, word in enumerate(words):
        for name in word.families if not negated[k] else ():
            votes.setdefault(name, []).append(k)
    strong = {name: at for name, at in votes.items() if name != NEUTRAL and any(words[k].lemma not in HINTS for k in at)}
    lone = {name: at for name, at in votes.items() if name != NEUTRAL and any(words[k].lemma in HINTS for k in at)}
    bare = {name: at for name, at in lone.items() if not all(words[k].lemma in METALS for k in at)}
    chosen = strong or bare or {name: at for name, at in votes.items() if name == NEUTRAL}
    ranked = sorted(chosen, key=lambda name: (-len(chosen[name]), chosen[name][0]))
    places = [name for name in ranked if FAMILIES[name].place]
    styles = [name for name in ranked if not FAMILIES[name].place]
    ranked = [places[0], styles[0]] if places and styles else ranked[:2]
    total = sum(len(chosen[name]) for name in ranked)
    return tuple((name, len(chosen[name]) / total) for name in ranked)


METALS = frozenset({"brass", "copper", "clock"})
"""Hints that make no family of their own even where none other is named: a kitchen with copper pans is just a kitchen."""


def toned(code: str, tone: str) -> str:
    """A colour made darker, paler or purer by a word of TONES or VIVID."""
    if tone in TONES:
        other, share = TONES[tone]
        return hex_code(mix_rgb(rgb(code), rgb(other), share))
    if tone in VIVID:
        hue, light, saturation = colorsys.rgb_to_hls(*rgb(code))
        return hex_code(colorsys.hls_to_rgb(hue, min(max(light, 0.45), 0.6), min(saturation * 1.6, 1.0)))
    return code


def _phrases(words: list[Word], used: set[int]) -> list[str]:
    """Used words as they were written, neighbours in one phrase; words without meaning are kept between used ones."""
    phrases: list[list[int]] = []
    for k in sorted(used):
        previous = phrases[-1][-1] if phrases else -9
        between = words[previous + 1 : k] if previous >= 0 else []
        close = previous >= 0 and not any(word.ends for word in words[previous:k])
        if close and all(word.lemma in FILLERS and word.lemma not in ("and", "with", "at", "in") for word in between):
            phrases[-1] += range(previous + 1, k + 1)
        else:
            phrases.append([k])
    return [" ".join(words[k].text for k in phrase) for phrase in phrases]
