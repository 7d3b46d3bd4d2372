"""Images as files: what is written is read, of whatever format; what is damaged is refused."""

import io

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from PIL import Image

from tests.models.image.shift import texture
from wm.models.image.pictures import as_png, decoded
from wm.services.faults import RefusedError

IMAGE = texture(64, 40)


def saved(kind: str, mode: str = "RGB", **options) -> bytes:
    file = io.BytesIO()
    Image.fromarray(IMAGE).convert(mode).save(file, kind, **options)
    return file.getvalue()


def test_a_png_is_read_as_it_was_written():
    assert np.array_equal(decoded(as_png(IMAGE)), IMAGE)


@pytest.mark.parametrize(
    ("kind", "mode", "off"), [("PNG", "RGBA", 0), ("PNG", "P", 40), ("PNG", "L", 60), ("JPEG", "RGB", 12), ("WEBP", "RGB", 16)]
)
def test_images_of_other_formats_become_rgb(kind, mode, off):
    read = decoded(saved(kind, mode))
    assert read.shape == IMAGE.shape and read.dtype == np.uint8
    assert np.abs(read.astype(int) - IMAGE).mean() <= off


@given(st.integers(0, len(saved("PNG")) - 20))
def test_a_cut_png_is_refused_wherever_it_is_cut(length):
    with pytest.raises(RefusedError, match="its image cannot be read"):
        decoded(saved("PNG")[:length])


@pytest.mark.parametrize("content", [b"", b"<html>busy</html>", saved("JPEG")[:500], saved("PNG").replace(b"IDAT", b"IDOT")])
def test_what_is_no_image_is_refused(content):
    with pytest.raises(RefusedError, match="its image cannot be read"):
        decoded(content)
