"""Laws of the exact world: repeatable, whatever was asked before; legible; objects under their own light."""

import dataclasses

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.offline.world.boxes import COARSE, box, furnished
from wm.color import to_linear
from wm.geometry.mesh.scene_mesh import assemble_scene
from wm.geometry.rays.pinhole import make_camera
from wm.offline.world.world import World, surface_ids


def camera(width=48, height=32, eye=(0.4, 0.5, 1.5), target=(2.4, 2.0, 0.9)):
    return make_camera(np.array(eye), np.array(target), width=width, height=height, fov_deg=70.0)


@pytest.fixture(scope="module")
def world():
    return World(furnished(), settings=COARSE)


def test_image_is_finite_in_range_and_legible(world):
    shot = world.shoot(camera())
    assert shot.rgb.shape == (32, 48, 3)
    assert shot.rgb.dtype == np.float32
    assert np.isfinite(shot.rgb).all()
    assert shot.rgb.min() >= 0
    assert shot.rgb.max() <= 1
    assert 0.1 < shot.rgb.mean() < 0.8
    assert shot.rgb.std() > 0.05
    assert shot.gbuffer.hit.all()
    assert set(np.unique(shot.object)) >= {-1, 0}


def test_truth_does_not_depend_on_what_was_asked_before(world):
    into_bath = camera(eye=(4.0, 2.2, 1.6), target=(5.0, 1.0, 0.8))
    first = world.shoot(camera()).rgb
    fresh = World(furnished(), settings=COARSE)
    fresh.shoot(into_bath)
    np.testing.assert_array_equal(first, fresh.shoot(camera()).rgb)
    np.testing.assert_array_equal(first, world.shoot(camera()).rgb)


def test_a_room_without_window_or_lamp_is_legible(world):
    shot = world.shoot(camera(eye=(4.0, 2.2, 1.6), target=(5.0, 1.0, 0.8)))
    assert shot.rgb.mean() > 0.15


def test_lamps_glow(world):
    shot = world.shoot(camera(eye=(0.6, 0.6, 1.6), target=(1.9, 1.5, 1.8)))
    lamp = shot.object == 2
    assert lamp.any()
    assert shot.rgb[lamp].mean() > shot.rgb[~lamp].mean()


def test_lamp_shades_stay_below_burning_and_are_darker_at_their_edges(world):
    lamp = furnished().objects[2]
    middle = (lamp.vertices.min(axis=0) + lamp.vertices.max(axis=0)) / 2
    shot = world.shoot(make_camera(middle - np.array([0.0, 0.6, 0.0]), middle, width=64, height=64, fov_deg=40.0))
    shade = shot.object == 2
    rows = [shot.rgb[row][shade[row]].mean() for row in np.flatnonzero(shade.any(axis=1))]
    assert shot.rgb[shade].max() < 0.95
    assert rows[len(rows) // 2] > 1.05 * max(rows[0], rows[-1])


def test_mirrors_show_the_room():
    """What a mirror shows the middle of the room is what an eye at the mirror sees the way the ray is thrown back."""
    mirror = box("mirror", (1.0, 2.62, 0.9), (2.2, 2.7, 1.9), "mirror")
    context = dataclasses.replace(furnished(), objects=(*furnished().objects, mirror))
    world = World(context, settings=COARSE)
    eye = world.room(0).eye.astype(float)
    shot = world.shoot(make_camera(eye, np.array([1.6, 2.62, 1.4]), width=48, height=48, fov_deg=50.0))
    assert shot.rgb[shot.object == 3].std(axis=0).max() > 0.05
    for x, z in ((1.2, 1.2), (1.6, 1.5), (2.0, 1.3), (1.4, 1.7)):
        place = np.array([x, 2.62, z])
        thrown = (place - eye) * (1, -1, 1)
        shown = world.shoot(make_camera(eye, place, width=1, height=1, fov_deg=0.3)).rgb[0, 0]
        there = world.shoot(make_camera(place - (0, 0.002, 0), place + thrown, width=1, height=1, fov_deg=0.3)).rgb[0, 0]
        tint = to_linear(np.array([0.6, 0.3, 0.25], np.float32))  # the slot's own colour
        np.testing.assert_allclose(to_linear(shown), 0.95 * tint * to_linear(there), rtol=0.25, atol=0.02)


def test_two_cameras_agree_on_a_surface(world):
    """Appearance does not depend on the view: the same wall point has the same colour from two places, to the blur of a pixel."""
    target = np.array([1.0, 2.7, 1.9])
    a = world.shoot(camera(41, 31, (1.2, 0.6, 1.6), target)).rgb[15, 20]
    b = world.shoot(camera(41, 31, (0.8, 0.7, 1.5), target)).rgb[15, 20]
    np.testing.assert_allclose(a, b, atol=0.05)


def test_supersampling_only_touches_edges():
    plain = World(furnished(), settings=COARSE, supersampling=1).shoot(camera()).rgb
    fine = World(furnished(), settings=COARSE, supersampling=2).shoot(camera()).rgb
    changed = np.abs(plain - fine).max(axis=2) > 0
    assert 0 < changed.mean() < 0.6


@given(st.lists(st.integers(1, 200), max_size=4), st.integers(0, 2**32 - 1))
def test_a_surface_has_a_number_of_its_own(slots, seed):
    """However many slots a thing has: a large bookshelf has 146, and the thing after it has others."""
    rng, table = np.random.default_rng(seed), furnished().objects[0]
    objects = [
        dataclasses.replace(table, slots=("wood",) * count, face_slot=rng.choice([0, count - 1, count // 2], 12).astype(np.int32))
        for count in slots
    ]
    mesh = assemble_scene(furnished().structure, objects)
    structure = mesh.face_object < 0
    slot = np.concatenate([np.zeros(structure.sum(), int), *(thing.face_slot for thing in objects)])
    room, kind = (np.where(structure, labels, 0) for labels in (mesh.face_room, mesh.face_kind))
    _, meant = np.unique(np.stack([mesh.face_object, slot, room, kind]), axis=1, return_inverse=True)
    pairs = np.unique(np.stack([surface_ids(mesh, objects), meant.ravel()]), axis=1)
    assert len(np.unique(pairs[0])) == len(np.unique(pairs[1])) == pairs.shape[1]
    assert pairs[0].min() >= 0  # a miss is -1
