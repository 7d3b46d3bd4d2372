"""PSNR against scikit-image's."""

import numpy as np
import pytest
from skimage.metrics import peak_signal_noise_ratio

from wm.splat.metrics import psnr


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_psnr_is_scikit_images_over_the_mask(dtype):
    rng = np.random.default_rng(0)
    image, truth = rng.random((2, 24, 40, 3)).astype(dtype)
    mask = rng.random((24, 40)) < 0.4
    for ours, pixels in ((psnr(image, truth), np.ones_like(mask)), (psnr(image, truth, mask), mask)):
        peer = peak_signal_noise_ratio(truth[pixels].astype(np.float64), image[pixels].astype(np.float64), data_range=1.0)
        np.testing.assert_allclose(ours, peer, rtol=1e-6)
