"""What backends return is taken as it is meant, or refused with an error that names the view and what is wrong."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from wm.geometry.rays.pinhole import make_camera
from wm.offline.depth.estimator import Settings as DepthSettings
from wm.synth.checked import SLACK, checked_estimate, checked_image
from wm.synth.registry import make_backend
from wm.types import View

CAMERA = make_camera(np.array([0.0, 0.0, 1.0]), np.array([1.0, 0.0, 1.0]), width=6, height=4, fov_deg=60.0)
VIEW = View(CAMERA, 0, "perimeter", "hall/perimeter3")
IMAGE = np.linspace(0, 1, 4 * 6 * 3, dtype=np.float32).reshape(4, 6, 3)
DEPTH = IMAGE[..., 0] - 0.5


@given(st.sampled_from([np.float16, np.float32, np.float64]), st.floats(-SLACK, SLACK))
def test_a_floating_image_is_taken_and_its_overshoot_clipped(dtype, over):
    taken = checked_image((IMAGE + 0.9 * over).astype(dtype), VIEW)
    assert taken.dtype == np.float32 and taken.min() >= 0 and taken.max() <= 1
    np.testing.assert_allclose(taken, IMAGE, atol=SLACK + 1e-3)


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_an_image_in_range_is_itself(dtype):
    np.testing.assert_array_equal(checked_image(IMAGE.astype(dtype), VIEW), IMAGE)


@pytest.mark.parametrize(
    ("image", "said"),
    [
        (np.round(IMAGE * 255).astype(np.uint8), r"uint8 of shape \(4, 6, 3\) with values from 0 to 255"),
        (IMAGE * 255, r"float32 .* with values from 0 to 255"),
        (2 * IMAGE - 1, r"with values from -1 to 1"),
        (np.where(IMAGE > 0.9, np.nan, IMAGE), r"float32 .* with 8 values that are not finite"),
        (np.where(IMAGE > 0.9, np.inf, IMAGE), r"not finite"),
        (IMAGE.transpose(2, 0, 1), r"\(3, 4, 6\); .* asks for shape \(4, 6, 3\)"),
        (IMAGE[None], r"\(1, 4, 6, 3\)"),
        (IMAGE.tolist(), r"builtins\.list, not a NumPy array"),
    ],
)
def test_what_is_no_image_is_refused_by_the_name_of_its_view(image, said):
    with pytest.raises(ValueError, match=rf"view hall/perimeter3: the image backend returned.*{said}"):
        checked_image(image, VIEW)


@pytest.mark.parametrize(
    ("estimate", "said"),
    [
        (np.zeros((4, 6), np.uint16), r"uint16 of shape \(4, 6\)"),
        (np.zeros((8, 12)), r"float64 of shape \(8, 12\); .* asks for shape \(4, 6\)"),
        (DEPTH[..., None], r"\(4, 6, 1\)"),
        (DEPTH.tolist(), r"builtins\.list"),
    ],
)
def test_what_is_no_estimate_is_refused_by_the_name_of_its_view(estimate, said):
    with pytest.raises(ValueError, match=rf"view hall/perimeter3: the depth backend returned.*{said}"):
        checked_estimate(estimate, VIEW)


def test_an_estimate_keeps_its_values_and_has_one_word_for_none():
    taken = checked_estimate(DEPTH.astype(np.float64), VIEW)
    assert taken is not None and taken.dtype == np.float32
    np.testing.assert_array_equal(taken, DEPTH)
    spoilt = DEPTH.astype(np.float64)
    spoilt[0, :4] = np.inf, -np.inf, np.nan, 1e300
    taken = checked_estimate(spoilt, VIEW)
    assert taken is not None
    np.testing.assert_array_equal(np.isnan(taken), np.arange(24).reshape(4, 6) < 4)
    assert checked_estimate(None, VIEW) is None


def test_a_group_that_does_not_exist_is_named_with_those_that_do():
    with pytest.raises(ValueError, match=r"'imgae'.*language, image"):
        make_backend("imgae", DepthSettings())
