"""The aesthetic score: the mark from 1 to 10 that people would give an image, predicted from its CLIP embedding.

    score = A_n (... A_1 f / |f|), with the embedding f of ViT-L/14 and affine maps A

The published predictor has five maps without any function between them (LAION-Aesthetics V2), an earlier one has a single map.

Source: Schuhmann et al., "LAION-5B", NeurIPS 2022 Datasets and Benchmarks, section 3.4 and appendix; the weights
`sac+logos+ava1-l14-linearMSE`.
"""

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float, UInt8
from PIL import Image

from wm.quality.attention import Weights
from wm.quality.image_tower import normalised, vit_features


@jax.jit
def aesthetic(image: Float[Array, "s s 3"], weights: Weights, head: Weights) -> Float[Array, ""]:
    """The score of an image, higher is better.

    Args:
      image: values from 0 to 1, of the size the encoder was trained with; see `prepared`.
      weights: of CLIP ViT-L/14, by OpenAI's names.
      head: of the predictor: "weight" and "bias" of each map, in the order of their names.
    """
    with jax.default_matmul_precision("highest"):
        x = vit_features(normalised(image), weights)
        x = x / jnp.linalg.norm(x)
        for name in maps_of(head):
            x = head[f"{name}weight"] @ x + head[f"{name}bias"]
    return x[0]


def maps_of(head: Weights) -> list[str]:
    """The prefixes of the maps of a predictor, in their order: "layers.0.", "layers.2." ..., or "" of a single one."""
    return sorted(name.removesuffix("weight") for name in head if name.endswith("weight"))


def prepared(rgb: UInt8[np.ndarray, "h w 3"], side: int) -> Float[np.ndarray, "s s 3"]:
    """The middle of an image as a square of `side` pixels: scaled by bicubic interpolation until its shorter side has that size,
    and cut. Values from 0 to 1."""
    height, width = rgb.shape[:2]
    shorter = min(height, width)
    scaled = Image.fromarray(rgb).resize((side * width // shorter, side * height // shorter), Image.Resampling.BICUBIC)
    left, top = (round((size - side) / 2) for size in scaled.size)
    return np.asarray(scaled.crop((left, top, left + side, top + side)), np.float32) / np.float32(255)
