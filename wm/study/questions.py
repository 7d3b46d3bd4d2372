"""What is asked in a study: a ready set (comparison, ablation), or a YAML or JSON file of the same keys (docs/study.md)."""

import difflib
import importlib.resources
import pathlib
from collections.abc import Mapping
from dataclasses import MISSING, asdict, dataclass, fields
from typing import Any, TypeVar

import yaml

from wm.errors import InputError

READY = ("ablation", "comparison")
"""Question sets that come with wm."""
POINTS = (1, 2, 3, 4, 5)
"""The answers of a rating."""


@dataclass(frozen=True)
class RatingQuestion:
    """A question about one video, answered with 1 to 5."""

    id: str  # in the answers and the tables of results
    title: str
    question: str
    low: str = "very poor"  # what 1 means
    high: str = "excellent"  # what 5 means


@dataclass(frozen=True)
class Checks:
    """Attention checks of one participant, by kind; see wm.study.attention for when one is failed."""

    ratings: int = 1  # pages that say which number to choose
    pairs: int = 1  # pages that say which of two videos to choose
    repeats: int = 1  # videos that are rated a second time
    tolerance: float = 2.0  # points by which the second rating may differ, on average over the questions


@dataclass(frozen=True)
class QuestionSet:
    """All that is said and asked in a study."""

    title: str
    consent: tuple[str, ...]  # paragraphs, shown before anything else
    ratings: tuple[RatingQuestion, ...] = ()
    preference: str = ""  # the question about two videos; "" for a study without pairs
    pairs: str = "reference"  # "reference": each method against the reference; "all": each against each
    thanks: str = "Thank you. You have answered everything."
    send_to: str = "Please send this file to the person who invited you."  # where there is no server
    must_watch: bool = True  # a video has to be seen to its end before its page can be left
    checks: Checks = Checks()
    paper: str = ""  # whose figures stand beside ours: "comparison", "ablation" or ""

    def as_json(self) -> dict[str, Any]:
        """The set as JSON has it."""
        return asdict(self)


Record = TypeVar("Record", RatingQuestion, Checks, QuestionSet)


def read_questions(name: str) -> QuestionSet:
    """A question set by the name of a ready one, or from a file.

    Raises:
      InputError: there is no such file, or it is not what a question set is; the message names the key.
    """
    if name in READY:
        text, place = (importlib.resources.files("wm.study") / "sets" / f"{name}.yaml").read_text(encoding="utf-8"), name
    else:
        text, place = _text(pathlib.Path(name)), name
    try:
        values = yaml.safe_load(text)  # JSON is YAML
    except (yaml.YAMLError, RecursionError) as error:
        where = getattr(error, "problem_mark", None)
        line = f" in line {where.line + 1}" if where is not None else ""
        raise InputError(f"questions={place}: the file is neither YAML nor JSON{line}") from error
    return questions_from(values, place=f"questions={place}")


def questions_from(values: Any, *, place: str) -> QuestionSet:
    """A question set from its JSON.

    Raises:
      InputError: a key is missing, unknown or of another type; the message begins with `place`.
    """
    given = dict(_mapping(values, place))
    consent = given.get("consent", ())
    given["consent"] = (consent,) if isinstance(consent, str) else consent
    asked = given.get("ratings") or ()
    if not isinstance(asked, list | tuple):
        raise InputError(f"{place}: ratings is a list of questions")
    given["ratings"] = tuple(_record(RatingQuestion, value, f"{place}: ratings[{n}]") for n, value in enumerate(asked))
    given["checks"] = _record(Checks, given.get("checks") or {}, f"{place}: checks")
    found = _record(QuestionSet, given, place)
    _held_to_the_rules(found, place)
    return found


def _held_to_the_rules(found: QuestionSet, place: str) -> None:
    ids = [question.id for question in found.ratings]
    if len(set(ids)) < len(ids):
        raise InputError(f"{place}: two ratings have the same id ({', '.join(ids)})")
    if not found.ratings and not found.preference:
        raise InputError(f"{place}: nothing is asked; it needs ratings, a preference, or both")
    if found.pairs not in ("reference", "all"):
        raise InputError(f"{place}: pairs is reference or all, not {found.pairs}")
    if found.paper not in ("", *READY):
        raise InputError(f"{place}: paper is {' or '.join(READY)}, or left out, not {found.paper}")
    if min(found.checks.ratings, found.checks.pairs, found.checks.repeats, found.checks.tolerance) < 0:
        raise InputError(f"{place}: a number of checks is at least 0")


def _record(kind: type[Record], values: Any, place: str) -> Record:
    given, known = _mapping(values, place), {field.name: field for field in fields(kind)}
    for key, value in given.items():
        if key not in known:
            near = difflib.get_close_matches(str(key), known, n=1)
            raise InputError(
                f"{place}: no key {key}" + (f"; did you mean {near[0]}?" if near else f"; it has {', '.join(known)}")
            )
        if not _fits(value, known[key].type):
            raise InputError(f"{place}: {key} is not {value!r}; it wants {_WANTED.get(str(known[key].type), 'text')}")
    missing = [name for name, field in known.items() if name not in given and field.default is MISSING]
    if missing or (kind is QuestionSet and not given["consent"]):
        raise InputError(f"{place}: {', '.join(missing or ['consent'])} is missing")
    return kind(**{key: _as_field(value, known[key].type) for key, value in given.items()})


_WANTED = {
    str(bool): "true or false",
    str(int): "a whole number",
    str(float): "a number",
    str(tuple[str, ...]): "text, or a list of texts",
}


def _as_field(value: Any, kind: Any) -> Any:
    """JSON has lists for tuples, and 1 for 1.0."""
    return tuple(value) if isinstance(value, list) else float(value) if kind is float else value


def _fits(value: Any, kind: Any) -> bool:
    if kind is str:
        return isinstance(value, str)
    if kind is bool:
        return isinstance(value, bool)
    if kind is int:
        return isinstance(value, int) and not isinstance(value, bool)
    if kind is float:
        return isinstance(value, int | float) and not isinstance(value, bool)
    if kind == tuple[str, ...]:
        return isinstance(value, list | tuple) and all(isinstance(item, str) for item in value)
    return True  # a record, read before


def _mapping(values: Any, place: str) -> Mapping[str, Any]:
    if not isinstance(values, Mapping):
        raise InputError(f"{place}: it has keys and values, see docs/study.md")
    return values


def _text(path: pathlib.Path) -> str:
    try:
        return path.read_text(encoding="utf-8")
    except FileNotFoundError as error:
        raise InputError(f"questions={path}: no such file; ready sets are {' and '.join(READY)}") from error
    except (OSError, UnicodeDecodeError) as error:
        raise InputError(f"questions={path}: the file cannot be read ({error})") from error
