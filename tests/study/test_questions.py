"""Question sets: the ready ones, files of one's own, and what is said of a wrong one."""

import dataclasses
import json

import pytest

from wm.errors import InputError
from wm.study.questions import READY, QuestionSet, questions_from, read_questions

SMALL = {"title": "T", "consent": "Yes?", "ratings": [{"id": "q", "title": "Q", "question": "How?"}]}


@pytest.mark.parametrize("name", READY)
def test_ready_sets_ask_the_papers_three_questions(name):
    found = read_questions(name)
    assert [question.id for question in found.ratings] == ["quality", "objects", "structure"]
    assert found.paper == name and len(found.consent) >= 2
    assert bool(found.preference) == (name == "comparison")


@pytest.mark.parametrize("name", READY)
def test_a_set_written_as_json_is_read_back(name, tmp_path):
    found = read_questions(name)
    file = tmp_path / "own.json"
    file.write_text(json.dumps(found.as_json()))
    assert read_questions(str(file)) == found


def test_yaml_of_ones_own_is_read(tmp_path):
    file = tmp_path / "own.yaml"
    file.write_text("title: T\nconsent: One text.\npreference: Which?\npairs: all\nchecks: {pairs: 0, tolerance: 2}\n")
    found = read_questions(str(file))
    assert found == QuestionSet("T", ("One text.",), preference="Which?", pairs="all", checks=found.checks)
    assert (found.checks.pairs, found.checks.tolerance, found.checks.ratings) == (0, 2, 1)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"titel": "T"}, "no key titel; did you mean title"),
        ({"title": 3}, "title is not 3; it wants text"),
        ({"consent": []}, "consent is missing"),
        ({"ratings": []}, "nothing is asked"),
        ({"ratings": "q"}, "ratings is a list"),
        ({"ratings": [{"id": "q"}]}, r"ratings\[0\]: title, question is missing"),
        ({"ratings": [*SMALL["ratings"], *SMALL["ratings"]]}, "two ratings have the same id"),
        ({"pairs": "some"}, "pairs is reference or all"),
        ({"paper": "other"}, "paper is ablation or comparison"),
        ({"must_watch": "yes"}, "must_watch is not 'yes'; it wants true or false"),
        ({"checks": {"ratings": True}}, "ratings is not True; it wants a whole number"),
        ({"checks": {"repeats": -1}}, "at least 0"),
        ({"checks": 3}, "it has keys and values"),
    ],
)
def test_a_wrong_key_or_value_is_named(change, message):
    with pytest.raises(InputError, match=message):
        questions_from(SMALL | change, place="own")


@pytest.mark.parametrize("text", ["title: [", "\t- : x", "just words", "[1, 2]", ""])
def test_a_file_that_is_no_question_set_is_one_clear_error(text, tmp_path):
    file = tmp_path / "own.yaml"
    file.write_text(text)
    with pytest.raises(InputError, match=r"questions=.*own\.yaml: "):
        read_questions(str(file))


def test_a_missing_file_names_the_ready_sets(tmp_path):
    with pytest.raises(InputError, match="ready sets are ablation and comparison"):
        read_questions(str(tmp_path / "none.yaml"))
    (tmp_path / "binary.yaml").write_bytes(b"\xff\xfe\x00")
    with pytest.raises(InputError, match="cannot be read"):
        read_questions(str(tmp_path / "binary.yaml"))


def test_every_field_of_the_set_is_shown_in_the_docs():
    from tests.test_house import ROOT

    page = (ROOT / "docs" / "study.md").read_text()
    assert all(f"`{field.name}`" in page for field in dataclasses.fields(QuestionSet))
