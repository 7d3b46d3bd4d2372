"""Ctrl-C and SIGTERM are heard wherever Python is, and handlers are given back."""

import gc
import os
import signal
import subprocess
import sys
import threading
from pathlib import Path

import pytest

from wm import run
from wm.cli.signals import ending

LOST = """
import gc, os, signal, sys
signal.signal(signal.SIGINT, signal.default_int_handler)  # a shell's background jobs, and what they start, ignore it otherwise
import wm.run

def callback(phase, info):
    os.kill(os.getpid(), signal.{signal})  # heard here, where an error would be printed and forgotten
    for _ in range(1000):
        pass

def collect():
    gc.callbacks.append(callback)
    gc.collect()

wm.run._run_all = collect
wm.run.main()
"""


@pytest.mark.parametrize(("name", "code"), [("SIGINT", 130), ("SIGTERM", 143)])
def test_a_signal_within_a_callback_of_the_garbage_collector_is_not_lost(name, code):
    env = os.environ | {"PYTHONPATH": str(Path(run.__file__).parents[1])}
    done = subprocess.run([sys.executable, "-c", LOST.format(signal=name)], capture_output=True, text=True, env=env, check=False)
    assert (done.returncode, done.stderr) == (code, "wm: interrupted; the same command resumes\n")


def test_handlers_are_given_back_and_what_is_ignored_stays_so():
    gc.collect()
    before = signal.getsignal(signal.SIGINT), signal.getsignal(signal.SIGTERM)
    heard = []
    try:
        signal.signal(signal.SIGINT, signal.default_int_handler)
        signal.signal(signal.SIGTERM, signal.SIG_IGN)  # as under nohup
        with ending(heard.append):
            assert signal.getsignal(signal.SIGTERM) == signal.SIG_IGN
            os.kill(os.getpid(), signal.SIGINT)
        assert heard == [130]
        assert signal.getsignal(signal.SIGINT) is signal.default_int_handler
    finally:
        signal.signal(signal.SIGINT, before[0])
        signal.signal(signal.SIGTERM, before[1])


def test_another_thread_leaves_them_alone():
    before, seen = signal.getsignal(signal.SIGINT), []

    def work():
        with ending(lambda code: None):
            seen.append(signal.getsignal(signal.SIGINT))

    thread = threading.Thread(target=work)
    thread.start()
    thread.join()
    assert seen == [before]
