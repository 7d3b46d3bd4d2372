"""Images made ready for depth models: against transformers' processor where it runs, and by what is known in closed form."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

torch = pytest.importorskip("torch")
transformers = pytest.importorskip("transformers")

from wm.models.depth.depth_anything_2 import _DEVIATION, _MEAN, _MULTIPLE, _SIDE  # noqa: E402 - after what it needs
from wm.models.depth.resampling import at_size, fitted, fitted_size, squashed  # noqa: E402

IMAGE = np.random.default_rng(0).integers(0, 256, (60, 90, 3), dtype=np.uint8)


@pytest.mark.parametrize("shape", [(60, 90), (90, 60), (192, 344), (700, 700), (768, 1376)])
def test_an_image_is_fitted_as_the_processor_of_the_checkpoints_does_it(shape):
    from transformers.models.dpt.image_processing_pil_dpt import DPTImageProcessorPil

    processor = DPTImageProcessorPil(
        do_resize=True, size={"height": _SIDE, "width": _SIDE}, keep_aspect_ratio=True, ensure_multiple_of=_MULTIPLE, resample=3,
        do_rescale=True, rescale_factor=1 / 255, do_normalize=True, image_mean=list(_MEAN), image_std=list(_DEVIATION),
    )  # fmt: skip
    image = np.random.default_rng(0).integers(0, 256, (*shape, 3), dtype=np.uint8)
    theirs = processor(images=image, return_tensors="pt")["pixel_values"]
    ours = fitted(image, _SIDE, _MULTIPLE, _MEAN, _DEVIATION)
    assert ours.shape == theirs.shape and ours.dtype == torch.float32
    assert float((ours - theirs).abs().max()) < 1e-6  # values reach 2.6


@given(st.integers(16, 4000), st.integers(16, 4000))
def test_fitted_sides_are_multiples_near_the_shape_of_the_image(width, height):
    across, down = fitted_size(width, height, 518, 14)
    assert across % 14 == down % 14 == 0
    assert 518 in (across, down)
    scale = 518 / (width if across == 518 and abs(1 - 518 / width) <= abs(1 - 518 / height) else height)
    assert abs(across - scale * width) <= 7 + 1e-6 and abs(down - scale * height) <= 7 + 1e-6


def test_a_squashed_image_of_its_own_size_is_the_image_in_another_range():
    square = IMAGE[:60, :60]
    pixels = squashed(square, 60)[0].permute(1, 2, 0).numpy()
    assert np.abs((pixels + 1) / 2 * 255 - square).max() < 1e-4


def test_a_squashed_ramp_stays_a_ramp_between_pixel_centres():
    ramp = np.repeat(np.arange(0, 180, 2, dtype=np.uint8)[None, :, None], 60, axis=0).repeat(3, axis=2)  # 90 wide
    pixels = squashed(ramp, 180)[0].numpy()
    centres = (np.arange(180) + 0.5) / 2 - 0.5  # in pixels of the ramp
    expected = (np.clip(centres, 0, 89) * 2 / 255 - 0.5) / 0.5
    assert np.abs(pixels - expected).max() < 1e-6


@pytest.mark.parametrize(("mode", "error"), [("bilinear", 1e-5), ("bicubic", 0.05)])  # torch's cubics (a = -3/4) bend ramps
def test_an_answer_at_another_size_is_not_shifted(mode, error):
    answer = torch.arange(40, dtype=torch.float32)[None, None].expand(1, 30, 40)
    found = at_size(answer, 100, 60, mode=mode)
    expected = (np.arange(100) + 0.5) * 0.4 - 0.5
    assert found.shape == (60, 100) and found.dtype == np.float32
    assert np.abs(found - expected)[:, 8:-8].max() < error
    assert np.array_equal(at_size(answer, 40, 30, mode=mode), answer[0].numpy())
