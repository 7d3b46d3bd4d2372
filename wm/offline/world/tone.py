"""From light to what a screen shows: the tone curve, and adaptation to the light's colour."""

import numpy as np
from jaxtyping import Float

from wm.color import LUMINANCE, to_srgb


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
    """Linear light as an eye adapted to its mean sees it: as bright as before, with the mean's cast raised to the power 1 -
    share.

    Source: von Kries adaptation, on the Rec. 709 primaries instead of the cones.
    """
    brightness = float(mean @ LUMINANCE)
    cast = np.maximum(mean / max(brightness, 1e-6), 1e-2) ** share
    gain = brightness / max(float((mean / cast) @ LUMINANCE), 1e-6)
    return (light * (gain / cast)).astype(light.dtype)
