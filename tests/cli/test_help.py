"""What --help says of every key, and that it says it without loading what a run needs."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

import wm
from tests.test_conf import leaves
from wm.cli.composition import CONF
from wm.cli.help import answer, asks_for_help
from wm.run import load_config
from wm.validate import ConfigError


def flat(text: str) -> str:
    return " ".join(text.split())


def test_help_names_every_key_with_its_meaning_its_default_and_its_range():
    said = flat(answer(["--help"], CONF))
    keys = [key for key in leaves(load_config(["+scene=gothic"])) if not key.endswith(".backend")]
    assert [key for key in keys if f" {key}{'' if key.startswith('scene.') else '='}" not in said] == []
    assert "fit.steps=100 Optimiser steps per room. [integer, 0 to 1e+07]" in said
    assert "below 1. [0 to below 1]" in said
    assert "cameras.eye_height=1.6 Height of a standing viewer's eyes above the floor. [0.2 to 5 m]" in said
    assert "condition.objects=textured How the scaffold's objects are shown. [textured | boxes | none]" in said
    assert "[integer, 1 to 1000, or null for one room per core]" in said
    assert "depth.softness=0.35 Distance over which edges are blurred. [0 to 100 px]" in said
    assert "report.video=true Write the fly-through. [true | false]" in said


@pytest.mark.parametrize(
    ("topic", "said", "not_said"),
    [
        ("fit", "fit.steps=100", "raster.near"),
        ("fit.steps", "fit.steps=100 Optimiser steps per room.", "fit.batch"),
        ("seed", "seed=0 Seed of everything random.", "variant"),
        ("--seed", "seed=0 Seed of everything random.", "variant"),
        ("variant", 'depth_only "depth only": the condition shows the empty structure', "fit.steps"),
        ("gothic", "scene=gothic name: gothic theme: gothic revival mansion", "beach_house"),
        ("image=like_closed", "image.drift=0.03", "depth.noise"),
        ("image.drift", "image.drift=0.02", "image.closed"),
        ("objects=lifted", "objects.image_width=640 Width of the images", "fit.steps"),
    ],
)
def test_help_on_one_thing_says_that_alone(topic, said, not_said):
    text = flat(answer(["--help", topic], CONF))
    assert said in text and not_said not in text
    assert flat(answer([topic, "-h"], CONF)) == text


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["--help", "fit.stepz"], "fit.stepz: no such group, key or choice; did you mean fit.steps"),
        (
            ["--help", "image.requests_at_once"],
            "is a key of image=nano_banana, nano_banana_pro, openai_images; "
            "wm --help image.requests_at_once image=nano_banana explains it",
        ),
        (["--help", "gothik"], "did you mean gothic"),
        (["--help", "image=gan"], "image=gan: no such image; choose one of .*like_closed, like_distilled, .*procedural"),
        (["--completion", "tcsh"], "--completion bash"),
    ],
)
def test_help_on_what_is_not_there_says_what_is(arguments, said):
    with pytest.raises(ConfigError, match=said) as caught:
        answer(arguments, CONF)
    assert "\n" not in str(caught.value)


def test_folders_of_ones_own_are_shown_too(tmp_path):
    (tmp_path / "scene").mkdir()
    (tmp_path / "scene/den.yaml").write_text("name: den\ntheme: a snug cabin\nrooms: [hall]\n")
    for form in (["--config-dir", str(tmp_path)], [f"-cd={tmp_path}"]):
        assert "den a snug cabin" in flat(answer([*form, "--help"], CONF))


def test_the_version_is_that_of_the_package():
    assert answer(["--version"], CONF) == f"wm {wm.__version__}"
    assert asks_for_help(["gothic", "--version"]) and not asks_for_help(["gothic", "version=1"])


@pytest.mark.parametrize("arguments", [["--version"], ["--help"], ["--help", "objects=lifted"], ["--completion", "bash"]])
def test_answers_load_nothing_that_a_run_needs(arguments, tmp_path):
    code = (
        f"import sys; sys.argv[1:] = {arguments}; from wm.run import main; main(); print({{'jax', 'numpy'}} & {{*sys.modules}})"
    )
    env = os.environ | {"PYTHONPATH": str(Path(wm.__file__).parents[1])}
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, cwd=tmp_path, env=env, check=True)
    assert done.stdout.splitlines()[-1] == "set()" and done.stderr == ""
    assert list(tmp_path.iterdir()) == []
