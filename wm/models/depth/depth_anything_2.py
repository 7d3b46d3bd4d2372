"""Depth Anything V2, on this machine, in the versions that were trained for metric depth, indoors or outdoors.

Their output is z-depth in metres, for the cameras of their training data: for others it is right up to a scale, which is all that
is asked of depth here. The relative versions are refused: they give inverse depth with an unknown shift, from which no depth
follows.

Source: Yang et al. 2024; transformers' DepthAnythingForDepthEstimation and DPTImageProcessorPil. Licences of the weights: Small
Apache-2.0, Base and Large CC BY-NC 4.0.
"""

import dataclasses
from typing import Any

import numpy as np
from jaxtyping import Float, UInt8

from wm.bounds import setting
from wm.models.access import optional_module
from wm.models.depth.local_depth import LocalDepth
from wm.models.depth.resampling import at_size, fitted
from wm.models.local_model import WEIGHTS, LocalModel, LocalSettings
from wm.models.weights import Weights, load_whole
from wm.services.faults import ServiceError
from wm.synth.backends import SceneContext
from wm.types import Camera

VERSION = "1"
SERVED = True
_SMALL_INDOOR = "depth-anything/Depth-Anything-V2-Metric-Indoor-Small-hf@4d5187ef4957085a714f15b6ae43230a8b813c03"
_SIDE, _MULTIPLE = 518, 14  # pixels
_MEAN, _DEVIATION = (0.485, 0.456, 0.406), (0.229, 0.224, 0.225)  # of ImageNet's channels


@dataclasses.dataclass(kw_only=True, unsafe_hash=True)
class Settings(LocalSettings):
    """Which weights, and where they compute."""

    backend: str = setting(__name__, "Depth Anything V2, metric, on this machine.")
    model: str = setting(_SMALL_INDOOR, WEIGHTS)


def predict(model: Any, rgb: UInt8[np.ndarray, "h w 3"]) -> Float[np.ndarray, "h w"]:
    """[h, w] z-depth in metres."""
    height, width = rgb.shape[:2]
    pixels = fitted(rgb, _SIDE, _MULTIPLE, _MEAN, _DEVIATION).to(model.device, model.dtype)
    return at_size(model(pixel_values=pixels).predicted_depth, width, height, mode="bicubic")


def _as_it_is(depth: Float[np.ndarray, "h w"], camera: Camera) -> Float[np.ndarray, "h w"]:
    return depth


def _load(weights: Weights, device: str, dtype: Any) -> Any:
    model = load_whole(optional_module("transformers", "depth").DepthAnythingForDepthEstimation, weights, dtype=dtype)
    if model.config.depth_estimation_type != "metric":
        raise ServiceError(
            f"{weights.name} gives inverse depth with an unknown shift; one of the checkpoints Depth-Anything-V2-Metric-* would "
            "be right"
        )
    return model.to(device)


def make(settings: Settings, context: SceneContext | None) -> LocalDepth:
    """The backend. It does not use the scene. Weights are loaded when the first image is to be measured."""
    return LocalDepth(__name__, settings, LocalModel(settings, _load, extra="depth"), predict, _as_it_is)
