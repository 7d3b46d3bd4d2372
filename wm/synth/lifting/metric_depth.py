"""Relative depth made metric: the empty room's depth D0 is known, and a furnished image still shows much of that room.

A depth model gives e with D = a e + b up to a slowly varying error. Where the image shows structure, D must be D0, and
elsewhere D < D0. So (a, b) comes from the pair of pixels that most pixels agree with (RANSAC), refined by least squares over
those; the ratio D0 / D that they leave is smoothed over the image and corrects what is between them.
"""

import numpy as np
from jaxtyping import Float
from scipy.ndimage import gaussian_filter

_PAIRS = 400
_AGREES = 0.03
"""Relative difference from D0 up to which a pixel is taken to show structure."""
_STRAYS = 24.0 / 688
"""Share of the image's width over which a depth model's error is alike."""
_SAMPLE = 4000


def metric_depth(
    estimate: Float[np.ndarray, "h w"], bare: Float[np.ndarray, "h w"], *, seed: int
) -> Float[np.ndarray, "h w"] | None:
    """[h, w] float32 z-depth in metres, 0 where there is no estimate; None where nothing of the room can be told by it.

    Args:
      estimate: depth up to a positive scale and any shift, so that values mean nothing by themselves; NaN where there is none.
      bare: z-depth D0 of the empty room from the same camera, metres, 0 where nothing is hit.
    """
    estimated = np.isfinite(estimate)
    usable = estimated & (bare > 0)
    if usable.sum() < 100:
        return None
    rng = np.random.default_rng(np.random.SeedSequence([seed, 0xD0]))
    chosen = rng.choice(np.flatnonzero(usable), min(_SAMPLE, int(usable.sum())), replace=False)
    line = _line(estimate.ravel()[chosen], bare.ravel()[chosen], rng)
    if line is None:
        return None
    depth = np.where(estimated, line[0] * np.where(estimated, estimate, 0) + line[1], 0.0)
    structure = usable & (np.abs(depth - bare) < _AGREES * bare)
    if not structure.any():
        return None
    ratio = np.where(structure, bare / np.where(depth > 0, depth, 1.0), 0.0)
    sigma = _STRAYS * estimate.shape[1]
    weight = gaussian_filter(structure.astype(np.float64), sigma, mode="nearest")
    known = gaussian_filter(ratio, sigma, mode="nearest") + 0.01
    return np.maximum(depth * known / (weight + 0.01), 0.0).astype(np.float32)


def _line(e: np.ndarray, d: np.ndarray, rng: np.random.Generator) -> tuple[float, float] | None:
    """(a, b) of d = a e + b for the most values; None where more are on a line with a < 0: e is an inverse depth."""
    pairs = rng.integers(len(e), size=(_PAIRS, 2))
    run = e[pairs[:, 1]] - e[pairs[:, 0]]
    fine = np.abs(run) > 0.05 * np.ptp(e)
    slope = (d[pairs[fine, 1]] - d[pairs[fine, 0]]) / run[fine]
    offset = d[pairs[fine, 0]] - slope * e[pairs[fine, 0]]
    agree = np.abs(slope[:, None] * e + offset[:, None] - d) < _AGREES * d
    count = agree.sum(axis=1)
    upward = slope > 0
    if not upward.any() or count[~upward].max(initial=0) > count[upward].max():
        return None
    best = agree[upward][int(np.argmax(count[upward]))]
    basis = np.stack([e[best], np.ones(int(best.sum()))], axis=1) / d[best][:, None]
    (scale, shift), *_ = np.linalg.lstsq(basis, np.ones(len(basis)), rcond=None)
    return float(scale), float(shift)
