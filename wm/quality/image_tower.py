"""CLIP's image encoders: a residual network whose last layer attends (RN50), and a vision transformer (ViT-L/14).

Both take an image that `normalised` made and give its embedding, whose length is free. Kernels are [y, x, in, out] inside.

Source: Radford et al., ICML 2021, section 2.4; parameters by the names of OpenAI's checkpoints.
"""

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from wm.quality.attention import Weights, attend, layer_norm, resblocks

MEAN = np.array([0.48145466, 0.4578275, 0.40821073], np.float32)
DEVIATION = np.array([0.26862954, 0.26130258, 0.27577711], np.float32)
"""Of the channels of the images that CLIP was trained on; for values from 0 to 1."""
_EPSILON = 1e-5  # of torch.nn.BatchNorm2d


def normalised(rgb: Float[Array, "h w 3"]) -> Float[Array, "h w 3"]:
    """An image with values from 0 to 1, as CLIP was trained on it."""
    return (rgb - MEAN) / DEVIATION


def resnet_features(image: Float[Array, "h w 3"], weights: Weights) -> Float[Array, " e"]:
    """The embedding of an image of any size by the residual network.

    The last layer attends without its embedding of positions, as CLIP-IQA has it, so that the size of the image is free.
    """
    x = image
    for k, stride in ((1, 2), (2, 1), (3, 1)):
        x = jax.nn.relu(_convolved(x, weights, f"visual.conv{k}", f"visual.bn{k}", stride=stride))
    x = _halved(x)
    for k in (1, 2, 3, 4):
        x = _stage(x, weights, f"visual.layer{k}", stride=1 if k == 1 else 2)
    return _attention_pool(x, weights)


def vit_features(image: Float[Array, "s s 3"], weights: Weights) -> Float[Array, " e"]:
    """The embedding by the vision transformer of a square image of the size it was trained with."""
    kernel = jnp.transpose(weights["visual.conv1.weight"], (2, 3, 1, 0))
    patches = _convolution(image, kernel, stride=kernel.shape[0], padding=0)
    tokens = patches.reshape(-1, patches.shape[-1])
    x = jnp.concatenate([weights["visual.class_embedding"][None], tokens]) + weights["visual.positional_embedding"]
    x = resblocks(layer_norm(x, weights, "visual.ln_pre"), weights, "visual.transformer.")
    return layer_norm(x[:1], weights, "visual.ln_post")[0] @ weights["visual.proj"]


def side_of_vit(weights: Weights) -> int:
    """Pixels of a side of the images that a vision transformer takes."""
    patches = len(weights["visual.positional_embedding"]) - 1
    return round(patches**0.5) * weights["visual.conv1.weight"].shape[-1]


def _stage(x: Float[Array, "h w c"], weights: Weights, name: str, *, stride: int) -> Float[Array, "y x d"]:
    """The bottleneck blocks of one resolution. The first of them lowers the resolution, by averages instead of strides."""
    blocks = {key.split(".")[2] for key in weights if key.startswith(f"{name}.")}
    for k in range(len(blocks)):
        x = _bottleneck(x, weights, f"{name}.{k}", stride=stride if k == 0 else 1)
    return x


def _bottleneck(x: Float[Array, "h w c"], weights: Weights, name: str, *, stride: int) -> Float[Array, "y x d"]:
    y = jax.nn.relu(_convolved(x, weights, f"{name}.conv1", f"{name}.bn1"))
    y = jax.nn.relu(_convolved(y, weights, f"{name}.conv2", f"{name}.bn2"))
    y = _convolved(_halved(y) if stride == 2 else y, weights, f"{name}.conv3", f"{name}.bn3")
    if f"{name}.downsample.0.weight" in weights:
        x = _convolved(_halved(x) if stride == 2 else x, weights, f"{name}.downsample.0", f"{name}.downsample.1")
    return jax.nn.relu(x + y)


def _attention_pool(x: Float[Array, "h w c"], weights: Weights) -> Float[Array, " e"]:
    """What the mean of all pixels sees in itself and in them."""
    pixels = x.reshape(-1, x.shape[-1])
    tokens = jnp.concatenate([pixels.mean(axis=0, keepdims=True), pixels])
    q, k, v = (
        some @ weights[f"visual.attnpool.{name}_proj.weight"].T + weights[f"visual.attnpool.{name}_proj.bias"]
        for name, some in (("q", tokens[:1]), ("k", tokens), ("v", tokens))
    )
    return attend(q, k, v)[0] @ weights["visual.attnpool.c_proj.weight"].T + weights["visual.attnpool.c_proj.bias"]


def _convolved(x: Float[Array, "h w c"], weights: Weights, name: str, norm: str, *, stride: int = 1) -> Float[Array, "y x d"]:
    """A convolution that keeps the size, up to its stride, and its batch normalisation with the statistics of the training."""
    scale = weights[f"{norm}.weight"] * jax.lax.rsqrt(weights[f"{norm}.running_var"] + _EPSILON)
    kernel = jnp.transpose(weights[f"{name}.weight"], (2, 3, 1, 0)) * scale
    shift = weights[f"{norm}.bias"] - weights[f"{norm}.running_mean"] * scale
    return _convolution(x, kernel, stride=stride, padding=kernel.shape[0] // 2) + shift


def _convolution(
    x: Float[Array, "h w c"], kernel: Float[Array, "k k c d"], *, stride: int, padding: int
) -> Float[Array, "y x d"]:
    layout = ("NHWC", "HWIO", "NHWC")
    padded = [(padding, padding)] * 2
    return jax.lax.conv_general_dilated(x[None], kernel, (stride, stride), padded, dimension_numbers=layout)[0]


def _halved(x: Float[Array, "h w c"]) -> Float[Array, "y x c"]:
    """Means of 2 x 2 pixels; an odd last row or column is left out."""
    height, width = (size // 2 for size in x.shape[:2])
    return x[: 2 * height, : 2 * width].reshape(height, 2, width, 2, -1).mean(axis=(1, 3))
