"""python -m wm.study: make, serve, analyse, and one clear line where something is wrong."""

import json
import os
import pathlib
import re
import subprocess
import sys
import urllib.request

import pytest

from tests.study.clips import answers, clip, clips, hand_in
from wm.study.__main__ import main
from wm.study.folder import open_study


@pytest.fixture(scope="module")
def videos(tmp_path_factory):
    return clips(tmp_path_factory.mktemp("clips"))


def words(videos):
    return [f"{method}={path}" for method, path in videos.items()]


def test_a_study_is_made_answered_and_analysed(videos, tmp_path, capsys):
    output = tmp_path / "s"
    assert main(["make", *words(videos), f"output={output}", "seed=4", "participants=3"]) == 0
    assert "do not publish it" in capsys.readouterr().out
    study = open_study(output)
    assert len(study.sessions) == 3
    hand_in(study, answers(study, 0, 1))
    hand_in(study, "broken", "broken")
    assert main(["analyse", str(output), "resamples=100"]) == 0
    said = capsys.readouterr()
    assert f"{output / 'results' / 'results.md'}: participants counted: 1, excluded: 0; files refused: 1" in said.out
    assert said.err.splitlines() == [f"wm.study: {output / 'answers' / 'broken.json'}: not counted: it is broken, no JSON"]


def test_answers_from_elsewhere_are_analysed_too(videos, tmp_path):
    output = tmp_path / "s"
    assert main(["make", *words(videos), f"output={output}", "participants=2", "questions=ablation"]) == 0
    study = open_study(output)
    elsewhere = hand_in(study, answers(study, 1, 2)).rename(tmp_path / "sent.json")
    assert main(["analyse", str(output), str(elsewhere), f"output={tmp_path / 'out'}", "resamples=100"]) == 0
    assert "1 participant is counted" in (tmp_path / "out" / "results.md").read_text()


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["mkae"], "no command mkae; there are make, serve, analyse"),
        (["make", "outptu=x"], "outptu=x: no video or folder is there; did you mean output=?"),
        (["make", "output=x"], "make wants METHOD=VIDEO_OR_FOLDER at least once, and output=FOLDER"),
        (["make", "video.mp4", "output=x"], "video.mp4: a video is given as METHOD=PATH"),
        (["make", "output=x", "output=y"], "output= is given twice"),
        (["make", "ours=HERE", "output=x", "seed=-1"], "seed=-1: it wants a whole number of at least 0"),
        (["make", "ours=HERE", "output=x", "participants=0"], "participants=0: it wants a whole number of at least 1"),
        (["make", "ours=HERE", "output=x", "questions=none"], "questions=none: no such file"),
        (["serve"], "serve wants the folder of one study"),
        (["serve", "HERE"], "no study is there"),
        (["analyse"], "analyse wants the folder of a study"),
        (["analyse", "HERE"], "no study is there"),
    ],
)
def test_what_is_wrong_is_one_line_and_code_2(arguments, message, tmp_path, capsys):
    clip(tmp_path / "hall.mp4")
    assert main([word.replace("HERE", str(tmp_path)) for word in arguments]) == 2
    said = capsys.readouterr().err
    assert message in said and said.count("\n") == 1


def test_help_says_how(capsys):
    for words in (["--help"], ["make", "--help"]):
        assert main(words) == 0 and "METHOD=VIDEO_OR_FOLDER" in capsys.readouterr().out
    assert main([]) == 2


@pytest.mark.parametrize("command", [["-m", "wm.study", "serve", "STUDY", "port=0"], ["STUDY/serve.py", "--port", "0"]])
def test_both_servers_show_the_page_until_they_are_stopped(made_study, command):
    told = [word.replace("STUDY", str(made_study.folder)) for word in command]
    root = str(pathlib.Path(__file__).parents[2])
    with subprocess.Popen(
        [sys.executable, *told], stdout=subprocess.PIPE, text=True, env={**os.environ, "PYTHONPATH": root}
    ) as process:
        try:
            address = re.search(r"http://\S+/", process.stdout.readline())[0]
            with urllib.request.urlopen(f"{address}plan.js", timeout=20) as reply:
                plan = json.loads(reply.read().decode().partition("=")[2].rstrip(";\n"))
            assert plan["study"] == made_study.id
        finally:
            process.terminate()
