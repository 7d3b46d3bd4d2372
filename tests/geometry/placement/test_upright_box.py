"""Laws of upright boxes: overlap is symmetric, does not depend on the frame, and agrees with polygons."""

import dataclasses
import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.geometry.things import box
from wm.geometry.placement.upright import EXACT, flattened, levelled, moved_to, transformed, turn_between
from wm.geometry.placement.upright_box import UprightBox, box_iou, box_of, overlap_height, penetration

place = st.floats(-2, 2)
side = st.floats(0.05, 3)
boxes = st.builds(UprightBox, place, place, st.floats(0, 2), st.floats(-4, 4), side, side, side)


def rotation(axis, angle):
    """A rigid motion: a turn about an axis through the origin."""
    x, y, z = np.asarray(axis, float) / np.linalg.norm(axis)
    K = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    motion = np.eye(4)
    motion[:3, :3] += math.sin(angle) * K + (1 - math.cos(angle)) * K @ K
    return motion


@given(boxes, boxes)
def test_overlap_is_symmetric_and_bounded(a, b):
    assert box_iou(a, b) == pytest.approx(box_iou(b, a), abs=1e-9)
    assert 0.0 <= box_iou(a, b) <= 1.0 + 1e-9
    assert box_iou(a, a) == pytest.approx(1.0)
    assert penetration(a, [b])[0] == pytest.approx(penetration(b, [a])[0], abs=1e-9)
    assert overlap_height(a, [b])[0] == overlap_height(b, [a])[0]


@given(boxes, boxes)
def test_penetration_agrees_with_polygons(a, b):
    reach = penetration(a, [b])[0]
    if abs(reach) > 1e-6:
        assert (reach > 0) == (a.footprint.intersection(b.footprint).area > 0)
    if reach < 0:
        assert a.footprint.distance(b.footprint) >= -reach - 1e-9


@given(boxes, boxes, st.floats(-3, 3), place, place)
def test_overlap_does_not_depend_on_where_and_how_the_pair_lies(a, b, turn, x, y):
    def moved(c):
        cos, sin = math.cos(turn), math.sin(turn)
        return dataclasses.replace(c, x=x + cos * c.x - sin * c.y, y=y + sin * c.x + cos * c.y, yaw=c.yaw + turn)

    assert box_iou(moved(a), moved(b)) == pytest.approx(box_iou(a, b), abs=1e-7)


def test_no_others_no_overlap():
    assert penetration(UprightBox(0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0), []).shape == (0,)


@given(boxes)
def test_a_thing_moved_to_a_box_fills_it(target):
    thing = box((0, 0, 0), (1.0, 0.5, 2.0))
    after = box_of(moved_to(thing, target))
    at = [after.x - target.x, after.y - target.y, after.z - target.z, turn_between(after.yaw, target.yaw)]
    assert np.allclose(at, 0, atol=1e-9)
    assert np.allclose([after.width, after.depth, after.height], [1.0, 0.5, 2.0])
    assert moved_to(thing, box_of(thing)) is thing


@given(st.tuples(st.floats(-1, 1), st.floats(-1, 1)).filter(lambda a: abs(a[0]) + abs(a[1]) > 0.1), st.floats(0.001, 0.6), place)
def test_levelling_undoes_a_tilt(axis, angle, yaw):
    thing = transformed(box((0.2, 0.1, 0.0), (1.4, 0.6, 0.8)), rotation((0, 0, 1), yaw))
    level = levelled(transformed(thing, rotation((*axis, 0.0), angle)))
    assert level.T_world_object[2, 2] == pytest.approx(1.0)
    assert np.allclose(level.size, [1.2, 0.5, 0.8], atol=1e-6)
    assert np.allclose([getattr(box_of(level), side) for side in ("width", "depth", "height")], level.size, atol=1e-6)
    assert levelled(level) is level


def test_what_fell_over_stays_on_the_side_it_lies_on():
    lying = levelled(transformed(box((0, 0, 0), (0.4, 0.5, 1.8)), rotation((1, 0.02, 0), math.pi / 2)))
    assert lying.size[2] == pytest.approx(0.5, abs=1e-6)
    assert np.ptp(lying.vertices[:, 2]) == pytest.approx(0.5, abs=1e-6)


def test_what_stands_is_left_alone_to_the_bit():
    thing = transformed(box((0, 0, 0), (1, 1, 1)), rotation((1, 0, 0), EXACT / 10))
    assert levelled(thing) is thing


def test_flat_things_are_pressed_once():
    rug = flattened(box((0, 0, 0.5), (2, 1, 0.56)), 0.008)
    assert np.ptp(rug.vertices[:, 2]) == pytest.approx(0.008) and rug.vertices[:, 2].min() == 0.5
    assert flattened(rug, 0.008) is rug
