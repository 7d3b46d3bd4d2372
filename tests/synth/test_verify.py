"""Recall counts missing structure only, up to the tolerance; what cannot be judged does not pass."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from wm.schema import VerifySettings
from wm.synth.canny import depth_edges
from wm.synth.verify import dilate, dilation_radius, edge_recall, verify

SHAPE = (30, 44)


def scattered(seed, share=0.03):
    return np.random.default_rng(seed).uniform(size=SHAPE) < share


@given(st.integers(0, 2**32 - 1), st.integers(0, 12))
def test_dilation_is_a_disk(seed, radius):
    edges = scattered(seed)
    i, j = np.mgrid[: SHAPE[0], : SHAPE[1]]
    expected = np.zeros(SHAPE, bool)
    for a, b in np.argwhere(edges):
        expected |= (i - a) ** 2 + (j - b) ** 2 <= radius**2
    np.testing.assert_array_equal(dilate(edges, radius), expected)


@given(st.integers(0, 2**32 - 1), st.integers(0, 8))
def test_laws_of_recall(seed, radius):
    ours, theirs, more = scattered(seed), scattered(seed + 1), scattered(seed + 2)
    recall = edge_recall(ours, theirs, radius)
    assert recall is not None
    assert 0 <= recall <= 1
    assert edge_recall(ours, ours, radius) == 1
    assert edge_recall(ours, theirs | more, radius) >= recall  # things that the image adds are allowed
    assert edge_recall(ours, theirs, radius + 1) >= recall
    assert edge_recall(ours, np.zeros(SHAPE, bool), radius) == 0
    assert edge_recall(np.zeros(SHAPE, bool), theirs, radius) is None


def test_recall_is_the_share_that_is_found():
    ours, theirs = np.zeros(SHAPE, bool), np.zeros(SHAPE, bool)
    ours[10, :20] = True
    theirs[12, :10] = True
    assert edge_recall(ours, theirs, 2) == 0.5
    assert edge_recall(ours, theirs, 1) == 0


@pytest.mark.parametrize(("width", "radius"), [(1376, 10), (688, 5), (344, 2), (64, 2)])
def test_the_tolerance_follows_the_image(width, radius):
    assert dilation_radius(VerifySettings(), width) == radius


def step(at=20):
    depth = np.full(SHAPE, 2.0)
    depth[:, at:] = 4.0
    return depth, depth_edges(depth, np.ones(SHAPE, bool), low=0.1, high=0.3)


def test_verdicts():
    depth, edges = step()
    settings = VerifySettings()
    assert verify(edges, depth, settings).passed
    assert verify(edges, 0.1 * depth + 7, settings).recall == 1.0
    moved = verify(edges, step(at=30)[0], settings)
    assert (moved.passed, moved.recall) == (False, 0.0)
    assert "recall" in moved.reason


@pytest.mark.parametrize("estimate", [None, np.full(SHAPE, np.nan)])
def test_no_estimate_is_no_pass(estimate):
    verdict = verify(step()[1], estimate, VerifySettings())
    assert not verdict.passed
    assert verdict.recall is None
    assert "no depth" in verdict.reason


def test_without_scaffold_edges_the_test_does_not_apply_and_says_so():
    verdict = verify(np.zeros(SHAPE, bool), step()[0], VerifySettings())
    assert verdict.passed
    assert verdict.recall is None
    assert "does not apply" in verdict.reason
    assert not verify(np.zeros(SHAPE, bool), None, VerifySettings()).passed  # it still fails closed


def test_verification_can_be_switched_off():
    assert verify(step()[1], None, VerifySettings(enabled=False)).passed


def test_an_estimate_of_another_size_is_refused():
    with pytest.raises(ValueError, match="estimate"):
        verify(step()[1], np.ones((4, 4)), VerifySettings())


def test_a_small_thing_that_is_missing_passes_recall_and_fails_depth():
    depth = step()[0]
    depth[12:18, 4:10] = 1.0
    edges = depth_edges(depth, np.ones(SHAPE, bool), low=0.1, high=0.3)
    without = step()[0]
    assert verify(edges, without, VerifySettings()).passed
    verdict = verify(edges, without, VerifySettings(), depth=depth)
    assert not verdict.passed
    assert verdict.disagreement == pytest.approx(4 / depth.size)  # what lies two pixels within its silhouette
    assert "disagrees" in verdict.reason
    assert verify(edges, without, VerifySettings(max_disagreement=1.0), depth=depth).passed  # the paper's test alone


def test_a_true_image_passes_both():
    depth, edges = step()
    verdict = verify(edges, 3 * depth + 1, VerifySettings(), depth=depth)
    assert (verdict.passed, verdict.recall, verdict.disagreement) == (True, 1.0, 0.0)


@pytest.mark.parametrize("falling", [lambda depth: -depth, lambda depth: 1 / depth], ids=["negated", "disparity"])
def test_front_and_back_swapped_does_not_pass(falling):
    """Its edges are all in their places; only held to depth can it be told."""
    depth, edges = step()
    verdict = verify(edges, falling(depth), VerifySettings(), depth=depth)
    assert (verdict.passed, verdict.recall) == (False, 1.0)
    assert verdict.disagreement is not None and verdict.disagreement > 0.2


@pytest.mark.parametrize("estimate", [None, np.full(SHAPE, np.nan)])
def test_held_to_depth_it_still_fails_closed(estimate):
    depth, edges = step()
    assert not verify(edges, estimate, VerifySettings(), depth=depth).passed


def test_an_estimate_of_half_the_image_vouches_for_no_more_than_that():
    """Also where the image is free to add things: the half that says nothing might be anything."""
    depth, edges = step(at=10)
    half = depth.copy()
    half[:, 22:] = np.nan
    for held in (None, depth):
        verdict = verify(edges, half, VerifySettings(), depth=held)
        assert (verdict.passed, verdict.recall, verdict.disagreement) == (False, 1.0, 0.5)
        assert "missing" in verdict.reason
        assert verify(edges, half, VerifySettings(max_disagreement=1.0), depth=held).passed  # the paper's test alone


@pytest.mark.parametrize("falling", [lambda z: 1 / z, lambda z: -z])
def test_front_and_back_swapped_does_not_pass_where_things_may_be_added(falling):
    """Without the depth it would: the edges of an inverted estimate are where they should be."""
    depth, edges = step()
    assert verify(edges, falling(depth), VerifySettings()).passed
    assert not verify(edges, falling(depth), VerifySettings(), depth=depth, adds=True).passed
    assert verify(edges, 3 * depth + 1, VerifySettings(), depth=depth, adds=True).passed
