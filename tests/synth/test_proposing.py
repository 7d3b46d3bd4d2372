"""The propose - validate - correct loop, with backends that answer from a script."""

import json

import pytest

from wm.offline.language.grammar import Settings, make
from wm.synth.backends import LanguageResult
from wm.synth.proposing import ProposalError, propose_plan

ROOMS = ["hall", "kitchen"]


class Scripted:
    """Gives its answers in order, the last one for ever, and keeps what it was asked."""

    def __init__(self, *answers: str):
        self.answers = answers
        self.asked: list[dict] = []

    def propose(self, theme, rooms, *, seed, violations, previous):
        self.asked.append({"seed": seed, "violations": violations, "previous": previous})
        return LanguageResult(self.answers[min(len(self.asked), len(self.answers)) - 1])


def good() -> str:
    return make(Settings()).propose("a house", ROOMS, seed=3, violations=[], previous=None).text


def without_doors() -> str:
    plan = json.loads(good())
    for room in plan["rooms"]:
        room["openings"] = []
    return json.dumps(plan)


def test_a_good_answer_ends_the_loop():
    backend = Scripted(good())
    proposal = propose_plan(backend, "a house", ROOMS, seed=3, max_iterations=5)
    assert proposal.iterations == 1
    assert proposal.seconds == sum(attempt.seconds for attempt in proposal.transcript) > 0
    assert backend.asked == [{"seed": 3, "violations": [], "previous": None}]


def test_violations_and_the_last_answer_go_back_to_the_backend():
    backend = Scripted("no JSON at all", without_doors(), good())
    proposal = propose_plan(backend, "a house", ROOMS, seed=3, max_iterations=5)
    assert proposal.iterations == 3
    assert backend.asked[1]["previous"] == "no JSON at all"
    assert "json" in backend.asked[1]["violations"][0]
    assert backend.asked[2]["previous"] == without_doors()
    assert any("unreachable" in violation for violation in backend.asked[2]["violations"])
    assert proposal.transcript[-1].violations == ()


def test_the_limit_raises_one_error_that_names_the_last_violations():
    with pytest.raises(ProposalError, match=r"after 3 proposals; the last one had: .*unreachable") as caught:
        propose_plan(Scripted(without_doors()), "a house", ROOMS, seed=3, max_iterations=3)
    assert len(caught.value.transcript) == 3
    assert "\n" not in str(caught.value)


def test_rooms_left_out_or_made_up_are_violations():
    with pytest.raises(ProposalError, match=r"no room is named 'library'.*'kitchen' was not asked for"):
        propose_plan(Scripted(good()), "a house", ["hall", "library"], seed=3, max_iterations=1)


def test_added_corridors_are_fine():
    assert propose_plan(Scripted(good()), "a house", ["kitchen"], seed=3, max_iterations=1).iterations == 1


@pytest.mark.parametrize("rooms", [[], ["hall", " "], ["a\nb"], ["x" * 201]])
def test_an_empty_programme_is_refused(rooms):
    with pytest.raises(ValueError, match="programme"):
        propose_plan(Scripted(good()), "a house", rooms, seed=3, max_iterations=1)


def test_a_plan_between_fences_and_words_is_read():
    wrapped = f"Here is the plan:\n```json\n{good()}\n```\nEnjoy!"
    proposal = propose_plan(Scripted(wrapped), "a house", ROOMS, seed=3, max_iterations=1)
    assert proposal.iterations == 1 and proposal.transcript[0].text == wrapped


def test_an_answer_without_a_plan_is_told_what_was_wrong():
    backend = Scripted("I would rather write a poem.", good())
    propose_plan(backend, "a house", ROOMS, seed=3, max_iterations=2)
    assert backend.asked[1]["violations"] == [
        "plan: json: the answer holds no JSON object; answer with the floor plan as one JSON object and nothing else"
    ]
