"""Checks of what backends return, made as soon as it is returned, so that an error can name the view and the expected value.

Common mistakes of a model that is plugged in for the first time: bytes instead of floats, [-1, 1] instead of [0, 1], channels
first, a tensor of its framework instead of a NumPy array, or its own image size instead of the requested one.
"""

from typing import Any

import numpy as np
from jaxtyping import Float

from wm.types import View

SLACK = 0.01
"""How far values of an image may lie outside [0, 1], since rounding and resampling can overshoot. They are clipped."""


def checked_image(rgb: Any, view: View) -> Float[np.ndarray, "h w 3"]:
    """The image of a view that an image backend returned, as float32 in [0, 1].

    Raises:
      ValueError: it is not a floating-point [h, w, 3] array of the view's size, or has values that are not finite or lie more
        than SLACK outside [0, 1]; the message names view, shape, dtype and range.
    """
    where = f"view {view.name}: the image backend returned"
    shape = (view.camera.height, view.camera.width, 3)
    _check_array(rgb, shape, where, "an image is floating sRGB in [0, 1]")
    low, high = float(rgb.min()), float(rgb.max())
    if not np.isfinite(rgb).all():
        raise ValueError(f"{where} {_told(rgb)} with {int((~np.isfinite(rgb)).sum())} values that are not finite")
    if low < -SLACK or high > 1 + SLACK:
        raise ValueError(f"{where} {_told(rgb)} with values from {low:g} to {high:g}; an image is floating sRGB in [0, 1]")
    return np.clip(rgb.astype(np.float32), 0, 1)


def checked_estimate(estimate: Any, view: View) -> Float[np.ndarray, "h w"] | None:
    """The depth estimate that a depth backend returned, as float32 with NaN for every value that is not finite; None stays None.

    Raises:
      ValueError: it is not a floating-point [h, w] array of the view's size; the message names view, shape and dtype.
    """
    if estimate is None:
        return None
    where = f"view {view.name}: the depth backend returned"
    _check_array(estimate, (view.camera.height, view.camera.width), where, "an estimate is floating, NaN where there is none")
    with np.errstate(over="ignore"):  # a value beyond the range of float32 becomes infinite, hence NaN
        single = estimate.astype(np.float32)
    return np.where(np.isfinite(single), single, np.float32(np.nan))


def _check_array(array: Any, shape: tuple[int, ...], where: str, right: str) -> None:
    if not isinstance(array, np.ndarray):
        raise ValueError(f"{where} a {type(array).__module__}.{type(array).__name__}, not a NumPy array of shape {shape}")
    if array.shape != shape:
        raise ValueError(f"{where} {_told(array)}; this view's camera asks for shape {shape}")
    if not np.issubdtype(array.dtype, np.floating):
        span = f" with values from {array.min()} to {array.max()}"
        raise ValueError(f"{where} {_told(array)}{span}; {right}")


def _told(array: np.ndarray) -> str:
    return f"{array.dtype} of shape {array.shape}"
