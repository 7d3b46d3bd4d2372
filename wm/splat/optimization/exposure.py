"""Exposure of each view, for image models whose brightness and white balance drift from view to view.

View k is compared with exp(a_k) C + b_k instead of its render C, per channel: a log gain and an offset, moved by gradient descent
beside the gaussians. What all views share belongs to the gaussians: the mean over k of (a_k, b_k) is 0, which fixes the gauge, so
that views which were never trained on are rendered without any. A weak regularisation toward the identity keeps exposures small
that the images do not determine.

Plain descent, not Adam: the gradient of a mean absolute difference is the share of pixels that are too bright less that of those
too dark, which is a scale of its own and vanishes where there is nothing to correct; Adam would take a full step for noise.
"""

import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

REGULARISATION = 0.02
"""Weight of the mean square of a view's exposure in the loss that its exposure descends."""


def no_exposure(views: int) -> Float[np.ndarray, "views 2 3"]:
    """The identity for every view: log gain and offset by channel."""
    return np.zeros((views, 2, 3), np.float32)


def expose(rgb: Float[Array, "h w 3"], exposure: Float[Array, "2 3"]) -> Float[Array, "h w 3"]:
    """A render with the exposure of a view applied."""
    return jnp.exp(exposure[0]) * rgb + exposure[1]


def move_exposure(
    exposure: Float[np.ndarray, "views 2 3"], view: int, gradient: Float[np.ndarray, "2 3"], rate: float
) -> Float[np.ndarray, "views 2 3"]:
    """All exposures after a step of one of them.

    Args:
        exposure: before the step; not changed.
        view: the index of the view.
        gradient: of the loss of that view with respect to its exposure.
        rate: the learning rate: the change of a channel if all pixels are too bright.
    """
    moved = exposure.copy()
    channels = gradient.shape[-1]
    moved[view] -= np.float32(rate) * channels * (gradient + 2 * REGULARISATION / channels * exposure[view])
    return moved - moved.mean(axis=0)
