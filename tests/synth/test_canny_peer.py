"""Depth edges against scikit-image's Canny: another implementation, the same thresholds, edges at about the same places."""

import numpy as np
from scipy.ndimage import binary_dilation
from skimage.feature import canny as peer_canny

from wm.synth.canny import depth_edges


def _boxes(rng):
    """A far wall and boxes before it."""
    depth = np.full((96, 160), 5.0, np.float32)
    for _ in range(6):
        i, j = rng.integers(4, 60), rng.integers(4, 110)
        depth[i : i + rng.integers(15, 30), j : j + rng.integers(15, 40)] = rng.uniform(1, 3)
    return depth


def test_edges_lie_where_scikit_image_finds_them():
    rng = np.random.default_rng(0)
    for _ in range(5):
        depth = _boxes(rng)
        ours = depth_edges(depth, depth > 0, low=0.1, high=0.3)
        normalised = (depth - depth.min()) / np.ptp(depth)
        theirs = peer_canny(normalised, sigma=0, low_threshold=0.1, high_threshold=0.3)
        near = binary_dilation(ours, iterations=2)
        assert theirs.any()
        assert (theirs & near).sum() >= 0.95 * theirs.sum()
