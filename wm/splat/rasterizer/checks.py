"""Checks of the arguments of a render: of shapes and dtypes always, of values on request.

Shapes and dtypes are known while tracing, so that checking them costs nothing in a compiled program. Values are checked on the
host where they are concrete, and inside jit by `jax.experimental.checkify`.
"""

from collections.abc import Callable
from types import ModuleType
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
from jax.core import Tracer
from jax.experimental import checkify

from wm.bounds import check_settings
from wm.schema import RasterSettings
from wm.types import Camera, Gaussians

DEGREES = {1: 0, 4: 1, 9: 2, 16: 3}
"""Number of coefficients per channel -> degree of the spherical harmonics."""

_SHAPES = {"means": ("n", 3), "quats": ("n", 4), "log_scales": ("n", 3), "opacity_logits": ("n",), "sh": ("n", "k", 3)}
_CAMERA = {"T_cam_world": (4, 4), "focal": (2,), "principal": (2,)}


def check_types(gaussians: Gaussians, camera: Camera, settings: RasterSettings) -> None:
    """Raises if shapes, dtypes or settings cannot be rendered. It reads no values of arrays, so that it can run while tracing.

    Raises:
        TypeError: a leaf is not an array of real floating-point numbers.
        ValueError: a shape, the image size or a setting is wrong.
    """
    check_gaussians(gaussians)
    for name, shape in _CAMERA.items():
        _check_leaf(f"camera.{name}", getattr(camera, name), shape)
    if min(camera.width, camera.height) < 1:
        raise ValueError(f"camera has {camera.width} x {camera.height} pixels; at least 1 x 1 would be right")
    check_raster(settings)


def check_gaussians(gaussians: Gaussians, name: str = "gaussians") -> None:
    """Raises TypeError or ValueError if a leaf of the gaussians is not an array of its shape. Messages call them `name`."""
    for leaf, shape in _SHAPES.items():
        _check_leaf(f"{name}.{leaf}", getattr(gaussians, leaf), shape)
    rows = {leaf: getattr(gaussians, leaf).shape[0] for leaf in _SHAPES}
    if len(set(rows.values())) > 1:
        raise ValueError(f"the leaves of {name} have different lengths {rows}; one row a gaussian in each would be right")
    if gaussians.sh.shape[1] not in DEGREES:
        raise ValueError(
            f"{name}.sh has {gaussians.sh.shape[1]} coefficients a channel; 1, 4, 9 or 16 (degree 0 to 3) would be right"
        )


def check_raster(settings: RasterSettings) -> None:
    """Raises ValueError if a setting of the rasterizer is outside its bounds or cannot be used on this machine."""
    check_settings("settings", settings)
    if settings.alpha_min >= settings.alpha_max:
        raise ValueError(
            f"settings.alpha_min {settings.alpha_min!r} and alpha_max {settings.alpha_max!r} are out of order; "
            "alpha_min < alpha_max would be right"
        )
    if settings.compositor == "kernels" and jax.default_backend() != "gpu":
        raise ValueError(
            "settings.compositor 'kernels' needs an NVIDIA GPU and JAX sees none; auto, loops or interpreted would be right"
        )
    if settings.compositor in ("kernels", "interpreted") and settings.tile.bit_count() != 1:
        raise ValueError(f"settings.tile {settings.tile} does not suit kernels; a power of two would be right")


def check_background(background: Any, camera: Camera) -> None:
    """Raises TypeError or ValueError unless a background is one colour, or one per pixel, in floating-point numbers."""
    image = (camera.height, camera.width, 3)
    _check_dtype("background", background)
    if background.shape not in ((3,), image):
        raise ValueError(f"background has shape {background.shape}; (3,) or {image} (height, width, 3) would be right")


def check_values(gaussians: Gaussians, camera: Camera, background: Any = None) -> None:
    """Raises if a number is not finite or a focal length is not positive. Inside jit this is a check of `checkify`.

    Raises:
        ValueError: naming the leaf and its first bad row. Inside jit: the error that `checkify.checkify` returns.
    """
    for name in _SHAPES:
        _require(_is_finite, f"gaussians.{name}", getattr(gaussians, name), "finite numbers")
    if background is not None:
        _require(_is_finite, "background", background, "finite numbers")
    _require_camera(camera)


def check_camera(camera: Camera) -> None:
    """`check_values` of a camera whose numbers are concrete. Without this check, a bad camera renders an empty image."""
    if not any(isinstance(x, Tracer) for x in jax.tree.leaves(camera)):
        _require_camera(camera)


def _require_camera(camera: Camera) -> None:
    for name in _CAMERA:
        _require(_is_finite, f"camera.{name}", getattr(camera, name), "finite numbers")
    _require(_is_positive, "camera.focal", camera.focal, "positive focal lengths")


def _is_finite(x, xp: ModuleType):
    return xp.isfinite(x)


def _is_positive(x, xp: ModuleType):
    return x > 0


def _require(is_good: Callable, name: str, x: Any, wanted: str) -> None:
    traced = isinstance(x, Tracer)
    xp = jnp if traced else np
    x = xp.asarray(x)
    if not x.size:
        return
    rows = is_good(x, xp).reshape(x.shape[0], -1).all(1)
    first = xp.argmin(rows)
    if traced:
        checkify.check(rows.all(), f"{name}[{{row}}] is bad; {wanted} would be right", row=first)
    elif not rows.all():
        raise ValueError(f"{name}[{first}] is {x[first]}; {wanted} would be right")


def _check_leaf(name: str, x: Any, shape: tuple) -> None:
    _check_dtype(name, x)
    fits = len(x.shape) == len(shape) and all(isinstance(a, str) or a == b for a, b in zip(shape, x.shape))
    if not fits:
        raise ValueError(f"{name} has shape {tuple(x.shape)}; ({', '.join(map(str, shape))}) would be right")


def _check_dtype(name: str, x: Any) -> None:
    if not hasattr(x, "dtype"):
        raise TypeError(f"{name} is a {type(x).__name__}; an array would be right")
    if not jnp.issubdtype(x.dtype, jnp.floating):
        raise TypeError(f"{name} has dtype {x.dtype}; floating-point numbers would be right")
