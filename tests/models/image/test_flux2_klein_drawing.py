"""FLUX.2 [klein] at work: the real pipeline, with a tiny checkpoint of random weights."""

import dataclasses
import shutil

import numpy as np
import pytest

torch = pytest.importorskip("torch")
pytest.importorskip("diffusers")
pytest.importorskip("transformers")

from tests.models import tiny  # noqa: E402 - after what it needs
from tests.models.image.requests import image_request  # noqa: E402
from tests.models.image.shift import texture  # noqa: E402
from wm.models import local_model  # noqa: E402
from wm.models.image.flux2_klein import Settings, make  # noqa: E402
from wm.services.faults import RefusedError, ServiceError  # noqa: E402
from wm.services.services import ONLY, Services  # noqa: E402
from wm.services.store import AnswerStore  # noqa: E402

PAINT = """{#
theme, room and the rest:

    theme      the scene
    room       the room
    sights     openings
    objects    furniture
    reference  whether there is one
#}
A {{ room }}: {{ theme }}{{ " again" if reference }}"""


@pytest.fixture
def klein(tmp_path):
    """Makes the backend of the tiny checkpoint; it has prompts of its own, since a token of its text model is one byte."""
    (tmp_path / "prompts").mkdir()
    (tmp_path / "prompts" / "paint.md").write_text(PAINT)
    (tmp_path / "prompts" / "furnish.md").write_text(PAINT.replace("    objects    furniture\n", ""))
    made = []

    def made_with(folder=None, services=None, **settings):
        chosen = {"dtype": "float32", "device": "cpu", "steps": 2, "least_megapixels": 0.0, **settings}
        model, prompts = str(folder or tiny.checkpoint("flux2_klein")), str(tmp_path / "prompts")
        backend = make(Settings(model=model, prompts=prompts, **chosen), None).with_services(services or Services())
        made.append(backend)
        return backend

    yield made_with
    for backend in made:
        backend.close()


VIEW, OTHER = texture(90, 70), texture(90, 70, seed=1)


def test_equal_requests_give_equal_images_in_models_loaded_anew(klein):
    backend = klein()
    first = backend.generate(image_request(VIEW, reference=OTHER))
    assert first.rgb.shape == (70, 90, 3) and first.rgb.dtype == np.float32
    assert np.array_equal(backend.generate(image_request(VIEW, reference=OTHER)).rgb, first.rgb)
    backend.close()
    assert np.array_equal(backend.generate(image_request(VIEW, reference=OTHER)).rgb, first.rgb)


def test_an_image_depends_on_seed_condition_reference_and_task(klein):
    backend = klein()
    asked = [
        image_request(VIEW), image_request(VIEW, seed=2**63), image_request(OTHER), image_request(VIEW, reference=OTHER),
        image_request(VIEW, task="furnish", reference=VIEW),
    ]  # fmt: skip
    images = [backend.generate(request).rgb for request in asked]
    assert len({image.tobytes() for image in images}) == len(images)


def test_what_made_an_image_is_told(klein):
    record = klein().generate(image_request(VIEW)).record
    assert record["model"] == record["model_version"] and record["model"].startswith("flux2_klein@")
    assert record["prompt"] == "A kitchen: a lighthouse keeper's cottage"
    assert (record["seed"], record["steps"], record["dtype"]) == (7, 2, "float32")


def test_a_small_checkpoint_draws_in_half_precision(klein):
    image = klein(dtype="bfloat16").generate(image_request(VIEW)).rgb
    assert np.ptp(image) > 0.1
    assert not np.array_equal(image, klein().generate(image_request(VIEW)).rgb)


def test_a_furnishing_image_of_a_wide_camera(klein):
    image = klein().generate(image_request(texture(128, 96), task="furnish"))
    assert image.rgb.shape == (96, 128, 3) and image.record["prompt"].startswith("A kitchen")


def test_a_long_theme_is_shortened_and_that_is_said(klein):
    said = []
    request = dataclasses.replace(image_request(VIEW), theme="stone " * 99 + "end")
    record = klein(services=Services(say=said.append)).generate(request).record
    assert record["prompt"].startswith("A kitchen: stone stone") and "end" not in record["prompt"]
    assert 400 < len(record["prompt"]) <= 512
    assert len(said) == 1 and "reads 512 tokens of a prompt" in said[0]
    with pytest.raises(ServiceError, match="a shorter theme would be right"):
        klein().generate(dataclasses.replace(request, theme="s" * 600))


def test_an_image_that_is_no_number_is_refused_once(klein, tmp_path):
    from safetensors.torch import load_file, save_file

    folder = shutil.copytree(tiny.checkpoint("flux2_klein"), tmp_path / "broken")
    file = folder / "transformer" / "diffusion_pytorch_model.safetensors"
    weights = load_file(file)
    save_file(weights | {"proj_out.weight": torch.full_like(weights["proj_out.weight"], torch.nan)}, file, {"format": "pt"})
    services = Services(store=AnswerStore(tmp_path / "answers"))
    backend = klein(folder, services)
    for _ in range(2):
        with pytest.raises(RefusedError, match="values that are not numbers; dtype=float32 may help"):
            backend.generate(image_request(VIEW))
    assert len(services.ledger.rows) == 1


def test_a_kept_image_is_read_again_without_the_model(klein, tmp_path):
    services = Services(store=AnswerStore(tmp_path / "answers"))
    backend = klein(services=services)
    first = backend.generate(image_request(VIEW))
    backend.close()
    assert not local_model._LOADED
    again = klein(services=Services(store=services.store, replay=ONLY)).generate(image_request(VIEW))
    assert np.array_equal(again.rgb, first.rgb) and again.record == first.record
    assert not local_model._LOADED
