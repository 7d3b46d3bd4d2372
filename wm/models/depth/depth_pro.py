"""Depth Pro of Apple, on this machine: metric depth with sharp edges.

The model's output is the canonical inverse depth C: that of the scene as a camera of focal length 1 (in widths of the image)
would see it. With the camera's focal length f in pixels and an image w pixels wide, z-depth is

    z = f / (w C),   C held to [1e-4, 1e4] w / f

f is the camera's, since it is known here; the part of the model that guesses it from the image is not loaded.

Source: Bochkovskii et al. 2024, section 3.1; transformers' DepthProForDepthEstimation and its processor, whose bounds of 1/z
these are. Licence of the weights: Apple's for research (apple-amlr).
"""

import dataclasses
from typing import Any

import numpy as np
from jaxtyping import Float, UInt8

from wm.bounds import setting
from wm.models.access import optional_module
from wm.models.depth.local_depth import LocalDepth
from wm.models.depth.resampling import at_size, squashed
from wm.models.local_model import WEIGHTS, LocalModel, LocalSettings
from wm.models.weights import Weights, load_whole
from wm.synth.backends import SceneContext
from wm.types import Camera

VERSION = "1"
SERVED = True
_NEAREST, _FARTHEST = 1e-4, 1e4  # metres


@dataclasses.dataclass(kw_only=True, unsafe_hash=True)
class Settings(LocalSettings):
    """Which weights, and where they compute."""

    backend: str = setting(__name__, "Depth Pro on this machine.")
    model: str = setting("apple/DepthPro-hf@3a8b51229207764e5215b31f47fac0d1a049d563", WEIGHTS)


def predict(model: Any, rgb: UInt8[np.ndarray, "h w 3"]) -> Float[np.ndarray, "h w"]:
    """[h, w] canonical inverse depth C."""
    height, width = rgb.shape[:2]
    side = model.config.patch_size * round(1 / min(model.config.scaled_images_ratios))
    pixels = squashed(rgb, side).to(model.device, model.dtype)
    return at_size(model(pixel_values=pixels).predicted_depth, width, height, mode="bilinear")


def metric(canonical: Float[np.ndarray, "h w"], camera: Camera) -> Float[np.ndarray, "h w"]:
    """[h, w] float64 z-depth in metres, from canonical inverse depth."""
    inverse = canonical.astype(np.float64) * camera.width / float(camera.focal[0])
    return 1 / np.clip(inverse, 1 / _FARTHEST, 1 / _NEAREST)


def _load(weights: Weights, device: str, dtype: Any) -> Any:
    return load_whole(
        optional_module("transformers", "depth").DepthProForDepthEstimation, weights, use_fov_model=False, dtype=dtype
    ).to(device)


def make(settings: Settings, context: SceneContext | None) -> LocalDepth:
    """The backend. It does not use the scene. Weights are loaded when the first image is to be measured."""
    return LocalDepth(__name__, settings, LocalModel(settings, _load, extra="depth"), predict, metric)
