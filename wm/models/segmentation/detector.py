"""Instances of what a name names, found by Sam3Model.

The image is encoded once, then the rest of the model is run once a name. The score of a query is that the name is in the image at
all, times that the query is one of it. Source: transformers 5.24, models/sam3 (post_process_instance_segmentation).
"""

from collections.abc import Sequence
from typing import Any

import numpy as np
from jaxtyping import UInt8

from wm.models.segmentation.masks import FoundMasks, halves
from wm.models.segmentation.sam3 import check_finite, image_tensor

_TOKENS = 32
"""Tokens of a name that the model takes; what is longer is cut."""


def detect(loaded: tuple[Any, Any], rgb: UInt8[np.ndarray, "h w 3"], names: Sequence[str], threshold: float) -> FoundMasks:
    """All instances of all names whose score is above `threshold`.

    Args:
      loaded: the model and its tokenizer (wm.models.segmentation.sam3.load_detector).

    Raises:
      ServiceError: the model computes values that are not finite.
    """
    model = loaded[0]
    seen = model.get_vision_features(pixel_values=image_tensor(rgb, model))
    found = [instance for name in names for instance in _instances(loaded, name, seen, threshold)]
    logits = np.stack([mask for *_, mask in found]) if found else np.zeros((0, 1, 1), np.float16)
    return FoundMasks(logits, tuple(name for name, *_ in found), tuple(score for _, score, _ in found))


def _instances(loaded: tuple[Any, Any], name: str, seen: Any, threshold: float) -> list[tuple[str, float, np.ndarray]]:
    model, tokenizer = loaded
    words = tokenizer(name, padding="max_length", max_length=_TOKENS, truncation=True, return_tensors="pt").to(model.device)
    out = model(vision_embeds=seen, input_ids=words.input_ids, attention_mask=words.attention_mask)
    scores = (out.pred_logits.sigmoid() * out.presence_logits.sigmoid())[0].float()
    check_finite(str(model.dtype).removeprefix("torch."), scores, out.pred_masks)
    kept = (scores > threshold).nonzero()[:, 0].tolist()
    return [(name, float(scores[k]), halves(out.pred_masks[0, k].float().cpu().numpy())) for k in kept]
