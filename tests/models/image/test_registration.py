"""Laws of registration: a view that goes onto a canvas and comes back in an image of any size has not moved."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.ndimage import map_coordinates
from scipy.ndimage import shift as moved

from tests.models.image.drawing_servers import redrawn
from tests.models.image.shift import shift, texture
from wm.models.image.nano_banana_pro import canvases
from wm.models.image.registration import ImageCanvas, SizeLimits, cut_out, nearest_canvas, placed
from wm.services.faults import RefusedError

LIMITS = SizeLimits(step=16, edge=3840, low=655_360, high=8_294_400, widest=3.0)
GEMINI = canvases("1K")
sides = st.integers(16, 4000)


@pytest.mark.parametrize("pixels", [0.0, 0.1, 0.25, 0.5])
def test_the_measure_finds_a_known_shift(pixels):
    image = texture(320, 200)
    other = moved(image.astype(float), (0, pixels, 0), order=5, mode="nearest")
    assert shift(image, other) == pytest.approx(pixels, abs=0.03)


@pytest.mark.parametrize("canvas", GEMINI, ids=lambda canvas: canvas.ratio)
@pytest.mark.parametrize("answer", [1.0, 2.0, 0.73], ids=["as asked", "twice", "odd"])
def test_a_view_comes_back_where_it_was(canvas, answer):
    """At half the service's sizes; experiments/registration has them all, through the backends."""
    half = ImageCanvas(canvas.width // 2, canvas.height // 2)
    width, height = canvas.width // 4 + 3, canvas.height // 4  # not quite the shape of the canvas
    assert nearest_canvas(GEMINI, width, height) == canvas
    view = texture(width, height)
    drawn = redrawn(placed(view, half), round(answer * half.width), round(answer * half.height))
    assert shift(view, cut_out(drawn, half, width, height)) <= 0.05  # the figure wanted is 0.25


def test_pixel_numbers_in_place_of_centres_would_be_found():
    view = texture(320, 200)
    places = np.mgrid[:800, :1280] / 4
    wrong = np.stack([map_coordinates(view[..., c].astype(float), places, order=1, mode="nearest") for c in range(3)], axis=-1)
    assert shift(view, cut_out(wrong.astype(np.uint8), ImageCanvas(1280, 800), 320, 200)) == pytest.approx(
        0.375 * 2**0.5, abs=0.05
    )


@given(width=st.integers(4, 40), height=st.integers(4, 40), seed=st.integers(0, 9))
def test_on_a_canvas_of_its_own_size_a_view_keeps_its_bytes(width, height, seed):
    view = np.random.default_rng(seed).integers(0, 256, (height, width, 3), dtype=np.uint8)
    canvas = ImageCanvas(width, height)
    assert np.array_equal(placed(view, canvas), view)
    assert np.array_equal(cut_out(view, canvas, width, height), view)


@given(width=st.integers(4, 60), height=st.integers(4, 60), to_width=st.integers(8, 80), to_height=st.integers(8, 80))
def test_a_canvas_shows_no_value_that_the_view_has_not(width, height, to_width, to_height):
    view = np.random.default_rng(0).integers(60, 200, (height, width, 3), dtype=np.uint8)
    canvas = placed(view, ImageCanvas(to_width, to_height))
    assert canvas.shape == (to_height, to_width, 3)
    assert view.min() <= canvas.min() and canvas.max() <= view.max()


@given(width=sides, height=sides)
def test_a_view_lies_within_its_canvas_undistorted_and_fills_it_one_way(width, height):
    canvas = nearest_canvas(GEMINI, width, height)
    left, top, right, bottom = canvas.frame(width, height)
    assert min(left, top) == pytest.approx(0, abs=1e-9)
    assert left + right == pytest.approx(canvas.width) and top + bottom == pytest.approx(canvas.height)
    assert (right - left) / width == pytest.approx((bottom - top) / height)


@given(width=sides, height=sides)
def test_no_offered_shape_is_nearer_and_no_smaller_canvas_would_do(width, height):
    offered = canvases("4K")
    chosen = nearest_canvas(offered, width, height)
    stretch = [abs(math.log(c.width / c.height * height / width)) for c in offered]
    assert stretch[offered.index(chosen)] <= min(stretch) + 1e-9
    same = [c for c in offered if c.ratio == chosen.ratio]
    holding = [c for c in same if c.width >= width and c.height >= height]
    assert chosen == (min(holding, key=lambda c: c.width) if holding else max(same, key=lambda c: c.width))


@settings(deadline=None)
@given(width=sides, height=sides, pixels=st.sampled_from([1, 1024**2, 2560 * 1440, 3840 * 2160, 10**9]))
def test_a_canvas_within_limits_keeps_them_and_has_the_shape_of_the_view(width, height, pixels):
    canvas = LIMITS.nearest(width, height, pixels)
    sides = canvas.width, canvas.height
    assert all(side % 16 == 0 and side <= 3840 for side in sides)
    assert 655_360 <= canvas.width * canvas.height <= 8_294_400 and max(sides) <= 3 * min(sides)
    if max(width, height) <= 3 * min(width, height):
        assert abs(math.log(canvas.width / canvas.height * height / width)) < 0.01


def test_the_sizes_of_our_presets_need_no_resampling_by_a_fraction():
    for width, height in ((344, 192), (688, 384), (1376, 768)):
        for canvas in (nearest_canvas(GEMINI, width, height), LIMITS.nearest(width, height, 1024**2)):
            assert (canvas.width, canvas.height) == (1376, 768)


def test_an_image_of_another_shape_is_refused():
    canvas = ImageCanvas(1376, 768, "16:9")
    assert cut_out(np.zeros((770, 1344, 3), np.uint8), canvas, 86, 48).shape == (48, 86, 3)
    with pytest.raises(RefusedError, match="1024 x 1024 pixels, which is another shape than 1376 x 768"):
        cut_out(np.zeros((1024, 1024, 3), np.uint8), canvas, 86, 48)
