"""Relative depth made metric by the room that is still to be seen."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.synth.objects.scenes import bare, cameras, piece
from wm.geometry.mesh import assemble_scene
from wm.geometry.raycast import cast
from wm.schema import DepthConfig
from wm.synth.backends import ImageResult
from wm.synth.depth.procedural import ProceduralDepth
from wm.synth.objects.metric_depth import metric_depth

CAMERA = cameras()[0]
EMPTY = cast(bare().structure, CAMERA).depth
THINGS = [piece("wardrobe", 2.4, 0.4, np.pi, (1.5, 0.6, 2.0)), piece("sofa", 2.6, 2.4, 0.0, (2.0, 0.9, 0.85))]
DRAWN = cast(assemble_scene(bare().structure, THINGS), CAMERA).depth


@given(st.floats(0.2, 5), st.floats(0, 1))
def test_scale_and_shift_are_found_though_furniture_hides_the_room(scale, shift):
    found = metric_depth(((DRAWN - shift) / scale + 1.0).astype(np.float32), EMPTY, seed=0)
    assert found is not None and np.median(np.abs(found - DRAWN) / DRAWN) < 2e-3
    assert np.quantile(np.abs(found - DRAWN) / DRAWN, 0.98) < 0.02


def test_the_offline_depth_model_is_within_a_percent():
    image = ImageResult(rgb=np.zeros((*DRAWN.shape, 3), np.float32), drawn_depth=DRAWN)
    for seed in range(3):
        estimate = ProceduralDepth(DepthConfig()).estimate(image, seed=seed)
        found = metric_depth(estimate, EMPTY, seed=seed)
        assert np.median(np.abs(found - DRAWN) / DRAWN) < 0.01


@pytest.mark.parametrize("nothing", ["estimate", "room"])
def test_without_an_estimate_or_a_room_there_is_no_depth(nothing):
    estimate = np.zeros_like(DRAWN) if nothing == "estimate" else DRAWN
    assert metric_depth(estimate, np.zeros_like(EMPTY) if nothing == "room" else EMPTY, seed=0) is None
