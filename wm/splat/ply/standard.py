"""Gaussians in the form that every program reads alike: unit quaternions and finite opacities. No render changes by it."""

import jax
import numpy as np
from jaxtyping import Float32, Num

from wm.types import Gaussians

HIGHEST_LOGIT = 6.2
"""Opacity 0.99797, less than 254.5 of 255. A higher one becomes 255 in formats of 8 bits, and infinite where their readers take
the logarithm. The rasterizer clamps alphas at 0.99, so what is drawn changes by less than half a step of 8 bits."""

LOWEST_LOGIT = -20.0
"""Opacity 2e-9: far below what any program draws."""

FLATTEST, LARGEST = -10.0, 10.0
"""Bounds of logarithms of scales in packed files: 0.05 mm, which is thin enough for a disc, to 22 km. SPZ holds -10 to 5.9."""

_ALREADY_UNIT = 1e-6  # of a squared length: nearer to 1 is rounding, and dividing by it again would move the last digits


def packable(gaussians: Gaussians) -> Gaussians:
    """The gaussians (NumPy float32 leaves) with unit quaternions, and with opacities and scales that a packed file can hold.

    Those with a number that is not finite, which no rasterizer draws, are left out: one would spoil the bounds of all others. A
    scale of zero, which has the logarithm -inf, is that of a disc and becomes 0.05 mm.
    """
    g: Gaussians = jax.tree.map(lambda leaf: np.asarray(leaf, np.float32), gaussians)
    rows = [g.means, g.quats, np.where(g.log_scales == -np.inf, 0, g.log_scales), g.sh.reshape(len(g.sh), 3 * g.sh.shape[1])]
    good = np.isfinite(np.concatenate(rows, axis=1)).all(axis=1) & ~np.isnan(g.opacity_logits)
    g = jax.tree.map(lambda leaf: leaf[good], g)
    return Gaussians(
        means=g.means,
        quats=unit_quats(g.quats),
        log_scales=np.clip(g.log_scales, FLATTEST, LARGEST),
        opacity_logits=bounded_logits(g.opacity_logits),
        sh=g.sh,
    )


def bounded_logits(logits: Num[np.ndarray, " n"]) -> Num[np.ndarray, " n"]:
    """Finite logits; NaN, which the rasterizer does not draw, as the lowest."""
    return np.clip(np.where(np.isnan(logits), LOWEST_LOGIT, logits), LOWEST_LOGIT, HIGHEST_LOGIT)


def unit_quats(quats: Num[np.ndarray, "n 4"]) -> Float32[np.ndarray, "n 4"]:
    """Quaternions of unit length; those that are, to rounding, stay as they are. Zero, which rotates nothing, is the identity."""
    q = quats.astype(np.float64)
    largest = np.abs(q).max(axis=1, keepdims=True, initial=0)
    with np.errstate(invalid="ignore"):  # what is not finite stays so, and is not drawn
        square = (q**2).sum(axis=1, keepdims=True)
        q = np.where(largest == 0, np.array([1.0, 0, 0, 0]), q / np.where(largest == 0, 1, largest))
        unit = q / np.linalg.norm(q, axis=1, keepdims=True)
    return np.where(np.abs(square - 1) < _ALREADY_UNIT, quats, unit).astype(np.float32)
