"""Images as files: what models are sent, and what they send."""

import io

import numpy as np
from jaxtyping import UInt8
from PIL import Image

from wm.services.faults import RefusedError


def as_png(rgb: UInt8[np.ndarray, "h w 3"]) -> bytes:
    """The PNG of an image, compressed quickly rather than well."""
    file = io.BytesIO()
    Image.fromarray(rgb).save(file, "PNG", compress_level=1)
    return file.getvalue()


def decoded(content: bytes) -> UInt8[np.ndarray, "h w 3"]:
    """The image in a file of any format, without its transparency.

    Raises:
      RefusedError: it cannot be read, or not to its end.
    """
    try:
        with Image.open(io.BytesIO(content)) as image:
            return np.array(image.convert("RGB"))
    except Exception as error:  # decoders raise errors of many kinds for damaged bytes
        raise RefusedError(f"its image cannot be read: {type(error).__name__}: {error}") from None
