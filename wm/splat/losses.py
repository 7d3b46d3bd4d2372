"""What the fit minimises (paper, "Geometry-Regularized 3DGS Scene Reconstruction"):

    L = (1 - w) mean |C - I|  +  w mean (1 - SSIM(C, I))  +  d mean |D - D_S|  +  n mean (1 - cos(N, N_S))

over the usable pixels of a view: C, D rendered colour and depth, I the image, D_S the scaffold's depth in metres, N and N_S the
normals of both depths (that term is ours). A pixel that
the mask leaves out has no term of its own, and takes the image's colour before the SSIM window passes over it, so that it does
not act on its neighbours either.
"""

import jax.numpy as jnp
from jaxtyping import Array, Bool, Float

from wm.numerics import masked_mean, safe_div
from wm.splat.ssim import ssim_map

BEND = 1e-3
"""Relative second difference of 1 / depth up to which neighbouring pixels count as one surface: it is 0 on a plane."""


def photometric_terms(
    rgb: Float[Array, "h w 3"], target: Float[Array, "h w 3"], mask: Bool[Array, "h w"]
) -> tuple[Float[Array, ""], Float[Array, ""]]:
    """Mean absolute difference and mean 1 - SSIM over the mask; both 0 where the mask holds nowhere."""
    h, w, c = rgb.shape
    everywhere = jnp.broadcast_to(mask[..., None], rgb.shape).reshape(h, w * c)  # flat: a last axis of 3 is slow on a CPU
    flat_target = target.reshape(h, w * c)
    flat = jnp.where(everywhere, rgb.reshape(h, w * c), flat_target)
    dissimilarity = 1 - ssim_map(flat.reshape(h, w, c), target).reshape(h, w * c)
    return masked_mean(jnp.abs(flat - flat_target), everywhere), masked_mean(dissimilarity, everywhere)


def depth_loss(
    depth: Float[Array, "h w"], scaffold_depth: Float[Array, "h w"], mask: Bool[Array, "h w"]
) -> Float[Array, ""]:
    """Mean |depth - scaffold_depth| in metres over the pixels of the mask where the scaffold is hit (its depth is above 0)."""
    return masked_mean(jnp.abs(depth - scaffold_depth), mask & (scaffold_depth > 0))


def normal_loss(
    depth: Float[Array, "h w"],
    scaffold_depth: Float[Array, "h w"],
    mask: Bool[Array, "h w"],
    focal: Float[Array, "2"],
    principal: Float[Array, "2"],
) -> Float[Array, ""]:
    """Mean 1 - cosine between the normals of two depths, where the scaffold is one smooth surface and the mask holds.

    With g = f_x (D_right - D_left) / (D_right + D_left) and h likewise, the normal of a depth at the pixel of slopes (a, b) is
    along (-g, -h, 1 + a g + b h): central differences of the points, exactly. Between two pixels without depth the difference
    is taken to be 0, and so is its gradient (`safe_div`).
    """
    if min(depth.shape) < 3:
        return jnp.float32(0)
    rows, columns = depth.shape
    a = (jnp.arange(1, columns - 1) + 0.5 - principal[0]) / focal[0]
    b = ((jnp.arange(1, rows - 1) + 0.5 - principal[1]) / focal[1])[:, None]

    def normal(d):
        g = focal[0] * safe_div(d[1:-1, 2:] - d[1:-1, :-2], d[1:-1, 2:] + d[1:-1, :-2])
        h = focal[1] * safe_div(d[2:, 1:-1] - d[:-2, 1:-1], d[2:, 1:-1] + d[:-2, 1:-1])
        return g, h, 1 + a * g + b * h

    ours, scaffolds = normal(depth), normal(scaffold_depth)
    # No root of 0: whatever the differences, x^2 + y^2 + z^2 >= 1 / (1 + a^2 + b^2).
    lengths = [jnp.sqrt(x * x + y * y + z * z) for x, y, z in (ours, scaffolds)]
    cosine = sum(p * q for p, q in zip(ours, scaffolds)) / (lengths[0] * lengths[1])
    return masked_mean(1 - cosine, smooth_pixels(scaffold_depth) & mask[1:-1, 1:-1])


def smooth_pixels(scaffold_depth: Float[Array, "h w"]) -> Bool[Array, "h-2 w-2"]:
    """Inner pixels that lie on one smooth surface (`BEND`) with their four neighbours: there differences mean its normal."""
    inverse = safe_div(jnp.ones_like(scaffold_depth), scaffold_depth)
    middle = inverse[1:-1, 1:-1]
    bends = [
        jnp.abs(before + after - 2 * middle)
        for before, after in ((inverse[1:-1, :-2], inverse[1:-1, 2:]), (inverse[:-2, 1:-1], inverse[2:, 1:-1]))
    ]
    return (jnp.maximum(*bends) <= BEND * middle) & (middle > 0)
