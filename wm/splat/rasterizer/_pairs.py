"""The arithmetic of one gaussian at one pixel, and the table in which gaussians come to it; compositing.py holds the equations.

Everything here is elementwise over arrays of any shape, so that loops over blocks (_loops.py) and kernels (_kernels.py) compute
the same numbers.
"""

import math
from typing import Any

import jax.numpy as jnp

from wm.schema import RasterSettings
from wm.splat.rasterizer._axes import has_slope
from wm.splat.rasterizer._exp2 import exp2_between, exp2_error
from wm.types import record

GEOMETRY = 6
"""Columns of the table before the features: mean x, y, l0, l1, l2 and log2 o, as compositing.py defines them."""

DEPTH = 3
"""Index of the first feature that is depth: of the gaussian's centre in the table, at the tile's centre when
it is composited."""

CLAMPED = 1e-6
"""Alphas closer than this (relative) to alpha_max count as clamped, or closer than the error of the power of two there."""


@record
class Composite:
    """Result of the compositing, lane by lane as the plan orders the tiles (blocks and lanes flattened)."""

    transmittance: Any  # [lanes, pixels]
    features: Any  # [lanes, features, pixels]
    length: Any  # [lanes] int32 entries visited before the list ended or every pixel was finished; no gradient


def alpha_at(dx, dy, l0, l1, l2, log2_opacity, settings: RasterSettings):
    """Alpha at an offset from a gaussian's mean, cut and clamped."""
    lowest, highest = math.log2(settings.alpha_min), math.log2(settings.alpha_max)
    log2_alpha = log2_opacity - (l0 * dx + l1 * dy) ** 2 - (l2 * dy) ** 2
    kept = log2_alpha >= lowest
    return jnp.where(kept, exp2_between(jnp.where(kept, jnp.minimum(log2_alpha, highest), 0.0), lowest), 0.0)


def weight(t, alpha, settings: RasterSettings):
    """The compositing weight of a gaussian behind transmittance t; 0 where the pixel is finished."""
    return jnp.where(t >= settings.transmittance_min, alpha * t, 0.0)


def slope(rest, alpha, w, share, settings: RasterSettings):
    """dL/d ln alpha, from the part of the loss still to come behind the gaussian; 0 where alpha is clamped or cut."""
    free = (w > 0) & (alpha < settings.alpha_max * (1 - clamp_tolerance(settings)))
    return jnp.where(free, share - rest * (alpha / (1 - alpha)), 0.0)


def clamp_tolerance(settings: RasterSettings) -> float:
    """How far, relatively, a clamped alpha may lie below alpha_max; a constant of the settings."""
    lowest, highest = math.log2(settings.alpha_min), math.log2(settings.alpha_max)
    return max(CLAMPED, exp2_error(highest, lowest) + 2.0**-24)  # what it is compared with is rounded too


def gradient_columns(place, root, tilt, place_moments, feature_sums, settings: RasterSettings) -> list:
    """Derivatives with respect to the columns of the table, whose logarithms are binary.

    Args:
        place: x, y of the mean from the tile's centre.
        root: l0, l1, l2.
        tilt: depth's slope to the right and down; not read unless depth is slanted.
        place_moments: moments of dL/d ln alpha over the tile, as `_tile_sums.POWERS` orders them.
        feature_sums: sums of w g over the tile, by feature.
    """
    (x, y), (l0, l1, l2) = place, root
    m0, mu, mv, muu, muv, mvv = (math.log(2) * moment for moment in place_moments)
    sx, sy = mu - x * m0, mv - y * m0
    sxx, syy = muu - 2 * x * mu + x * x * m0, mvv - 2 * y * mv + y * y * m0
    sxy = muv - x * mv - y * mu + x * y * m0
    ex, exx, exy = l0 * sx + l1 * sy, l0 * sxx + l1 * sxy, l0 * sxy + l1 * syy  # e = l0 dx + l1 dy summed with 1, dx, dy
    g_mean, feature_sums = [2 * l0 * ex, 2 * (l1 * ex + l2 * l2 * sy)], list(feature_sums)
    if has_slope(settings):
        *color, g_depth, g_right, g_down = feature_sums
        g_mean = [g_mean[0] - tilt[0] * g_depth, g_mean[1] - tilt[1] * g_depth]
        feature_sums = [*color, g_depth, g_right - x * g_depth, g_down - y * g_depth]
    return [*g_mean, -2 * exx, -2 * exy, -2 * l2 * syy, m0, *feature_sums]
