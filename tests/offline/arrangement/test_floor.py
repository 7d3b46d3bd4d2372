"""Laws of the floor that furnishing leaves: what is passable and what is closed off; neither depends on where a grid lies."""

import numpy as np
import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st

from wm.geometry.placement.clearances import BODY
from wm.geometry.plan.site import make_site
from wm.offline.arrangement.floor import HALF_CELL, WAY, BareFloor


def bare(width=5.0, depth=4.0, *, at=(0.0, 0.0)):
    """A room with a door in its front wall near the left corner, its own corner at a point."""
    x, y = at
    door = ("door", np.array([[x + 0.5, y], [x + 1.4, y]]), 0.0, 2.1)
    return BareFloor(make_site(shapely.box(x, y, x + width, y + depth), 2.7, [door]))


def furnished(room, *footprints):
    floor = room.floor
    for footprint in footprints:
        floor = room.with_piece(floor, footprint)
    return floor


@given(st.floats(0.3, 6.0), st.floats(0.3, 6.0))
def test_a_bare_room_is_passable_if_one_can_stand_in_it(width, depth):
    room = bare(width, depth)
    assert room.passable(room.floor) == bool(room.floor.standing.any())


@pytest.mark.parametrize("gap", [0.3, 0.5, 0.62])
def test_a_row_of_cupboards_with_a_narrow_gap_closes_off_what_lies_behind(gap):
    room = bare()
    floor = furnished(room, shapely.box(2.5, 0.01, 3.0, 3.99 - gap))
    assert not room.passable(floor)
    behind = (2.0 - 2 * BODY) * (4.0 - 2 * BODY)
    assert behind - 0.1 < floor.closed_off() < behind + 2 * HALF_CELL * 2 * (2.0 + 4.0)


def test_a_gap_that_a_person_walks_through_closes_off_nothing():
    room = bare()
    floor = furnished(room, shapely.box(2.5, 0.01, 3.0, 3.99 - 0.9))
    assert room.passable(floor) and floor.closed_off() < 0.1


@given(st.floats(0.02, 0.12))
def test_a_strip_between_two_pieces_counts_however_thin_it_is(width):
    """Two sofas face each other, something stands at either end: on an unlucky grid there is a row of cells in between."""
    y = 2.3 + 2 * BODY + width
    sofas = (shapely.box(2.5, 1.5, 5.0, 2.3), shapely.box(2.5, y, 5.0, y + 0.8))
    ends = (shapely.box(2.0, 2.1, 2.45, y + 0.2), shapely.box(5.05, 2.1, 5.5, y + 0.2))
    row = (5.05 - 2.45 - 2 * BODY + 2 * HALF_CELL) * (width + 2 * HALF_CELL)
    assert row * (1 - 1e-6) < furnished(bare(7.5, 5.5), *sofas, *ends).closed_off() < row + 0.02


@given(st.floats(-3, 3), st.floats(-3, 3), st.floats(0.3, 3.4), st.floats(0.3, 2.4))
def test_what_is_closed_off_does_not_depend_on_where_the_room_lies(dx, dy, x, y):
    here, there = bare(), bare(at=(dx, dy))
    a = furnished(here, shapely.box(x, y, x + 1.2, y + 1.2)).closed_off()
    b = furnished(there, shapely.box(x + dx, y + dy, x + dx + 1.2, y + dy + 1.2)).closed_off()
    assert a == pytest.approx(b, abs=1e-6)


@given(st.floats(0.3, 3.4), st.floats(0.3, 2.4))
def test_one_more_piece_leaves_less(x, y):
    room = bare()
    footprint = shapely.box(x, y, x + 0.9, y + 0.6)
    floor = room.with_piece(room.floor, footprint)
    assert not (floor.open & ~room.floor.open).any() and not (floor.standing & ~room.floor.standing).any()
    assert floor.ways.distance(footprint) > WAY - 0.01 and floor.places.distance(footprint) > BODY - 0.01
