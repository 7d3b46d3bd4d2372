"""Stage times add up over interruptions and memory is a peak."""

import pathlib
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

from wm.meter import StageMeter, resident_gib


def test_seconds_add_up_and_peaks_do_not():
    meter = StageMeter({"paint": {"seconds": 2.0, "peak_gib": 99.0}})
    with meter.stage("paint"):
        pass
    assert meter.stages["paint"]["seconds"] >= 2.0
    assert meter.stages["paint"]["peak_gib"] == 99.0
    assert meter.seconds == meter.stages["paint"]["seconds"]


def test_peak_sees_memory_that_was_given_back():
    meter = StageMeter()
    before = resident_gib()
    with meter.stage("bake"):
        block = np.ones(60_000_000)
        assert resident_gib() > before
        del block
    assert meter.peak_gib >= before + 0.3


def test_credit_counts_like_a_part_of_the_stage():
    meter = StageMeter({"paint": {"seconds": 2.0, "peak_gib": 1.0}})
    meter.credit("paint", {"seconds": 3.0, "peak_gib": 0.5})
    meter.credit("fit", {"seconds": 4.0, "peak_gib": 2.0})
    assert meter.stages == {"paint": {"seconds": 5.0, "peak_gib": 1.0}, "fit": {"seconds": 4.0, "peak_gib": 2.0}}


def test_a_failing_stage_is_still_measured():
    meter = StageMeter()
    with pytest.raises(ValueError, match="no"), meter.stage("fit"):
        raise ValueError("no")
    assert "fit" in meter.stages


@pytest.mark.skipif(not pathlib.Path("/proc/self/task").exists(), reason="counts workers on Linux only")
def test_the_memory_of_workers_counts_whichever_thread_started_them():
    before = resident_gib()
    code = "block = b'x' * 300_000_000; print('ready', flush=True); input()"

    def start():
        return subprocess.Popen([sys.executable, "-c", code], stdin=subprocess.PIPE, stdout=subprocess.PIPE)

    with ThreadPoolExecutor(1) as thread, thread.submit(start).result() as worker:
        assert worker.stdout is not None and worker.stdout.readline() == b"ready\n"
        assert resident_gib() > before + 0.25
        worker.communicate(b"\n")


@pytest.mark.skipif(not pathlib.Path("/proc/self/task").exists(), reason="counts workers on Linux only")
def test_the_memory_of_a_child_that_has_only_been_forked_is_counted_once():
    code = """
import os
from wm.meter import resident_gib

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
