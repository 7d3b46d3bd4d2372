"""CLIP-IQA+: the chance, as CLIP sees it, that an image is a good photo rather than a bad one.

With the image's embedding f, those g of the good and b of the bad prompt, and CLIP's learned temperature exp(tau):

    score = softmax(exp(tau) [cos(f, g), cos(f, b)])_good, from 0 to 1

Source: Wang, Chan and Loy, "Exploring CLIP for Assessing the Look and Feel of Images", AAAI 2023. As there, the backbone is RN50
without its embedding of positions, and the image keeps its size.
"""

import jax
import jax.numpy as jnp
from jaxtyping import Array, Float

from wm.quality.attention import Weights
from wm.quality.image_tower import normalised, resnet_features
from wm.quality.text_tower import prompt_features


@jax.jit
def clip_iqa(rgb: Float[Array, "h w 3"], prompts: Float[Array, "2 e"], weights: Weights) -> Float[Array, ""]:
    """The score of an image with values from 0 to 1, higher is better.

    Args:
      rgb: of any size from 32 x 32 pixels.
      prompts: what `encoded_prompts` gives, the good one first.
      weights: of CLIP RN50, by OpenAI's names.
    """
    with jax.default_matmul_precision("highest"):
        image = _unit(resnet_features(normalised(rgb), weights))
        cosines = _unit(prompts) @ image
    return jax.nn.softmax(jnp.exp(weights["logit_scale"]) * cosines)[0]


@jax.jit
def encoded_prompts(context: Float[Array, "2 m d"], weights: Weights) -> Float[Array, "2 e"]:
    """The embeddings of the two prompts, which all images share."""
    with jax.default_matmul_precision("highest"):
        return prompt_features(context, weights)


def _unit(x: Float[Array, "*n e"]) -> Float[Array, "*n e"]:
    return x / jnp.linalg.norm(x, axis=-1, keepdims=True)
