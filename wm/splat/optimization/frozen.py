"""Frozen gaussians: those of neighbouring rooms, which a view sees through doors and which the fit of its room does not move.

They do not change while the fit runs, so they are projected once per view, and those that the scaffold hides from the view are
dropped: a room behind a wall costs nothing, and what is left is a small set of projected ellipses.
"""

import math

import jax
import jax.numpy as jnp
import numpy as np
from scipy.ndimage import maximum_filter

from wm.splat.rasterizer.projection import Projected

MARGIN = 0.25
"""Metres behind the scaffold up to which a gaussian may still show."""

REACH = 8
"""Pixels around its centre that a gaussian may cover before it is kept whatever stands in front of it."""


def visible_columns(projected: Projected, depth: np.ndarray, size: tuple[int, int] | None = None) -> Projected:
    """The columns of `projected` (NumPy) that a view can see.

    Args:
        projected: gaussians on an image.
        depth: [h, w] the scaffold's depth there, metres (0: nothing there); a coarser image than that of the view will do.
        size: (height, width) of the view's image; None: that of `depth`.
    """
    h, w = size or depth.shape
    mean, extent, z, opacity = (np.asarray(x) for x in (projected.mean2d, projected.extent, projected.depth, projected.opacity))
    limits = np.array([[w], [h]])
    shown = np.flatnonzero((opacity > 0) & ((mean + extent > 0) & (mean - extent < limits)).all(axis=0))
    if len(shown):
        scale = np.array([[depth.shape[1] / w], [depth.shape[0] / h]])
        reach = [math.ceil(REACH * s) for s in scale[::-1, 0]]
        farthest = maximum_filter(np.where(depth > 0, depth, np.inf), size=[2 * r + 1 for r in reach])
        last = np.array([[depth.shape[1] - 1], [depth.shape[0] - 1]])
        u, v = np.clip(np.floor(mean[:, shown] * scale).astype(np.int64), 0, last)
        large = (extent[:, shown] > REACH).any(axis=0)
        shown = shown[large | (z[shown] < farthest[v, u] + MARGIN)]
    return jax.tree.map(lambda x: np.asarray(x)[..., shown], projected)


def join_columns(*parts: Projected | None) -> Projected:
    """Several projections as one, in order; None stands for none. NumPy stays NumPy."""
    first, *others = (part for part in parts if part is not None)
    join = np.concatenate if all(isinstance(x, np.ndarray) for x in jax.tree.leaves((first, others))) else jnp.concatenate
    return jax.tree.map(lambda *xs: join(xs, axis=-1), first, *others) if others else first


def pad_columns(projected: Projected | None, size: int) -> Projected:
    """Columns up to `size`: those added (all of them for None) have opacity and extent 0, so no tile lists them."""
    if projected is None:
        rows = {"mean2d": 2, "root": 3, "color": 3, "slope": 2, "extent": 2}
        empty = {name: np.zeros((rows[name], 0) if name in rows else 0, np.float32) for name in ("opacity", "depth", *rows)}
        projected = Projected(**empty)
    missing = size - projected.opacity.shape[-1]
    return jax.tree.map(lambda x: np.concatenate([x, np.zeros((*x.shape[:-1], missing), x.dtype)], axis=-1), projected)
