"""Lines reach whoever can be reached, and end no run."""

import io
import os
import subprocess
import sys
from pathlib import Path

import pytest

from wm import console
from wm.stages import progress as module
from wm.stages.progress import progress

SAYS = (
    "from wm import console; console.open_standard_streams(); console.say('12.5\\u00b0 \\u2013 K\\u00fcche'); "
    "console.warn('end'); console.flush()"
)


def call(redirection: str = "", **environment: str) -> subprocess.CompletedProcess:
    env = os.environ | {"PYTHONPATH": str(Path(console.__file__).parents[1])} | environment
    command = f'"$0" -c "$1" {redirection}'
    return subprocess.run(["bash", "-c", command, sys.executable, SAYS], capture_output=True, env=env, check=False)


def test_a_line_in_each_stream():
    done = call()
    assert (done.returncode, done.stdout.decode(), done.stderr) == (0, "12.5° – Küche\n", b"end\n")


@pytest.mark.parametrize("redirection", ["2>&-", ">&-", "<&- >&- 2>&-", "> /dev/full", "2> /dev/full", "> >(true)"])
def test_a_stream_that_is_closed_full_or_left_ends_nothing(redirection):
    assert call(redirection).returncode == 0


def test_a_full_disk_is_said():
    assert b"standard output cannot be written" in call("> /dev/full").stderr


def test_another_encoding_gets_what_it_can_say():
    done = call(LC_ALL="C", PYTHONUTF8="0", PYTHONCOERCECLOCALE="0")
    assert (done.returncode, done.stdout) == (0, b"12.5? ? K?che\n")


def test_a_closed_stream_is_not_taken_by_the_next_file():
    code = "import os; from wm import console; console.open_standard_streams(); os._exit(os.open(os.devnull, os.O_RDONLY))"
    env = os.environ | {"PYTHONPATH": str(Path(console.__file__).parents[1])}
    done = subprocess.run(["bash", "-c", '"$0" -c "$1" <&- >&- 2>&-', sys.executable, code], env=env, check=False)
    assert done.returncode > 2


def test_progress_without_a_terminal_is_lines(monkeypatch, capsys):
    monkeypatch.setattr(module, "LINE_SECONDS", 0.0)
    with progress("paint", 2) as bar:
        for _ in range(2):
            bar.set_postfix_str("hall", refresh=False)
            bar.update()
    said = capsys.readouterr().err
    assert "\r" not in said and [line[:12] for line in said.splitlines()] == ["paint: 1 of ", "paint: 2 of "]


def test_nothing_to_do_says_nothing(monkeypatch, capsys):
    with progress("heldout", 0):
        pass
    terminal = io.StringIO()
    terminal.isatty = lambda: True
    monkeypatch.setattr(sys, "stderr", terminal)
    with progress("heldout", 0):
        pass
    assert terminal.getvalue() == capsys.readouterr().err == ""
    with progress("paint", 2) as bar:
        bar.update()
    assert "\r" in terminal.getvalue() and "paint" in terminal.getvalue()


def test_control_c_ends_a_command_with_a_line_and_no_traceback(capsys):
    def command():
        raise KeyboardInterrupt

    with pytest.raises(SystemExit) as ended:
        console.end(command)
    assert ended.value.code == 130
    assert capsys.readouterr().err == "interrupted; the same command begins again\n"
    with pytest.raises(SystemExit) as ended:
        console.end(lambda: 2)
    assert ended.value.code == 2
