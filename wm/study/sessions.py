"""The pages of each participant: videos to rate, then pairs to compare, with attention checks among them."""

import random
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from itertools import combinations
from typing import Any

from wm.errors import InputError
from wm.study.balance import Sides, dealt
from wm.study.questions import POINTS, QuestionSet

_FEWEST_BEFORE_A_REPEAT = 4
"""Rated videos below which none is shown again: it would be remembered."""


@dataclass(frozen=True)
class Trial:
    """One page."""

    videos: tuple[str, ...]  # names: one to rate, or the left and the right one of a pair
    check: int | str | None = None  # the answer that the page asks for: a number, "left" or "right"
    repeat: bool = False  # the video was rated before; this rating is compared with the first and not counted

    @property
    def is_pair(self) -> bool:
        """Whether two videos are compared."""
        return len(self.videos) == 2

    def as_json(self) -> dict[str, Any]:
        """The page as JSON has it; what is not said is left out."""
        return {key: value for key, value in asdict(self).items() if value not in (None, False)}


@dataclass(frozen=True)
class StudyPlan:
    """How many sessions, and how long they are. None: two videos of each method; every pair of methods once."""

    participants: int = 60
    ratings: int | None = None
    pairs: int | None = None
    reference: str | None = None  # the method that others are compared with; None: "ours", or else the first
    seed: int = 0


def reference_of(methods: Sequence[str], plan: StudyPlan) -> str:
    """The method that the others are compared with.

    Raises:
      InputError: the plan names a method that is not there.
    """
    if plan.reference is not None:
        if plan.reference not in methods:
            raise InputError(f"reference={plan.reference}: the methods are {', '.join(methods)}")
        return plan.reference
    return next((method for method in methods if method.lower() == "ours"), methods[0])


def plan_sessions(names: Mapping[str, Mapping[str, str]], questions: QuestionSet, plan: StudyPlan) -> list[list[Trial]]:
    """The pages of every session, the same for the same arguments.

    Args:
      names: of each method, its videos' names by scene; every method has every scene.
      questions: what is asked, and how many checks.
      plan: how many sessions and how long.

    Raises:
      InputError: more videos or pairs are asked for than there are, or a study of pairs has one method.
    """
    rng = random.Random(f"wm.study {plan.seed}")
    rated = _rated(names, questions, plan, rng)
    compared = _compared(names, questions, plan, rng)
    return [[*_with_checks(one, questions, rng), *_with_side_checks(two, questions, rng)] for one, two in zip(rated, compared)]


def _rated(
    names: Mapping[str, Mapping[str, str]], questions: QuestionSet, plan: StudyPlan, rng: random.Random
) -> list[list[Trial]]:
    strata = [tuple(scenes.values()) for scenes in names.values()] if questions.ratings else []
    each = _length("ratings", plan.ratings, 2 * len(strata), sum(map(len, strata)), at_least=int(bool(strata)))
    hands = dealt(strata, each, plan.participants, rng)
    return [[Trial((name,)) for name in rng.sample(hand, len(hand))] for hand in hands]


def _compared(
    names: Mapping[str, Mapping[str, str]], questions: QuestionSet, plan: StudyPlan, rng: random.Random
) -> list[list[Trial]]:
    couples: list[tuple[str, str]] = []
    if questions.preference:
        if len(names) < 2:
            raise InputError("pairs need two methods; give a second METHOD=PATH, or questions without a preference")
        methods = list(names)
        reference = reference_of(methods, plan)
        against = [(reference, method) for method in methods if method != reference]
        couples = against if questions.pairs == "reference" else list(combinations(methods, 2))
    strata = [tuple((names[first][scene], names[second][scene]) for scene in names[first]) for first, second in couples]
    each = _length("pairs", plan.pairs, len(strata), sum(map(len, strata)), at_least=int(bool(strata)))
    sides = Sides(strata, rng)
    sessions = []
    for hand in dealt(strata, each, plan.participants, rng):
        mixed = rng.sample(hand, len(hand))
        sessions.append([Trial(card if sides.next_left(card) else card[::-1]) for card in mixed])
    return sessions


def _length(key: str, asked: int | None, default: int, most: int, *, at_least: int) -> int:
    number = min(default, most) if asked is None else asked
    if not at_least <= number <= most:
        raise InputError(f"{key}={number}: a participant can see {at_least} to {most}")
    return number


def _with_checks(trials: list[Trial], questions: QuestionSet, rng: random.Random) -> list[Trial]:
    """Ratings with a few of the first third again at the end, and pages that say what to choose anywhere but at the beginning."""
    if not trials:
        return []
    found = list(trials)
    if len(trials) >= _FEWEST_BEFORE_A_REPEAT:
        early = trials[: max(1, len(trials) // 3)]
        again = rng.sample(early, min(questions.checks.repeats, len(early)))
        found += [Trial(trial.videos, repeat=True) for trial in again]
    for _ in range(questions.checks.ratings):
        told = Trial(rng.choice(trials).videos, check=rng.choice(POINTS))
        found.insert(rng.randint(1, len(found)), told)
    return found


def _with_side_checks(trials: list[Trial], questions: QuestionSet, rng: random.Random) -> list[Trial]:
    found = list(trials)
    for _ in range(questions.checks.pairs if trials else 0):
        told = Trial(rng.choice(trials).videos, check=rng.choice(("left", "right")))
        found.insert(rng.randint(1, len(found)), told)
    return found
