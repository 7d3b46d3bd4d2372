"""The tables of a study: results.md for people, CSV files for programs.

    results.md         everything, with the paper's figures beside ours
    ratings.csv        mean and interval of every method and question
    preferences.csv    share and interval of every pair of methods
    agreement.csv      Krippendorff's alpha of every question
    participants.csv   who is counted, and who is not and why
    answers.csv        every rating and preference that is counted, one a line, with methods and scenes

The same answers give the same bytes.
"""

import csv
import io
import math
import pathlib
from collections.abc import Iterable, Sequence
from typing import Any

from tabulate import tabulate

from wm.artifacts.atomic import write_atomically
from wm.metric_table import MISSING
from wm.study.analysis import Findings
from wm.study.folder import Study
from wm.study.intervals import Estimate
from wm.study.paper_study import paper_preference, paper_rating


def write_results(study: Study, found: Findings, output: pathlib.Path) -> None:
    """Writes all tables into a folder; the same answers give the same bytes.

    Raises:
      OSError: the folder cannot be written.
    """
    write_atomically(output / "results.md", _page(study, found))
    for name, (head, rows) in _csv_tables(study, found).items():
        write_atomically(output / f"{name}.csv", _csv(head, rows))


def _page(study: Study, found: Findings) -> str:
    excluded = len(found.excluded)
    counted = f"{found.counted} participant{' is' if found.counted == 1 else 's are'} counted"
    others = f"{excluded} failed an attention check and {'is' if excluded == 1 else 'are'} not"
    parts = [f"# {study.questions.title}", f"{counted}; {others}. Brackets are 95 % intervals."]
    if study.questions.ratings:
        parts += ["## Ratings", _ratings_table(study, found), _ratings_words(found)]
    if study.questions.preference:
        parts += ["## Preferences", _preferences_table(study, found), _preferences_words(found)]
    parts += ["## Agreement", _agreement_table(found), _AGREEMENT_WORDS]
    if found.excluded:
        parts += [
            "## Not counted",
            _table(("participant", "reason"), [(sheet.participant, why) for sheet, why in found.excluded]),
        ]
    return "\n\n".join(parts) + "\n"


def _ratings_table(study: Study, found: Findings) -> str:
    questions = study.questions.ratings
    with_paper = any(_paper(study, method, question.id) is not None for method in study.methods for question in questions)
    head = ["method"]
    for question in questions:
        head += [question.title, "paper"] if with_paper else [question.title]
    rows = []
    for method in study.methods:
        row, most = [method], 0
        for question in questions:
            estimate = found.ratings[method, question.id]
            row += [_interval(estimate, "{:.2f}")] + (
                [_figure(_paper(study, method, question.id), "{:.2f}")] if with_paper else []
            )
            most = max(most, estimate.answers)
        rows.append([*row, most])
    return _table([*head, "answers"], rows)


def _paper(study: Study, method: str, question: str) -> float | None:
    return paper_rating(study.questions.paper, method, question, reference=method == study.reference)


def _ratings_words(found: Findings) -> str:
    words = "Means of 1 to 5, higher is better. Intervals: expanded percentiles of"
    return f"{words} {found.resamples} bootstrap samples of participants."


def _preferences_table(study: Study, found: Findings) -> str:
    rows = [
        (
            first,
            second,
            _interval(estimate, "{:.1f}", 100.0),
            _figure(_paper_share(study, second), "{:.1f}", 100.0),
            estimate.answers,
        )
        for (first, second), estimate in found.preferences.items()
    ]
    shares = [estimate.value for estimate in found.preferences.values() if estimate.answers]
    if study.questions.pairs == "reference" and shares:
        papers = [_paper_share(study, second) for _, second in found.preferences]
        known = [share for share in papers if share is not None]
        paper = _figure(sum(known) / len(known) if len(known) == len(papers) else None, "{:.1f}", 100.0)
        rows.append((study.reference, "mean of these", f"{100 * sum(shares) / len(shares):.1f}", paper, len(found.chosen)))
    return _table(("method", "against", "preferred (%)", "paper", "answers"), rows)


def _paper_share(study: Study, method: str) -> float | None:
    """The paper compares with its own method only."""
    return paper_preference(study.questions.paper, method) if study.questions.pairs == "reference" else None


def _preferences_words(found: Findings) -> str:
    words = "Intervals are exact (Clopper and Pearson)."
    if any(estimate.answers > estimate.participants for estimate in found.preferences.values()):
        words += (
            " Some participants judged a pair of methods in several scenes. The intervals take these answers as independent, and"
        )
        words += " are too narrow where they are not."
    share = _interval(found.left, "{:.1f}", 100.0)
    return f"{words} The left video was chosen in {share} % of all pairs; 50 % is no preference of a side."


def _agreement_table(found: Findings) -> str:
    rows = [(row.question, row.level, _figure(row.alpha, "{:.3f}"), row.units) for row in found.agreement]
    return _table(("question", "level", "Krippendorff's alpha", "judged twice or more"), rows)


_AGREEMENT_WORDS = (
    "1 is perfect agreement, 0 that of answers shuffled at random. Krippendorff draws tentative conclusions from 0.667 on and "
    "firm ones from 0.8. A dash: undefined, since nothing was judged twice or all answers are the same."
)


def _csv_tables(study: Study, found: Findings) -> dict[str, tuple[Sequence[str], Sequence[Sequence[Any]]]]:
    interval = ("low", "high", "answers", "participants", "paper")
    ratings = [
        (method, question, *_numbers(estimate), _paper(study, method, question))
        for (method, question), estimate in found.ratings.items()
    ]
    preferences = [
        (first, second, *_numbers(estimate), _paper_share(study, second))
        for (first, second), estimate in found.preferences.items()
    ]
    agreement = [(row.question, row.level, _rounded(row.alpha), row.units) for row in found.agreement]
    people = [(sheet.participant, sheet.slot + 1, "yes", "") for sheet in found.sheets]
    people += [(sheet.participant, sheet.slot + 1, "no", reason) for sheet, reason in found.excluded]
    answers = [(r.participant, "rating", r.question, r.scene, r.method, "", "", r.value) for r in found.rated]
    answers += [(c.participant, "preference", "preference", c.scene, c.chosen, c.other, c.side, 1) for c in found.chosen]
    return {
        "ratings": (("method", "question", "mean", *interval), ratings),
        "preferences": (("method", "against", "share", *interval), preferences),
        "agreement": (("question", "level", "alpha", "units"), agreement),
        "participants": (("participant", "session", "counted", "reason"), people),
        "answers": (("participant", "kind", "question", "scene", "method", "against", "side", "value"), answers),
    }


def _numbers(estimate: Estimate) -> tuple[Any, ...]:
    return (
        *(_rounded(value) for value in (estimate.value, estimate.low, estimate.high)),
        estimate.answers,
        estimate.participants,
    )


def _rounded(value: float | None) -> float | None:
    return None if value is None or math.isnan(value) else round(value, 6)


def _interval(estimate: Estimate, form: str, factor: float = 1.0) -> str:
    if math.isnan(estimate.low):
        return _figure(estimate.value, form, factor)
    return (
        f"{_figure(estimate.value, form, factor)} [{_figure(estimate.low, form, factor)}, {_figure(estimate.high, form, factor)}]"
    )


def _figure(value: float | None, form: str, factor: float = 1.0) -> str:
    return MISSING if value is None or math.isnan(value) else form.format(factor * value)


def _table(head: Sequence[str], rows: Iterable[Sequence[Any]]) -> str:
    safe = [[str(cell).replace("|", "\\|") for cell in row] for row in rows]
    return tabulate(safe, [*head], tablefmt="github", disable_numparse=True)


def _csv(head: Sequence[str], rows: Iterable[Sequence[Any]]) -> str:
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(head)
    writer.writerows(rows)
    return text.getvalue()
