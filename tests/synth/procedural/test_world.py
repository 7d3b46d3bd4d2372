"""Laws of the exact world: repeatable, whatever was asked before; legible; objects under their own light."""

import numpy as np
import pytest

from tests.synth.procedural.boxes import COARSE, furnished
from wm.geometry.camera import make_camera
from wm.synth.procedural.world import World


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
