"""Our CLIP against transformers' CLIPModel and PyTorch's own layers with the same weights. torch comes with the extra `depth`."""

import jax.numpy as jnp
import numpy as np
import pytest

from tests.quality import tiny
from tests.quality.test_scores import on_device
from wm.quality.aesthetic import aesthetic, prepared
from wm.quality.clip_iqa import clip_iqa, encoded_prompts
from wm.quality.image_tower import resnet_features, vit_features
from wm.quality.text_tower import END, START, WORDS, prompt_features

torch = pytest.importorskip("torch", reason="extra `depth`")
transformers = pytest.importorskip("transformers", reason="extra `depth`")


def theirs(name: str) -> str:
    """The name that transformers has for a weight of OpenAI's, where only the name differs."""
    side = "vision" if name.startswith("visual.") else "text"
    known = {
        "token_embedding.weight": "text_model.embeddings.token_embedding.weight",
        "positional_embedding": "text_model.embeddings.position_embedding.weight",
        "visual.class_embedding": "vision_model.embeddings.class_embedding",
        "visual.conv1.weight": "vision_model.embeddings.patch_embedding.weight",
        "visual.positional_embedding": "vision_model.embeddings.position_embedding.weight",
        "logit_scale": "logit_scale",
    }
    if name in known:
        return known[name]
    for ours, other in (
        ("visual.transformer.resblocks", "vision_model.encoder.layers"),
        ("transformer.resblocks", "text_model.encoder.layers"),
        ("visual.ln_pre", "vision_model.pre_layrnorm"),
        ("visual.ln_post", "vision_model.post_layernorm"),
        ("ln_final", "text_model.final_layer_norm"),
        ("attn.out_proj", "self_attn.out_proj"),
        ("ln_1", "layer_norm1"),
        ("ln_2", "layer_norm2"),
        ("c_fc", "fc1"),
        ("c_proj", "fc2"),
    ):
        name = name.replace(ours, other)
    assert name.startswith(side)
    return name


def peer(arrays: tiny.Arrays):
    """transformers' CLIPModel with these weights."""
    both = {"hidden_act": "quick_gelu", "num_hidden_layers": 2, "projection_dim": tiny.EMBEDDING}
    words = both | {
        "hidden_size": tiny.WIDTH, "intermediate_size": 4 * tiny.WIDTH, "num_attention_heads": 1, "vocab_size": tiny.WORDS,
        "max_position_embeddings": tiny.CONTEXT, "bos_token_id": START, "eos_token_id": END,
    }  # fmt: skip
    images = both | {
        "hidden_size": tiny.VIT_WIDTH, "intermediate_size": 4 * tiny.VIT_WIDTH, "num_attention_heads": 2,
        "image_size": tiny.SIDE, "patch_size": tiny.PATCH,
    }  # fmt: skip
    config = transformers.CLIPConfig(text_config=words, vision_config=images, projection_dim=tiny.EMBEDDING)
    model = transformers.CLIPModel(config).eval()
    state = {}
    for name, array in arrays.items():
        tensor = torch.from_numpy(np.array(array))
        if name in ("text_projection", "visual.proj"):
            state[{"text_projection": "text_projection", "visual.proj": "visual_projection"}[name] + ".weight"] = tensor.T
        elif "attn.in_proj_" in name:
            for part, letter in zip(tensor.chunk(3), "qkv"):
                state[theirs(name).replace("attn.in_proj_", f"self_attn.{letter}_proj.")] = part
        else:
            state[theirs(name)] = tensor
    told = model.load_state_dict(state, strict=False)
    assert not told.unexpected_keys and all(key.endswith("position_ids") for key in told.missing_keys)
    return model


def test_the_vision_transformer_is_that_of_transformers():
    arrays = tiny.vit_l14()
    image = np.random.default_rng(0).standard_normal((tiny.SIDE, tiny.SIDE, 3)).astype(np.float32)
    with torch.no_grad():
        model = peer(arrays)
        pooled = model.vision_model(torch.from_numpy(image.transpose(2, 0, 1)[None])).pooler_output
        wanted = model.visual_projection(pooled)[0].numpy()
    np.testing.assert_allclose(vit_features(jnp.asarray(image), on_device(arrays)), wanted, atol=2e-5)


def test_the_prompts_are_those_of_transformers_with_the_vectors_in_its_vocabulary():
    arrays, context = tiny.vit_l14(), tiny.prompts()["ctx"]
    arrays["token_embedding.weight"][1:33] = context.reshape(32, -1)
    numbers = np.arange(1, 33).reshape(2, 16)
    ids = np.stack([[START, *own[:8], *words, *own[8:], END] for own, words in zip(numbers, WORDS)])
    with torch.no_grad():
        model = peer(arrays)
        wanted = model.text_projection(model.text_model(torch.from_numpy(ids)).pooler_output).numpy()
    np.testing.assert_allclose(prompt_features(jnp.asarray(context), on_device(arrays)), wanted, atol=2e-5)


def test_the_aesthetic_score_is_that_of_its_formula_by_transformers():
    arrays, head, rgb = tiny.vit_l14(), tiny.head(), tiny.picture()
    processor = transformers.CLIPImageProcessorPil(
        size={"shortest_edge": tiny.SIDE}, crop_size={"height": tiny.SIDE, "width": tiny.SIDE}
    )
    with torch.no_grad():
        model = peer(arrays)
        pixels = processor(images=rgb, return_tensors="pt")["pixel_values"]
        features = model.visual_projection(model.vision_model(pixels).pooler_output)
        x = torch.nn.functional.normalize(features)
        for k in (0, 2, 7):
            x = torch.nn.functional.linear(x, *(torch.from_numpy(head[f"layers.{k}.{part}"]) for part in ("weight", "bias")))
    found = aesthetic(prepared(rgb, tiny.SIDE), on_device(arrays), on_device(head))
    np.testing.assert_allclose(found, x.item(), atol=2e-5)


@pytest.mark.parametrize("size", [(32, 32), (64, 96), (70, 101)])
def test_the_residual_network_is_that_of_pytorch_layers(size):
    arrays = tiny.rn50()
    image = np.random.default_rng(0).standard_normal((*size, 3)).astype(np.float32)
    with torch.no_grad():
        wanted = peer_resnet(image, {name: torch.from_numpy(np.array(array)) for name, array in arrays.items()}).numpy()
    np.testing.assert_allclose(resnet_features(jnp.asarray(image), on_device(arrays)), wanted, atol=2e-5)


def test_the_score_is_the_softmax_of_the_cosines():
    arrays, rgb = tiny.rn50(), tiny.picture()
    weights = on_device(arrays)
    prompts = encoded_prompts(jnp.asarray(tiny.prompts()["ctx"]), weights)
    with torch.no_grad():
        tensors = {name: torch.from_numpy(np.array(array)) for name, array in arrays.items()}
        mean, deviation = (torch.tensor(x) for x in ((0.48145466, 0.4578275, 0.40821073), (0.26862954, 0.26130258, 0.27577711)))
        features = peer_resnet(((torch.from_numpy(rgb).float() / 255 - mean) / deviation).numpy(), tensors)
        cosines = torch.nn.functional.cosine_similarity(features[None], torch.from_numpy(np.array(prompts)))
        wanted = (tensors["logit_scale"].exp() * cosines).softmax(0)[0].item()
    np.testing.assert_allclose(clip_iqa(rgb.astype(np.float32) / 255, prompts, weights), wanted, atol=1e-5)


def peer_resnet(image, weights):
    """The residual network by PyTorch's batch normalisation, pooling and multi-head attention."""
    functional = torch.nn.functional

    def convolved(x, name, bn, stride=1):
        kernel = weights[f"{name}.weight"]
        y = functional.conv2d(x, kernel, stride=stride, padding=kernel.shape[-1] // 2)
        mean, var, weight, bias = (weights[f"{bn}.{part}"] for part in ("running_mean", "running_var", "weight", "bias"))
        return functional.batch_norm(y, mean, var, weight, bias)

    x = torch.from_numpy(image.transpose(2, 0, 1)[None])
    for k in (1, 2, 3):
        x = functional.relu(convolved(x, f"visual.conv{k}", f"visual.bn{k}", stride=2 if k == 1 else 1))
    x = functional.avg_pool2d(x, 2)
    for stage in (1, 2, 3, 4):
        for block in range(2 if stage == 1 else 1):
            name = f"visual.layer{stage}.{block}"
            pool = 2 if stage > 1 and block == 0 else 1
            y = functional.relu(convolved(x, f"{name}.conv1", f"{name}.bn1"))
            y = functional.relu(convolved(y, f"{name}.conv2", f"{name}.bn2"))
            y = convolved(functional.avg_pool2d(y, pool), f"{name}.conv3", f"{name}.bn3")
            if block == 0:
                x = convolved(functional.avg_pool2d(x, pool), f"{name}.downsample.0", f"{name}.downsample.1")
            x = functional.relu(x + y)
    tokens = x.flatten(2).permute(2, 0, 1)
    tokens = torch.cat([tokens.mean(0, keepdim=True), tokens])
    pool = {name: weights[f"visual.attnpool.{name}"] for name in (f"{p}_proj.{q}" for p in "qkvc" for q in ("weight", "bias"))}
    mixed, _ = functional.multi_head_attention_forward(
        tokens[:1], tokens, tokens, tokens.shape[-1], tokens.shape[-1] // 64, None,
        torch.cat([pool[f"{letter}_proj.bias"] for letter in "qkv"]), None, None, False, 0.0,
        pool["c_proj.weight"], pool["c_proj.bias"], training=False, need_weights=False, use_separate_proj_weight=True,
        q_proj_weight=pool["q_proj.weight"], k_proj_weight=pool["k_proj.weight"], v_proj_weight=pool["v_proj.weight"],
    )  # fmt: skip
    return mixed[0, 0]
