"""Tiny checkpoints of the real model classes with random weights, saved as folders of the hub are: a second and a megabyte each.

    folder = tiny.checkpoint("flux2_klein")  # once a process
    model = tiny.depth_pro()  # the model itself, to be changed and saved elsewhere

torch, transformers and diffusers are imported inside the functions.
"""

import atexit
import functools
import pathlib
import tempfile
from collections.abc import Callable, Sequence
from typing import Any

SIDE = 112
"""Pixels of the square image that the tiny SAM 3 models take."""
WIDTH = 32
"""Channels of the tiny SAM 3 models."""


@functools.cache
def checkpoint(name: str) -> pathlib.Path:
    """The folder of a checkpoint: one of BUILDERS. It is removed when the process ends, and must not be changed."""
    import torch

    torch.set_num_threads(1)  # the processes of a suite share the cores
    folder = _scratch() / name
    for part in BUILDERS[name]():
        part.save_pretrained(folder)
    return folder


@functools.cache
def _scratch() -> pathlib.Path:
    folder = tempfile.TemporaryDirectory(prefix="tiny-checkpoints-")
    atexit.register(folder.cleanup)
    return pathlib.Path(folder.name)


def flux2_klein() -> Any:
    """A Flux2KleinPipeline, distilled as klein 4B and 9B are. Its text model has the 28 layers of which three are read."""
    import torch
    from diffusers import AutoencoderKLFlux2, FlowMatchEulerDiscreteScheduler, Flux2KleinPipeline, Flux2Transformer2DModel
    from transformers import Qwen2TokenizerFast, Qwen3Config, Qwen3ForCausalLM

    torch.manual_seed(0)
    vocabulary = _byte_vocabulary()
    special = {name: len(vocabulary) + k for k, name in enumerate(("<|endoftext|>", "<|im_start|>", "<|im_end|>"))}
    tokenizer = Qwen2TokenizerFast(
        vocab={**vocabulary, **special}, merges=[], pad_token="<|endoftext|>", eos_token="<|im_end|>", unk_token="<|endoftext|>"
    )
    tokenizer.chat_template = "{% for m in messages %}<|im_start|>{{ m.role }}\n{{ m.content }}<|im_end|>\n{% endfor %}"
    text = Qwen3Config(
        vocab_size=len(tokenizer) + 8,
        hidden_size=16,
        intermediate_size=16,
        num_hidden_layers=28,
        num_attention_heads=2,
        num_key_value_heads=1,
        head_dim=8,
    )
    transformer = Flux2Transformer2DModel(
        in_channels=16,
        num_layers=1,
        num_single_layers=1,
        attention_head_dim=16,
        num_attention_heads=2,
        joint_attention_dim=48,
        axes_dims_rope=(4, 4, 4, 4),
        guidance_embeds=False,
    )
    vae = AutoencoderKLFlux2(block_out_channels=(4, 4, 4, 4), layers_per_block=1, latent_channels=4, norm_num_groups=1)
    return Flux2KleinPipeline(
        scheduler=FlowMatchEulerDiscreteScheduler(use_dynamic_shifting=True),
        vae=vae.eval(),
        text_encoder=Qwen3ForCausalLM(text).eval(),
        tokenizer=tokenizer,
        transformer=transformer.eval(),
        is_distilled=True,
    )


def sam3() -> tuple[Any, Any]:
    """A Sam3Model and its tokenizer."""
    import torch
    from transformers import CLIPTokenizerFast, Sam3Config, Sam3Model

    torch.manual_seed(0)
    vocabulary = _byte_vocabulary(ends=("</w>",))
    special = {name: len(vocabulary) + k for k, name in enumerate(("<|startoftext|>", "<|endoftext|>"))}
    tokenizer = CLIPTokenizerFast(vocab={**vocabulary, **special}, merges=[])
    layer = _sam_layer()
    text = dict(
        vocab_size=len(tokenizer),
        projection_dim=WIDTH,
        num_hidden_layers=1,
        max_position_embeddings=32,
        bos_token_id=tokenizer.bos_token_id,
        eos_token_id=tokenizer.eos_token_id,
        **layer,
    )
    config = Sam3Config(
        vision_config=_sam_vision(),
        text_config=text,
        geometry_encoder_config=dict(num_layers=1, **layer),
        detr_encoder_config=dict(num_layers=1, **layer),
        detr_decoder_config=dict(num_layers=1, num_queries=8, **layer),
        mask_decoder_config={"hidden_size": WIDTH, "num_attention_heads": 2},
    )
    return Sam3Model(config).eval(), tokenizer


def sam3_tracker() -> Any:
    """A Sam3TrackerModel: the part of SAM 3 that takes clicks."""
    import torch
    from transformers import Sam3TrackerConfig, Sam3TrackerModel

    torch.manual_seed(0)
    prompts = {"hidden_size": WIDTH, "image_size": SIDE, "patch_size": 14, "mask_input_channels": 4}
    masks = {
        "hidden_size": WIDTH,
        "mlp_dim": WIDTH,
        "num_hidden_layers": 2,
        "num_attention_heads": 2,
        "iou_head_hidden_dim": WIDTH,
    }
    config = Sam3TrackerConfig(vision_config=_sam_vision(), prompt_encoder_config=prompts, mask_decoder_config=masks)
    return Sam3TrackerModel(config).eval()


def depth_pro() -> Any:
    """A DepthProForDepthEstimation that takes images of 64 x 64 pixels."""
    import torch
    from transformers import DepthProConfig, DepthProForDepthEstimation

    def encoder() -> dict[str, Any]:
        return {
            "model_type": "dinov2",
            "hidden_size": 16,
            "num_hidden_layers": 2,
            "num_attention_heads": 2,
            "mlp_ratio": 1,
            "image_size": 32,
            "patch_size": 8,
        }

    torch.manual_seed(0)
    config = DepthProConfig(
        patch_size=32,
        fusion_hidden_size=16,
        intermediate_hook_ids=[1, 0],
        intermediate_feature_dims=[8, 8],
        scaled_images_ratios=[0.5, 1.0],
        scaled_images_overlap_ratios=[0.0, 0.2],
        scaled_images_feature_dims=[8, 8],
        image_model_config=encoder(),
        patch_model_config=encoder(),
        fov_model_config=encoder(),
        use_fov_model=True,
    )
    return DepthProForDepthEstimation(config).eval()


def depth_anything(*, metric: bool = True) -> Any:
    """A DepthAnythingForDepthEstimation, of metric depth up to 20 m or of relative inverse depth."""
    import torch
    from transformers import DepthAnythingConfig, DepthAnythingForDepthEstimation, Dinov2Config

    torch.manual_seed(0)
    backbone = Dinov2Config(
        hidden_size=16,
        num_hidden_layers=4,
        num_attention_heads=2,
        mlp_ratio=1,
        image_size=518,
        patch_size=14,
        out_features=["stage1", "stage2", "stage3", "stage4"],
        reshape_hidden_states=False,
        initializer_range=0.2,
    )
    kind = {"depth_estimation_type": "metric", "max_depth": 20} if metric else {}
    config = DepthAnythingConfig(
        backbone_config=backbone,
        reassemble_hidden_size=16,
        patch_size=14,
        neck_hidden_sizes=[8] * 4,
        fusion_hidden_size=8,
        head_hidden_size=8,
        initializer_range=0.2,  # with the usual 0.02 its answer is one value to within float32
        **kind,
    )
    return DepthAnythingForDepthEstimation(config).eval()


BUILDERS: dict[str, Callable[[], Sequence[Any]]] = {
    "flux2_klein": lambda: (flux2_klein(),),
    "sam3": lambda: sam3(),
    "sam3_tracker": lambda: (sam3_tracker(),),
    "depth_pro": lambda: (depth_pro(),),
    "depth_anything_metric": lambda: (depth_anything(),),
    "depth_anything_relative": lambda: (depth_anything(metric=False),),
}
"""The parts of each checkpoint, which are saved to one folder."""


def _sam_layer() -> dict[str, Any]:
    return {"hidden_size": WIDTH, "num_attention_heads": 2, "intermediate_size": WIDTH}


def _sam_vision() -> dict[str, Any]:
    backbone = dict(
        model_type="sam3_vit_model",
        num_hidden_layers=2,
        image_size=SIDE,
        patch_size=14,
        window_size=4,
        global_attn_indexes=[1],
        pretrain_image_size=SIDE,
        **_sam_layer(),
    )
    sizes = [[k * SIDE // 14] * 2 for k in (4, 2, 1)]
    return {
        "model_type": "sam3_vision_model",
        "backbone_config": backbone,
        "fpn_hidden_size": WIDTH,
        "backbone_feature_sizes": sizes,
    }


def _byte_vocabulary(ends: Sequence[str] = ()) -> dict[str, int]:
    """One token a byte, and one a byte with each of `ends` behind it."""
    from tokenizers import pre_tokenizers

    letters = sorted(pre_tokenizers.ByteLevel.alphabet())
    return {word: k for k, word in enumerate([*letters, *(letter + end for end in ends for letter in letters)])}
