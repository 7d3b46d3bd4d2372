"""Laws of the offline image model: truth without drift, tone kept where it is shown, drift where it is invented, same bytes."""

import dataclasses

import numpy as np
import pytest

from tests.synth.procedural.boxes import COARSE, furnished
from wm.geometry.camera import make_camera
from wm.schema import ImageConfig
from wm.synth.backends import Condition, ImageRequest, make_backend
from wm.synth.image.procedural import ProceduralImages, lowpass
from wm.synth.procedural.world import World
from wm.types import OUTSIDE, View

VIEW = View(
    make_camera(np.array([0.4, 0.5, 1.5]), np.array([2.4, 2.0, 0.9]), width=72, height=48, fov_deg=70.0),
    0,
    "perimeter",
    "living/p0",
)


@pytest.fixture(scope="module")
def world():
    return World(furnished(), settings=COARSE)


@pytest.fixture(scope="module")
def shot(world):
    return world.shoot(VIEW.camera)


def request(shot, *, rgb=None, known=0.0, depth=None, seed=3):
    condition = Condition(
        rgb=np.zeros_like(shot.rgb) if rgb is None else rgb,
        known=np.full(shot.rgb.shape[:2], known, np.float32),
        depth=shot.gbuffer.depth if depth is None else depth,
    )
    return ImageRequest(condition=condition, reference=None, prompt="", view=VIEW, seed=seed)


def model(world, drift):
    return ProceduralImages(world=world, config=ImageConfig(drift=drift))


def test_without_drift_it_is_the_truth(world, shot):
    exact = model(world, 0.0)
    truth = exact.truth(VIEW)
    np.testing.assert_array_equal(truth, shot.rgb)
    np.testing.assert_array_equal(exact.generate(request(shot)).rgb, truth)
    np.testing.assert_allclose(exact.generate(request(shot, rgb=truth, known=1.0)).rgb, truth, atol=1e-5)
    np.testing.assert_array_equal(exact.generate(request(shot)).drawn_depth, shot.gbuffer.depth)


def test_drift_is_seeded_moderate_and_a_view_s_own(world, shot):
    drifting = model(world, 0.05)
    a, again, b = (drifting.generate(request(shot, seed=s)).rgb for s in (1, 1, 2))
    np.testing.assert_array_equal(a, again)
    assert np.abs(a - b).mean() > 1e-3
    assert np.abs(a - shot.rgb).mean() < 0.1


def test_shown_tone_is_kept(world, shot):
    """Low-passed output equals low-passed condition where it is known, to what a second low pass changes."""
    shown = np.clip(shot.rgb * np.array([1.15, 0.95, 0.85], np.float32), 0, 1)
    out = model(world, 0.05).generate(request(shot, rgb=shown, known=1.0)).rgb
    structure = (shot.object == OUTSIDE).astype(np.float32)
    error = np.abs(lowpass(out, structure) - lowpass(shown, structure))[structure > 0]
    untouched = np.abs(lowpass(shot.rgb, structure) - lowpass(shown, structure))[structure > 0]
    assert error.mean() < 0.25 * untouched.mean()


def test_detail_is_restored_under_a_blurred_condition(world, shot):
    structure = (shot.object == OUTSIDE).astype(np.float32)
    blurred = lowpass(shot.rgb, structure)
    out = model(world, 0.0).generate(request(shot, rgb=blurred, known=1.0)).rgb
    inside = structure > 0
    assert np.abs(out - shot.rgb)[inside].mean() < 0.7 * np.abs(blurred - shot.rgb)[inside].mean()


def test_objects_that_are_not_shown_are_invented_more_strongly(world, shot):
    drifting = model(world, 0.03)
    empty = np.where(shot.object == OUTSIDE, shot.gbuffer.depth, shot.gbuffer.depth * 1.5).astype(np.float32)
    invented = np.stack([drifting.generate(request(shot, depth=empty, seed=s)).rgb for s in range(6)])
    shown = np.stack([drifting.generate(request(shot, seed=s)).rgb for s in range(6)])
    objects = shot.object != OUTSIDE
    assert invented.std(axis=0)[objects].mean() > 3 * shown.std(axis=0)[objects].mean()
    np.testing.assert_array_equal(shown[0][objects], shot.rgb[objects])


def test_a_condition_of_another_size_is_refused(world, shot):
    small = request(shot)
    wrong = dataclasses.replace(small, condition=dataclasses.replace(small.condition, known=np.zeros((5, 5), np.float32)))
    with pytest.raises(ValueError, match="asks for"):
        model(world, 0.0).generate(wrong)


def test_the_registry_finds_it():
    backend = make_backend("image", ImageConfig(), furnished())
    assert isinstance(backend, ProceduralImages)


@pytest.mark.parametrize("size", [0.0, -0.01, float("nan")])
def test_a_texel_size_that_is_no_length_is_named(size):
    with pytest.raises(ValueError, match=r"image\.texel_size"):
        make_backend("image", ImageConfig(texel_size=size), furnished())
