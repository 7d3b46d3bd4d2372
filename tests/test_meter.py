"""Stage times add up over interruptions and memory is a peak."""

import pathlib
import subprocess
import sys
import threading
import time
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

from wm import meter as module
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


def test_a_stage_that_finds_all_done_costs_nothing_but_the_first_time():
    meter = StageMeter({"paint": {"seconds": 2.0, "peak_gib": 1.0}})
    for name in ("paint", "structure"):
        with meter.stage(name, made=lambda: False):
            pass
    assert meter.stages["paint"] == {"seconds": 2.0, "peak_gib": 1.0} and "structure" in meter.stages


def test_of_another_run_counts_only_what_is_still_used():
    rows = {name: {"seconds": 1e3, "peak_gib": 99.0} for name in ("plan", "paint", "fit")}
    meter = StageMeter(rows)
    meter.outdate()
    with meter.stage("plan", made=lambda: False):
        pass
    for _ in range(2):
        with meter.stage("paint"):
            time.sleep(0.01)
    meter.credit("fit", {"seconds": 4.0, "peak_gib": 2.0})
    assert meter.stages["plan"] == rows["plan"]
    assert 0.02 <= meter.stages["paint"]["seconds"] < 1e3 and meter.stages["paint"]["peak_gib"] < 99
    assert meter.stages["fit"] == {"seconds": 4.0, "peak_gib": 2.0}


def test_the_times_of_a_stage_under_way_are_kept_for_when_the_process_is_killed(monkeypatch):
    monkeypatch.setattr(module, "KEEP_SECONDS", 0.0)
    kept, seen = [], threading.Event()

    def keep(rows):
        kept.append(rows)
        seen.set()
        raise OSError("no space left")

    meter = StageMeter({"plan": {"seconds": 1.0, "peak_gib": 1.0}}, keep=keep)
    with pytest.raises(OSError, match="no space"), meter.stage("paint"):  # at the end it is said
        assert seen.wait(60)
    assert set(kept[0]) == {"plan", "paint"} and kept[0]["paint"]["seconds"] <= meter.stages["paint"]["seconds"]


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
from wm import meter as module
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
