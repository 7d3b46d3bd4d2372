"""Every numeric guard in one place, each named by what it promises in value *and* in gradient.

The rule: substitute before the dangerous operation, select after it, per element. Where no direction exists the gradient is 0.
"""

import jax
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


def safe_norm(x: Float[Array, "*batch d"]) -> Float[Array, "*batch"]:
    """Euclidean norm along the last axis without overflow or underflow; at the zero vector 0 with zero gradient."""
    largest = jax.lax.stop_gradient(jnp.max(jnp.abs(x), axis=-1, keepdims=True))
    usable = (largest > 0) & jnp.isfinite(largest)
    scale = jnp.where(usable, largest, 1.0)
    return safe_sqrt(jnp.sum((x / scale) ** 2, axis=-1)) * scale[..., 0]


def normalize(x: Float[Array, "*batch d"]) -> Float[Array, "*batch d"]:
    """x / |x| along the last axis; at the zero vector 0 with zero gradient."""
    return safe_div(x, safe_norm(x)[..., None])


def normalize_quat(q: Float[Array, "*batch 4"]) -> Float[Array, "*batch 4"]:
    """Unit quaternion (wxyz); the zero quaternion becomes the identity with zero gradient."""
    zero = jnp.all(q == 0, axis=-1, keepdims=True)
    identity = jnp.array([1.0, 0.0, 0.0, 0.0], q.dtype)
    return jnp.where(zero, identity, normalize(q))


def masked_mean(x: Float[Array, "..."], mask: Bool[Array, "..."]) -> Float[Array, ""]:
    """Mean of x where mask holds; 0 with zero gradient where it holds nowhere. Masked values may be NaN or infinite."""
    kept = jnp.where(mask, x, 0.0)
    return jnp.sum(kept) / jnp.maximum(jnp.sum(mask), 1)
