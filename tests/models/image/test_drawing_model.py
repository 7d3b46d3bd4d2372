"""Image backends that ask services, whatever the service: what is asked, kept and told. No SDK is needed."""

import dataclasses
import sys

import numpy as np
import pytest

from tests.models.image.drawing_servers import encoded, redrawn
from tests.models.image.requests import image_request
from tests.models.image.shift import shift, texture
from wm.models.image import nano_banana_pro, openai_images
from wm.models.image.drawing import DrawingRequest, drawing_of
from wm.models.image.drawing_model import DrawingModel
from wm.models.image.registration import ImageCanvas
from wm.models.prompt_files import PromptError, Prompts
from wm.services.budget import Budget
from wm.services.faults import BudgetError, MissingExtraError, RefusedError, ReplayError
from wm.services.ledger import Ledger
from wm.services.prices import Price, Prices
from wm.services.records import ServiceAnswer
from wm.services.services import ONLY, Services
from wm.services.store import AnswerStore
from wm.synth.backends import ClosableBackend, ConcurrentBackend, ImageBackend, ServedBackend

BACKENDS = [nano_banana_pro, openai_images]
FAMILIES = ["image/nano_banana", "image/gpt_image"]
VIEW = texture(172, 96)


class Draughtsman:
    """A service on this machine that draws the guide, in a size of its own."""

    expected = {"images": 1.0}  # noqa: RUF012 - nobody changes it

    def __init__(self, *size: int, content: bytes | None = None):
        self.size, self.content, self.sent = size, content, []

    def canvas(self, width, height):
        return ImageCanvas(344, 192, "16:9")

    def deciding(self, canvas):
        return {"shape": canvas.ratio}

    def send(self, drawing: DrawingRequest, *, seed: int) -> ServiceAnswer:
        self.sent.append((drawing, seed))
        content = encoded(redrawn(drawing.guide, *self.size)) if self.content is None else self.content
        return ServiceAnswer(files={"image.png": content}, model_version="v1", usage={"requests": 1.0, "images": 1.0})

    def close(self):
        self.sent.clear()


def model(service, **services) -> DrawingModel:
    made = DrawingModel(backend="here", model="draughtsman", service=service, prompts=Prompts(FAMILIES[0]), at_once=3)
    return made.with_services(Services(**services))


def test_the_view_comes_back_in_its_own_size_and_place():
    result = model(Draughtsman(499, 278)).generate(image_request(VIEW))
    assert result.rgb.shape == VIEW.shape and result.rgb.dtype == np.float32
    assert shift(VIEW, np.round(result.rgb * 255)) <= 0.25
    assert result.drawn_depth is None and result.drawn_object is None


def test_the_record_says_what_made_the_image():
    record = model(Draughtsman(344, 192)).generate(image_request(VIEW, seed=11)).record
    assert record["model"] == "draughtsman" and record["model_version"] == "v1" and record["seed"] == 11
    assert "lighthouse keeper's cottage" in record["prompt"] and record["usage"]["images"] == 1


def test_an_equal_request_is_sent_once_and_any_other_is_sent(tmp_path):
    service = Draughtsman(344, 192)
    backend = model(service, store=AnswerStore(tmp_path), ledger=Ledger())
    first = backend.generate(image_request(VIEW))
    assert np.array_equal(backend.generate(image_request(VIEW)).rgb, first.rgb)
    assert len(service.sent) == 1
    others = [image_request(VIEW, seed=8), image_request(VIEW[::-1]), image_request(VIEW, reference=VIEW)]
    for count, request in enumerate([*others, image_request(VIEW, task="furnish")], start=2):
        backend.generate(request)
        assert len(service.sent) == count


def test_kept_answers_are_read_without_the_service(tmp_path):
    first = model(Draughtsman(344, 192), store=AnswerStore(tmp_path)).generate(image_request(VIEW))
    offline = model(Draughtsman(), store=AnswerStore(tmp_path), replay=ONLY)
    assert np.array_equal(offline.generate(image_request(VIEW)).rgb, first.rgb)
    with pytest.raises(ReplayError):
        offline.generate(image_request(VIEW, seed=8))


@pytest.mark.parametrize(
    ("content", "said"), [(encoded(VIEW)[:-500], "cannot be read"), (encoded(VIEW[:, :96]), "another shape than 344 x 192")]
)
def test_a_paid_image_that_cannot_be_used_is_refused_and_not_paid_twice(tmp_path, content, said):
    service = Draughtsman(content=content)
    backend = model(service, store=AnswerStore(tmp_path), ledger=Ledger(), budget=Budget(requests=1))
    for _ in range(2):
        with pytest.raises(RefusedError, match=f"draughtsman: .*{said}"):
            backend.generate(image_request(VIEW))
    assert len(service.sent) == 1 and backend.services.ledger.spent().requests == 1
    with pytest.raises(BudgetError):
        backend.generate(image_request(VIEW, seed=8))


@pytest.mark.parametrize("module", BACKENDS)
def test_backends_have_the_protocols_of_a_paid_service(module):
    backend = module.make(module.Settings(requests_at_once=5), None)
    for protocol in (ImageBackend, ServedBackend, ConcurrentBackend, ClosableBackend):
        assert isinstance(backend, protocol)
    assert backend.at_once == 5
    backend.close()
    backend.close()


@pytest.mark.parametrize("module", BACKENDS)
def test_without_its_package_a_backend_names_the_extra(module, monkeypatch):
    for name in ("google.genai", "openai"):
        monkeypatch.setitem(sys.modules, name, None)
    extra = {"nano_banana_pro": "gemini", "openai_images": "openai"}[module.__name__.rpartition(".")[2]]
    with pytest.raises(MissingExtraError, match=rf"pip install 'wm\[{extra}\]'"):
        module.make(module.Settings(), None).generate(image_request(VIEW))


@pytest.mark.parametrize(
    ("settings", "tokens"),
    [
        (nano_banana_pro.Settings(), 1120),
        (nano_banana_pro.Settings(image_size="4K"), 2000),
        (nano_banana_pro.Settings(model="gemini-nano-banana-2.1", image_size="4K"), 3780),
        (nano_banana_pro.Settings(model="gemini-9"), 500),
        (openai_images.Settings(), 1756),
        (openai_images.Settings(quality="low"), 196),
        (openai_images.Settings(quality="auto"), 500),
        (openai_images.Settings(model="gpt-image-2"), 500),
    ],
)
def test_a_quote_goes_by_the_size_and_quality_that_is_asked_for(settings, tokens):
    module = nano_banana_pro if settings.backend.endswith("pro") else openai_images
    price = Price(input=1.0, image_tokens=100.0, usage={"input_tokens": 2000.0, "image_tokens": 500.0}, seconds=20.0)
    services = Services(prices=Prices(models={settings.model: price}))
    quote = module.make(settings, None).with_services(services).quote()
    assert quote.usd == pytest.approx(2000e-6 + tokens * 100e-6) and quote.seconds == 20 and quote.at_once == 8


@pytest.mark.parametrize("family", FAMILIES)
def test_prompts_tell_what_the_method_knows(family):
    prompts, canvas = Prompts(family), ImageCanvas(344, 192)
    for task in ("paint", "furnish"):
        alone = drawing_of(image_request(VIEW, task=task), canvas, prompts)
        beside = drawing_of(image_request(VIEW, task=task, reference=VIEW[:50]), canvas, prompts)
        for told in ("a lighthouse keeper's cottage", "kitchen", "a doorway on the left"):
            assert told in alone.prompt and told in beside.prompt
        second = {"image/nano_banana": "second image", "image/gpt_image": "Image 2"}[family]
        assert second in beside.prompt and second not in alone.prompt
        assert len(alone.images) == 1 and np.array_equal(beside.images[1], VIEW[:50])


def test_a_request_that_says_nothing_of_the_scene_keeps_the_prompt_of_the_method():
    request = dataclasses.replace(image_request(VIEW), theme="", room="", sights=())
    assert drawing_of(request, ImageCanvas(344, 192), Prompts(FAMILIES[0])).prompt == "a prompt of the method"


@pytest.mark.parametrize("family", FAMILIES)
def test_prompts_differ_by_how_the_guide_shows_furniture(family):
    told = {"theme": "t", "room": "r", "sights": [], "reference": True}
    texts = {objects: Prompts(family).write("paint", objects=objects, **told) for objects in ("textured", "boxes", "none")}
    assert len(set(texts.values())) == 3
    assert "box" in texts["boxes"] and "box" not in texts["textured"] + texts["none"]
    assert all("No doorway and no window of this room is in view" in text for text in texts.values())


def test_a_prompt_of_ones_own_takes_the_place_of_ours(tmp_path):
    (tmp_path / "paint.md").write_text("Paint the {{ room }}.")
    backend = nano_banana_pro.make(nano_banana_pro.Settings(prompts=str(tmp_path)), None)
    assert drawing_of(image_request(VIEW), ImageCanvas(344, 192), backend.prompts).prompt == "Paint the kitchen."
    (tmp_path / "paint.md").write_text("Paint the {{ rooom }}.")
    with pytest.raises(PromptError, match="rooom"):
        openai_images.make(openai_images.Settings(prompts=str(tmp_path)), None)
