"""Words for doors and windows are true: of what is in the image, on the side where it is, and not behind a corner."""

import math

import numpy as np
import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st

from tests.geometry.plans import two_rooms
from wm.geometry.plan.site import make_site, room_site
from wm.geometry.rays.pinhole import make_camera
from wm.synth.sights import sights

ANGLE = st.floats(-math.pi, math.pi)


def looking(eye, yaw, pitch=0.0, fov=60.0, width=160, height=120):
    way = np.array([math.cos(yaw) * math.cos(pitch), math.sin(yaw) * math.cos(pitch), math.sin(pitch)])
    return make_camera(np.array(eye), np.array(eye) + way, width=width, height=height, fov_deg=fov)


def site(corners, *openings):
    return make_site(shapely.Polygon(corners), 2.6, [(kind, np.array(ends, float), *span) for kind, ends, span in openings])


DOOR = ("door", [[4, 1.8], [4, 2.2]], (0.0, 2.1))  # straight east of the camera
SQUARE = site([(0, 0), (4, 0), (4, 4), (0, 4)], DOOR)
L_SHAPED = site([(0, 0), (6, 0), (6, 2), (2, 2), (2, 6), (0, 6)], ("window", [[6, 0.5], [6, 1.5]], (1.0, 2.0)))


@given(ANGLE)
def test_a_door_is_said_to_be_where_it_is(yaw):
    said = sights(looking([1.0, 2.0, 1.5], yaw), SQUARE)
    off = abs(yaw)  # the door is two hands wide, three metres away
    across = math.atan(math.tan(math.radians(30)) * 160 / 120)
    if off < across - 0.1:
        assert len(said) == 1 and said[0].startswith("a doorway")
    if off > across + 0.1:
        assert said == []
    if 0.5 < off < across - 0.1:
        assert said == ["a doorway on the right" if yaw > 0 else "a doorway on the left"]
    if off < 0.2:
        assert said == ["a doorway straight ahead"]


@pytest.mark.parametrize(("pitch", "said"), [(0.0, 1), (1.4, 0), (-1.4, 0)])
def test_a_camera_that_looks_up_or_down_past_it_does_not_show_it(pitch, said):
    assert len(sights(looking([1.0, 2.0, 1.5], 0.0, pitch), SQUARE)) == said


def test_what_is_around_the_corner_is_not_said():
    east = looking([1.0, 1.0, 1.5], 0.0)
    assert sights(east, L_SHAPED) == ["a window straight ahead"]
    behind = looking([1.0, 5.0, 1.5], -0.65)  # the same way, over the inner corner
    assert sights(behind, L_SHAPED) == []


def test_a_camera_in_the_next_room_looks_in_through_the_doorway():
    """It sees the room's own openings from outside its polygon."""
    room = room_site(two_rooms(), 1)
    through = looking([4.6, 2.0, 1.6], 0.0, fov=90.0)
    assert not shapely.contains_xy(room.polygon, 4.6, 2.0)
    assert sights(through, room)
