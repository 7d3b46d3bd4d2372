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


def test_what_is_seen_through_or_in_glass_does_not_matter():
    """Whatever an estimate says of a pane, or if it says nothing; also where things may be added."""
    depth, edges = step()
    glass = np.zeros(SHAPE, bool)
    glass[8:16, 26:38] = True
    held, binding = np.where(glass, 0, depth), edges & ~glass
    for seen in (depth[glass], 30.0, 0.5, np.nan):
        estimate = depth.copy()
        estimate[glass] = seen
        for adds in (False, True):
            verdict = verify(binding, estimate, VerifySettings(), depth=held, adds=adds, glass=glass)
            assert (verdict.passed, verdict.recall, verdict.disagreement) == (True, 1.0, 0.0)


def test_glass_does_not_excuse_what_is_beside_it():
    depth, edges = step()
    glass = np.zeros(SHAPE, bool)
    glass[8:16, 26:38] = True
    estimate = np.where(glass, 30.0, depth)
    estimate[18:26, 26:38] = 1.0
    verdict = verify(edges & ~glass, estimate, VerifySettings(), depth=np.where(glass, 0, depth), glass=glass)
    assert not verdict.passed


def drifting(seed):
    """A smooth field around 1 that leaves it by up to 15 %."""
    x, y = np.meshgrid(np.linspace(-1, 1, SHAPE[1]), np.linspace(-1, 1, SHAPE[0]))
    a, b, c, d = np.random.default_rng(seed).uniform(-1, 1, 4)
    field = a * x + b * y + c * x * y + d * x**2
    return np.exp(np.log(1.15) * field / np.abs(field).max())


def empty_room():
    """Far wall, side walls, floor and ceiling, as a camera sees them."""
    x, y = np.meshgrid(np.linspace(-0.9, 0.9, SHAPE[1]), np.linspace(-0.6, 0.6, SHAPE[0]))
    sides = np.minimum(np.where(x < 0, 2.0, 2.4) / np.abs(x), np.where(y < 0, 1.2, 1.4) / np.abs(y))
    return np.minimum(sides, 5.0)


def furnished(i=14, j=16):
    depth = empty_room()
    depth[i : i + 10, j : j + 10] = 1.5
    return depth


@given(st.integers(0, 2**32 - 1))
def test_a_smooth_drift_of_scale_never_fails_an_image_and_never_hides_a_thing(seed):
    depth, field, settings = furnished(), drifting(seed), VerifySettings(field=4)
    edges = depth_edges(depth, np.ones(SHAPE, bool), low=settings.low, high=settings.high)
    assert verify(edges, 3 * depth * field, settings, depth=depth).passed
    for wrong in (empty_room(), furnished(j=24), furnished(i=6)):
        apart = verify(edges, 3 * wrong * field, settings, depth=depth).disagreement
        assert apart is not None and apart > 0.02


def test_a_drift_of_scale_fails_where_none_is_allowed():
    """The far wall drifts from side to side, which no scale and shift explains."""
    depth = furnished()
    edges = depth_edges(depth, np.ones(SHAPE, bool), low=0.1, high=0.3)
    drifted = depth * np.exp(np.linspace(-0.2, 0.2, SHAPE[1]))
    assert not verify(edges, drifted, VerifySettings(field=0), depth=depth).passed
    assert verify(edges, drifted, VerifySettings(field=1), depth=depth).passed


@pytest.mark.parametrize("falling", [lambda z: 1 / z, lambda z: -z])
@pytest.mark.parametrize("adds", [False, True])
def test_no_field_makes_an_inverted_estimate_pass(falling, adds):
    depth, settings = furnished(), VerifySettings(field=8)
    edges = depth_edges(depth, np.ones(SHAPE, bool), low=settings.low, high=settings.high)
    assert not verify(edges, falling(depth), settings, depth=depth, adds=adds).passed


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
