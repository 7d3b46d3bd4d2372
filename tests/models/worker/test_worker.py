"""A worker is a process of another interpreter: what it answers, how its faults are told apart, that nothing of it is left."""

import io
import json
import os
import pathlib
import signal
import subprocess
import tempfile
import time

import numpy as np
import pytest

import wm
from tests.models.worker.scripts import PYTHON, SUM, changed, script
from wm.models.worker.worker import ARRAYS, VALUES, ModelWorker, ServedModel, WorkerProgram
from wm.services.faults import ServiceError, TransientError

X = {"x": np.arange(6.0).reshape(2, 3)}
HELLO = {"say": "hello"}


@pytest.fixture
def temporary(tmp_path, monkeypatch):
    """The folder for temporary files, of this test alone."""
    folder = tmp_path / "temporary"
    folder.mkdir()
    monkeypatch.setattr(tempfile, "tempdir", str(folder))
    return folder


def worker_of(path: pathlib.Path, *, start=30.0, request=30.0, python=PYTHON, log="", **options) -> ModelWorker:
    return ModelWorker(WorkerProgram(python, path, options, start, request, log))


def values(answer) -> dict:
    return json.loads(answer.files[VALUES])


def is_running(pid: int) -> bool:
    try:
        os.kill(pid, 0)
    except ProcessLookupError:
        return False
    return True


def ends(pid: int) -> bool:
    """Whether a process ends by itself, within a time that only a fault exceeds."""
    until = time.monotonic() + 20
    while is_running(pid) and time.monotonic() < until:
        time.sleep(0.01)
    return not is_running(pid)


def has_children() -> bool:
    """Whether a child process runs or is a zombie."""
    try:
        return os.waitid(os.P_ALL, 0, os.WEXITED | os.WNOHANG | os.WNOWAIT) is not None
    except ChildProcessError:
        return False


def test_arrays_values_and_files_come_back_from_a_process_without_wm(tmp_path, temporary):
    worker = worker_of(script(tmp_path, SUM), offset=0.5)
    assert worker.describe() == ServedModel("sum", "1.0")
    first, second = (worker.ask({"say": text}, X) for text in ("one", "zwei: é"))
    assert values(first) == {"total": 15.5, "said": "one", "pid": values(first)["pid"], "alone": True}
    assert values(second) == values(first) | {"said": "zwei: é"}  # the same process
    with np.load(io.BytesIO(first.files[ARRAYS])) as arrays:
        np.testing.assert_array_equal(arrays["doubled"], 2 * X["x"])
    assert first.files["note.bin"] == b"\x00\x01" and first.model_version == "1.0"
    (folder,) = temporary.iterdir()
    assert folder.stat().st_mode & 0o077 == 0
    worker.close()
    worker.close()
    assert not is_running(values(first)["pid"]) and list(temporary.iterdir()) == []
    assert values(worker.ask(HELLO, X))["pid"] != values(first)["pid"]  # it starts anew
    worker.close()


def test_what_libraries_print_and_read_does_not_disturb(tmp_path, temporary):
    noisy = changed(
        "return options.get",
        """
        import subprocess, sys
        print('{"id": 2, "done": {"fake": 1}}', flush=True)
        os.write(1, b"native code prints too\\n")
        subprocess.run([sys.executable, "-c", "print('a child prints'); assert input is not None"], check=True)
        assert sys.stdin.read() == ""
        return options.get""",
    )
    log = tmp_path / "logs" / "worker.txt"
    worker = worker_of(script(tmp_path, noisy), log=str(log))
    assert values(worker.ask(HELLO, X))["said"] == "hello"
    worker.close()
    assert {"native code prints too", "a child prints"} <= set(log.read_text().splitlines())


def test_no_file_beside_the_scripts_hides_a_package(tmp_path, temporary):
    """Of the environment: `fractions` beside the script, `folder` beside serve.py. What only the script's folder has is found."""
    (tmp_path / "fractions.py").write_text("hidden = True\n")
    (tmp_path / "beside.py").write_text("found = True\n")
    text = changed("import os", "import os, beside, fractions, importlib.util")
    told = '[beside.found, hasattr(fractions, "hidden"), importlib.util.find_spec("folder")]'
    text = changed('request["say"]', told, text)
    worker = worker_of(script(tmp_path, text))
    assert values(worker.ask(HELLO, X))["said"] == [True, False, None]
    worker.close()


def test_a_launcher_may_greet_before_python_starts(tmp_path, temporary):
    launcher = tmp_path / "python"
    launcher.write_text(f'#!/bin/sh\necho "Welcome to conda"\necho "[1, 2]"\nexec {PYTHON} "$@"\n')
    launcher.chmod(0o755)
    worker = worker_of(script(tmp_path, SUM), python=str(launcher))
    assert values(worker.ask(HELLO, X))["total"] == 15
    worker.close()


def at_start(code: str) -> str:
    """The script with this code in place of its first import of a package."""
    return changed("import numpy as np", code)


def in_load(code: str) -> str:
    return changed("return options.get", f"{code}; return options.get")


def in_answer(code: str) -> str:
    """The script with this code before it answers."""
    return changed("return {\n            ", f"{code}\n        return {{")


DIES = "import signal; os.kill(os.getpid(), signal.SIGKILL)"
SLEEPS = "import time; time.sleep(60)"
LASTING = {
    "missing package": (at_start("import sam3d"), "describe.. raised ModuleNotFoundError: .*'sam3d'"),
    "missing package in load": (in_load("import sam3d"), "load.. raised ModuleNotFoundError: .*'sam3d'"),
    "no such function": (changed("def load", "def lade"), "raised AttributeError.*load"),
    "syntax": (changed("def load(options):", "def load(options"), "raised SyntaxError"),
    "no name": (changed('"sum"', "None"), "describe.. gave .*would be right"),
    "exits at start": (at_start("print('no GPU'); os._exit(3)"), "exit code 3 in describe.*\n  no GPU"),
    "exits by sys.exit": (at_start("import sys; sys.exit('no GPU')"), "SystemExit: no GPU"),
    "raises": (changed('arrays["x"].sum()', 'arrays["y"].sum()'), "answer.. raised KeyError: 'y'.*\n.*KeyError"),
    "no JSON": (changed('request["say"]', "{1, 2}"), "raised TypeError: set of the answer is neither"),
}
PASSING = {
    "killed at start": (in_load(DIES), "ended by SIGKILL in load"),
    "dies": (in_answer(DIES), "ended by SIGKILL in answer"),
    "exits": (in_answer("print('torn'); os._exit(7)"), "exit code 7 in answer.*\n  torn"),
    "hangs": (in_answer(SLEEPS), "not answered within 1 s in answer"),
    "hangs with a child": (in_answer(f"os.system('sleep 60'); {SLEEPS}"), "not answered within 1 s in answer"),
    "out of memory": (in_answer("raise MemoryError('GPU')"), "ran out of memory: .*GPU"),
}


SLOW = {
    "killed",
    "terminated",
    "without close",
    "by an error",
    "hangs with a child",
    "says nothing",
    "missing package in load",
    "exits by sys.exit",
    "no such function",
}


def marked(names) -> list:
    """The names, those of SLOW marked so."""
    return [pytest.param(name, marks=pytest.mark.slow) if name in SLOW else name for name in names]


@pytest.mark.parametrize("fault", marked([*LASTING, *PASSING]))
def test_a_fault_is_one_clear_error_and_leaves_nothing(tmp_path, temporary, fault):
    text, said = (LASTING | PASSING)[fault]
    worker = worker_of(script(tmp_path, text), request=1.0 if "hangs" in fault else 30.0)
    with pytest.raises(TransientError if fault in PASSING else ServiceError, match=rf"(?s)^the worker model\.py of .*{said}"):
        worker.ask(HELLO, X)
    if fault in PASSING:  # its process is gone before it is asked again
        assert list(temporary.iterdir()) == [] and not has_children()
    worker.close()
    assert list(temporary.iterdir()) == [] and not has_children()


LAUNCHERS = {
    "gone": (None, ServiceError, "cannot be started: .*No such file"),
    "not a program": ("", ServiceError, "cannot be started: "),
    "fails": (
        "#!/bin/sh\necho no such environment >&2; exit 1\n",
        ServiceError,
        "exit code 1 in describe.*\n  no such environment",
    ),
    "echoes": ("#!/bin/sh\nexec cat\n", ServiceError, "describe.. gave None"),
    "prints garbage for ever": ("#!/bin/sh\nexec yes garbage\n", TransientError, "it prints without end.*\n  garbage"),
    "says nothing": ("#!/bin/sh\nsleep 60\n", TransientError, "not answered within 1 s in describe"),
}


@pytest.mark.parametrize("fault", marked(LAUNCHERS))
def test_an_interpreter_that_is_none_is_one_clear_error(tmp_path, temporary, fault):
    text, kind, said = LAUNCHERS[fault]
    launcher = tmp_path / "python"
    if text is not None:
        launcher.write_text(text)
        launcher.chmod(0o755)
    worker = worker_of(script(tmp_path, SUM), python=str(launcher), start=1.0 if "nothing" in fault else 30.0)
    with pytest.raises(kind, match=f"(?s){said}"):
        worker.describe()
    worker.close()
    assert list(temporary.iterdir()) == [] and not has_children()


def test_it_is_started_again_and_gives_up_after_three_deaths_in_succession(tmp_path, temporary):
    """The first process dies at its second request, all others at their first one that is called "die"."""
    text = in_answer(f"if request['say'] == 'die': {DIES}")
    worker = worker_of(script(tmp_path, text))
    first = values(worker.ask(HELLO, X))["pid"]
    for _ in range(2):
        with pytest.raises(TransientError, match="SIGKILL"):
            worker.ask({"say": "die"}, X)
    assert values(worker.ask(HELLO, X))["pid"] != first
    kinds = []
    for _ in range(3):
        with pytest.raises((TransientError, ServiceError)) as caught:
            worker.ask({"say": "die"}, X)
        kinds.append(type(caught.value))
    assert kinds == [TransientError, TransientError, ServiceError] and "3 times in succession" in str(caught.value)
    worker.close()


def test_an_error_of_the_script_does_not_end_its_process(tmp_path, temporary):
    worker = worker_of(script(tmp_path, SUM))
    first = values(worker.ask(HELLO, X))["pid"]
    with pytest.raises(ServiceError, match="KeyError: 'say'"):
        worker.ask({}, X)
    assert values(worker.ask(HELLO, X))["pid"] == first
    worker.close()


def test_a_refusal_is_an_answer(tmp_path, temporary):
    worker = worker_of(script(tmp_path, in_answer('return {"refused": "an empty mask"}')))
    answer = worker.ask(HELLO, X)
    assert (answer.refusal, dict(answer.files), answer.model_version) == ("an empty mask", {}, "1.0")
    worker.close()


def test_numbers_that_are_not_finite_travel(tmp_path, temporary):
    worker = worker_of(script(tmp_path, SUM))
    answer = worker.ask(HELLO, {"x": np.array([[np.nan, np.inf]])})
    assert np.isnan(values(answer)["total"])
    with np.load(io.BytesIO(answer.files[ARRAYS])) as arrays:
        np.testing.assert_array_equal(arrays["doubled"], [[np.nan, np.inf]])
    worker.close()


def test_the_parents_own_packages_do_not_reach_the_other_interpreter(tmp_path, temporary, monkeypatch):
    monkeypatch.setenv("PYTHONPATH", str(tmp_path / "of_the_parent"))
    text = changed(
        '"said": request["say"]', '"said": [os.environ.get("PYTHONPATH"), os.environ["PATH"].split(":")[0], os.getcwd()]'
    )
    worker = worker_of(script(tmp_path, text))
    assert values(worker.ask(HELLO, X))["said"] == [None, os.path.dirname(PYTHON), os.getcwd()]
    worker.close()


def test_ctrl_c_ends_the_process_of_a_request_under_way(tmp_path, temporary):
    worker = worker_of(script(tmp_path, in_answer(SLEEPS)))
    worker.describe()

    def interrupt(*_):
        raise KeyboardInterrupt

    before = signal.signal(signal.SIGALRM, interrupt)
    try:
        signal.setitimer(signal.ITIMER_REAL, 0.3)
        with pytest.raises(KeyboardInterrupt):
            worker.ask(HELLO, X)
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)
    assert list(temporary.iterdir()) == [] and not has_children()


PARENT = """
import pathlib, sys, time
import numpy as np
from wm.models.worker.worker import ModelWorker, WorkerProgram
worker = ModelWorker(WorkerProgram(sys.executable, pathlib.Path(sys.argv[1]), {}, 60.0, 60.0))
worker.describe()
print(worker._running.popen.pid, flush=True)
END
"""
ASKS = 'worker.ask({"say": "x"}, {"x": np.zeros(3)})'


ENDS = {
    "killed in a request": (ASKS, signal.SIGKILL), "killed": ("time.sleep(60)", signal.SIGKILL),
    "terminated": (ASKS, signal.SIGTERM), "without close": ("sys.exit()", None), "by an error": ("1 / 0", None),
}  # fmt: skip


@pytest.mark.parametrize("way", marked(ENDS))
def test_it_ends_with_its_parent(tmp_path, temporary, way):
    end, stop = ENDS[way]
    path = script(tmp_path, in_answer(f"print('begun', flush=True); {SLEEPS}"))
    env = os.environ | {"TMPDIR": str(temporary), "PYTHONPATH": str(pathlib.Path(wm.__file__).parents[1])}
    command = [PYTHON, "-c", PARENT.replace("END", end), str(path)]
    with subprocess.Popen(command, env=env, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as parent:
        assert parent.stdout is not None
        pid = int(parent.stdout.readline())
        (folder,) = temporary.iterdir()
        until = time.monotonic() + 20
        while end == ASKS and "begun" not in (folder / "log.txt").read_text() and time.monotonic() < until:
            time.sleep(0.01)
        if stop is not None:
            parent.send_signal(stop)
        parent.communicate()
    assert ends(pid)
    until = time.monotonic() + 20
    while list(temporary.iterdir()) and time.monotonic() < until:
        time.sleep(0.01)
    assert list(temporary.iterdir()) == []
