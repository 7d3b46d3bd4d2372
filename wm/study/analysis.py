"""All figures of a study: ratings, preferences, agreement of raters, sides."""

from collections import defaultdict
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations

from wm.study.agreement import krippendorff_alpha
from wm.study.answers import ReadAnswers, Sheet
from wm.study.attention import failed_check
from wm.study.folder import Study
from wm.study.intervals import Estimate, bootstrapped_mean, exact_share
from wm.study.tallies import Choice, Rating, choices_of, ratings_of


@dataclass(frozen=True)
class RaterAgreement:
    """How far the answers to one question agree."""

    question: str
    level: str  # "ordinal" or "nominal"
    alpha: float | None
    units: int  # videos or pairs that at least two participants have judged


@dataclass(frozen=True)
class Findings:
    """What a study has found."""

    sheets: tuple[Sheet, ...]  # of the participants that are counted
    excluded: tuple[tuple[Sheet, str], ...]  # with the reason
    ratings: dict[tuple[str, str], Estimate]  # by method and question
    preferences: dict[tuple[str, str], Estimate]  # share that chose the first of two methods
    agreement: tuple[RaterAgreement, ...]
    left: Estimate  # share of the pairs in which the left video was chosen: 0.5 where sides do not matter
    rated: tuple[Rating, ...]
    chosen: tuple[Choice, ...]
    resamples: int  # of the bootstrap

    @property
    def counted(self) -> int:
        """Participants that are counted."""
        return len(self.sheets)


def analyse(study: Study, read: ReadAnswers, *, seed: int = 0, resamples: int = 10_000) -> Findings:
    """The figures of a study from what its participants answered.

    Args:
      study: what was asked.
      read: the participants' answers.
      seed: of the bootstrap.
      resamples: of the bootstrap.
    """
    judged = [(sheet, failed_check(study, sheet)) for sheet in read.sheets]
    sheets = tuple(sheet for sheet, reason in judged if reason is None)
    rated, chosen = ratings_of(study, sheets), choices_of(study, sheets)
    return Findings(
        sheets=sheets,
        excluded=tuple((sheet, reason) for sheet, reason in judged if reason is not None),
        ratings=_ratings(study, rated, seed, resamples),
        preferences={pair: _preference(chosen, *pair) for pair in _pairs(study)},
        agreement=(*_rating_agreement(study, rated), *_choice_agreement(study, chosen)),
        left=exact_share(sum(choice.side == "left" for choice in chosen), len(chosen), _participants(chosen)),
        rated=tuple(rated),
        chosen=tuple(chosen),
        resamples=resamples,
    )


def _ratings(study: Study, rated: Sequence[Rating], seed: int, resamples: int) -> dict[tuple[str, str], Estimate]:
    answers = defaultdict(list)
    for rating in rated:
        answers[rating.method, rating.question].append((rating.participant, float(rating.value)))
    cells = [(method, question.id) for method in study.methods for question in study.questions.ratings]
    return {cell: bootstrapped_mean(answers[cell], seed=seed, resamples=resamples) for cell in cells}


def _pairs(study: Study) -> list[tuple[str, str]]:
    if not study.questions.preference:
        return []
    if study.questions.pairs == "all":
        return list(combinations(study.methods, 2))
    return [(study.reference, method) for method in study.methods if method != study.reference]


def _preference(chosen: Sequence[Choice], first: str, second: str) -> Estimate:
    between = [choice for choice in chosen if {choice.chosen, choice.other} == {first, second}]
    return exact_share(sum(choice.chosen == first for choice in between), len(between), _participants(between))


def _participants(chosen: Sequence[Choice]) -> int:
    return len({choice.participant for choice in chosen})


def _rating_agreement(study: Study, rated: Sequence[Rating]) -> list[RaterAgreement]:
    units: dict[str, dict[tuple[str, str], list[int]]] = defaultdict(lambda: defaultdict(list))
    for rating in rated:
        units[rating.question][rating.method, rating.scene].append(rating.value)
    found = []
    for question in study.questions.ratings:
        values = list(units[question.id].values())
        found.append(
            RaterAgreement(question.id, "ordinal", krippendorff_alpha(values, "ordinal"), sum(len(v) > 1 for v in values))
        )
    return found


def _choice_agreement(study: Study, chosen: Sequence[Choice]) -> list[RaterAgreement]:
    """Over pairs of videos, with the one that was chosen as the value.

    Each pair stands twice, with its videos named in either order, so that no name is the usual one: chance is then a choice by
    lot, and a method that nearly everybody prefers gives agreement and not, as the more frequent of two values would, none.
    """
    if not study.questions.preference:
        return []
    units: dict[tuple[str, ...], list[int]] = defaultdict(list)
    for choice in chosen:
        units[choice.scene, *sorted((choice.chosen, choice.other))].append(int(choice.chosen < choice.other))
    values = list(units.values())
    both = [*values, *([1 - value for value in unit] for unit in values)]
    return [RaterAgreement("preference", "nominal", krippendorff_alpha(both, "nominal"), sum(len(v) > 1 for v in values))]
