"""Solids are closed, wound outward, and as large as they say."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from wm.offline.furniture import outlines
from wm.offline.furniture.solids import ball, box, extrude, lathe, puff, rod, rounded_box, shell, stretch, tube, turn, volume

sizes = st.floats(0.02, 3.0)


def edges_met_twice(solid) -> bool:
    """Every edge is shared by two faces that run along it in opposite directions."""
    f = solid.faces
    directed = np.concatenate([f[:, [0, 1]], f[:, [1, 2]], f[:, [2, 0]]])
    pairs, counts = np.unique(directed, axis=0, return_counts=True)
    there = {tuple(p) for p in pairs.tolist()}
    return bool((counts == 1).all()) and all((b, a) in there for a, b in there)


SOLIDS = {
    "box": box((0, 0, 0), (1, 2, 3), 0.1),
    "plain box": box((0, 0, 0), (1, 2, 3), 0.0),
    "rounded box": rounded_box((0, 0, 0), (1, 2, 3), 0.2),
    "puff": puff((0, 0, 0), (1, 1, 0.3)),
    "lathe": lathe([(0.2, 0.0), (0.5, 0.4), (0.1, 0.9)], smooth=2),
    "shell": shell([(0.5, 0.0), (0.3, 0.4)], 0.01),
    "tube": tube([(0, 0, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1)], [0.1, 0.05, 0.05, 0.1], smooth=3),
    "rod": rod((0, 0, 0), (1, 1, 1), 0.05),
    "ball": ball((1, 2, 3), 0.5),
    "frame": extrude(outlines.frame(outlines.arch("pointed", 1.0, 2.0), 0.1), 0.0, 0.1),
    "prism along x": extrude(outlines.arch("wave", 1.0, 2.0), 0.0, 0.1, "x"),
    "prism along z": extrude(outlines.circle(0.5), 0.0, 0.1, "z"),
    "mirrored": stretch(lathe([(0.2, 0.0), (0.5, 1.0)]), (-1.0, 1.0, 2.0)),
}


@pytest.mark.parametrize("name", SOLIDS)
def test_solids_are_closed_and_wound_outward(name):
    assert edges_met_twice(SOLIDS[name]) and volume(SOLIDS[name]) > 0


@settings(deadline=None, max_examples=25)
@given(sizes, sizes, sizes, st.floats(0.0, 0.2))
def test_boxes_fill_their_corners(w, d, h, bevel):
    for solid in (
        box((0, 0, 0), (w, d, h), bevel),
        rounded_box((0, 0, 0), (w, d, h), max(bevel, 1e-3)),
        puff((0, 0, 0), (w, d, h)),
    ):
        assert np.allclose(solid.vertices.min(0), 0, atol=1e-12) and np.allclose(solid.vertices.max(0), [w, d, h])
        assert 0 < volume(solid) <= w * d * h * (1 + 1e-12)


def test_volumes():
    assert volume(box((0, 0, 0), (1, 2, 3), 0.0)) == pytest.approx(6.0)
    assert volume(lathe([(0.5, 0.0), (0.5, 2.0)], 256)) == pytest.approx(math.pi * 0.25 * 2, rel=1e-3)
    assert volume(ball((0, 0, 0), 1.0, 96)) == pytest.approx(4 / 3 * math.pi, rel=3e-3)
    arch = outlines.arch("round", 1.0, 2.0)
    assert volume(extrude(arch, 0.0, 0.3)) == pytest.approx(0.3 * arch.area)


def test_turning_keeps_volume_and_turns_counter_clockwise():
    solid = turn(box((1, 0, 0), (2, 1, 1)), "z", 90)
    assert volume(solid) == pytest.approx(volume(box((1, 0, 0), (2, 1, 1))))
    assert np.allclose(solid.vertices.min(0), [-1, 1, 0])


def test_an_outline_in_two_parts_is_refused():
    with pytest.raises(ValueError, match="one polygon"):
        extrude(outlines.rectangle(1, 1).union(outlines.rectangle(1, 1, at=(3, 0))), 0.0, 1.0)
