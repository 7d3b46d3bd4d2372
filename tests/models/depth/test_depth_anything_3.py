"""Depth from a worker that is a real process: at the size of the image, in metres where the model says how, and its faults."""

import contextlib
import pathlib

import numpy as np
import pytest

from tests.models.worker.scripts import PYTHON, script
from wm.geometry.rays.pinhole import make_camera
from wm.models.depth.depth_anything_3 import Settings, WorkerDepth, at_camera
from wm.services.faults import ServiceError
from wm.services.retries import RetryPolicy
from wm.services.services import Services
from wm.services.store import AnswerStore
from wm.synth.backends import ClosableBackend, DepthBackend, ImageResult, ServedBackend
from wm.synth.registry import make_backend

QUICK = RetryPolicy(first=0.01, longest=0.01)
CAMERA = make_camera(np.array([0.5, 2.0, 1.6]), np.array([3.0, 2.0, 1.1]), width=60, height=40, fov_deg=70.0)
MODEL = """
    '''Depth that falls with the brightness of every second pixel; what else it answers, the red channel says.'''
    import numpy as np

    def describe(options):
        return {"model": options["checkpoint"], "version": "1"}

    def load(options):
        return options

    def answer(model, request, arrays):
        depth = 2.0 - arrays["rgb"][::2, ::2, 1].astype(np.float32) / 255
        fault = {10: np.nan * depth, 20: depth[None], 30: np.ones(depth.shape, int), 40: np.where(depth > 1.5, np.nan, depth)}
        red = int(arrays["rgb"][0, 0, 0])
        if red == 50:
            return {"refused": "all black"}
        if red == 60:
            return {"distance": depth}
        if red == 80:
            import os
            os._exit(4)
        result = {"depth": fault.get(red, depth)}
        return {**result, "focal_of_unit": 300.0} if model.get("metric") else result
"""


@pytest.fixture(scope="module")
def path(tmp_path_factory) -> pathlib.Path:
    return script(tmp_path_factory.mktemp("depth"), MODEL)


def backend(path: pathlib.Path, services: Services | None = None, **settings) -> WorkerDepth:
    config = Settings(python=PYTHON, script=str(path), checkpoint="da3", start_seconds=60.0, request_seconds=60.0, **settings)
    return make_backend("depth", config, None, services or Services(retries=QUICK))


@pytest.fixture(scope="module")
def model(path):
    with contextlib.closing(backend(path)) as found:
        yield found


def picture(red: int = 0) -> ImageResult:
    """An image that grows brighter in green from left to right; `red` tells the model what to answer."""
    rgb = np.zeros((40, 60, 3), np.float32)
    rgb[..., 0] = red / 255
    rgb[..., 1] = np.linspace(0, 1, 60)
    return ImageResult(rgb=rgb)


def test_depth_has_the_size_of_the_image(model):
    assert isinstance(model, DepthBackend) and isinstance(model, ServedBackend) and isinstance(model, ClosableBackend)
    depth = model.estimate(picture(), camera=CAMERA, seed=0)
    assert depth.shape == (40, 60) and depth.dtype == np.float32
    np.testing.assert_allclose(
        depth[:, 1:-1], np.broadcast_to(2 - np.linspace(0, 1, 60) + 0.5 / 59, (40, 60))[:, 1:-1], atol=0.01
    )
    assert model.quote().usd == 0


def test_a_metric_model_is_scaled_by_the_focal_length_in_pixels_of_its_output(path, model):
    relative = model.estimate(picture(), camera=CAMERA, seed=0)
    with contextlib.closing(backend(path, options="metric=true")) as metric:
        metres = metric.estimate(picture(), camera=CAMERA, seed=0)
    focal_of_output = CAMERA.focal[0] / 2  # it answers with half as many pixels
    np.testing.assert_allclose(metres, relative * focal_of_output / 300, rtol=1e-6)


@pytest.mark.parametrize("red", [10, 50], ids=["NaN", "a refusal"])
def test_an_answer_without_a_number_is_no_estimate(model, red):
    assert model.estimate(picture(red), camera=CAMERA, seed=0) is None


def test_pixels_without_depth_stay_without(model):
    depth = model.estimate(picture(40), camera=CAMERA, seed=0)
    assert np.isnan(depth[:, :24]).all() and np.isfinite(depth[:, 34:]).all()


@pytest.mark.parametrize(
    ("red", "said"),
    [
        (20, r"float32 of shape \(1, 20, 30\)"),
        (30, r"int64 of shape \(20, 30\)"),
        (60, "nothing of that name"),
        (80, "3 times in succ"),
    ],
    ids=["a batch", "whole numbers", "another name", "dies"],
)
def test_what_is_no_depth_map_is_one_clear_error(model, red, said):
    with pytest.raises(ServiceError, match=said):
        model.estimate(picture(red), camera=CAMERA, seed=0)


def test_a_kept_answer_needs_no_interpreter(path, tmp_path):
    store = AnswerStore(tmp_path / "answers")
    with contextlib.closing(backend(path, Services(store=store, retries=QUICK))) as first:
        depth = first.estimate(picture(), camera=CAMERA, seed=0)
    named = Settings(python="/not/here", script=str(path), checkpoint="da3", serves="da3 1")
    again = make_backend("depth", named, None, Services(store=store, replay="only"))
    np.testing.assert_array_equal(again.estimate(picture(), camera=CAMERA, seed=9), depth)


def test_the_script_that_is_shipped_names_the_package_it_lacks():
    shipped = make_backend("depth", Settings(python=PYTHON), None, Services(retries=QUICK))
    with contextlib.closing(shipped), pytest.raises(ServiceError, match=r"PackageNotFoundError: .*depth-anything-3"):
        shipped.estimate(picture(), camera=CAMERA, seed=0)


@pytest.mark.parametrize("shape", [(40, 60), (20, 30), (34, 51), (80, 120)])
def test_resampling_keeps_a_plane_where_it_is(shape):
    """A plane, told at the pixel centres of another resolution, is the same plane at those of the image, but at the border."""
    y, x = ((np.arange(n) + 0.5) / n for n in shape)
    plane = 1.0 + 2.0 * x[None, :] + 0.5 * y[:, None]
    v, u = (np.arange(40) + 0.5) / 40, (np.arange(60) + 0.5) / 60
    found = at_camera(plane, CAMERA)
    np.testing.assert_allclose(found[2:-2, 2:-2], (1.0 + 2.0 * u[None, :] + 0.5 * v[:, None])[2:-2, 2:-2], rtol=1e-6)
