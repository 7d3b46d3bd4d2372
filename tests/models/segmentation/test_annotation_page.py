"""The annotation page in a browser without a screen, with a tiny tracker behind it; then the backend goes by what was saved."""

import base64
import contextlib
import io
import re
import shutil

import numpy as np
import pytest
from PIL import Image

from tests.annotation.discs import HEIGHT, NAMES, WIDTH, drawn_run, picture
from tests.models import tiny
from wm.annotate import opened
from wm.annotation.server import serve
from wm.annotation.session import Session
from wm.geometry.rays.pinhole import make_camera
from wm.synth.backends import Click, ImageResult, Surroundings
from wm.synth.lifting.clicks import ClicksError, load_clicks
from wm.types import View

playwright = pytest.importorskip("playwright.sync_api")
pytest.importorskip("torch")
pytest.importorskip("transformers")

EVERYWHERE = ["--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage"]


@pytest.fixture(scope="module")
def browser():
    with playwright.sync_playwright() as library:
        browser = library.chromium.launch(executable_path=shutil.which("chromium"), args=EVERYWHERE)
        yield browser
        browser.close()


@contextlib.contextmanager
def page_of(browser, run, scale=1.0, **options):
    """The page of a run, which must not make an error; and the backend behind it."""
    backend, min_area = opened(run)
    with contextlib.closing(backend), serve(Session(run, backend, min_area=min_area)) as address:
        context = browser.new_context(viewport={"width": 1200, "height": 760}, device_scale_factor=scale, **options)
        page, faults, asked = context.new_page(), [], []
        page.on("pageerror", lambda error: faults.append(str(error)))
        page.on("console", lambda line: faults.append(line.text) if line.type == "error" else None)
        page.on("request", lambda request: asked.append(request.url))
        page.goto(address)
        playwright.expect(page.locator("#images li")).to_have_count(2)
        yield page, backend
        context.close()
        assert faults == []
        assert all(url.startswith((address, "data:")) for url in asked)


def run_folder(tmp_path):
    settings = {"backend": "wm.models.segmentation.sam3_clicks", "model": str(tiny.checkpoint("sam3_tracker"))}
    return drawn_run(tmp_path, settings)


def click(page, x, y, **options):
    """Clicks at a point of the image, in its pixels, and waits for what comes of it."""
    box = page.locator("#picture").bounding_box()
    at = (box["x"] + x * box["width"] / WIDTH, box["y"] + y * box["height"] / HEIGHT)
    with page.expect_response("**/mask"):
        if options.get("shift"):
            page.keyboard.down("Shift")
        page.mouse.click(*at)
        page.keyboard.up("Shift")
    playwright.expect(page.locator("#message")).to_have_text("")
    return at


def shown(page):
    """The mask that the page shows for the clicks."""
    source = page.locator("#mask").get_attribute("src")
    with Image.open(io.BytesIO(base64.b64decode(source.removeprefix("data:image/png;base64,")))) as image:
        return np.asarray(image)[..., 3] > 0


def close_to(clicks, wanted):
    """Whether clicks are where they were made, within a pixel of the image, with the same signs."""
    assert [c.on for c in clicks] == [w[2] for w in wanted]
    return all(np.hypot(c.x - w[0], c.y - w[1]) < 1 for c, w in zip(clicks, wanted, strict=True))


@pytest.mark.parametrize("scale", [1.0, 2.0])
def test_a_thing_is_marked_named_and_saved_where_it_was_clicked(tmp_path, browser, scale):
    drawings = run_folder(tmp_path)
    with page_of(browser, tmp_path, scale) as (page, backend):
        playwright.expect(page.locator("#confirm")).to_be_disabled()
        click(page, 30.5, 40.5)
        clicked = backend.mask_of(picture(), _clicks(page))
        np.testing.assert_array_equal(shown(page), clicked.mask)
        click(page, 100.25, 70.75, shift=True)
        assert page.locator("#dots i").count() == 2 and page.locator("#dots i.beside").count() == 1
        with page.expect_response("**/mask"):
            page.keyboard.press("z")
        playwright.expect(page.locator("#dots i")).to_have_count(1)
        playwright.expect(page.locator("#message")).to_have_text("")
        np.testing.assert_array_equal(shown(page), clicked.mask)
        click(page, 110.0, 10.0, shift=True)
        page.keyboard.press("l")
        page.keyboard.type("arm chair")
        assert load_clicks(tmp_path, drawings[0]) is None
        page.keyboard.press("Enter")
        playwright.expect(page.locator("#things li")).to_have_text(re.compile("arm chair"))
        saved = load_clicks(tmp_path, drawings[0])
        assert [thing.label for thing in saved.things] == ["arm chair"] and not saved.finished
        assert close_to(saved.things[0].clicks, [(30.5, 40.5, True), (110.0, 10.0, False)])


def _clicks(page):
    return [Click(float(x), float(y), sign == "+") for x, y, sign in page.evaluate("view.clicks")]


def test_an_evening_at_the_page_then_the_run_goes_on_alone(tmp_path, browser):
    """Marks, changes, deletes, finishes both images by keyboard; what is saved gives the masks that were shown."""
    drawings = run_folder(tmp_path)
    with page_of(browser, tmp_path) as (page, _):
        click(page, 20.0, 20.0)
        page.locator("#chips button", has_text="washbasin").click()
        page.keyboard.press("Enter")
        playwright.expect(page.locator("#things li")).to_have_count(1)
        click(page, 90.0, 60.0)
        page.locator("#label").fill("rug")
        page.locator("#confirm").click()
        playwright.expect(page.locator("#things li")).to_have_count(2)
        with page.expect_response("**/mask"):
            page.locator("#things li").first.click()  # changed: one click more
        click(page, 40.0, 25.0)
        mask = shown(page)
        page.locator("#confirm").click()
        playwright.expect(page.locator("#message")).to_have_text("Saved: washbasin.")
        page.get_by_label("delete rug").click()
        playwright.expect(page.locator("#things li")).to_have_count(1)
        page.keyboard.press("f")
        playwright.expect(page.locator("#images li.chosen b")).to_have_text("hall 1")
        playwright.expect(page.locator("#message")).to_have_text("")
        page.keyboard.press("f")
        playwright.expect(page.locator("#progress")).to_have_text("2 of 2 images finished")
        playwright.expect(page.locator("#message")).to_contain_text("the same run command now goes on")
    with page_of(browser, tmp_path) as (page, _):  # all is there when the page is opened again
        playwright.expect(page.locator("#things li")).to_have_text(re.compile("washbasin"))
    unattended, _ = opened(tmp_path)
    camera = make_camera(np.array([0.0, 0, 1]), np.array([1.0, 0, 1]), width=WIDTH, height=HEIGHT, fov_deg=60.0)
    images = [ImageResult(rgb=(picture(k) / 255).astype(np.float32)) for k in range(2)]
    views = [View(camera, k, "bootstrap", name) for k, name in enumerate(NAMES)]
    drawn = [(image, Surroundings("gothic", "room", view, tmp_path)) for image, view in zip(images, views, strict=True)]
    with contextlib.closing(unattended):
        unattended.prepare(drawn)
        found = [unattended.segment(result, where=where, seed=0) for result, where in drawn]
        with pytest.raises(ClicksError):
            unattended.prepare([(ImageResult(rgb=1 - drawn[0][0].rgb), drawn[0][1])])
    assert [[segment.label for segment in segments] for segments in found] == [["washbasin"], []]
    np.testing.assert_array_equal(found[0][0].mask, mask)
    assert close_to(load_clicks(tmp_path, drawings[0]).things[0].clicks, [(20.0, 20.0, True), (40.0, 25.0, True)])


def test_what_cannot_be_done_is_said_and_nothing_is_lost(tmp_path, browser):
    drawings = run_folder(tmp_path)
    with page_of(browser, tmp_path) as (page, _):
        page.keyboard.press("Enter")
        playwright.expect(page.locator("#message.error")).to_have_text("Click on a thing first.")
        page.keyboard.down("Shift")
        page.locator("#picture").click()
        page.keyboard.up("Shift")
        playwright.expect(page.locator("#message")).to_contain_text("Click on the thing as well")
        click(page, 60.0, 45.0)
        page.keyboard.press("Enter")
        playwright.expect(page.locator("#message.error")).to_contain_text("Say what it is")
        page.keyboard.type("b")  # into the label, which has the focus now
        playwright.expect(page.locator("#label")).to_have_value("b")
        page.keyboard.press("Escape")
        page.keyboard.press("Escape")
        playwright.expect(page.locator("#dots i")).to_have_count(0)
        assert load_clicks(tmp_path, drawings[0]) is None


def test_a_right_click_is_beside_the_thing_and_a_name_is_shown_as_text(tmp_path, browser):
    run_folder(tmp_path)
    with page_of(browser, tmp_path) as (page, _):
        click(page, 60.0, 45.0)
        box = page.locator("#picture").bounding_box()
        with page.expect_response("**/mask"):
            page.mouse.click(box["x"] + 5, box["y"] + 5, button="right")
        assert page.locator("#dots i.beside").count() == 1
        page.locator("#label").fill("<img src=x onerror=alert(1)>")
        page.locator("#confirm").click()
        playwright.expect(page.locator("#things li span")).to_have_text("<img src=x onerror=alert(1)>")
        assert page.locator("#things li img").count() == 0
