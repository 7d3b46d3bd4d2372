"""The transformer that CLIP's text encoder and its image encoder ViT share, from weights by OpenAI's names.

Notation: x [t, d] tokens, H = d / 64 heads. A block is

    x <- x + attention(norm(x; ln_1)),    x <- x + W_proj gelu(W_fc norm(x; ln_2))

with gelu(a) = a / (1 + exp(-1.702 a)), which is how OpenAI's checkpoints were trained.

Source: Radford et al., "Learning Transferable Visual Models From Natural Language Supervision", ICML 2021, section 2.4.
"""

from collections.abc import Mapping

import jax
import jax.numpy as jnp
from jaxtyping import Array, Bool, Float

Weights = Mapping[str, Array]
"""Parameters by OpenAI's names. A prefix such as "transformer." selects a part of a model."""
HEAD = 64
"""Channels of an attention head in every CLIP of OpenAI's."""
_EPSILON = 1e-5  # of torch.nn.LayerNorm


def heads_of(width: int) -> int:
    """Heads of an attention over this many channels."""
    return max(width // HEAD, 1)


def layer_norm(x: Float[Array, "t d"], weights: Weights, name: str) -> Float[Array, "t d"]:
    """Each token with mean 0 and variance 1, then scaled and shifted."""
    centred = x - x.mean(axis=-1, keepdims=True)
    scale = jax.lax.rsqrt((centred**2).mean(axis=-1, keepdims=True) + _EPSILON)
    return centred * scale * weights[f"{name}.weight"] + weights[f"{name}.bias"]


def attend(
    q: Float[Array, "s d"], k: Float[Array, "t d"], v: Float[Array, "t d"], seen: Bool[Array, "s t"] | None = None
) -> Float[Array, "s d"]:
    """Scaled dot-product attention of every head, before its output projection. `seen` says which tokens a query may look at."""
    heads = heads_of(q.shape[-1])
    q, k, v = (x.reshape(len(x), heads, -1) for x in (q, k, v))
    scores = jnp.einsum("shc,thc->hst", q, k) / jnp.sqrt(jnp.float32(q.shape[-1]))
    if seen is not None:
        scores = jnp.where(seen, scores, -jnp.inf)
    return jnp.einsum("hst,thc->shc", jax.nn.softmax(scores, axis=-1), v).reshape(len(q), -1)


def resblocks(x: Float[Array, "t d"], weights: Weights, prefix: str, *, causal: bool = False) -> Float[Array, "t d"]:
    """All blocks of a transformer.

    Args:
      x: tokens.
      weights: with those of the blocks under `prefix`resblocks.
      prefix: "transformer." of the text encoder, "visual.transformer." of a ViT.
      causal: whether a token sees only itself and those before it, as in the text encoder.
    """
    seen = jnp.tri(len(x), dtype=bool) if causal else None
    for k in range(_depth(weights, f"{prefix}resblocks.")):
        name = f"{prefix}resblocks.{k}"
        mixed = _linear(layer_norm(x, weights, f"{name}.ln_1"), weights, f"{name}.attn.in_proj_")
        x = x + _linear(attend(*jnp.split(mixed, 3, axis=-1), seen), weights, f"{name}.attn.out_proj.")
        hidden = _linear(layer_norm(x, weights, f"{name}.ln_2"), weights, f"{name}.mlp.c_fc.")
        x = x + _linear(hidden * jax.nn.sigmoid(1.702 * hidden), weights, f"{name}.mlp.c_proj.")
    return x


def _linear(x: Float[Array, "t d"], weights: Weights, name: str) -> Float[Array, "t e"]:
    return x @ weights[f"{name}weight"].T + weights[f"{name}bias"]


def _depth(weights: Weights, prefix: str) -> int:
    """How many blocks there are."""
    return 1 + max(int(name[len(prefix) :].partition(".")[0]) for name in weights if name.startswith(prefix))
