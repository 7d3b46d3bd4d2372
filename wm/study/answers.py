"""Files of answers, each counted once or refused with a reason."""

import json
import pathlib
import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from wm.errors import InputError
from wm.study.folder import VERSION, Study
from wm.study.questions import POINTS
from wm.study.sessions import Trial

LARGEST = 1 << 20
"""Bytes of one participant's answers; a file beyond it is something else."""


@dataclass(frozen=True)
class Answer:
    """What was answered on one page; all None where the video could not be played."""

    ratings: Mapping[str, int] | None  # by question
    choice: str | None  # "left" or "right"


@dataclass(frozen=True)
class Sheet:
    """The answers of one participant, one a page of the session."""

    participant: str
    file: str
    slot: int
    answers: tuple[Answer, ...]

    def with_trials(self, study: Study) -> list[tuple[Trial, Answer]]:
        """Each page with what was answered on it."""
        return list(zip(study.sessions[self.slot], self.answers))


@dataclass(frozen=True)
class ReadAnswers:
    """What was found in the files."""

    sheets: tuple[Sheet, ...]
    refused: tuple[str, ...]  # a line for each file that is not counted


class _Refused(Exception):
    """Why a file is not counted."""


def read_answers(study: Study, places: Sequence[pathlib.Path]) -> ReadAnswers:
    """The answers in files and in folders of JSON files; a participant is counted once, whatever is given twice.

    Files go by path, and of several of one participant the first is counted.

    Raises:
      InputError: a place is neither a file nor a folder.
    """
    sheets: dict[str, Sheet] = {}
    refused: list[str] = []
    for file in _files(places):
        try:
            sheet = _sheet(study, file)
            if (first := sheets.get(sheet.participant)) is not None:
                same = "the same answers as" if first.answers == sheet.answers else "other answers of the participant in"
                raise _Refused(f"{same} {first.file}")
            sheets[sheet.participant] = sheet
        except _Refused as reason:
            refused.append(f"{file}: not counted: {reason}")
    return ReadAnswers(tuple(sheets.values()), tuple(refused))


def _files(places: Iterable[pathlib.Path]) -> list[pathlib.Path]:
    found: dict[pathlib.Path, pathlib.Path] = {}
    for place in places:
        if not place.exists():
            raise InputError(f"{place}: no file or folder of answers is there")
        for file in sorted(place.rglob("*.json")) if place.is_dir() else [place]:
            found.setdefault(file.resolve(), file)
    return sorted(found.values())


def _sheet(study: Study, file: pathlib.Path) -> Sheet:
    values = _values(file)
    if values.get("study") != study.id:
        raise _Refused("it answers another study" if isinstance(values.get("study"), str) else "it is no file of answers")
    participant, slot, given = values.get("participant"), values.get("slot"), values.get("answers")
    if values.get("version") != VERSION or not (isinstance(participant, str) and re.fullmatch(r"[0-9a-f]{32}", participant)):
        raise _Refused("its version or participant is not as the page writes it")
    if type(slot) is not int or not 0 <= slot < len(study.sessions) or not isinstance(given, list):
        raise _Refused("its slot or answers are not as the page writes them")
    trials = study.sessions[slot]
    if len(given) != len(trials):
        raise _Refused(f"it has {len(given)} of {len(trials)} pages")
    questions = {question.id for question in study.questions.ratings}
    return Sheet(
        participant, str(file), slot, tuple(_answer(n, *both, questions) for n, both in enumerate(zip(trials, given), 1))
    )


def _values(file: pathlib.Path) -> dict[str, Any]:
    try:
        if file.stat().st_size > LARGEST:
            raise _Refused("it is too large for a file of answers")
        values = json.loads(file.read_bytes())
    except (ValueError, RecursionError) as error:
        raise _Refused("it is broken, no JSON") from error
    except OSError as error:
        raise _Refused(f"it cannot be read ({error.strerror})") from error
    if not isinstance(values, dict):
        raise _Refused("it is no file of answers")
    return values


def _answer(page: int, trial: Trial, given: Any, questions: set[str]) -> Answer:
    if not isinstance(given, dict):
        raise _Refused(f"page {page} is not as the page writes it")
    if given.get("unseen") is True:
        return Answer(None, None)
    if trial.is_pair:
        if given.get("choice") not in ("left", "right"):
            raise _Refused(f"page {page} has no choice of left or right")
        return Answer(None, given["choice"])
    ratings = given.get("ratings")
    if (
        not isinstance(ratings, dict)
        or set(ratings) != questions
        or not all(type(v) is int and v in POINTS for v in ratings.values())
    ):
        raise _Refused(f"page {page} has not a number from 1 to 5 for every question")
    return Answer(ratings, None)
