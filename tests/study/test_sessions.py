"""Sessions: the same for the same seed, balanced, with their attention checks."""

from collections import Counter

import pytest
from hypothesis import given
from hypothesis import strategies as st

from wm.errors import InputError
from wm.study.questions import Checks, QuestionSet, RatingQuestion, read_questions
from wm.study.sessions import StudyPlan, Trial, plan_sessions, reference_of

NAMES = {method: {scene: f"{method}-{scene}" for scene in "abc"} for method in ("ours", "x", "y", "z")}
COMPARISON = read_questions("comparison")


def counted(trial: Trial) -> bool:
    return trial.check is None and not trial.repeat


def test_the_same_seed_gives_the_same_sessions_and_another_one_others():
    first = plan_sessions(NAMES, COMPARISON, StudyPlan(seed=1))
    assert first == plan_sessions(NAMES, COMPARISON, StudyPlan(seed=1))
    assert first != plan_sessions(NAMES, COMPARISON, StudyPlan(seed=2))


@given(st.integers(0, 10**6), st.integers(1, 12), st.integers(1, 9), st.integers(1, 30))
def test_after_any_number_of_sessions_every_video_and_every_pair_was_shown_equally(seed, ratings, pairs, participants):
    plan = StudyPlan(seed=seed, ratings=ratings, pairs=pairs, participants=participants)
    rated, compared, sides = Counter(), Counter(), Counter()
    for session in plan_sessions(NAMES, COMPARISON, plan):
        for trial in filter(counted, session):
            if trial.is_pair:
                compared[frozenset(trial.videos)] += 1
                sides[frozenset(trial.videos)] += 1 if trial.videos[0].startswith("ours") else -1
            else:
                rated[trial.videos] += 1
        assert max(rated.values()) - min(rated.values() if len(rated) == 12 else (0,)) <= 1
        assert max(compared.values()) - min(compared.values() if len(compared) == 9 else (0,)) <= 1
        assert all(abs(value) <= 1 for value in sides.values())


def test_a_session_has_every_method_twice_and_the_reference_against_every_other_once():
    for session in plan_sessions(NAMES, COMPARISON, StudyPlan()):
        rated = [trial.videos[0] for trial in session if counted(trial) and not trial.is_pair]
        assert len(set(rated)) == 8 and set(Counter(name.split("-")[0] for name in rated).values()) == {2}
        pairs = [trial.videos for trial in session if counted(trial) and trial.is_pair]
        assert sorted(next(n for n in pair if "ours" not in n)[0] for pair in pairs) == ["x", "y", "z"]
        assert all(left.split("-")[1] == right.split("-")[1] for left, right in pairs)


@given(st.integers(0, 10**6))
def test_checks_are_as_many_as_asked_for_and_never_first(seed):
    questions = QuestionSet("t", ("c",), (RatingQuestion("q", "Q", "?"),), "which?", checks=Checks(ratings=2, pairs=1, repeats=2))
    for session in plan_sessions(NAMES, questions, StudyPlan(seed=seed, participants=3)):
        told = [trial for trial in session if trial.check is not None]
        assert Counter(trial.is_pair for trial in told) == {False: 2, True: 1}
        assert all(trial.check in ({"left", "right"} if trial.is_pair else {1, 2, 3, 4, 5}) for trial in told)
        first_pair = next(number for number, trial in enumerate(session) if trial.is_pair)
        assert counted(session[0]) and counted(session[first_pair])
        repeats = [number for number, trial in enumerate(session) if trial.repeat]
        assert len(repeats) == 2
        for number in repeats:
            before = [n for n, trial in enumerate(session) if trial.videos == session[number].videos and counted(trial)]
            assert len(before) == 1 and number - before[0] >= 4


def test_ratings_come_before_pairs():
    for session in plan_sessions(NAMES, COMPARISON, StudyPlan()):
        kinds = [trial.is_pair for trial in session]
        assert kinds == sorted(kinds)


def test_all_pairs_are_those_of_every_two_methods():
    questions = QuestionSet("t", ("c",), preference="which?", pairs="all")
    session = plan_sessions(NAMES, questions, StudyPlan())[0]
    couples = {frozenset(name.split("-")[0] for name in trial.videos) for trial in session}
    assert len(couples) == 6 and len([trial for trial in session if counted(trial)]) == 6


def test_the_ablation_has_no_pairs():
    assert not any(
        trial.is_pair for session in plan_sessions(NAMES, read_questions("ablation"), StudyPlan()) for trial in session
    )


def test_the_reference_is_the_named_one_or_ours_or_the_first():
    assert reference_of(["a", "Ours"], StudyPlan()) == "Ours"
    assert reference_of(["a", "b"], StudyPlan()) == "a"
    assert reference_of(["a", "b"], StudyPlan(reference="b")) == "b"
    with pytest.raises(InputError, match="reference=c: the methods are a, b"):
        reference_of(["a", "b"], StudyPlan(reference="c"))


@pytest.mark.parametrize(
    ("plan", "message"),
    [
        (StudyPlan(ratings=13), "ratings=13: a participant can see 1 to 12"),
        (StudyPlan(pairs=10), "pairs=10: a participant can see 1 to 9"),
        (StudyPlan(ratings=0), "ratings=0"),
    ],
)
def test_more_than_there_is_is_refused(plan, message):
    with pytest.raises(InputError, match=message):
        plan_sessions(NAMES, COMPARISON, plan)


def test_one_method_alone_has_no_pairs_to_show():
    with pytest.raises(InputError, match="pairs need two methods"):
        plan_sessions({"ours": NAMES["ours"]}, COMPARISON, StudyPlan())
    assert plan_sessions({"ours": NAMES["ours"]}, read_questions("ablation"), StudyPlan())[0]
