"""Images made ready for depth models, and their answers brought to the size of the image, as transformers' processors do it.

Those processors need torchvision, for which there is no build beside torch without CUDA; these functions need torch and Pillow.
"""

from typing import Any

import numpy as np
from jaxtyping import Float, UInt8
from PIL import Image

from wm.models.access import optional_module


def squashed(rgb: UInt8[np.ndarray, "h w 3"], side: int) -> Any:
    """[1, 3, side, side] torch.float32 in [-1, 1]: the image without its aspect ratio, interpolated linearly without a low pass.

    Source: DepthProImageProcessor of transformers 5.24.
    """
    torch = optional_module("torch", "depth")
    pixels = torch.from_numpy(rgb.copy()).permute(2, 0, 1)[None].float()
    return torch.nn.functional.interpolate((pixels / 255 - 0.5) / 0.5, (side, side), mode="bilinear", align_corners=False)


def fitted(
    rgb: UInt8[np.ndarray, "h w 3"], side: int, multiple: int, mean: tuple[float, ...], deviation: tuple[float, ...]
) -> Any:
    """[1, 3, h', w'] torch.float32: the image scaled so that the side which changes least becomes `side`, both sides then rounded
    to multiples, by cubic interpolation; each channel shifted by `mean` and divided by `deviation`.

    Source: DPTImageProcessorPil of transformers 5.24, with keep_aspect_ratio.
    """
    torch = optional_module("torch", "depth")
    size = fitted_size(rgb.shape[1], rgb.shape[0], side, multiple)
    pixels = np.asarray(Image.fromarray(rgb).resize(size, Image.Resampling.BICUBIC)).astype(np.float32) / np.float32(255)
    normal = (pixels - np.array(mean, np.float32)) / np.array(deviation, np.float32)
    return torch.from_numpy(normal).permute(2, 0, 1)[None]


def fitted_size(width: int, height: int, side: int, multiple: int) -> tuple[int, int]:
    """(width, height) of `fitted`."""
    across, down = side / width, side / height
    scale = across if abs(1 - across) < abs(1 - down) else down
    return multiple * round(scale * width / multiple), multiple * round(scale * height / multiple)


def at_size(values: Any, width: int, height: int, *, mode: str) -> Float[np.ndarray, "h w"]:
    """A model's answer [1, h', w'] at another size, as float32 on the host: interpolated linearly ("bilinear") or by cubics
    ("bicubic") between pixel centres, without a low pass."""
    torch = optional_module("torch", "depth")
    resized = torch.nn.functional.interpolate(values.float()[:, None], (height, width), mode=mode, align_corners=False)
    return np.ascontiguousarray(resized[0, 0].cpu().numpy())
