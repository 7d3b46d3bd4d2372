"""Several images in one: each where it is said to be, its border around it."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from wm.geometry.texture.image_sheet import image_sheet, sheet_uv


@given(st.lists(st.tuples(st.integers(1, 9), st.integers(1, 9)), min_size=2, max_size=6), st.integers(0, 1000))
def test_each_image_lies_in_the_sheet_with_its_border_around_it(shapes, seed):
    rng = np.random.default_rng(seed)
    images = [rng.integers(0, 256, (*shape, 3), np.uint8) for shape in shapes]
    sheet, corner = image_sheet(images)
    for image, (row, column) in zip(images, corner):
        framed = np.pad(image, ((1, 1), (1, 1), (0, 0)), mode="edge")
        height, width = framed.shape[:2]
        np.testing.assert_array_equal(sheet[row - 1 : row - 1 + height, column - 1 : column - 1 + width], framed)
        first = sheet_uv(np.array([0.0, 0.0]), image, np.array([row, column]), sheet.shape)
        last = sheet_uv(np.array([1.0, 1.0]), image, np.array([row, column]), sheet.shape)
        np.testing.assert_allclose(first * sheet.shape[1::-1], [column, row], atol=1e-9)
        np.testing.assert_allclose(last * sheet.shape[1::-1], [column + image.shape[1], row + image.shape[0]], atol=1e-9)


def test_one_image_stays_as_it_is():
    image = np.arange(24, dtype=np.uint8).reshape(2, 4, 3)
    sheet, corner = image_sheet([image])
    assert sheet is image and corner.tolist() == [[0, 0]]
