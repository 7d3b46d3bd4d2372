"""The figures of a study whose answers are known, and the tables that are written of them."""

import collections
import csv

import pytest

from tests.study.clips import answers, hand_in
from wm.study.analysis import analyse
from wm.study.answers import read_answers
from wm.study.paper_study import PAPER_PREFERENCES, PAPER_RATINGS, paper_preference, paper_rating
from wm.study.results import write_results

LEVELS = {"ours": 5, "WonderWorld": 2, "FlexWorld": 3}


def prefers_ours(left, right):
    return "left" if left == "ours" else "right"


def prefers_other(left, right):
    return "right" if left == "ours" else "left"


def answered(study, *, careless=(), against=()):
    """Six participants who rate by LEVELS; some of them prefer the other method, some fail a check."""
    for number in range(6):
        given = answers(study, number, number, lambda m, s: LEVELS[m], prefers_other if number in against else prefers_ours)
        if number in careless:
            page = next(n for n, trial in enumerate(study.sessions[number]) if trial.check is not None)
            given["answers"][page] = {"ratings": {"quality": 1, "objects": 2, "structure": 3}}
        hand_in(study, given)
    return analyse(study, read_answers(study, [study.folder / "answers"]), resamples=200)


def table(path):
    with path.open() as file:
        return list(csv.DictReader(file))


def test_means_and_shares_are_those_of_the_answers(study):
    found = answered(study, against=(4,))
    for (method, _), estimate in found.ratings.items():
        assert (estimate.value, estimate.low, estimate.high) == (LEVELS[method],) * 3
        assert estimate.participants == 6 and estimate.answers == 12
    assert {pair: (e.value, e.answers) for pair, e in found.preferences.items()} == {
        ("ours", "WonderWorld"): (pytest.approx(5 / 6), 6),
        ("ours", "FlexWorld"): (pytest.approx(5 / 6), 6),
    }


def test_checks_and_second_ratings_are_not_among_the_answers(study):
    found = answered(study)
    assert len(found.rated) == 6 * 6 * 3 and len(found.chosen) == 6 * 2
    assert len({(r.participant, r.method, r.scene, r.question) for r in found.rated}) == len(found.rated)


def test_agreement_is_perfect_where_all_answer_alike(study):
    found = answered(study)
    assert [(row.question, row.level) for row in found.agreement] == [
        ("quality", "ordinal"), ("objects", "ordinal"), ("structure", "ordinal"), ("preference", "nominal"),
    ]  # fmt: skip
    assert [row.alpha for row in found.agreement] == pytest.approx([1, 1, 1, 1])


def test_agreement_on_pairs_is_that_of_choices_by_lot_whichever_method_is_usual(study):
    """One of six prefers the other methods. By hand: pairs of answers that differ, against half of all pairs."""
    found = answered(study, against=(4,)).agreement[3]
    per_unit = collections.defaultdict(list)
    for choice in answered(study, against=(4,)).chosen:
        per_unit[choice.scene, frozenset((choice.chosen, choice.other))].append(choice.chosen == "ours")
    differing = sum(2 * sum(u) * (len(u) - sum(u)) / (len(u) - 1) for u in per_unit.values())
    answers_twice = 2 * sum(map(len, per_unit.values()))
    assert found.units == len(per_unit)
    assert found.alpha == pytest.approx(1 - (2 * differing / answers_twice) / (answers_twice / 2 / (answers_twice - 1)))


def test_who_fails_a_check_is_in_no_figure(study):
    found = answered(study, careless=(1, 3))
    assert found.counted == 4 and [sheet.slot for sheet, _ in found.excluded] == [1, 3]
    out = {f"{1:032x}", f"{3:032x}"}
    assert not out & ({r.participant for r in found.rated} | {c.participant for c in found.chosen})


def test_the_tables_have_the_papers_figures_beside_ours(study, tmp_path):
    found = answered(study, careless=(1,))
    write_results(study, found, tmp_path / "out")
    page = (tmp_path / "out" / "results.md").read_text()
    assert "| ours        | 5.00 [5.00, 5.00] | 4.48" in page and "| 1.94" in page
    assert "5 participants are counted; 1 failed an attention check and is not." in page
    assert "100.0 [47.8, 100.0] | 93.5" in page and "mean of these" in page and "96.8" in page  # of the paper's 100.0 and 93.5
    assert "it asked for" in page
    ratings = {(row["method"], row["question"]): row for row in table(tmp_path / "out" / "ratings.csv")}
    assert float(ratings["FlexWorld", "structure"]["mean"]) == 3 and ratings["FlexWorld", "structure"]["paper"] == "2.34"
    preferences = table(tmp_path / "out" / "preferences.csv")
    assert [(row["against"], row["share"], row["paper"]) for row in preferences] == [
        ("WonderWorld", "1.0", "1.0"),
        ("FlexWorld", "1.0", "0.935"),
    ]
    people = table(tmp_path / "out" / "participants.csv")
    assert [row["counted"] for row in people] == ["yes"] * 5 + ["no"]
    assert len(table(tmp_path / "out" / "answers.csv")) == len(found.rated) + len(found.chosen)
    assert {row["question"] for row in table(tmp_path / "out" / "agreement.csv")} == {
        "quality",
        "objects",
        "structure",
        "preference",
    }


def test_the_same_answers_give_the_same_bytes(study, tmp_path):
    for name in ("a", "b"):
        write_results(study, answered(study, against=(2,)), tmp_path / name)
    files = sorted(file.name for file in (tmp_path / "a").iterdir())
    assert len(files) == 6
    assert all((tmp_path / "a" / name).read_bytes() == (tmp_path / "b" / name).read_bytes() for name in files)


def test_a_study_without_answers_has_tables_with_dashes(study, tmp_path):
    (study.folder / "answers").mkdir()
    found = analyse(study, read_answers(study, [study.folder / "answers"]))
    write_results(study, found, tmp_path / "out")
    assert "0 participants are counted" in (tmp_path / "out" / "results.md").read_text()
    assert table(tmp_path / "out" / "ratings.csv")[0]["mean"] == ""


def test_the_papers_figures_are_found_by_names_as_people_type_them():
    assert paper_rating("comparison", "Layer-Pano 3D", "quality", reference=False) == 2.27
    assert paper_rating("ablation", "depth_walls_bboxes", "structure", reference=False) == 2.26
    assert paper_rating("ablation", "whatever", "quality", reference=True) == 4.48
    assert paper_rating("comparison", "ours", "own question", reference=True) is None
    assert paper_rating("", "ours", "quality", reference=True) is None
    assert paper_preference("comparison", "FlexWorld") == 0.935 and paper_preference("ablation", "x") is None


def test_the_papers_mean_preference_is_that_of_its_rows():
    assert len(PAPER_PREFERENCES) == 6 and sum(PAPER_PREFERENCES.values()) / 6 == pytest.approx(0.962, abs=5e-4)  # "Average"
    assert PAPER_RATINGS["comparison"]["ours"] == PAPER_RATINGS["ablation"]["full"]
