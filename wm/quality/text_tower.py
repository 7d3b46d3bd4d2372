"""CLIP's text encoder, for the two prompts of CLIP-IQA+ between whose words learned vectors stand.

A prompt is the sequence START, c_1 .. c_8, the words, c_9 .. c_16, END, where c are learned (16 of them as published).
Its embedding is that of END, before which the encoder looks only backwards, so nothing after END needs to be computed.

Source: Wang, Chan and Loy, "Exploring CLIP for Assessing the Look and Feel of Images", AAAI 2023, section "CLIP-IQA+", after Zhou
et al., "Learning to Prompt for Vision-Language Models", IJCV 2022, with the words in the middle.
"""

import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from wm.quality.attention import Weights, layer_norm, resblocks

START, END = 49406, 49407
"""Tokens of CLIP's vocabulary that begin and end a text."""
WORDS = np.array([[886, 1125, 852], [2103, 1125, 852]])
"""[2, 3] tokens of "good photo.." and "bad photo.."; the published weights were learned with two full stops."""


def prompt_features(context: Float[Array, "2 m d"], weights: Weights) -> Float[Array, "2 e"]:
    """The embeddings of the good and the bad prompt, not normalised.

    Args:
      context: m learned vectors of each.
      weights: of the text encoder, by OpenAI's names.
    """
    return jnp.stack([_features(vectors, words, weights) for vectors, words in zip(context, WORDS)])


def _features(context: Float[Array, "m d"], words: np.ndarray, weights: Weights) -> Float[Array, " e"]:
    token, half = weights["token_embedding.weight"], len(context) // 2
    x = jnp.concatenate([token[START][None], context[:half], token[words], context[half:], token[END][None]])
    x = x + weights["positional_embedding"][: len(x)]
    x = resblocks(x, weights, "transformer.", causal=True)
    return layer_norm(x[-1:], weights, "ln_final")[0] @ weights["text_projection"]
