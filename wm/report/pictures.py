"""Pictures for the report: data URIs of thumbnails, and depth error as colour."""

import base64
import io

import matplotlib
import numpy as np
from jaxtyping import Float, Num, UInt8
from PIL import Image

from wm.color import to_bytes

DEPTH_ERROR_RANGE = 0.10
"""Depth error, in metres, at which the colour saturates."""


def depth_error_image(ours: Float[np.ndarray, "h w"], scaffold: Float[np.ndarray, "h w"]) -> UInt8[np.ndarray, "h w 3"]:
    """|ours - scaffold| as a colour, from dark (0) to bright (DEPTH_ERROR_RANGE or more); grey where the scaffold is not hit."""
    error = np.clip(np.abs(ours - scaffold) / DEPTH_ERROR_RANGE, 0, 1)
    colours = matplotlib.colormaps["inferno"](error)[..., :3]
    return to_bytes(np.where((scaffold > 0)[..., None], colours, 0.5))


def data_uri(rgb: Num[np.ndarray, "h w 3"], *, max_width: int, quality: int = 82) -> str:
    """A JPEG of at most `max_width` pixels as a data URI."""
    image = Image.fromarray(to_bytes(rgb))
    if image.width > max_width:
        image = image.resize((max_width, round(image.height * max_width / image.width)), Image.Resampling.LANCZOS)
    buffer = io.BytesIO()
    image.save(buffer, format="JPEG", quality=quality)
    return media_uri(buffer.getvalue(), "image/jpeg")


def media_uri(data: bytes, kind: str) -> str:
    """Data of a media type ("video/mp4") as a data URI."""
    return f"data:{kind};base64,{base64.b64encode(data).decode()}"
