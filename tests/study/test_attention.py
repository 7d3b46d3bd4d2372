"""Attention checks: each kind is failed by what the docs say, and by nothing else."""

from tests.study.clips import answers, hand_in
from wm.study.answers import read_answers
from wm.study.attention import failed_check


def judged(study, given):
    (sheet,) = read_answers(study, [hand_in(study, given)]).sheets
    return failed_check(study, sheet)


def page_of(study, wanted):
    return next(number for number, trial in enumerate(study.sessions[0]) if wanted(trial))


def changed(given, page, answer):
    given["answers"][page] = answer
    return given


def rated(*values):
    return {"ratings": dict(zip(("quality", "objects", "structure"), values))}


def test_who_answers_every_check_is_counted(study):
    assert judged(study, answers(study, 0, 1)) is None


def test_another_number_than_the_page_asks_for_excludes(study):
    page = page_of(study, lambda trial: trial.check is not None and not trial.is_pair)
    asked = study.sessions[0][page].check
    wrong = asked % 5 + 1
    given = changed(answers(study, 0, 1), page, rated(asked, asked, wrong))
    assert judged(study, given) == f"page {page + 1}: it asked for {asked} everywhere, the answers are {asked}, {asked}, {wrong}"
    assert judged(study, changed(given, page, {"unseen": True})) is None


def test_the_other_side_than_the_page_asks_for_excludes(study):
    page = page_of(study, lambda trial: trial.check is not None and trial.is_pair)
    asked = study.sessions[0][page].check
    wrong = {"left": "right", "right": "left"}[asked]
    given = changed(answers(study, 0, 1), page, {"choice": wrong})
    assert judged(study, given) == f"page {page + 1}: it asked for the {asked} video, the answer is {wrong}"


def test_a_second_rating_may_differ_by_the_tolerance_and_no_more(study):
    page = page_of(study, lambda trial: trial.repeat)
    first = {"rate": lambda *_: 2}
    assert judged(study, changed(answers(study, 0, 1, **first), page, rated(5, 3, 4))) is None
    reason = judged(study, changed(answers(study, 0, 1, **first), page, rated(5, 3, 5)))
    assert reason == f"page {page + 1}: the video was rated before, and now 2.3 points apart on average"
