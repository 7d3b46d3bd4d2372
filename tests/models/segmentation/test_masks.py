"""Masks of the model brought to the image, told apart, and kept as bytes."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from wm.models.segmentation.masks import FoundMasks, decode, encode, halves, iou, resized, segments, unlike
from wm.services.faults import RefusedError


@given(st.integers(1, 9), st.integers(1, 9), st.integers(1, 40), st.integers(1, 40))
def test_a_constant_stays_constant_and_values_stay_between_their_neighbours(a, b, h, w):
    grid = np.random.default_rng(a + 10 * b).normal(size=(a, b)).astype(np.float32)
    out = resized(grid, (h, w))
    assert out.shape == (h, w)
    assert grid.min() - 1e-5 <= out.min() and out.max() <= grid.max() + 1e-5
    np.testing.assert_allclose(resized(np.full((a, b), 3.0, np.float32), (h, w)), 3.0, atol=1e-5)


def test_the_size_of_the_grid_changes_nothing():
    grid = np.random.default_rng(0).normal(size=(7, 5)).astype(np.float32)
    np.testing.assert_array_equal(resized(grid, (7, 5)), grid)


def test_a_half_plane_keeps_its_border_within_a_cell_and_its_middle_exactly():
    """The border of a mask between two cells lies between them in the image too: nothing is shifted by half a cell."""
    grid = np.where(np.arange(8)[None] < 4, 1.0, -1.0) * np.ones((6, 1))
    inside = resized(grid.astype(np.float32), (60, 160)) > 0
    assert (inside == (np.arange(160) < 80)).all()


def found(*masks, scores, labels=None):
    logits = np.stack([np.where(mask, 8.0, -8.0) for mask in masks])
    return FoundMasks(halves(logits), tuple(labels or "abcdef"[: len(masks)]), tuple(scores))


def box(rows, columns, shape=(16, 20)):
    mask = np.zeros(shape, bool)
    mask[slice(*rows), slice(*columns)] = True
    return mask


SOFA, COUCH, LAMP, PILLOW = box((2, 12), (1, 15)), box((2, 12), (1, 14)), box((0, 9), (16, 19)), box((4, 7), (3, 7))


def test_of_two_names_for_one_thing_the_surer_remains_and_what_lies_on_it_too():
    everything = found(SOFA, COUCH, LAMP, PILLOW, scores=[0.5, 0.9, 0.4, 0.8], labels=["sofa", "couch", "lamp", "pillow"])
    kept = segments(everything, (16, 20), most=0.7)
    assert [(segment.label, segment.score) for segment in kept] == [("couch", 0.9), ("pillow", 0.8), ("lamp", 0.4)]
    for segment, mask in zip(kept, (COUCH, PILLOW, LAMP), strict=True):
        np.testing.assert_array_equal(segment.mask, mask)


def test_nothing_found_is_no_segment_and_an_empty_mask_is_none_either():
    assert segments(found(np.zeros((4, 4), bool), scores=[0.9]), (8, 8)) == []
    assert segments(FoundMasks(np.zeros((0, 1, 1), np.float16), (), ()), (8, 8)) == []


def test_the_order_in_which_they_come_decides_only_between_equals():
    masks, scores = [SOFA, COUCH, LAMP], [0.5, 0.6, 0.5]
    assert unlike(masks, scores, most=0.7) == [1, 2]
    assert [2 - k for k in unlike(masks[::-1], scores[::-1], most=0.7)] == [1, 2]
    assert unlike([SOFA, SOFA], [0.5, 0.5], most=0.7) == [0]
    assert unlike([SOFA, SOFA], [0.5, 0.5], most=1.0) == [0, 1]


def test_intersection_over_union():
    assert iou(SOFA, SOFA) == 1 and iou(SOFA, LAMP) == 0 == iou(SOFA & ~SOFA, SOFA & ~SOFA)
    assert iou(SOFA, COUCH) == iou(COUCH, SOFA) == 130 / 140


def test_what_was_found_survives_its_bytes():
    before = found(SOFA, LAMP, scores=[0.25, 0.125], labels=["sofa", "lamp"])
    after = decode(encode(before))
    np.testing.assert_array_equal(after.logits, before.logits)
    assert (after.labels, after.scores) == (before.labels, before.scores)
    assert encode(before) == encode(after)


def test_logits_beyond_half_precision_stay_finite():
    assert np.isfinite(halves(np.array([[[1e9, -1e9]]]))).all()


@pytest.mark.parametrize("files", [{}, {"masks.npy": b"", "found.json": b"[]"}, {"masks.npy": b"x", "found.json": b"{"}])
def test_bytes_that_are_none_of_these_count_as_a_failed_answer(files):
    with pytest.raises(RefusedError, match="cannot be read"):
        decode(files)
    with pytest.raises(RefusedError, match="2 labels"):
        decode(encode(found(SOFA, LAMP, scores=[0.0, 0.0])) | {"masks.npy": encode(found(SOFA, scores=[0.0]))["masks.npy"]})
