"""Masses, centres and inertias of bodies are those of their parts; what hangs is fixed."""

import dataclasses

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.export.simulation.houses import joined, named, objects, table
from tests.geometry.things import box
from wm.export.simulation.bodies import rigid_body
from wm.export.simulation.substances import LIGHTEST, OTHER, substance


def test_a_solid_box_weighs_and_turns_as_the_textbook_says():
    body = rigid_body(named(box((2, 3, 0), (2.2, 3.4, 0.6)), "block", slots=("wax",)))
    mass = 900 * 0.2 * 0.4 * 0.6
    assert body.mass == pytest.approx(mass)
    np.testing.assert_allclose(body.center, [0, 0, 0.3], atol=1e-12)
    textbook = mass / 12 * np.array([0.4**2 + 0.6**2, 0.2**2 + 0.6**2, 0.2**2 + 0.4**2])
    np.testing.assert_allclose(body.inertia, np.diag(textbook), atol=1e-8)


def test_thick_boards_are_hollow_and_thin_ones_are_not():
    board, chest = (named(box((0, 0, 0), size), "thing") for size in ((1, 1, 0.01), (1, 1, 1)))
    assert rigid_body(board).mass == pytest.approx(600 * 0.01)
    assert rigid_body(chest).mass == pytest.approx(600 * 6 * 0.018)


def test_inertia_of_two_parts_is_that_of_the_whole_they_make():
    halves = joined(box((0, 0, 0), (0.5, 1, 1)), box((0.5, 0, 0), (1, 1, 1)))
    two = rigid_body(dataclasses.replace(halves, slots=("wax", "wax"), T_world_object=np.eye(4)))
    one = rigid_body(dataclasses.replace(box((0, 0, 0), (1, 1, 1)), slots=("wax",), T_world_object=np.eye(4)))
    assert two.mass == pytest.approx(one.mass)
    np.testing.assert_allclose(two.center, one.center)
    np.testing.assert_allclose(two.inertia, one.inertia, atol=1e-8)


@given(st.integers(0, 1000))
def test_a_body_is_the_same_wherever_its_object_stands(seed):
    rng = np.random.default_rng(seed)
    angle = rng.uniform(-np.pi, np.pi)
    moved = np.eye(4)
    moved[:2, :2] = [[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]]
    moved[:3, 3] = rng.uniform(-20, 20, 3)
    thing = table()
    elsewhere = dataclasses.replace(
        thing, vertices=thing.vertices @ moved[:3, :3].T + moved[:3, 3], T_world_object=moved @ thing.T_world_object
    )
    here, there = rigid_body(thing), rigid_body(elsewhere)
    np.testing.assert_allclose([here.mass, *here.center], [there.mass, *there.center], atol=1e-9)
    np.testing.assert_allclose(here.inertia, there.inertia, atol=1e-9)
    np.testing.assert_allclose(here.vertices, there.vertices, atol=1e-9)


def test_what_stands_is_free_and_rugs_do_not_collide():
    bodies = [rigid_body(thing) for thing in objects()]
    assert [body.moves for body in bodies] == [True, True, False, False, False, True]
    assert [len(body.hulls) for body in bodies] == [5, 1, 1, 0, 1, 1]


def test_scale_in_a_pose_is_left_to_the_vertices():
    thing = named(box((0, 0, 0), (1, 1, 1)), "thing")
    stretched = dataclasses.replace(thing, T_world_object=thing.T_world_object @ np.diag([2.0, 3.0, -1.0, 1.0]))
    body = rigid_body(stretched)
    np.testing.assert_allclose(body.T_world_body[:3, :3].T @ body.T_world_body[:3, :3], np.eye(3), atol=1e-12)
    assert np.linalg.det(body.T_world_body[:3, :3]) == pytest.approx(1)
    back = body.vertices @ body.T_world_body[:3, :3].T + body.T_world_body[:3, 3]
    np.testing.assert_allclose(back, thing.vertices, atol=1e-12)


def test_open_and_flat_things_have_a_mass_too():
    thing = named(box((0, 0, 0), (1, 1, 1)), "sheet", slots=("unheard of",))
    sheet = dataclasses.replace(thing, faces=thing.faces[:2], face_slot=thing.face_slot[:2])
    body = rigid_body(sheet)
    assert body.open_parts == 1
    assert body.mass >= LIGHTEST
    assert np.linalg.eigvalsh(body.inertia).min() > 0


def test_materials_are_known_by_a_word_of_their_name_and_else_by_the_label():
    assert substance("dark_wood").density == 600
    assert substance("material 3", "marble bust") == substance("marble")
    assert substance("material 3", "thing") == OTHER
