"""CLIP in miniature with random weights, by the names of OpenAI's checkpoints: the shapes are small, the vocabulary is whole."""

import numpy as np

WIDTH, EMBEDDING, CONTEXT, WORDS = 64, 32, 24, 49408
"""Of the text encoder."""
PATCH, SIDE, VIT_WIDTH = 8, 32, 128
STEM = 8
"""Channels of the residual network before its stages; its attention has 32 times as many."""

Arrays = dict[str, np.ndarray]


def drawn(rng: np.random.Generator, *shape: int, scale: float | None = None) -> np.ndarray:
    """Normal numbers with a deviation that keeps activations near 1."""
    scale = 1 / np.sqrt(np.prod(shape[1:]) or 1) if scale is None else scale
    return (scale * rng.standard_normal(shape)).astype(np.float32)


def transformer(rng: np.random.Generator, prefix: str, width: int, layers: int = 2) -> Arrays:
    arrays: Arrays = {}
    for k in range(layers):
        name = f"{prefix}resblocks.{k}."
        arrays |= norm(rng, f"{name}ln_1", width) | norm(rng, f"{name}ln_2", width)
        for part, shape in {
            "attn.in_proj_": (3 * width, width),
            "attn.out_proj.": (width, width),
            "mlp.c_fc.": (4 * width, width),
            "mlp.c_proj.": (width, 4 * width),
        }.items():
            arrays |= {f"{name}{part}weight": drawn(rng, *shape), f"{name}{part}bias": drawn(rng, shape[0], scale=0.1)}
    return arrays


def norm(rng: np.random.Generator, name: str, width: int) -> Arrays:
    return {f"{name}.weight": 1 + drawn(rng, width, scale=0.1), f"{name}.bias": drawn(rng, width, scale=0.1)}


def text(rng: np.random.Generator) -> Arrays:
    arrays = {
        "token_embedding.weight": drawn(rng, WORDS, WIDTH, scale=0.5),
        "positional_embedding": drawn(rng, CONTEXT, WIDTH, scale=0.5),
        "text_projection": drawn(rng, WIDTH, EMBEDDING, scale=0.2),
        "logit_scale": np.float32(2.0),
    }
    return arrays | transformer(rng, "transformer.", WIDTH) | norm(rng, "ln_final", WIDTH)


def vit(rng: np.random.Generator) -> Arrays:
    arrays = {
        "visual.conv1.weight": drawn(rng, VIT_WIDTH, 3, PATCH, PATCH),
        "visual.class_embedding": drawn(rng, VIT_WIDTH, scale=0.5),
        "visual.positional_embedding": drawn(rng, (SIDE // PATCH) ** 2 + 1, VIT_WIDTH, scale=0.5),
        "visual.proj": drawn(rng, VIT_WIDTH, EMBEDDING, scale=0.2),
    }
    arrays |= norm(rng, "visual.ln_pre", VIT_WIDTH) | norm(rng, "visual.ln_post", VIT_WIDTH)
    return arrays | transformer(rng, "visual.transformer.", VIT_WIDTH)


def resnet(rng: np.random.Generator) -> Arrays:
    """Two blocks in the first stage, one in each of the others."""
    stem = ((1, 3, STEM // 2), (2, STEM // 2, STEM // 2), (3, STEM // 2, STEM))
    arrays: Arrays = {}
    for k, before, after in stem:
        arrays |= convolution(rng, f"visual.conv{k}", f"visual.bn{k}", before, after, 3)
    channels = STEM
    for k in (1, 2, 3, 4):
        planes = STEM * 2 ** (k - 1)
        for block in range(2 if k == 1 else 1):
            name = f"visual.layer{k}.{block}"
            arrays |= convolution(rng, f"{name}.conv1", f"{name}.bn1", channels, planes, 1)
            arrays |= convolution(rng, f"{name}.conv2", f"{name}.bn2", planes, planes, 3)
            arrays |= convolution(rng, f"{name}.conv3", f"{name}.bn3", planes, 4 * planes, 1)
            if block == 0:
                arrays |= convolution(rng, f"{name}.downsample.0", f"{name}.downsample.1", channels, 4 * planes, 1)
            channels = 4 * planes
    for part, outputs in {"q_proj": channels, "k_proj": channels, "v_proj": channels, "c_proj": EMBEDDING}.items():
        name = f"visual.attnpool.{part}"
        arrays |= {f"{name}.weight": drawn(rng, outputs, channels), f"{name}.bias": drawn(rng, outputs, scale=0.1)}
    return arrays | {"visual.attnpool.positional_embedding": drawn(rng, 50, channels)}


def convolution(rng: np.random.Generator, name: str, bn: str, before: int, after: int, size: int) -> Arrays:
    statistics = {
        f"{bn}.running_mean": drawn(rng, after, scale=0.2),
        f"{bn}.running_var": rng.uniform(0.5, 2, after).astype("f4"),
    }
    return {f"{name}.weight": drawn(rng, after, before, size, size)} | norm(rng, bn, after) | statistics


def rn50(seed: int = 0) -> Arrays:
    """A whole CLIP with the residual network."""
    rng = np.random.default_rng(seed)
    return text(rng) | resnet(rng)


def vit_l14(seed: int = 1) -> Arrays:
    """A whole CLIP with the vision transformer."""
    rng = np.random.default_rng(seed)
    return text(rng) | vit(rng)


def prompts(seed: int = 2) -> Arrays:
    """Learned vectors of CLIP-IQA+, 16 of them as published."""
    return {"ctx": drawn(np.random.default_rng(seed), 2, 16, WIDTH, scale=0.5)}


def head(seed: int = 3) -> Arrays:
    """An aesthetic predictor of several maps, by the published names."""
    rng, arrays = np.random.default_rng(seed), {}
    for k, before, after in ((0, EMBEDDING, 16), (2, 16, 8), (7, 8, 1)):
        arrays |= {f"layers.{k}.weight": drawn(rng, after, before), f"layers.{k}.bias": drawn(rng, after, scale=0.5)}
    return arrays


def picture(height: int = 70, width: int = 101, seed: int = 4) -> np.ndarray:
    """[h, w, 3] uint8, of odd size."""
    return np.random.default_rng(seed).integers(0, 256, (height, width, 3), dtype=np.uint8)
