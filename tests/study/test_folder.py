"""The folder of a study: blind, the same for the same arguments, read back from its key alone."""

import json
import shutil

import pytest

from tests.study.clips import METHODS, SCENES, answers, clips, hand_in
from wm.errors import InputError
from wm.study.folder import make_study, open_study
from wm.study.questions import read_questions
from wm.study.sessions import StudyPlan

COMPARISON = read_questions("comparison")


def contents(folder):
    return {path.relative_to(folder).as_posix(): path.read_bytes() for path in folder.rglob("*") if path.is_file()}


def test_nothing_that_is_published_tells_a_method_or_a_scene(made_study):
    for name, content in contents(made_study.folder / "page").items():
        text = f"{name}\n".encode() + content
        for word in (*METHODS[1:], *SCENES, "made by ours", '"reference"', '"paper"'):
            assert word.lower().encode() not in text.lower(), f"{word} in {name}"
    assert not list((made_study.folder / "page").rglob("*key*"))


def test_files_have_the_same_date_and_names_that_follow_their_content(made_study):
    videos = sorted((made_study.folder / "page" / "videos").iterdir())
    assert len({file.stat().st_mtime for file in videos}) == 1
    assert {file.stem for file in videos} == set(made_study.videos)


def test_the_key_tells_every_video(made_study):
    assert sorted(made_study.videos.values()) == sorted((method, scene) for method in METHODS for scene in SCENES)
    assert made_study.reference == "ours" and made_study.methods == METHODS
    page = json.loads((made_study.folder / "page" / "plan.js").read_text().removeprefix("window.STUDY = ").rstrip(";\n"))
    assert page["study"] == made_study.id
    assert page["sessions"] == [[json.loads(json.dumps(trial.as_json())) for trial in session] for session in made_study.sessions]


def test_the_same_arguments_give_the_same_bytes_and_another_seed_another_study(tmp_path):
    methods = clips(tmp_path / "videos")
    for name, seed in (("a", 0), ("b", 0), ("c", 1)):
        make_study(methods, tmp_path / name, COMPARISON, StudyPlan(participants=4, seed=seed))
    assert contents(tmp_path / "a") == contents(tmp_path / "b")
    assert open_study(tmp_path / "a").id != open_study(tmp_path / "c").id


def test_making_it_again_leaves_no_old_video_and_never_a_study_that_was_answered(tmp_path):
    methods = clips(tmp_path / "videos")
    make_study(methods, tmp_path / "s", COMPARISON, StudyPlan(participants=2))
    (methods["ours"] / f"{SCENES[0]}.mp4").unlink()
    lines = make_study(methods, tmp_path / "s", COMPARISON, StudyPlan(participants=2))
    assert lines == [f"left out, since not every method has them: {SCENES[0]}"]
    study = open_study(tmp_path / "s")
    assert {file.stem for file in (tmp_path / "s" / "page" / "videos").iterdir()} == set(study.videos)
    hand_in(study, answers(study, 0, 1))
    with pytest.raises(InputError, match="people have answered this study already"):
        make_study(methods, tmp_path / "s", COMPARISON, StudyPlan(participants=2))


def test_the_key_alone_is_enough_to_analyse(made_study, tmp_path):
    shutil.copy(made_study.folder / "key.json", tmp_path)
    assert open_study(tmp_path).sessions == made_study.sessions


@pytest.mark.parametrize(
    "damage", [lambda text: text[:-20], lambda text: "[]", lambda text: text.replace('"version": 1', '"version": 9')]
)
def test_a_damaged_key_is_one_clear_error(made_study, tmp_path, damage):
    (tmp_path / "key.json").write_text(damage((made_study.folder / "key.json").read_text()))
    with pytest.raises(InputError, match=r"key\.json: the key is damaged"):
        open_study(tmp_path)


def test_a_folder_without_a_key_says_how_to_make_one(tmp_path):
    with pytest.raises(InputError, match=r"no study is there.*wm\.study make"):
        open_study(tmp_path)
