"""Laws of the video's walk: every room, free air, room to spare, bounded speed, and eyes on what there is to see."""

import functools

import numpy as np
import pytest
import shapely

from tests.geometry.cameras.test_views import SMALL, assert_free, case, furnished
from tests.geometry.plans import two_rooms
from tests.geometry.things import box
from wm.geometry.cameras.gaze import ENOUGH, HEADINGS, LOOKS, Panorama, looks, panorama, turns
from wm.geometry.cameras.walk import GLANCE, TURNING, WISH, walkthrough
from wm.geometry.mesh.scene_mesh import assemble_scene
from wm.geometry.mesh.structure import build_structure
from wm.geometry.placement.navigation import walkable_floor
from wm.geometry.plan.footprint import interior_polygon
from wm.geometry.plan.openings import portals
from wm.geometry.rays.pinhole import camera_center, camera_rotation
from wm.geometry.rays.raycast import build_ray_scene, cast, occluded
from wm.types import OUTSIDE

FPS, SPEED = 12, 1.4
ROOMS = ("one", "concave", "random", "furnished")


@functools.cache
def walk(name):
    plan, mesh, _, _ = case(name)
    return tuple(walkthrough(plan, mesh, SMALL, fps=FPS, speed=SPEED))


def eyes_of(cameras):
    return np.array([camera_center(camera) for camera in cameras])


@pytest.mark.parametrize("name", ROOMS)
def test_the_walk_visits_every_room_and_passes_through_nothing(name):
    plan, mesh, _, _ = case(name)
    eyes = eyes_of(walk(name))
    for index in range(len(plan.rooms)):
        assert shapely.contains_xy(interior_polygon(plan, index), *eyes[:, :2].T).any()
    assert shapely.contains_xy(interior_polygon(plan, 0), *eyes[0, :2])
    assert not occluded(build_ray_scene(mesh), eyes[:-1], np.diff(eyes, axis=0), 1.0).any()
    assert_free(mesh, eyes[::4], 0.2)


@pytest.mark.parametrize("name", ROOMS)
def test_the_walker_is_no_faster_than_told(name):
    cameras = walk(name)
    looks_ = np.array([camera_rotation(camera)[2] for camera in cameras])
    assert np.linalg.norm(np.diff(eyes_of(cameras), axis=0), axis=1).max(initial=0) < 1.01 * SPEED / FPS
    turns = np.degrees(np.arccos(np.clip(np.sum(looks_[1:] * looks_[:-1], axis=1), -1, 1)))
    assert turns.max(initial=0) < 1.01 * TURNING / FPS


@pytest.mark.parametrize("name", ["one", "concave", "furnished"])
def test_the_walker_keeps_clear_of_walls_and_goes_through_the_middle_of_doors(name):
    plan = case(name)[0]
    floor = walkable_floor(plan)
    doors = [portal for portal in portals(plan) if portal.kind != "window"]
    for eye in eyes_of(walk(name))[:, :2]:
        beside = [np.linalg.norm(eye - portal.ends.mean(axis=0)) for portal in doors]
        clear = shapely.distance(floor.boundary, shapely.Point(eye))
        nearest = doors[int(np.argmin(beside))] if doors else None
        if nearest is None or min(beside) > 1.0:
            assert clear > WISH - 0.05
        else:
            width = float(np.linalg.norm(nearest.ends[1] - nearest.ends[0]))
            assert clear > min(WISH, width / 2) - 0.1


def test_the_walker_looks_at_furniture_and_not_at_walls_from_near():
    _, mesh, _, _ = case("furnished")
    scene = build_ray_scene(mesh)
    near, seen = [], set()
    for camera in walk("furnished")[::3]:
        gbuffer = cast(scene, camera)
        near.append(((gbuffer.depth < 1.0) & gbuffer.hit).mean())
        things, pixels = np.unique(mesh.face_object[gbuffer.face], return_counts=True)
        seen |= set(things[pixels > 0.01 * gbuffer.hit.size].tolist())
    assert np.mean(np.array(near) < 1 / 3) > 0.9
    assert seen - {OUTSIDE} == set(range(len(furnished()[2])))


def test_an_empty_room_is_given_less_time_than_a_furnished_one():
    plan = two_rooms()
    things = [box([0.3 + x, 3.3, 0.0], [0.9 + x, 3.8, 1.0]) for x in (0.0, 1.2, 2.4)]
    things += [box([0.2, 0.3, 0.0], [0.8, 1.5, 1.5]), box([3.6, 0.2, 0.0], [4.6, 0.6, 1.2])]
    eyes = eyes_of(walkthrough(plan, assemble_scene(build_structure(plan), things), SMALL, fps=FPS, speed=SPEED))
    frames = [shapely.contains_xy(interior_polygon(plan, index), *eyes[:, :2].T).sum() for index in (0, 1)]
    assert frames[0] > 1.5 * frames[1] and frames[1] > GLANCE * FPS


def test_looks_show_all_that_stands_in_the_own_room():
    plan = two_rooms()
    things = [box([0.3, 1.2, 0.0], [0.9, 2.8, 1.8]), box([3.8, 2.8, 0.0], [4.8, 3.8, 1.8])]
    things.append(box([8.0, 1.6, 0.0], [8.8, 2.4, 1.4], room=1))
    scene = build_ray_scene(assemble_scene(build_structure(plan), things))
    view = panorama(scene, np.array([2.5, 1.6, 1.5]), 0, fov=np.radians(60))
    assert view.own.tolist() == [True, True, False, True, False, False]  # three things, both windows, the study
    headings = [round(heading * HEADINGS / (2 * np.pi)) for heading, _ in looks(view)]
    assert (view.shares[headings, :2].max(axis=0) > ENOUGH / 2).all()
    assert len(headings) == len(set(headings)) <= LOOKS


def test_a_turn_goes_round_what_is_near():
    shares, near = np.zeros((HEADINGS, 0)), np.zeros(HEADINGS)
    near[3:15] = 1.0  # between the headings 0 and 18: a wall
    view = Panorama(shares=shares, own=np.zeros(0, bool), near=near)
    (away, _), (back, worth) = turns(view, 0.0, [(np.pi / 2, 0.1)], 0.0)
    assert away == pytest.approx(-3 * np.pi / 2) and back == pytest.approx(3 * np.pi / 2) and worth is None
    clear = Panorama(shares=shares, own=np.zeros(0, bool), near=np.zeros(HEADINGS))
    assert turns(clear, 0.0, [(np.pi / 2, 0.1)], None) == [(pytest.approx(np.pi / 2), 0.1)]


def test_the_same_scene_gives_the_same_walk():
    plan, mesh, _, _ = case("furnished")
    again = walkthrough(plan, mesh, SMALL, fps=FPS, speed=SPEED)
    assert [c.T_cam_world.tobytes() for c in again] == [c.T_cam_world.tobytes() for c in walk("furnished")]


def test_a_room_that_cannot_be_walked_into_is_named():
    plan = two_rooms()
    block = box([5.1, 1.0, 0.0], [5.9, 3.0, 2.6], room=1)
    with pytest.raises(ValueError, match="no walk into study"):
        walkthrough(plan, assemble_scene(build_structure(plan), [block]), SMALL, fps=12, speed=1.4)
    with pytest.raises(ValueError, match="speed above 0"):
        walkthrough(plan, build_structure(plan), SMALL, fps=12, speed=0.0)
