"""The shell of a building as a theme describes it: sizes of rooms, ceilings, doors, windows, passages."""

import dataclasses

import numpy as np

from wm.offline.style.lexicon import Word, negated, words_of


@dataclasses.dataclass(frozen=True)
class Building:
    """Parameters of the shell. Lengths in metres; ranges are (low, high)."""

    share: tuple[float, float]  # range of the share at which a room's area lies in the range of its kind
    ceiling: tuple[float, float]
    lofty: float  # by how much a hall may be higher than the other rooms
    corridor: tuple[float, float]  # width between wall centre lines
    door: tuple[float, float]  # width, height
    openness: float  # probability of a passage instead of a door between two rooms that may be open to each other
    window: tuple[float, float]  # width
    sill: float
    head: float  # height of the lintel above the floor; lower under a low ceiling
    spacing: float  # metres of wall between two windows


_PLAIN = Building(
    share=(0.15, 0.75),
    ceiling=(2.6, 2.9),
    lofty=0.3,
    corridor=(1.5, 1.7),
    door=(0.9, 2.1),
    openness=0.5,
    window=(1.2, 1.6),
    sill=0.9,
    head=2.3,
    spacing=1.0,
)

# A later row overrides earlier ones, so rows of size words come before rows of style words.
_WORDS: tuple[tuple[str, dict], ...] = (
    ("mansion estate palace castle manor villa chateau cathedral temple grand opulent stately",
     {"share": (0.5, 1.0), "ceiling": (3.2, 3.6), "lofty": 0.6, "corridor": (1.8, 2.2), "head": 2.7}),
    ("cabin cottage hut tiny bungalow shack burrow den cosy cozy snug",
     {"share": (0.0, 0.35), "ceiling": (2.4, 2.5), "lofty": 0.0, "corridor": (1.5, 1.5), "window": (0.9, 1.2), "sill": 0.95,
      "head": 2.05}),
    ("submarine spaceship capsule igloo cave ship pirate galleon burrow bunker dungeon prison",
     {"ceiling": (2.4, 2.6), "lofty": 0.1, "window": (0.8, 1.1), "sill": 1.1, "head": 2.0}),
    ("scandinavian nordic swedish danish norwegian finnish japanese japandi minimal minimalist",
     {"openness": 0.65, "window": (1.4, 1.8), "sill": 0.7, "head": 2.25}),
    ("modern contemporary beach coastal loft futuristic pavilion conservatory aquarium",
     {"openness": 0.8, "window": (1.8, 2.6), "sill": 0.1, "head": 2.5, "spacing": 0.8}),
    ("gothic medieval victorian baroque haunted",
     {"openness": 0.35, "door": (1.0, 2.4), "window": (1.0, 1.3), "sill": 0.7, "head": 2.9, "spacing": 1.2}),
    ("roman greek classical mediterranean tuscan moorish pompeian",
     {"openness": 0.5, "door": (1.0, 2.4), "window": (1.0, 1.4), "sill": 1.0, "head": 2.6, "spacing": 1.3}),
)  # fmt: skip


def building_of(theme: str) -> Building:
    """The shell for a theme. Words that are not in the table are ignored."""
    words = {word.lemma for word in building_words(theme)}
    building = _PLAIN
    for keys, changes in _WORDS:
        if words & set(keys.split()):
            building = dataclasses.replace(building, **changes)
    return building


def building_words(theme: str) -> list[Word]:
    """The words of a theme that speak of the shell: not those that are negated, nor those of furniture ("a modern sofa")."""
    words = words_of(theme)
    known = {key for keys, _ in _WORDS for key in keys.split()}
    reached = negated(words)
    after = [*words[1:], None]
    of_furniture = [bool(word is not None and word.target) and not here.ends for here, word in zip(words, after)]
    return [word for word, no, yes in zip(words, reached, of_furniture) if word.lemma in known and not no and not yes]


def draw(interval: tuple[float, float], rng: np.random.Generator) -> float:
    """A uniform sample from an interval in metres, rounded to 5 cm."""
    return round(float(rng.uniform(*interval)) * 20) / 20
