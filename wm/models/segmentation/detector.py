"""Instances of what a name names, found by Sam3Model.

The image is encoded once, then the rest of the model is run once a name. The score of a query is that the name is in the image at
all, times that the query is one of it. Source: transformers 5.24, models/sam3 (post_process_instance_segmentation).
"""

from collections.abc import Sequence
from typing import Any

import numpy as np
from jaxtyping import UInt8

from wm.models.segmentation.checkpoint import (
    Sam3Settings,
    free_memory,
    image_tensor,
    libraries,
    load_model,
    load_tokenizer,
    version_of,
)
from wm.models.segmentation.masks import FoundMasks, halves
from wm.services.faults import ServiceError

_TOKENS = 32
"""Tokens of a name that the model takes; what is longer is cut."""


class Detector:
    """The model, loaded when it is first asked. One thread asks it at a time."""

    def __init__(self, settings: Sam3Settings):
        self._settings = settings
        self._loaded: tuple[Any, Any] | None = None

    @property
    def version(self) -> str:
        """Of the weights, where the hub tells it."""
        return "" if self._loaded is None else version_of(self._loaded[0])

    def find(self, rgb: UInt8[np.ndarray, "h w 3"], names: Sequence[str], *, threshold: float) -> FoundMasks:
        """All instances of all names whose score is above `threshold`.

        Raises:
          MissingExtraError, ServiceError: the model cannot be loaded, or computes values that are not finite.
        """
        torch, _ = libraries()
        if self._loaded is None:
            self._loaded = load_model("Sam3Model", self._settings), load_tokenizer(self._settings)
        model = self._loaded[0]
        found: list[tuple[str, float, np.ndarray]] = []
        with torch.inference_mode():
            seen = model.get_vision_features(pixel_values=image_tensor(rgb, model))
            for name in names:
                found += self._instances(name, seen, threshold)
        logits = np.stack([mask for *_, mask in found]) if found else np.zeros((0, 1, 1), np.float16)
        return FoundMasks(logits, tuple(name for name, *_ in found), tuple(score for _, score, _ in found))

    def close(self) -> None:
        """Gives the memory back. Asking again loads the model again."""
        if self._loaded is not None:
            self._loaded = None
            free_memory(self._settings)

    def _instances(self, name: str, seen: Any, threshold: float) -> list[tuple[str, float, np.ndarray]]:
        torch, _ = libraries()
        assert self._loaded is not None
        model, tokenizer = self._loaded
        words = tokenizer(name, padding="max_length", max_length=_TOKENS, truncation=True, return_tensors="pt").to(model.device)
        out = model(vision_embeds=seen, input_ids=words.input_ids, attention_mask=words.attention_mask)
        scores = (out.pred_logits.sigmoid() * out.presence_logits.sigmoid())[0].float()
        if not bool(torch.isfinite(scores).all() and torch.isfinite(out.pred_masks).all()):
            raise ServiceError(f"SAM 3 computes values that are not finite in {self._settings.dtype}; segmentation.dtype=float32")
        kept = torch.nonzero(scores > threshold)[:, 0].tolist()
        return [(name, float(scores[k]), halves(out.pred_masks[0, k].float().cpu().numpy())) for k in kept]
