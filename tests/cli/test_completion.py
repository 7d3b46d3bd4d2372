"""What bash offers at TAB, with the script sourced as users source it."""

import shutil
import subprocess

import pytest

from wm.cli.composition import CONF
from wm.cli.help import answer

BASH = shutil.which("bash")


def offered(line: str, breaks: str = "=:") -> list[str]:
    """What the script of --completion offers at the end of a line. (`compopt` works only while bash completes.)"""
    assert BASH is not None
    script = answer(["--completion", "bash"], CONF)
    call = f"COMP_WORDBREAKS='{breaks}' COMP_LINE=$1 COMP_POINT=${{#1}}; _wm; echo ${{COMPREPLY[*]}}"
    body = f"compopt() {{ :; }}\n{script}\n{call}"
    done = subprocess.run([BASH, "-c", body, "bash", line], capture_output=True, text=True, check=True)
    assert done.stderr == ""
    return done.stdout.split()


@pytest.mark.parametrize(
    ("line", "words"),
    [
        ("wm got", ["gothic"]),
        ("wm gothic pres", ["preset=draft", "preset=paper", "preset=standard"]),
        ("wm gothic preset=d", ["draft"]),
        ("wm gothic --preset ", ["draft", "paper", "standard"]),
        ("wm --the", ["--theme"]),
        ("wm --theme ", []),
        ("wm --plan my", []),
        ("wm gothic fi", ["finish.", "fit."]),
        ("wm gothic fit.ste", ["fit.steps="]),
        ("wm gothic fit.init=f", ["flat"]),
        ("wm gothic report.video=", ["true", "false"]),
        ("wm gothic see", ["seed="]),
        ("wm gothic image.dr", ["image.drift="]),
    ],
)
def test_what_is_offered_at_tab(line, words):
    assert offered(line) == words


def test_where_the_equals_sign_is_part_of_a_word_the_whole_word_is_offered():
    assert offered("wm gothic preset=d", breaks=":") == ["preset=draft"]
