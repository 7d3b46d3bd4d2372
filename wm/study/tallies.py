"""Answers with the methods behind the videos, without attention checks and second ratings."""

from collections.abc import Iterable
from dataclasses import dataclass

from wm.study.answers import Sheet
from wm.study.folder import Study


@dataclass(frozen=True)
class Rating:
    """One number for one question about one video."""

    participant: str
    method: str
    scene: str
    question: str
    value: int


@dataclass(frozen=True)
class Choice:
    """One preference among two videos of a scene."""

    participant: str
    scene: str
    chosen: str  # method
    other: str  # method
    side: str  # of the chosen one: "left" or "right"


def ratings_of(study: Study, sheets: Iterable[Sheet]) -> list[Rating]:
    """Every rating that counts."""
    found = []
    for sheet in sheets:
        for trial, answer in sheet.with_trials(study):
            if answer.ratings is not None and trial.check is None and not trial.repeat:
                method, scene = study.videos[trial.videos[0]]
                found += [Rating(sheet.participant, method, scene, question, value) for question, value in answer.ratings.items()]
    return found


def choices_of(study: Study, sheets: Iterable[Sheet]) -> list[Choice]:
    """Every preference that counts."""
    found = []
    for sheet in sheets:
        for trial, answer in sheet.with_trials(study):
            if answer.choice is not None and trial.check is None:
                (left, scene), (right, _) = (study.videos[name] for name in trial.videos)
                chosen, other = (left, right) if answer.choice == "left" else (right, left)
                found.append(Choice(sheet.participant, scene, chosen, other, answer.choice))
    return found
