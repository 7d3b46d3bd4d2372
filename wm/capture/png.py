"""Images of frames as PNG files."""

import io

import numpy as np
from jaxtyping import Float, UInt16
from PIL import Image


def encode_16_bits(image: UInt16[np.ndarray, "h w"]) -> bytes:
    """A 16-bit PNG of whole numbers."""
    buffer = io.BytesIO()
    Image.fromarray(image).save(buffer, format="PNG", compress_level=1)
    return buffer.getvalue()


def encode_normals(normal: Float[np.ndarray, "h w 3"]) -> bytes:
    """An 8-bit PNG of (n + 1) / 2; where nothing is hit, middle grey."""
    buffer = io.BytesIO()
    Image.fromarray(np.round((normal + 1) * 127.5).astype(np.uint8)).save(buffer, format="PNG", compress_level=1)
    return buffer.getvalue()


def depth_steps(depth: Float[np.ndarray, "h w"], steps: float) -> UInt16[np.ndarray, "h w"]:
    """Depth in so many steps a metre; what 16 bits cannot hold is 0, which means none."""
    scaled = np.round(depth * steps)
    return np.where((scaled > 0) & (scaled <= np.iinfo(np.uint16).max), scaled, 0).astype(np.uint16)
