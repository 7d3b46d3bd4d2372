"""Stage times add up over interruptions and memory is a peak."""

import threading
import time

import numpy as np
import pytest

from tests.test_memory import start_worker
from wm import meter as module
from wm.artifacts.timings import UNKNOWN
from wm.memory import resident_gib
from wm.meter import StageMeter


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


def test_a_stage_that_finds_all_done_keeps_its_row_and_gets_none():
    meter = StageMeter({"paint": {"seconds": 2.0, "peak_gib": 1.0}})
    for name in ("paint", "reconstruct"):
        with meter.stage(name, made=lambda: False):
            pass
    assert meter.stages == {"paint": {"seconds": 2.0, "peak_gib": 1.0}}


def test_what_was_lost_stays_unknown_and_so_does_the_sum():
    meter = StageMeter({"plan": {"seconds": 2.0, "peak_gib": 1.0}, "paint": UNKNOWN})
    with meter.stage("paint"):
        pass
    assert meter.stages["paint"] == UNKNOWN and meter.seconds is None and meter.peak_gib is None
    meter.outdate()
    with meter.stage("paint"):
        pass
    assert meter.seconds is not None and meter.seconds >= 2.0


def test_a_stage_of_another_run_is_forgotten():
    meter = StageMeter({"furnish": {"seconds": 2.0, "peak_gib": 1.0}})
    assert meter.knows("furnish")
    meter.outdate()
    assert not meter.knows("furnish")
    meter.forget("furnish")
    meter.forget("furnish")
    assert meter.stages == {}


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


def test_a_peak_counts_a_worker_that_began_and_ended_within_the_stage(monkeypatch):
    monkeypatch.setattr(module, "KEEP_SECONDS", 0.0)
    before, seen = resident_gib(), threading.Event()
    meter = StageMeter(keep=lambda rows: seen.set() if rows["fit"]["peak_gib"] > before + 0.25 else None)
    with meter.stage("fit"), start_worker() as worker:
        assert seen.wait(60)
        worker.communicate(b"\n")
    assert resident_gib() < before + 0.25 < meter.peak_gib
