"""Colour: sRGB encoding, linear light and luminance, and images in 8 bits."""

import numpy as np
from jaxtyping import Float, Num, UInt8

LUMINANCE = np.array([0.2126, 0.7152, 0.0722], np.float32)
"""Rec. 709 weights of linear red, green and blue."""


def to_linear(srgb: Float[np.ndarray, "..."]) -> Float[np.ndarray, "..."]:
    """sRGB-encoded in [0, 1] to linear light (Source: IEC 61966-2-1)."""
    x = np.asarray(srgb)
    return np.where(x <= 0.04045, x / 12.92, ((np.maximum(x, 0) + 0.055) / 1.055) ** 2.4).astype(x.dtype)


def to_srgb(linear: Float[np.ndarray, "..."]) -> Float[np.ndarray, "..."]:
    """Linear light, clipped to [0, 1], to sRGB encoding."""
    x = np.clip(linear, 0, 1)
    return np.where(x <= 0.0031308, 12.92 * x, 1.055 * np.maximum(x, 1e-9) ** (1 / 2.4) - 0.055).astype(x.dtype)


def to_bytes(rgb: Num[np.ndarray, "h w 3"]) -> UInt8[np.ndarray, "h w 3"]:
    """An image in [0, 1], clipped and rounded to 8 bits. An 8-bit image is returned unchanged."""
    return rgb if rgb.dtype == np.uint8 else np.round(np.clip(rgb, 0, 1) * 255).astype(np.uint8)
