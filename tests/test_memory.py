"""Memory is counted with that of children, and of each page once."""

import os
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor

import pytest

from wm import memory as module
from wm.memory import MemoryProbe, resident_gib

WORKER = "block = b'x' * 300_000_000; print('ready', flush=True); input()"


def start_worker() -> subprocess.Popen[bytes]:
    """A process that holds 0.28 GiB until it is sent a line."""
    return subprocess.Popen([sys.executable, "-c", WORKER], stdin=subprocess.PIPE, stdout=subprocess.PIPE)


def test_a_worker_is_counted_from_the_next_listing_until_it_ends(monkeypatch):
    monkeypatch.setattr(module, "LIST_SECONDS", 0.0)
    probe = MemoryProbe()
    before = probe.resident_gib()
    with start_worker() as worker:
        assert worker.stdout is not None and worker.stdout.readline() == b"ready\n"
        assert probe.resident_gib() > before + 0.25
        monkeypatch.setattr(module, "LIST_SECONDS", 1e9)  # it is still among the listed ones when it has ended
        worker.communicate(b"\n")
    assert probe.resident_gib() < before + 0.1


def test_the_memory_of_workers_counts_whichever_thread_started_them():
    before = resident_gib()
    with ThreadPoolExecutor(1) as thread, thread.submit(start_worker).result() as worker:
        assert worker.stdout is not None and worker.stdout.readline() == b"ready\n"
        assert resident_gib() > before + 0.25
        worker.communicate(b"\n")


@pytest.mark.skipif(not hasattr(os, "fork"), reason="forks")
def test_the_memory_of_a_child_that_has_only_been_forked_is_counted_once():
    code = """
import os
from wm.memory import resident_gib

block = b"x" * 300_000_000
ends = os.pipe()
before = resident_gib()
if os.fork() == 0:
    os.read(ends[0], 1)
    os._exit(0)
print(resident_gib() - before)
os.write(ends[1], b"x")
os.wait()
"""
    grown = float(subprocess.run([sys.executable, "-c", code], check=True, capture_output=True, text=True).stdout)
    assert grown < 0.1
