"""Structural similarity with a hand-written gradient.

With a gaussian window b (11 taps, sigma 1.5, zero padding) and, per pixel and channel, m = b * x, s = b * (x y) - m_x m_y:

    S = A1 A2 / (B1 B2),   A1 = 2 m_x m_y + c1,      A2 = 2 s_xy + c2,
                           B1 = m_x^2 + m_y^2 + c1,  B2 = s_xx + s_yy + c2 = b * (x^2 + y^2) - m_x^2 - m_y^2 + c2

S depends on x through m_x, b * (x^2 + y^2) and b * (x y), so its gradient is three more blurs of its partial derivatives (b is
even), and the gradient with respect to y shares two of them:

    dL/dx = b * (g S_mx) + 2 x  b * (g S_q) + y  b * (g S_xy),   S_q = -S / B2,   S_xy = 2 A1 / (B1 B2)

The blur is separable. XLA on a CPU fuses the two passes and then recomputes the inner one once per outer tap, several times
slower, so a fusion barrier follows each pass. A last axis of 3 is not vectorised: the arithmetic is done on planes [c, h, w].

scikit-image's `structural_similarity` is the independent check (tests/splat/test_similarity_peer.py: equal maps away from the
border) and cannot take the place of this one: a fit needs the derivative, inside jit and on the device. With the barriers an
image of 688 x 384 x 3 takes 14 ms on a CPU core, without them 160 ms.

Source: Wang et al. 2004, eq. 13 (c1 = 0.01^2, c2 = 0.03^2 for images in [0, 1]); window and padding as in 3D Gaussian Splatting.
"""

import dataclasses
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Bool, Float, Num

from wm.splat.image_checks import check_images
from wm.splat.xla.fusion_barrier import fusion_barrier

RADIUS = 5
_taps = np.exp(-0.5 * (np.arange(-RADIUS, RADIUS + 1) / 1.5) ** 2)
TAPS = tuple(float(tap) for tap in _taps / _taps.sum())
C1, C2 = 0.01**2, 0.03**2


@jax.tree_util.register_dataclass
@dataclasses.dataclass(frozen=True, eq=False)
class _Residual:
    """The images, and the partial derivatives of the map with respect to the means, b * (x^2 + y^2) and b * (x y)."""

    x: Array
    y: Array
    d_mean_x: Array
    d_mean_y: Array
    d_squares: Array
    d_mixed: Array


def ssim(x: Num[Any, "..."], y: Num[Any, "..."]) -> Float[Array, ""]:
    """Mean structural similarity of two images in [0, 1]: 1 for equal ones.

    Args:
        x, y: images [h, w, c] of floats from 0 to 1; a render may overshoot.

    Returns: the mean of `ssim_map` over pixels and channels; differentiable in both.

    Raises:
        TypeError: an image is no array of floats.
        ValueError: shapes differ, or values lie outside the range, where they are there to be seen (not inside jit).
    """
    return jnp.mean(ssim_map(x, y))


def ssim_map(x: Num[Any, "..."], y: Num[Any, "..."]) -> Float[Array, "h w c"]:
    """Structural similarity of the windows around each pixel, unreduced; differentiable in both images. Raises as `ssim`."""
    check_images(x=x, y=y)
    return jnp.moveaxis(_of_planes(jnp.moveaxis(x, -1, 0), jnp.moveaxis(y, -1, 0)), 0, -1)


@jax.custom_vjp
def _of_planes(x: Float[Array, "c h w"], y: Float[Array, "c h w"]) -> Float[Array, "c h w"]:
    return _forward(x, y)[0]


def _forward(x, y):
    mean_x, mean_y, squares, mixed = _blur(x, y, x * x + y * y, x * y)
    a1 = 2 * mean_x * mean_y + C1
    a2 = 2 * (mixed - mean_x * mean_y) + C2
    b1 = mean_x**2 + mean_y**2 + C1
    b2 = squares - mean_x**2 - mean_y**2 + C2
    similarity = a1 * a2 / (b1 * b2)
    d_squares = -similarity / b2
    d_mixed = 2 * a1 / (b1 * b2)

    def d_mean(mean, other):
        direct = 2 * other * a2 / (b1 * b2) - 2 * mean * similarity / b1
        return direct - 2 * mean * d_squares - other * d_mixed

    d_means = d_mean(mean_x, mean_y), d_mean(mean_y, mean_x)
    return similarity, _Residual(x, y, *d_means, d_squares=d_squares, d_mixed=d_mixed)


def _backward(residual: _Residual, cotangent):
    partials = residual.d_mean_x, residual.d_mean_y, residual.d_squares, residual.d_mixed
    mean_x, mean_y, squares, mixed = _blur(*(cotangent * d for d in partials))
    return mean_x + 2 * residual.x * squares + residual.y * mixed, mean_y + 2 * residual.y * squares + residual.x * mixed


_of_planes.defvjp(_forward, _backward)


def _blur(*images):
    """Both passes of the window over each of the images [c, h, w], zero outside."""
    never = images[0][0, 0, 0] > jnp.inf  # which XLA cannot fold
    return [_pass(never, _pass(never, image, axis=1), axis=2) for image in images]


def _pass(never: Bool[Array, ""], image, *, axis: int):
    """One pass: the sum of shifted slices of the padded image."""
    pad = [(0, 0)] * 3
    pad[axis] = (RADIUS, RADIUS)

    def sums(image):
        padded = jnp.pad(image, pad)
        shifted = [jax.lax.slice_in_dim(padded, k, k + image.shape[axis], axis=axis) for k in range(2 * RADIUS + 1)]
        return TAPS[RADIUS] * shifted[RADIUS] + sum(TAPS[k] * (shifted[k] + shifted[-1 - k]) for k in range(RADIUS))

    return fusion_barrier(never, sums, image)
