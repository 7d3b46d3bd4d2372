"""Relative depth made metric by the room that is still to be seen."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.synth.lifting.scenes import bare, cameras, piece
from wm.geometry.mesh.scene_mesh import assemble_scene
from wm.geometry.rays.raycast import cast
from wm.offline.depth.estimator import ProceduralDepth
from wm.offline.depth.estimator import Settings as DepthSettings
from wm.synth.backends import ImageResult
from wm.synth.lifting.metric_depth import metric_depth

CAMERA = cameras()[0]
EMPTY = cast(bare().structure, CAMERA).depth
THINGS = [piece("wardrobe", 2.4, 0.4, np.pi, (1.5, 0.6, 2.0)), piece("sofa", 2.6, 2.4, 0.0, (2.0, 0.9, 0.85))]
DRAWN = cast(assemble_scene(bare().structure, THINGS), CAMERA).depth


@given(st.floats(0.2, 5), st.floats(-10, 10))
def test_scale_and_shift_are_found_though_furniture_hides_the_room(scale, shift):
    found = metric_depth(((DRAWN - shift) / scale).astype(np.float32), EMPTY, seed=0)
    assert found is not None and (found > 0).all()  # zero and negative values are depth like others
    assert np.median(np.abs(found - DRAWN) / DRAWN) < 2e-3
    assert np.quantile(np.abs(found - DRAWN) / DRAWN, 0.98) < 0.02


def test_what_has_no_estimate_is_unknown_and_bends_nothing():
    whole = metric_depth(DRAWN, EMPTY, seed=0)
    partial = DRAWN.copy()
    partial[:40], partial[80, 80] = np.nan, np.nan
    found = metric_depth(partial, EMPTY, seed=0)
    assert whole is not None and found is not None
    np.testing.assert_array_equal(found == 0, np.isnan(partial))
    assert np.abs(found / whole - 1)[found > 0].max() < 0.01


def test_an_estimate_that_is_the_nearer_the_larger_or_constant_tells_nothing():
    assert metric_depth(-DRAWN, EMPTY, seed=0) is None
    assert metric_depth(np.full_like(DRAWN, 2.0), EMPTY, seed=0) is None


def test_the_offline_depth_model_is_within_a_percent():
    image = ImageResult(rgb=np.zeros((*DRAWN.shape, 3), np.float32), drawn_depth=DRAWN)
    for seed in range(3):
        estimate = ProceduralDepth(DepthSettings()).estimate(image, seed=seed)
        found = metric_depth(estimate, EMPTY, seed=seed)
        assert np.median(np.abs(found - DRAWN) / DRAWN) < 0.01


@pytest.mark.parametrize("nothing", ["estimate", "room"])
def test_without_an_estimate_or_a_room_there_is_no_depth(nothing):
    estimate = np.full_like(DRAWN, np.nan) if nothing == "estimate" else DRAWN
    assert metric_depth(estimate, np.zeros_like(EMPTY) if nothing == "room" else EMPTY, seed=0) is None
