"""The loss of normals of a depth, with a hand-written gradient.

With g = f_x (D_right - D_left) / (D_right + D_left) and h likewise down, the normal of a depth at the pixel of slopes (a, b) is
along N = (-g, -h, 1 + a g + b h): central differences of the points, exactly. With n = N / |N|, m the scaffold's and c = n . m,

    e = d(1 - c)/dN = (c n - m) / |N|,   d(1 - c)/dg = a e_2 - e_0,   d(1 - c)/dh = b e_2 - e_1,
    dg/dD_right = 2 f_x D_left / (D_right + D_left)^2,   and likewise for the other three neighbours.

So the gradient at a pixel is the sum of four products: derivatives with respect to g or h at its neighbours, times depths two
pixels away. The derivative that JAX makes by itself pads and adds the derivatives of eight slices, and XLA on a CPU repeats the
arithmetic in each: four times as slow.
"""

import jax
import jax.numpy as jnp
from jaxtyping import Array, Bool, Float

from wm.numerics import safe_div
from wm.splat.xla.fusion_barrier import fusion_barrier

BEND = 1e-3
"""Relative second difference of 1 / depth up to which neighbouring pixels count as one surface: it is 0 on a plane."""


@jax.custom_vjp
def normal_loss(
    depth: Float[Array, "h w"],
    scaffold_depth: Float[Array, "h w"],
    mask: Bool[Array, "h w"],
    focal: Float[Array, "2"],
    principal: Float[Array, "2"],
) -> Float[Array, ""]:
    """Mean 1 - cosine between the normals of two depths, where the scaffold is one smooth surface and the mask holds.

    Between two pixels without depth the difference is taken to be 0, and so is its gradient (`safe_div`). Differentiable
    with respect to `depth` only.
    """
    return _forward(depth, scaffold_depth, mask, focal, principal)[0]


def _forward(depth, scaffold_depth, mask, focal, principal):
    if min(depth.shape) < 3:
        return jnp.zeros((), depth.dtype), None
    used = smooth_pixels(scaffold_depth) & mask[1:-1, 1:-1]
    rows, columns = depth.shape
    a = (jnp.arange(1, columns - 1) + 0.5 - principal[0]) / focal[0]
    b = ((jnp.arange(1, rows - 1) + 0.5 - principal[1]) / focal[1])[:, None]

    def unit(d):
        """The normal, and one over its length before."""
        g, h = (f * safe_div(after - before, after + before) for f, (before, after) in zip(focal, _neighbours(d)))
        z = 1 + a * g + b * h
        # no root of 0: whatever the differences, g^2 + h^2 + z^2 >= 1 / (1 + a^2 + b^2)
        inverse = jax.lax.rsqrt(g * g + h * h + z * z)
        return (-g * inverse, -h * inverse, z * inverse), inverse

    def costs(depth, scaffold_depth, used):
        """1 - cosine at the inner pixels, its derivative with respect to g times 2 f_x / (D_right + D_left)^2, and h likewise."""
        (n, inverse), (m, _) = unit(depth), unit(scaffold_depth)
        cosine = sum(p * q for p, q in zip(n, m))
        e = [(cosine * p - q) * inverse for p, q in zip(n, m)]
        d_ratios = [
            safe_div(2 * f * d, (before + after) ** 2)
            for f, d, (before, after) in zip(focal, (a * e[2] - e[0], b * e[2] - e[1]), _neighbours(depth))
        ]
        return jnp.where(used, jnp.stack([1 - cosine, *d_ratios]), 0.0)

    never = depth[0, 0] > jnp.inf
    cost, *d_ratios = fusion_barrier(never, costs, depth, scaffold_depth, used)
    count = jnp.maximum(jnp.sum(used), 1)
    return jnp.sum(cost) / count, (never, depth, d_ratios, count)


def _backward(residual, cotangent):
    if residual is None:
        return None, None, None, None, None
    never, depth, d_ratios, count = residual

    def gradient(depth, across, down):
        """The derivative with respect to every depth, through its four neighbours and the depths on their other sides."""
        rows, columns = depth.shape
        across, down = jnp.pad(across, ((1, 1), (2, 2))), jnp.pad(down, ((2, 2), (1, 1)))
        wide, high = jnp.pad(depth, ((0, 0), (2, 2))), jnp.pad(depth, ((2, 2), (0, 0)))
        return (
            across[:, :columns] * wide[:, :columns]
            - across[:, 2:] * wide[:, 4:]
            + down[:rows] * high[:rows]
            - down[2:] * high[4:]
        )

    scale = cotangent / count
    return fusion_barrier(never, gradient, depth, *(scale * d for d in d_ratios)), None, None, None, None


normal_loss.defvjp(_forward, _backward)


def _neighbours(d):
    """Left and right, above and below of every inner pixel."""
    return (d[1:-1, :-2], d[1:-1, 2:]), (d[:-2, 1:-1], d[2:, 1:-1])


def smooth_pixels(scaffold_depth: Float[Array, "h w"]) -> Bool[Array, "h-2 w-2"]:
    """Inner pixels that lie on one smooth surface (`BEND`) with their four neighbours: there differences mean its normal."""
    inverse = safe_div(jnp.ones_like(scaffold_depth), scaffold_depth)
    middle = inverse[1:-1, 1:-1]
    bends = [jnp.abs(before + after - 2 * middle) for before, after in _neighbours(inverse)]
    return (jnp.maximum(*bends) <= BEND * middle) & (middle > 0)
