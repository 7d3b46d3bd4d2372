"""All numeric guards. Each is named by what it guarantees for the value *and* for the gradient.

The rule: substitute before the unsafe operation and select after it, per element. Where there is no gradient, it is set to 0.
"""

import jax.numpy as jnp
from jaxtyping import Array, Bool, Float


def safe_div(numerator: Float[Array, "..."], denominator: Float[Array, "..."]) -> Float[Array, "..."]:
    """numerator / denominator, and 0 with zero gradient where the denominator is 0."""
    zero = denominator == 0
    return jnp.where(zero, 0.0, numerator / jnp.where(zero, 1.0, denominator))


def safe_sqrt(x: Float[Array, "..."]) -> Float[Array, "..."]:
    """sqrt(x), and 0 with zero gradient where x <= 0; NaN stays NaN."""
    zero = x <= 0
    return jnp.where(zero, 0.0, jnp.sqrt(jnp.where(zero, 1.0, x)))


def masked_mean(x: Float[Array, "..."], mask: Bool[Array, "..."]) -> Float[Array, ""]:
    """Mean of x where mask holds; 0 with zero gradient where it holds nowhere. Masked values may be NaN or infinite."""
    kept = jnp.where(mask, x, 0.0)
    return jnp.sum(kept) / jnp.maximum(jnp.sum(mask), 1)
