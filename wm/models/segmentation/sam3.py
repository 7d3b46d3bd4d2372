"""SAM 3: which checkpoint, and how an image becomes what its models take.

The hub's facebook/sam3 holds two models that share an image encoder: the detector, which takes words, and the tracker, which
takes clicks. A checkpoint that was saved from one of them lacks weights of the other, and is refused there (wm.models.weights).
"""

import dataclasses
from typing import Any

import numpy as np
from jaxtyping import UInt8

from wm.bounds import setting
from wm.models.access import optional_module
from wm.models.local_model import WEIGHTS, LocalSettings
from wm.models.weights import Weights, load, load_whole
from wm.services.faults import ServiceError

EXTRA = "sam"


@dataclasses.dataclass(kw_only=True, unsafe_hash=True)
class Sam3Settings(LocalSettings):
    """The checkpoint, and where it computes."""

    model: str = setting("facebook/sam3", WEIGHTS)


def load_detector(weights: Weights, device: str, dtype: Any) -> tuple[Any, Any]:
    """The Sam3Model and its tokenizer. Raises: MissingExtraError, ServiceError as `wm.models.weights.load_whole`."""
    transformers = optional_module("transformers", EXTRA)
    model = load_whole(transformers.Sam3Model, weights, dtype=dtype)
    return model.to(device), load(transformers.CLIPTokenizerFast, weights)


def load_tracker(weights: Weights, device: str, dtype: Any) -> Any:
    """The Sam3TrackerModel. Raises: MissingExtraError, ServiceError as `wm.models.weights.load_whole`."""
    transformers = optional_module("transformers", EXTRA)
    return load_whole(transformers.Sam3TrackerModel, weights, dtype=dtype).to(device)


def image_tensor(rgb: UInt8[np.ndarray, "h w 3"], model: Any) -> Any:
    """[1, 3, s, s] in [-1, 1]: the image stretched to the square that the model takes, as Sam3ImageProcessor does it.

    Source: transformers 5.24, models/sam3/image_processing_sam3.py (resized as bytes, with antialiasing).
    """
    torch = optional_module("torch", EXTRA)
    side = model.config.vision_config.image_size
    tensor = torch.from_numpy(np.ascontiguousarray(rgb)).permute(2, 0, 1)[None]
    resized = torch.nn.functional.interpolate(tensor, (side, side), mode="bilinear", antialias=True, align_corners=False)
    return ((resized.float() / 255 - 0.5) / 0.5).to(device=model.device, dtype=model.dtype)


def check_finite(dtype: str, *outputs: Any) -> None:
    """Raises: ServiceError where a model computed values that are no numbers."""
    if not all(bool(output.isfinite().all()) for output in outputs):
        raise ServiceError(f"SAM 3 computes values that are not finite in {dtype}; segmentation.dtype=float32 would be right")
