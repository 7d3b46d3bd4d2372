"""The laws of placement, over rooms and things drawn at random: whatever comes in, what comes out is furniture in a room."""

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.geometry.placement.test_upright_box import rotation
from tests.geometry.things import box
from wm.geometry.placement.laws import broken_laws
from wm.geometry.placement.placing import place_objects
from wm.geometry.placement.upright import transformed
from wm.geometry.placement.upright_box import box_of
from wm.geometry.plan.site import make_site

LABELS = {
    "sofa": (2.0, 0.9, 0.8), "armchair": (0.8, 0.8, 0.9), "dining table": (1.6, 0.9, 0.75), "bookshelf": (1.2, 0.3, 2.0),
    "rug": (2.0, 1.4, 0.03), "picture": (0.7, 0.04, 0.5), "curtains": (1.6, 0.1, 1.9), "chandelier": (0.7, 0.7, 0.7),
    "vase": (0.2, 0.2, 0.3), "pile of books": (0.25, 0.3, 0.1), "large indoor plant": (0.6, 0.6, 1.3),
    "tv stand": (1.4, 0.4, 0.5), "wooden door": (0.9, 0.1, 2.0), "fern plant": (0.3, 0.3, 0.4), "gizmo": (0.3, 0.25, 0.35),
    "thin gizmo": (0.8, 0.05, 1.9), "low bench": (1.2, 0.5, 0.3),
}  # fmt: skip


unit = st.floats(0, 1)
rooms = st.tuples(unit, unit, unit, st.booleans(), st.booleans())
thing_places = st.lists(
    st.tuples(st.sampled_from(sorted(LABELS)), unit, unit, unit, st.floats(-3, 3), st.floats(-1, 1), unit), min_size=1, max_size=8
)


def site_of(wide, deep, high, notched, second):
    """A rectangle or an L with one or two doors and a window."""
    w, d = 2.6 + 3.4 * wide, 2.6 + 2.4 * deep
    polygon = shapely.box(0, 0, w, d)
    if notched:
        polygon = polygon.difference(shapely.box(0.65 * w, 0.6 * d, w + 1, d + 1))
    openings = [("door", np.array([[0.2, 0.0], [1.1, 0.0]]), 0.0, 2.1), ("window", np.array([[w, 0.3], [w, 1.5]]), 0.9, 2.1)]
    if second:
        openings.append(("passage", np.array([[0.0, d - 1.2], [0.0, d - 0.4]]), 0.0, 2.2))
    return make_site(polygon, 2.3 + 0.9 * high, openings)


def scattered(places, site):
    """Things anywhere in a site and a little beyond, somewhat tilted, some in walls and in each other."""
    x0, y0, x1, y1 = site.polygon.bounds
    things = []
    for label, x, y, z, yaw, across, tilt in places:
        size = np.array(LABELS[label])
        motion = rotation((0, 0, 1), yaw) @ rotation((1, across, 0), 0.2 * tilt)
        motion[:3, 3] = [x0 - 0.3 + x * (x1 - x0 + 0.6), y0 - 0.3 + y * (y1 - y0 + 0.6), 1.7 * z - 0.2]
        things.append(transformed(box(-size / 2 * [1, 1, 0], size / 2 * [1, 1, 2], label=label), motion))
    return things


@settings(max_examples=12)
@given(rooms, thing_places, st.integers(0, 1000))
def test_placed_rooms_obey_the_laws_and_stay_as_they_are(room, places, seed):
    site = site_of(*room)
    things = scattered(places, site)
    placement = place_objects(things, site)
    objects = list(placement.objects)
    assert broken_laws(objects, site) == []
    assert sorted([*placement.source, *(k for k, _ in placement.dropped)]) == list(range(len(things)))
    assert not any(thing.label == "wooden door" for thing in objects)

    again = place_objects(objects, site)
    assert again.dropped == ()
    for a, b in zip(objects, again.objects, strict=True):
        assert a.vertices.tobytes() == b.vertices.tobytes() and a.support == b.support
        assert a.T_world_object.tobytes() == b.T_world_object.tobytes()

    order = np.random.default_rng(seed).permutation(len(things)).tolist()
    other = place_objects([things[k] for k in order], site)
    # of two things that are the same to the bit, either may be the one for which there is room: they count as one source
    known = [(thing.label, thing.vertices.tobytes()) for thing in things]
    alike = [known.index(one) for one in known]
    found = sorted((alike[k], thing.vertices.tobytes()) for k, thing in zip(placement.source, objects))
    assert found == sorted((alike[order[k]], thing.vertices.tobytes()) for k, thing in zip(other.source, other.objects))


def square_room(*openings):
    return make_site(shapely.box(0, 0, 5, 4), 2.7, list(openings))


def centers(placement):
    return [box_of(thing).center for thing in placement.objects]


def test_two_that_overlap_keep_their_sides_and_go_towards_the_walls():
    site = square_room()
    left, right = box((0.4, 1.5, 0), (1.6, 2.5, 0.8), label="sofa"), box((1.3, 1.6, 0), (2.2, 2.4, 0.8), label="armchair")
    placed = place_objects([left, right], site)
    a, b = centers(placed)
    assert a[0] < b[0] and broken_laws(list(placed.objects), site) == []
    alone = place_objects([box((0.4, -0.3, 0), (1.6, 0.6, 0.8), label="sofa")], site)
    assert centers(alone)[0][1] == pytest.approx(0.45, abs=0.1)  # out of the wall, not across the room


def test_small_things_stand_on_what_is_below_and_only_where_it_carries():
    site = square_room()
    table = box((2, 1, 0), (3.2, 1.8, 0.75), label="dining table")
    vase = box((2.3, 1.3, 0.9), (2.5, 1.5, 1.2), label="vase")
    beside = box((3.3, 1.3, 0.7), (3.45, 1.45, 0.9), label="bowl")
    placed = place_objects([vase, table, beside], site)
    heights = [box_of(thing).z for thing in placed.objects]
    assert heights[0] == pytest.approx(0.754, abs=1e-3) and heights[2] == pytest.approx(0.754, abs=1e-3)
    far = place_objects([table, box((0.5, 3, 0.7), (0.7, 3.2, 0.9), label="vase")], site)
    assert box_of(far.objects[1]).z < 0.01


@pytest.mark.parametrize(("label", "low"), [("vase", 0.9), ("fern plant", 0.6), ("gizmo", 0.6)])
def test_what_finds_no_top_stands_on_the_floor_and_stays_there(label, low):
    """A low bench beside it is within reach of a thing on the floor, and was not of where it was first seen."""
    bench = box((1.2, 1.0, 0.0), (2.4, 1.6, 0.25), label="low bench")
    thing = box((0.9, 1.2, low), (1.1, 1.4, low + 0.3), label=label)
    placed = place_objects([bench, thing], square_room())
    assert [thing.support for thing in placed.objects] == ["floor", "floor"]
    again = place_objects(list(placed.objects), square_room())
    assert [thing.support for thing in again.objects] == ["floor", "floor"]
    np.testing.assert_array_equal(again.objects[1].vertices, placed.objects[1].vertices)


def test_what_no_word_tells_stays_on_a_low_bench():
    bench = box((1.2, 1.0, 0.0), (2.4, 1.6, 0.3), label="low bench")
    placed = place_objects([bench, box((1.5, 1.2, 0.4), (1.8, 1.4, 0.7), label="gizmo")], square_room())
    again = place_objects(list(placed.objects), square_room())
    assert [thing.support for thing in placed.objects] == [thing.support for thing in again.objects] == ["floor", "object"]
    np.testing.assert_array_equal(again.objects[1].vertices, placed.objects[1].vertices)


def test_pictures_hang_on_the_nearest_wall_and_off_its_openings():
    window = ("window", np.array([[1.0, 0.0], [3.0, 0.0]]), 0.9, 2.1)
    site = square_room(window)
    picture = transformed(box((-0.35, -0.02, 0), (0.35, 0.02, 0.5), label="picture"), rotation((0, 0, 1), 0.2))
    motion = np.eye(4)
    motion[:3, 3] = [2.7, 0.25, 1.4]
    hung = place_objects([transformed(picture, motion)], site).objects[0]
    assert hung.vertices[:, 1].min() == pytest.approx(0.005) and hung.vertices[:, 0].min() >= 3.0
    curtain = box((0.9, 0.1, 0.3), (3.1, 0.2, 2.3), label="curtains")
    assert box_of(place_objects([curtain], site).objects[0]).x == pytest.approx(2.0, abs=0.01)


def test_doors_stay_passable_and_what_shuts_them_is_left_out_with_a_reason():
    door = ("door", np.array([[2.0, 0.0], [2.9, 0.0]]), 0.0, 2.1)
    site = make_site(shapely.box(0, 0, 5, 1.2), 2.7, [door, ("door", np.array([[0.0, 0.1], [0.0, 1.0]]), 0.0, 2.1)])
    placed = place_objects([box((1.0, 0.1, 0), (1.9, 1.1, 0.9), label="armchair")], site)
    assert broken_laws(list(placed.objects), site) == []
    blocked = place_objects([box((0.9, 0.02, 0), (1.3, 1.18, 2.0), label="bookshelf")], make_site(
        shapely.box(0, 0, 2.2, 1.2), 2.7, [door, ("door", np.array([[0.0, 0.1], [0.0, 1.0]]), 0.0, 2.1)]
    ))  # fmt: skip
    assert blocked.objects == () and blocked.dropped == ((0, "no free place within reach"),)


def test_an_empty_list_is_an_empty_room():
    placed = place_objects([], square_room())
    assert placed.objects == () and placed.dropped == ()
