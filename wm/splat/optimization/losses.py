"""What the fit minimises (paper, "Geometry-Regularized 3DGS Scene Reconstruction"):

    L = (1 - w) mean |C - I|  +  w mean (1 - SSIM(C, I))  +  d mean |D - D_S|  +  n mean (1 - cos(N, N_S))

over the usable pixels of a view: C, D rendered colour and depth, I the image, D_S the scaffold's depth in metres, N and N_S the
normals of both depths (that term is ours). A pixel outside the mask has no term of its own, and takes the image's colour before
the SSIM window passes over it, so that it does not affect its neighbours either.
"""

import jax.numpy as jnp
from jaxtyping import Array, Bool, Float

from wm.numerics import masked_mean
from wm.splat.similarity import ssim_map


def photometric_terms(
    rgb: Float[Array, "h w 3"], target: Float[Array, "h w 3"], mask: Bool[Array, "h w"]
) -> tuple[Float[Array, ""], Float[Array, ""]]:
    """Mean absolute difference and mean 1 - SSIM over the mask; both 0 where the mask holds nowhere."""
    everywhere = jnp.broadcast_to(mask[..., None], rgb.shape)
    seen = jnp.where(everywhere, rgb, target)
    return masked_mean(jnp.abs(seen - target), everywhere), masked_mean(1 - ssim_map(seen, target), everywhere)


def depth_loss(depth: Float[Array, "h w"], scaffold_depth: Float[Array, "h w"], mask: Bool[Array, "h w"]) -> Float[Array, ""]:
    """Mean |depth - scaffold_depth| in metres over the pixels of the mask where the scaffold is hit (its depth is above 0).

    A scaffold's depth of NaN counts, so that the loss becomes NaN and the fit reports it.
    """
    return masked_mean(jnp.abs(depth - scaffold_depth), mask & ~(scaffold_depth <= 0))
