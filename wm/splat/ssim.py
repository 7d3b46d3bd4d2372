"""Structural similarity with a hand-written gradient.

With a gaussian window b (11 taps, sigma 1.5, zero padding) and, per pixel and channel, m = b * x, s = b * (x y) - m_x m_y:

    S = A1 A2 / (B1 B2),   A1 = 2 m_x m_y + c1,      A2 = 2 s_xy + c2,
                           B1 = m_x^2 + m_y^2 + c1,  B2 = s_xx + s_yy + c2

S depends on x through m_x, b * x^2 and b * (x y), so its gradient is three more blurs of its partial derivatives (b is even):

    dL/dx = b * (g S_mx) + 2 x  b * (g S_xx) + y  b * (g S_xy),   S_xx = -S / B2,   S_xy = 2 A1 / (B1 B2)

The blur is separable. XLA on a CPU fuses the two passes and then recomputes the inner one once per outer tap, several times
slower; `optimization_barrier` no longer stops it (barriers are dropped before fusion), and a loop's body is not vectorised. So
each pass is a branch of its own (`_apart`). A last axis of 3 is not vectorised either: images are flattened to [h, w c], and a
step along columns is a step of c.

Source: Wang et al. 2004, eq. 13 (c1 = 0.01^2, c2 = 0.03^2 for images in [0, 1]); window and padding as in 3D Gaussian Splatting.
"""

import dataclasses
from functools import partial
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

RADIUS = 5
_taps = np.exp(-0.5 * (np.arange(-RADIUS, RADIUS + 1) / 1.5) ** 2)
TAPS = tuple(float(tap) for tap in _taps / _taps.sum())
C1, C2 = 0.01**2, 0.03**2


@jax.tree_util.register_dataclass
@dataclasses.dataclass(frozen=True, eq=False)
class _Residual:
    """The images and the partial derivatives of the map: by the means, by the second moments, by the mixed moment."""

    x: Array
    y: Array
    d_mean_x: Array
    d_mean_y: Array
    d_square: Array
    d_mixed: Array


def ssim(x: Float[Array, "h w c"], y: Float[Array, "h w c"]) -> Float[Array, ""]:
    """Mean structural similarity of two images in [0, 1]: 1 for equal ones.

    Args:
        x, y: images [h, w, c], any range but the constants are meant for [0, 1].

    Returns: the mean of `ssim_map` over pixels and channels; differentiable in both.
    """
    return jnp.mean(ssim_map(x, y))


def ssim_map(x: Float[Array, "h w c"], y: Float[Array, "h w c"]) -> Float[Array, "h w c"]:
    """Structural similarity of the windows around each pixel, unreduced; differentiable in both images."""
    h, w, c = x.shape
    flat: Any = _ssim_map(x.reshape(h, w * c), y.reshape(h, w * c), c)
    return flat.reshape(h, w, c)


@partial(jax.custom_vjp, nondiff_argnums=(2,))
def _ssim_map(x, y, c: int):
    """`ssim_map` of images [h, w c]: XLA on a CPU does not vectorise over a last axis of 3."""
    return _forward(x, y, c)[0]


def _forward(x, y, c: int):
    mean_x, mean_y, xx, yy, xy = _blur(c, x, y, x * x, y * y, x * y)
    a1 = 2 * mean_x * mean_y + C1
    a2 = 2 * (xy - mean_x * mean_y) + C2
    b1 = mean_x**2 + mean_y**2 + C1
    b2 = (xx - mean_x**2) + (yy - mean_y**2) + C2
    similarity = a1 * a2 / (b1 * b2)
    d_square = -similarity / b2
    d_mixed = 2 * a1 / (b1 * b2)

    def d_mean(mean, other):
        direct = 2 * other * a2 / (b1 * b2) - 2 * mean * similarity / b1
        return direct - 2 * mean * d_square - other * d_mixed

    return similarity, _Residual(
        x=x, y=y, d_mean_x=d_mean(mean_x, mean_y), d_mean_y=d_mean(mean_y, mean_x), d_square=d_square, d_mixed=d_mixed
    )


def _backward(c: int, residual: _Residual, cotangent):
    of_means = (residual.d_mean_x, residual.d_mean_y)
    mean_x, mean_y, square, mixed = _blur(c, *(cotangent * d for d in (*of_means, residual.d_square, residual.d_mixed)))
    grad_x = mean_x + 2 * residual.x * square + residual.y * mixed
    grad_y = mean_y + 2 * residual.y * square + residual.x * mixed
    return grad_x, grad_y


_ssim_map.defvjp(_forward, _backward)


def _blur(c: int, *images):
    """Both passes of the window over each of the images [h, w c] of c channels, zero outside."""
    rows = [_apart(partial(_pass, axis=0, step=1), image) for image in images]
    return [_apart(partial(_pass, axis=1, step=c), image) for image in rows]


def _pass(image, *, axis: int, step: int):
    """One pass: the sum of shifted slices of the padded image, taps `step` apart along `axis`."""
    pad = [(0, 0), (0, 0)]
    pad[axis] = (RADIUS * step, RADIUS * step)
    padded, size = jnp.pad(image, pad), image.shape[axis]

    def shifted(k: int):
        return jax.lax.slice_in_dim(padded, k * step, k * step + size, axis=axis)

    pairs = (TAPS[k] * (shifted(k) + shifted(2 * RADIUS - k)) for k in range(RADIUS))
    return TAPS[RADIUS] * shifted(RADIUS) + sum(pairs)


def _apart(f, x):
    """f(x) of the shape of x, compiled apart from what surrounds it: the other branch is never taken and XLA does not know."""
    return jax.lax.cond(x[0, 0] > jnp.inf, jnp.zeros_like, f, x)
