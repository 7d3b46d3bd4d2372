"""Stage times add up over interruptions and memory is a peak."""

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


def test_a_failing_stage_is_still_measured():
    meter = StageMeter()
    with pytest.raises(ValueError, match="no"), meter.stage("fit"):
        raise ValueError("no")
    assert "fit" in meter.stages
