"""Files of answers: whole ones are read, others are one line each, and nobody is counted twice."""

import json

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from tests.study.clips import answers, hand_in
from wm.errors import InputError
from wm.study.answers import read_answers

json_values = st.recursive(
    st.none() | st.booleans() | st.integers(-3, 9) | st.floats(allow_nan=False) | st.text(max_size=5),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.text(max_size=5), inner, max_size=3),
    max_leaves=8,
)


def test_what_the_page_writes_is_read(study):
    given = answers(study, 2, 5, rate=lambda method, scene: 4 if method == "ours" else 2, prefer=lambda left, right: "right")
    given["answers"][0] = {"unseen": True, "seconds": 1, "plays": 0}
    hand_in(study, given)
    read = read_answers(study, [study.folder / "answers"])
    (sheet,) = read.sheets
    assert read.refused == () and (sheet.participant, sheet.slot) == (f"{5:032x}", 2)
    assert (sheet.answers[0].ratings, sheet.answers[0].choice) == (None, None)
    for (trial, answer), written in list(zip(sheet.with_trials(study), given["answers"]))[1:]:
        assert answer.choice == written.get("choice") and answer.ratings == written.get("ratings")
        assert trial.is_pair == (answer.choice is not None)


def test_a_participant_is_counted_once_whatever_is_handed_in_twice(study):
    first, same, other = answers(study, 0, 1), answers(study, 0, 1), answers(study, 0, 1, rate=lambda *_: 5)
    files = [hand_in(study, given, name) for given, name in ((first, "a"), (same, "b"), (other, "c"))]
    read = read_answers(study, [study.folder / "answers", *files, study.folder])
    assert [sheet.file for sheet in read.sheets] == [str(files[0])]
    assert read.refused == (
        f"{files[1]}: not counted: the same answers as {files[0]}",
        f"{files[2]}: not counted: other answers of the participant in {files[0]}",
    )


@pytest.mark.parametrize(
    ("change", "reason"),
    [
        (lambda given: json.dumps(given)[:-30], "it is broken, no JSON"),
        (lambda given: "", "it is broken, no JSON"),
        (lambda given: "[" * 100_000, "it is broken, no JSON"),
        (lambda given: "[1, 2]", "it is no file of answers"),
        (lambda given: {"some": "thing"}, "it is no file of answers"),
        (lambda given: " " * (1 << 20) + "{}", "it is too large for a file of answers"),
        (lambda given: given | {"study": "000000000000"}, "it answers another study"),
        (lambda given: given | {"version": 2}, "its version or participant is not as the page writes it"),
        (lambda given: given | {"participant": "me"}, "its version or participant is not as the page writes it"),
        (lambda given: given | {"slot": 99}, "its slot or answers are not as the page writes them"),
        (lambda given: given | {"slot": True}, "its slot or answers are not as the page writes them"),
        (lambda given: given | {"answers": given["answers"][:3]}, "it has 3 of 11 pages"),
        (lambda given: given | {"answers": [3, *given["answers"][1:]]}, "page 1 is not as the page writes it"),
        (
            lambda given: with_page(given, 0, {"ratings": {"quality": 3}}),
            "page 1 has not a number from 1 to 5 for every question",
        ),
        (lambda given: with_page(given, 0, rated(6)), "page 1 has not a number from 1 to 5 for every question"),
        (lambda given: with_page(given, 0, rated(True)), "page 1 has not a number from 1 to 5 for every question"),
        (lambda given: with_page(given, 0, rated(3.0)), "page 1 has not a number from 1 to 5 for every question"),
        (lambda given: with_page(given, 10, {"choice": "A"}), "page 11 has no choice of left or right"),
    ],
)
def test_a_file_that_is_not_counted_is_one_line_with_its_reason(study, change, reason):
    assert len(study.sessions[0]) == 11
    file = hand_in(study, change(answers(study, 0, 1)), "bad")
    read = read_answers(study, [file])
    assert read.sheets == () and read.refused == (f"{file}: not counted: {reason}",)


def with_page(given, number, page):
    return given | {"answers": [*given["answers"][:number], page, *given["answers"][number + 1 :]]}


def rated(value):
    return {"ratings": {"quality": value, "objects": 3, "structure": 3}}


@settings(suppress_health_check=[HealthCheck.function_scoped_fixture], max_examples=60)
@given(st.data())
def test_no_json_is_a_crash(study, data):
    whole = answers(study, 0, 1)
    where = data.draw(st.sampled_from(["all", "key", "page", "rating"]))
    junk = data.draw(json_values)
    if where == "all":
        whole = junk
    elif where == "key":
        whole[data.draw(st.sampled_from(sorted(whole)))] = junk
    elif where == "page":
        whole["answers"][data.draw(st.integers(0, 10))] = junk
    else:
        whole["answers"][0] = {"ratings": {"quality": junk, "objects": junk, "structure": 1}}
    read = read_answers(study, [hand_in(study, json.dumps(whole), "junk")])
    assert len(read.sheets) + len(read.refused) == 1


def test_a_place_that_is_not_there_is_an_error(study):
    with pytest.raises(InputError, match="no file or folder of answers"):
        read_answers(study, [study.folder / "none"])
