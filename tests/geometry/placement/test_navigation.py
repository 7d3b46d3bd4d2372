"""Laws of the occupancy grid: open houses hang together, blocked doors divide them, and nothing depends on the grid's phase."""

import dataclasses

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.geometry.plans import l_shaped, one_room, opening, random_plan, rectangle, two_rooms
from tests.geometry.things import box
from wm.geometry.placement.navigation import navigability, object_corners, outlines, walkable_floor
from wm.geometry.plan.footprint import interior_polygon
from wm.geometry.plan.records import FloorPlan, Opening, Room
from wm.schema import NavigationSettings


def turned(plan, angle, shift=(0.0, 0.0)):
    r = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    rooms = []
    for room in plan.rooms:
        holes = tuple(dataclasses.replace(hole, segment=hole.segment @ r.T + shift) for hole in room.openings)
        rooms.append(dataclasses.replace(room, polygon=room.polygon @ r.T + shift, openings=holes))
    return FloorPlan(tuple(rooms), plan.wall_thickness, plan.default_ceiling_height)


def without_doors(plan):
    windows = (tuple(hole for hole in room.openings if hole.kind == "window") for room in plan.rooms)
    return FloorPlan(tuple(dataclasses.replace(room, openings=holes) for room, holes in zip(plan.rooms, windows)))


@pytest.mark.parametrize("plan", [one_room(), two_rooms(), l_shaped(), random_plan(4, 8)], ids=["one", "two", "l", "random"])
def test_an_empty_open_house_is_navigable_throughout(plan):
    result = navigability(plan, [])
    assert result.share == 1.0 and result.share_body == 1.0


@settings(max_examples=12, deadline=None)
@given(st.floats(0.0, np.pi / 2), st.floats(0.0, 0.15), st.floats(0.0, 0.15))
def test_doors_stay_open_however_the_grid_falls(angle, x, y):
    result = navigability(turned(two_rooms(), angle, (x, y)), [])
    assert result.share == 1.0 and result.share_body == 1.0


@settings(max_examples=25, deadline=None)
@given(st.floats(0.3, 0.8), st.floats(0.4, 2.6), st.floats(0.0, np.pi))
def test_whether_a_body_passes_a_door_depends_on_its_width_alone(width, position, angle):
    rooms = (rectangle("hall", 0, 0, 3, 4, opening("door", (3, 0), (3, 4), position, width)), rectangle("store", 3, 0, 6, 4))
    share = navigability(turned(FloorPlan(rooms), angle), []).share_body
    assert share == 1.0 if width >= 0.5 else share < 0.6


def test_a_shut_house_is_as_navigable_as_its_largest_room():
    plan = without_doors(two_rooms())
    result = navigability(plan, [])
    areas = [interior_polygon(plan, index).area for index in (0, 1)]
    assert result.share == pytest.approx(areas[0] / sum(areas), abs=0.01)
    assert result.component.max() == 2


def test_a_blocked_door_lowers_the_share_and_a_narrowed_one_only_the_bodys():
    plan = two_rooms()
    blocked = navigability(plan, [box([4.5, 1.0, 0.0], [4.95, 3.0, 1.0])])
    assert 0.5 < blocked.share < 0.65
    narrowed = navigability(plan, [box([4.5, 1.0, 0.0], [4.95, 2.05, 1.0])])
    assert narrowed.share == 1.0 and 0.5 < narrowed.share_body < 0.65


@pytest.mark.parametrize(
    ("thing", "counts"),
    [
        (box([1.0, 1.0, 0.0], [3.0, 3.0, 0.02]), False),  # a rug
        (box([1.0, 1.0, 2.0], [3.0, 3.0, 2.5]), False),  # above one's head
        (box([1.0, 1.0, 0.0], [3.0, 3.0, 0.5]), True),
        (dataclasses.replace(box([1.0, 1.0, 0.0], [3.0, 3.0, 1.0]), support="wall"), False),
        (dataclasses.replace(box([1.0, 1.0, 0.5], [3.0, 3.0, 1.0]), support="object"), True),
        (dataclasses.replace(box([1.0, 1.0, 0.0], [3.0, 3.0, 0.5]), support="flat"), False),
    ],
)
def test_what_stands_in_the_way(thing, counts):
    empty, full = navigability(one_room(), []), navigability(one_room(), [thing])
    assert (full.free.sum() < empty.free.sum()) == counts
    if counts:
        assert (empty.free.sum() - full.free.sum()) * full.cell**2 == pytest.approx(4.0, rel=0.1)


def flared(foot: float, side: float, height: float, angle: float) -> np.ndarray:
    """The triangles of a pyramid upside down, its tip cut off: a square foot, and a wider square above."""
    thing = box([-0.5, -0.5, 0.0], [0.5, 0.5, height])
    vertices = thing.vertices.copy()
    vertices[:, :2] *= np.where(vertices[:, 2:] > 0, side, foot)
    r = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    vertices[:, :2] = vertices[:, :2] @ r.T
    return vertices[thing.faces]


@given(st.floats(0.05, 0.5), st.floats(0.6, 3.0), st.floats(0.3, 3.0), st.floats(0.0, 3.0), st.floats(0.2, 2.9))
def test_what_widens_upwards_is_cut_at_the_height(foot, side, height, angle, high):
    corners = flared(foot, side, height, angle)
    width = foot + (side - foot) * min(high / height, 1.0)
    assert outlines([corners], 0.1, high).area == pytest.approx(width**2 if height > 0.1 else 0.0, rel=1e-6)


@given(st.integers(0, 2**32 - 1), st.floats(-0.5, 1.5))
def test_outlines_do_not_depend_on_the_triangles(seed, high):
    corners = np.random.default_rng(seed).uniform(0, 1, (6, 3, 3))
    a, b, c = np.moveaxis(corners, 1, 0)
    ab, bc, ca = (a + b) / 2, (b + c) / 2, (c + a) / 2
    finer = np.concatenate([np.stack(t, axis=1) for t in ((a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca))])
    coarse, fine = outlines([corners], 0.0, high), outlines([finer], 0.0, high)
    assert coarse.area == pytest.approx(fine.area, abs=1e-9) and outlines([finer], 0.0, 2.0).area >= fine.area - 1e-12


def test_windows_are_no_way_out():
    plan = two_rooms()
    areas = sum(interior_polygon(plan, index).area for index in (0, 1))
    assert walkable_floor(plan).area == pytest.approx(areas + 0.9 * 0.15, abs=1e-6)


def test_the_grid_is_labelled_by_size_and_placed_in_the_world():
    result = navigability(two_rooms(), [box([4.5, 0.5, 0.0], [4.95, 3.5, 1.0])])
    assert result.component.shape == result.free.shape and ((result.component > 0) == result.free).all()
    sizes = np.bincount(result.component.reshape(-1))[1:]
    assert (np.diff(sizes) <= 0).all() and result.share == sizes[0] / sizes.sum()
    j, i = np.argwhere(result.component == 2)[0]
    x, y = result.origin + result.cell * (np.array([i, j]) + 0.5)
    assert x > 4.9 and 0 < y < 4  # the study and its door


def test_a_full_house_has_no_free_cell():
    result = navigability(one_room(), [box([0, 0, 0], [5, 4, 1])])
    assert result.share == 0.0 and result.share_body == 0.0 and not result.free.any()


def test_the_cell_size_is_a_setting():
    coarse, fine = (navigability(two_rooms(), [], NavigationSettings(cell=cell)) for cell in (0.15, 0.05))
    assert fine.free.sum() * 0.05**2 == pytest.approx(walkable_floor(two_rooms()).area, rel=0.01)
    assert coarse.cell == 0.15 and coarse.share == fine.share == 1.0


def test_objects_are_found_in_a_mesh():
    from wm.geometry.mesh.scene_mesh import assemble_scene
    from wm.geometry.mesh.structure import build_structure

    things = [box([1, 1, 0], [2, 2, 1]), box([3, 1, 0], [4, 2, 2])]
    mesh = assemble_scene(build_structure(one_room()), things)
    for corners, thing in zip(object_corners(mesh), things, strict=True):
        np.testing.assert_allclose(corners, thing.vertices[thing.faces])
    assert object_corners(build_structure(one_room())) == []


def test_a_door_in_a_slanted_wall_is_open():
    left = Room("left", "Left", np.array([[0, 0], [5, 0], [3, 4], [0, 4]], float), 2.8, ())
    door = opening("door", (5, 0), (3, 4), 1.7)
    right = Room("right", "Right", np.array([[5, 0], [8, 0], [8, 4], [3, 4]], float), 2.8, (Opening(**vars(door)),))
    result = navigability(FloorPlan((left, right)), [])
    assert result.share == 1.0 and result.share_body == 1.0
