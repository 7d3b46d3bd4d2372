"""Between the colours people name (sRGB), light (linear), and what a screen shows of it (the tone curve)."""

import numpy as np
from jaxtyping import Float

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


def tone(radiance: Float[np.ndarray, "..."], *, exposure: float = 1.0) -> Float[np.ndarray, "..."]:
    """Scene radiance to sRGB: linear up to half of white, then a shoulder that reaches 1 only at infinity.

    x for x <= a, and a + (1 - a) (1 - exp(-(x - a) / (1 - a))) above, with a = 0.5: value and slope are continuous. Below the
    shoulder a white-balanced, unit-lit surface shows exactly the colour its material was given.
    """
    x = np.maximum(radiance, 0) * exposure
    knee = 0.5
    above = knee + (1 - knee) * -np.expm1(-(np.maximum(x, knee) - knee) / (1 - knee))
    return to_srgb(np.where(x <= knee, x, above).astype(np.float32))


def adapted(light: Float[np.ndarray, "n 3"], mean: Float[np.ndarray, "3"], share: float) -> Float[np.ndarray, "n 3"]:
    """Linear light as an eye sees it that is used to its mean: as bright as before, the mean's cast to the power 1 - share.

    Source: von Kries adaptation, on the Rec. 709 primaries instead of the cones.
    """
    brightness = float(mean @ LUMINANCE)
    cast = np.maximum(mean / max(brightness, 1e-6), 1e-2) ** share
    gain = brightness / max(float((mean / cast) @ LUMINANCE), 1e-6)
    return (light * (gain / cast)).astype(light.dtype)
