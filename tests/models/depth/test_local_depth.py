"""Depth models in this process: metres at the camera's size, by the real classes with tiny checkpoints of random weights."""

import contextlib
import shutil

import numpy as np
import pytest

torch = pytest.importorskip("torch")
pytest.importorskip("transformers")

from tests.models import tiny  # noqa: E402 - after what it needs
from tests.models.image.shift import texture  # noqa: E402
from wm.models import local_model  # noqa: E402
from wm.models.depth import depth_anything_2, depth_pro  # noqa: E402
from wm.models.depth.local_depth import LocalDepth  # noqa: E402
from wm.models.depth.resampling import squashed  # noqa: E402
from wm.models.local_model import LocalModel, LocalSettings  # noqa: E402
from wm.services.faults import ServiceError  # noqa: E402
from wm.services.services import ONLY, Services  # noqa: E402
from wm.services.store import AnswerStore  # noqa: E402
from wm.synth.backends import ImageResult  # noqa: E402
from wm.types import Camera  # noqa: E402

CHECKPOINTS = {depth_pro: "depth_pro", depth_anything_2: "depth_anything_metric"}
each_model = pytest.mark.parametrize("module", CHECKPOINTS, ids=["depth_pro", "depth_anything_2"])


@pytest.fixture
def depth():
    made = []

    def make(module, folder=None, services=None, **settings):
        model = str(folder or tiny.checkpoint(CHECKPOINTS[module]))
        made.append(module.make(module.Settings(model=model, device="cpu", **settings), None))
        return made[-1].with_services(services or Services())

    yield make
    for backend in made:
        backend.close()


def camera(width=100, height=60, focal=90.0):
    return Camera(
        T_cam_world=np.eye(4),
        focal=np.full(2, focal),
        principal=np.array([width / 2, height / 2]),
        width=width,
        height=height,
    )


def image(seed=0):
    return ImageResult(rgb=texture(100, 60, seed).astype(np.float32) / 255)


def estimated(backend, result=None, seen_by=None, seed=0):
    return backend.estimate(result or image(), camera=seen_by or camera(), seed=seed)


@each_model
def test_an_estimate_is_metres_at_the_size_of_the_image(depth, module):
    estimate = estimated(depth(module))
    assert estimate.shape == (60, 100) and estimate.dtype == np.float32
    assert np.isfinite(estimate).all() and (estimate > 0).all()


@each_model
def test_equal_images_give_equal_bytes_whatever_the_seed_in_models_loaded_anew(depth, module):
    backend = depth(module)
    first = estimated(backend)
    backend.close()
    assert np.array_equal(estimated(backend, seed=9), first)
    assert not np.array_equal(estimated(backend, image(1)), first)


@each_model
def test_another_type_gives_nearly_the_same(depth, module):
    full, half = estimated(depth(module)), estimated(depth(module, dtype="bfloat16"))
    assert not np.array_equal(full, half)
    assert np.median(np.abs(np.log(half / full))) < 0.05


def test_depth_pro_is_what_transformers_makes_of_it_with_the_same_focal_length(depth):
    """Source of the formula: DepthProImageProcessor.post_process_depth_estimation, which torchvision is needed to import."""
    model = tiny.depth_pro()
    with torch.no_grad():
        inverse = model(pixel_values=squashed(texture(100, 60), 64)).predicted_depth * 100 / 90.0
        sized = torch.nn.functional.interpolate(inverse[:, None], (60, 100), mode="bilinear")[0, 0]
        expected = 1 / torch.clamp(sized, min=1e-4, max=1e4)
    assert np.abs(estimated(depth(depth_pro)) / expected.numpy() - 1).max() < 1e-5


def test_depth_grows_with_the_focal_length_and_not_with_resolution():
    canonical = np.full((4, 6), 0.25)
    assert np.allclose(depth_pro.metric(canonical, camera(100, 60, 90.0)), 90 / 100 / 0.25)
    assert np.allclose(depth_pro.metric(canonical, camera(200, 120, 180.0)), 90 / 100 / 0.25)
    assert np.allclose(depth_pro.metric(canonical, camera(100, 60, 180.0)), 2 * 90 / 100 / 0.25)


def test_what_depth_pro_holds_for_endlessly_far_or_near_is_bounded():
    found = depth_pro.metric(np.array([[0.0, -1.0, 1e9, np.nan]]), camera())
    assert np.array_equal(found[0, :3], [1e4, 1e4, 1e-4]) and np.isnan(found[0, 3])


def test_the_focal_length_is_no_part_of_what_depth_pro_is_asked(depth, tmp_path):
    services = Services(store=AnswerStore(tmp_path))
    near, far = (estimated(depth(depth_pro, services=services), seen_by=camera(focal=focal)) for focal in (50.0, 100.0))
    assert len(services.ledger.rows) == 1
    free = (far < 9e3) & (near > 1e-3)
    assert free.mean() > 0.1 and np.allclose(far[free], 2 * near[free])


def test_metric_depth_anything_stays_within_what_it_was_trained_for(depth):
    estimate = estimated(depth(depth_anything_2))
    assert estimate.min() > 0 and estimate.max() < 20


def test_relative_depth_is_refused(depth):
    backend = depth(depth_anything_2, tiny.checkpoint("depth_anything_relative"))
    with pytest.raises(ServiceError, match=r"inverse depth with an unknown shift; .* Depth-Anything-V2-Metric-\* would be right"):
        estimated(backend)


@each_model
def test_what_is_not_finite_is_nan_and_nothing_finite_is_no_estimate(depth, module, tmp_path):
    from safetensors.torch import load_file, save_file

    folder = shutil.copytree(tiny.checkpoint(CHECKPOINTS[module]), tmp_path / "broken")
    weights = load_file(folder / "model.safetensors")
    last = [name for name in weights if name.startswith("head.") and name.endswith("bias")][-1]
    save_file(weights | {last: torch.full_like(weights[last], torch.nan)}, folder / "model.safetensors", {"format": "pt"})
    services = Services(store=AnswerStore(tmp_path / "answers"))
    backend = depth(module, folder, services)
    assert estimated(backend) is None and estimated(backend) is None
    assert len(services.ledger.rows) == 1
    if module is depth_anything_2:
        some = np.array([[1.0, np.inf], [np.nan, 2.0]], np.float32)
        blank = ImageResult(rgb=np.zeros((2, 2, 3), np.float32))
        with contextlib.closing(local_depth_of(some)) as backend:
            partly = backend.estimate(blank, camera=camera(2, 2), seed=0)
        assert np.array_equal(partly, [[1.0, np.nan], [np.nan, 2.0]], equal_nan=True)


def local_depth_of(output):
    """A backend whose model says this."""
    settings = LocalSettings(model="lab/depth@0123abc", device="cpu")
    model = LocalModel(settings, lambda *told: None, extra="depth")
    return LocalDepth("here", settings, model, lambda model, rgb: output, lambda depth, camera: depth)


@each_model
def test_a_kept_estimate_is_read_again_without_the_model(depth, module, tmp_path):
    services = Services(store=AnswerStore(tmp_path))
    backend = depth(module, services=services)
    first = estimated(backend)
    backend.close()
    assert not local_model._LOADED
    assert np.array_equal(estimated(depth(module, services=Services(store=services.store, replay=ONLY))), first)
    assert not local_model._LOADED
