"""What is wrong with the arguments of an image measure: dtype, shape and range, named before a number comes out that means
nothing. An image of 8 bits, or of floats from 0 to 255, would be compared with constants that are meant for [0, 1].

Shapes and dtypes are looked at while tracing too; values only where they are there to be seen. NaN is no error: measures of it
are NaN.
"""

from typing import Any

import jax
import numpy as np
from jax.core import Tracer

BRIGHTEST = 16.0
"""Renders overshoot 1 where gaussians are brighter than white; beyond this an image counts from 0 to 255."""

_ROUNDING = 1e-3


def check_images(*, highest: float = BRIGHTEST, **images: Any) -> None:
    """Raises unless images are floating-point arrays [h, w, c] of one shape with values from 0 to `highest`.

    Args:
        images: by the name of the argument.

    Raises:
        TypeError: an image is no array of floating-point numbers.
        ValueError: shapes differ, or a value lies outside the range.
    """
    for name, image in images.items():
        check_floats(name, image, "an image of floats from 0 to 1 (8 bits: image / np.float32(255))")
        if len(image.shape) != 3:
            raise ValueError(f"{name} has shape {tuple(image.shape)}; (height, width, channels) would be right")
    check_shapes(**images)
    for name, image in images.items():
        check_range(name, image, highest)


def check_floats(name: str, x: Any, right: str) -> None:
    """Raises TypeError unless x is an array of real floating-point numbers."""
    if not hasattr(x, "dtype"):
        raise TypeError(f"{name} is a {type(x).__name__}; {right} would be right")
    if not jax.numpy.issubdtype(x.dtype, jax.numpy.floating):
        raise TypeError(f"{name} has dtype {x.dtype}; {right} would be right")


def check_shapes(**arrays: Any) -> None:
    """Raises ValueError unless all arrays have the shape of the first."""
    (first, x), *others = arrays.items()
    for name, other in others:
        if tuple(other.shape) != tuple(x.shape):
            raise ValueError(f"{name} has shape {tuple(other.shape)}; that of {first}, {tuple(x.shape)}, would be right")


def check_range(name: str, image: Any, highest: float = BRIGHTEST) -> None:
    """Raises ValueError where a value lies outside [0, highest]; of a traced image nothing can be said."""
    if isinstance(image, Tracer) or not image.size:
        return
    values = np.asarray(image)
    low, high = np.fmin.reduce(values, axis=None), np.fmax.reduce(values, axis=None)  # these skip NaN
    if low < -_ROUNDING or high > highest + _ROUNDING:
        raise ValueError(f"{name} has values from {low:.4g} to {high:.4g}; an image from 0 to 1 would be right (8 bits: / 255)")
