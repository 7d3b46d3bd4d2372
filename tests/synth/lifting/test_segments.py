"""Segments: what the offline segmenter spoils, and what tidying mends."""

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st
from scipy import ndimage

from wm.offline.segmentation.drawn import DrawnSegmentation, Settings
from wm.synth.backends import ImageResult, Segment
from wm.synth.lifting.segments import tidy_segments

LABELS = ("chair", "chair", "vase", "sofa")


def drawn():
    ids = np.full((120, 160), -1, np.int32)
    ids[40:80, 20:50], ids[40:80, 50:80], ids[30:35, 100:106], ids[60:110, 100:150] = 0, 1, 2, 3
    return ImageResult(rgb=np.zeros((120, 160, 3), np.float32), drawn_object=ids, drawn_labels=LABELS)


def segments(seed=0, **strengths):
    exact = {"ragged": 0.0, "merged": 0.0, "missed": 0.0}
    return DrawnSegmentation(Settings(**(exact | strengths))).segment(drawn(), seed=seed)


def test_at_strength_0_it_returns_what_was_drawn():
    found = segments()
    assert [segment.label for segment in found] == list(LABELS)
    assert all(np.array_equal(segment.mask, drawn().drawn_object == k) for k, segment in enumerate(found))


def test_borders_stray_by_about_as_much_as_asked():
    for amount in (1.0, 3.0):
        changed = [np.mean(a.mask ^ b.mask) for a, b in zip(segments(), segments(ragged=amount))]
        border = 2 * (40 + 30) * amount / drawn().drawn_object.size
        assert 0.2 * border < changed[0] < 2.0 * border


def test_touching_neighbours_of_one_kind_merge_and_small_things_are_missed():
    assert [segment.label for segment in segments(merged=1.0)] == ["chair", "vase", "sofa"]
    assert [segment.label for segment in segments(missed=1.0)] == ["chair", "chair", "sofa"]


def test_the_seed_decides():
    def masks(seed):
        return b"".join(segment.mask.tobytes() for segment in segments(seed, ragged=1.0))

    assert masks(1) == masks(1) != masks(2)


def test_an_image_that_carries_nothing_is_refused():
    with pytest.raises(ValueError, match=r"offline segmentation.*this image tells nothing"):
        DrawnSegmentation(Settings()).segment(ImageResult(rgb=np.zeros((4, 4, 3), np.float32)), seed=0)


def rectangle(y0, y1, x0, x1):
    mask = np.zeros((60, 80), bool)
    mask[y0:y1, x0:x1] = True
    return mask


FLAT = np.full((60, 80), 3.0, np.float32)


LABELLED = st.sampled_from(("sofa", "bed", "pillow", "curtains", "wooden door"))
SOME = st.lists(st.tuples(LABELLED, *[st.integers(0, 59)] * 2, *[st.integers(0, 79)] * 2), max_size=8)


@given(SOME, st.integers(0, 2), st.floats(0, 0.05), st.permutations(range(8)))
@example([("curtains", 0, 9, 0, 9), ("pillow", 0, 9, 0, 9)], 0, 0.0, range(8)).via("a plural of which nothing is left")
@example([("curtains", 0, 9, 0, 9), ("pillow", 0, 8, 0, 9)], 0, 0.01, range(8)).via("a plural nine tenths of which are covered")
def test_tidy_segments_share_no_pixel_and_tidying_twice_or_in_another_order_is_the_same(corners, blocks, min_area, order):
    found = [Segment(label, rectangle(min(a, b), max(a, b) + 1, min(c, d), max(c, d) + 1)) for label, a, b, c, d in corners]
    depth = FLAT.copy()
    for k in range(blocks):  # something near, behind which a thing may go on
        depth[:, 20 + 25 * k : 28 + 25 * k] = 1.5
    tidy = tidy_segments(found, depth, min_area=min_area)
    assert sum((segment.mask.astype(int) for segment in tidy), np.zeros(depth.shape, int)).max(initial=0) <= 1
    for segment in tidy:
        claimed = np.any([other.mask for other in found if other.label == segment.label], axis=0)
        assert (segment.mask <= claimed).all() and segment.mask.sum() >= max(min_area * depth.size, 1)
        assert segment.label != "wooden door"
        if not blocks and segment.label != "curtains":  # nothing near: what does not hang together is not one thing
            assert ndimage.label(segment.mask, np.ones((3, 3)))[1] == 1
    shuffled = [found[k] for k in order if k < len(found)]
    for again in (tidy_segments(tidy, depth, min_area=min_area), tidy_segments(shuffled, depth, min_area=min_area)):
        assert [segment.label for segment in again] == [segment.label for segment in tidy]
        assert all(np.array_equal(a.mask, b.mask) for a, b in zip(again, tidy))


def test_small_ones_and_structure_go():
    found = [Segment("bowl", rectangle(0, 2, 0, 2)), Segment("wooden door", rectangle(0, 40, 0, 20)),
             Segment("sofa", rectangle(30, 50, 30, 60))]  # fmt: skip
    assert [segment.label for segment in tidy_segments(found, FLAT, min_area=2e-3)] == ["sofa"]


def test_overlaps_of_one_label_merge_and_every_pixel_belongs_to_one_segment():
    found = [Segment("bed", rectangle(10, 40, 10, 40)), Segment("bed", rectangle(12, 38, 20, 44)),
             Segment("pillow", rectangle(15, 20, 15, 25))]  # fmt: skip
    tidy = tidy_segments(found, FLAT, min_area=1e-4)
    assert [segment.label for segment in tidy] == ["bed", "pillow"]
    assert (
        not (tidy[0].mask & tidy[1].mask).any() and (tidy[0].mask | tidy[1].mask).sum() == (found[0].mask | found[1].mask).sum()
    )


def test_pieces_part_unless_something_nearer_hides_what_is_between():
    two = rectangle(20, 40, 5, 25) | rectangle(20, 40, 40, 60)
    assert len(tidy_segments([Segment("chair", two)], FLAT, min_area=1e-3)) == 2
    hidden = FLAT.copy()
    hidden[:, 25:40] = 1.5
    assert len(tidy_segments([Segment("chair", two)], hidden, min_area=1e-3)) == 1
    assert len(tidy_segments([Segment("curtains", two)], FLAT, min_area=1e-3)) == 1
