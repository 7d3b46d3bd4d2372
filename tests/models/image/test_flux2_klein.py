"""FLUX.2 [klein]: canvases, prompts and requests, as far as they need no torch."""

import dataclasses
import math
import sys

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.models.image.requests import image_request
from tests.models.image.shift import shift, texture
from wm.models.image.flux2_klein import Settings, canvas_of, fitting_prompt, make
from wm.models.image.registration import cut_out, placed
from wm.models.prompt_files import Prompts
from wm.services.faults import MissingExtraError, ServiceError
from wm.services.services import Services

MEGAPIXEL = 1024 * 1024
COMMIT = "lab/klein@0123abc"


@pytest.mark.parametrize(
    ("view", "canvas"),
    [((1376, 768), (1344, 752)), ((688, 384), (688, 384)), ((640, 480), (640, 480)), ((1024, 1024), (1024, 1024))],
)
def test_the_canvas_of_a_view(view, canvas):
    found = canvas_of(*view)
    assert (found.width, found.height) == canvas


@given(st.integers(16, 4096), st.integers(16, 4096), st.integers(0, 1_000_000))
def test_a_canvas_is_what_the_pipeline_takes_as_it_is(width, height, smallest):
    if max(width, height) > 6 * min(width, height):
        return
    canvas = canvas_of(width, height, smallest=smallest)
    assert canvas.width % 16 == canvas.height % 16 == 0
    assert min(canvas.width, canvas.height) >= 64 and canvas.width * canvas.height <= MEGAPIXEL
    assert max(canvas.width, canvas.height) <= 8 * min(canvas.width, canvas.height)
    assert abs(math.log(canvas.width * height / (canvas.height * width))) <= 0.13  # half a step of 16 in sides from 64 on


def test_small_views_are_drawn_larger():
    canvas = canvas_of(344, 192, smallest=250_000)
    assert 0.8 * 250_000 <= canvas.width * canvas.height <= 1.25 * 250_000
    assert canvas_of(344, 192).width < 400


@pytest.mark.parametrize("view", [(2000, 100), (100, 2000)])
def test_views_that_are_too_long_are_refused(view):
    with pytest.raises(ServiceError, match="no side may be 8 times the other"):
        canvas_of(*view)


@pytest.mark.parametrize("view", [(1376, 768), (344, 192), (640, 480), (96, 64)])
def test_what_is_drawn_over_the_condition_registers_with_the_view(view):
    image, canvas = texture(*view), canvas_of(*view, smallest=60_000)
    assert shift(cut_out(placed(image, canvas), canvas, *view), image) <= 0.1


def words(text):
    return len(text.split())


def test_a_prompt_that_fits_stays():
    assert fitting_prompt("a hall of stone", "stone", words, 4) == "a hall of stone"


@given(st.integers(4, 12))
def test_a_long_theme_loses_as_few_words_as_it_must(most):
    theme = "old stone with moss on every wall"
    prompt = fitting_prompt(f"A hall: {theme}, sharp.", theme, words, most)
    assert words(prompt) == min(most, 10)
    assert prompt.startswith("A hall: old") and prompt.endswith(", sharp.")


@pytest.mark.parametrize("theme", ["stone", "", "not in it"])
def test_a_prompt_that_no_shorter_theme_makes_fit_is_one_error(theme):
    with pytest.raises(ServiceError, match="the prompt has 6 tokens, and the model reads 3: a shorter theme"):
        fitting_prompt("a hall of stone and wood", theme, words, 3)


@pytest.mark.parametrize("reference", [True, False])
@pytest.mark.parametrize("objects", ["textured", "boxes", "none"])
def test_our_prompts_leave_room_for_a_theme(objects, reference):
    sights = ["a doorway on the left", "a window straight ahead", "a doorway on the right", "a window on the far right"]
    prompts = Prompts("image/flux2_klein")
    told = {"theme": "", "room": "living room", "sights": sights, "reference": reference}
    for prompt in (prompts.write("paint", objects=objects, **told), prompts.write("furnish", **told)):
        assert len(prompt) / 4 < 420  # English has more than four characters a token


def test_a_missing_package_is_named_with_what_installs_it(monkeypatch):
    monkeypatch.setitem(sys.modules, "diffusers", None)
    for package in ("torch", "transformers"):
        monkeypatch.setitem(sys.modules, package, sys)  # so that they are found, whether or not they are installed
    with pytest.raises(MissingExtraError, match=r"diffusers is not installed: pip install 'wm\[diffusers\]'"):
        make(Settings(model=COMMIT), None).generate(image_request(texture(96, 64)))


class Heard(Exception):
    pass


class Listening(Services):
    """Services that keep what they are asked."""

    def ask(self, request, send):
        self.request = request
        raise Heard


def key(request, **settings):
    listening = Listening()
    with pytest.raises(Heard):
        make(Settings(model=COMMIT, **settings), None).with_services(listening).generate(request)
    assert listening.request.model == COMMIT and not listening.request.paid
    return listening.request.key


def test_a_request_is_what_decides_the_image_and_nothing_else():
    image, other = texture(96, 64), texture(96, 64, seed=1)
    request = image_request(image, reference=other)
    same = {key(request), key(dataclasses.replace(request, prompt="unused, since the theme is known"))}
    same |= {key(request, device="cpu"), key(request, device="cuda"), key(request, offload="sequential")}
    assert len(same) == 1
    changed = [
        key(image_request(image)), key(image_request(other, reference=other)), key(image_request(image, reference=image)),
        key(image_request(image, reference=other, seed=8)), key(image_request(image, reference=other, task="furnish")),
        key(request, steps=5), key(request, guidance=2.0), key(request, dtype="float32"), key(request, least_megapixels=0.1),
    ]  # fmt: skip
    assert len({*same, *changed}) == 1 + len(changed)
