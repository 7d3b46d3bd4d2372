"""Quality of single images as CLIP sees it: CLIP-IQA+ and the aesthetic score, the last two columns of the paper's tables.

    scores       open_quality, check_quality, Quality: what an image scores, by the weights of a folder
    clip_iqa     clip_iqa: how much nearer an image is to "Good photo." than to "Bad photo."
    aesthetic    aesthetic, prepared: the mark that people would give an image, from 1 to 10
    image_tower  resnet_features, vit_features: CLIP's two kinds of image encoder
    text_tower   prompt_features: CLIP's text encoder, for prompts that were learned
    attention    layer_norm, resblocks, heads_of: the transformer that both encoders share
    weights      find_folder, Checkpoint, read_checkpoint: the files, checked before they are used

The models are pure functions of their weights in JAX; reading the files needs the extra `quality`. Weights are no part of wm, and
those of CLIP-IQA+ may only be used without commercial purpose; docs/evaluation.md names each file and its licence. Both scores
are of 2D images: they say nothing of whether two views show the same room.
"""

from wm.quality.scores import Quality, check_quality, open_quality

__all__ = ["Quality", "check_quality", "open_quality"]
