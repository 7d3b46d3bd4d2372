"""How far an image is shifted against another, by the correlation of their spectra, and images to measure it on.

The spectra are not whitened (`normalization=None`): whitening weighs the rounding of 8 bits like the image, and then finds 0.2 px
between equal images that have little detail.
"""

import itertools

import numpy as np
from scipy.ndimage import gaussian_filter
from skimage.registration import phase_cross_correlation

STEPS = 50
"""Fractions of a pixel that are told apart."""


def texture(width: int, height: int, seed: int = 0) -> np.ndarray:
    """[h, w, 3] uint8: noise with detail down to the pixel and up to a third of the image."""
    rng = np.random.default_rng(seed)
    layers = [
        gaussian_filter(rng.normal(size=(height, width, 3)), (sigma, sigma, 0)) * sigma
        for sigma in (1.0, 2.0, 6.0, 0.1 * min(width, height))
    ]
    image = np.sum(layers, axis=0)
    return np.clip(128 + 40 * image / image.std(), 0, 255).astype(np.uint8)


def shift(image: np.ndarray, other: np.ndarray, tiles: int = 3) -> float:
    """Pixels by which one image is shifted against the other, the most of all tiles (a wrong scale shifts the outer ones)."""
    grey, beside = (np.asarray(x, float).mean(axis=-1) for x in (image, other))
    rows, columns = (np.linspace(0, size, tiles + 1).astype(int) for size in grey.shape)
    found = []
    for top, bottom in itertools.pairwise(rows):
        for left, right in itertools.pairwise(columns):
            window = np.outer(np.hanning(bottom - top), np.hanning(right - left))
            pair = [(x[top:bottom, left:right] - x[top:bottom, left:right].mean()) * window for x in (grey, beside)]
            found.append(np.hypot(*phase_cross_correlation(*pair, upsample_factor=STEPS, normalization=None)[0]))
    return float(max(found))
