"""The page in a real browser without a screen, from the first click to the analysed tables."""

import contextlib
import csv
import json
import re
import shutil
import threading

import pytest

from tests.study.clips import small_study
from wm.study.__main__ import main
from wm.study.folder import Study
from wm.study.serve import server

playwright = pytest.importorskip("playwright.sync_api", reason="the page is tested in Chromium, by playwright")

EVERYWHERE = ["--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage"]
LEVELS = {"ours": 5, "WonderWorld": 2, "FlexWorld": 3}
WAIT = 30_000  # ms, for machines that are busy


@pytest.fixture(scope="module")
def browser():
    with playwright.sync_playwright() as library:
        browser = library.chromium.launch(executable_path=shutil.which("chromium"), args=EVERYWHERE)
        yield browser
        browser.close()


@pytest.fixture
def own_study(made_study, tmp_path) -> Study:
    """The study in a folder of its own, with answers of its own."""
    shutil.copytree(made_study.folder, tmp_path / "study")
    return Study(**{**vars(made_study), "folder": tmp_path / "study"})


@contextlib.contextmanager
def opened(browser, address, **options):
    """A page that makes no error and asks for nothing from elsewhere."""
    context = browser.new_context(viewport={"width": 1200, "height": 760}, **options)
    context.set_default_timeout(WAIT)
    page, faults, asked = context.new_page(), [], []
    page.on("pageerror", lambda error: faults.append(str(error)))
    page.on("console", lambda line: faults.append(line.text) if line.type == "error" else None)
    page.on("request", lambda request: asked.append(request.url))
    page.goto(address)
    yield page
    context.close()
    assert faults == []
    root = address.partition("?")[0].removesuffix("index.html")
    assert all(url.startswith((root, "data:", "blob:")) for url in asked)


@contextlib.contextmanager
def served(study):
    with server(study.folder, port=0) as running:
        thread = threading.Thread(target=running.serve_forever, kwargs={"poll_interval": 0.02}, daemon=True)
        thread.start()
        try:
            yield f"http://127.0.0.1:{running.server_address[1]}/"
        finally:
            running.shutdown()
            thread.join()


def file_address(study, seat):
    return f"{(study.folder / 'page' / 'index.html').as_uri()}?p={seat}"


def press(page, study, trial):
    """Answers a page by keys alone, as somebody who passes every check and likes ours."""
    methods = [study.videos[name][0] for name in trial.videos]
    if trial.is_pair:
        side = trial.check or ("left" if methods[0] == "ours" else "right")
        page.keyboard.press("ArrowLeft" if side == "left" else "ArrowRight")
    else:
        for _ in study.questions.ratings:
            page.keyboard.press(str(trial.check or LEVELS[methods[0]]))
    page.locator("#next:enabled").wait_for()
    page.keyboard.press("Enter")


def answered(page, study, seat, first=0, last=None):
    """Goes through pages of a session."""
    trials = study.sessions[seat - 1]
    for number, trial in list(enumerate(trials))[first:last]:
        playwright.expect(page.locator("#where")).to_have_text(f"{number + 1} of {len(trials)}")
        press(page, study, trial)


def test_from_the_first_click_to_the_tables_with_a_server(browser, own_study):
    with served(own_study) as address:
        for seat in (1, 2):  # the server hands sessions out in turn
            with opened(browser, address) as page:
                page.get_by_role("button", name="I agree, start").click()
                answered(page, own_study, seat)
                playwright.expect(page.locator("#told")).to_have_text("Your answers are stored. You can close this page.")
                page.reload()  # sends nothing twice
                playwright.expect(page.locator("#told")).to_have_text("Your answers are stored. You can close this page.")
    assert len(list((own_study.folder / "answers").iterdir())) == 2
    assert main(["analyse", str(own_study.folder), "resamples=100"]) == 0
    with (own_study.folder / "results" / "ratings.csv").open() as file:
        rows = list(csv.DictReader(file))
    assert {(row["method"], float(row["mean"]), row["participants"]) for row in rows} == {(m, v, "2") for m, v in LEVELS.items()}
    with (own_study.folder / "results" / "preferences.csv").open() as file:
        assert {(row["against"], row["share"]) for row in csv.DictReader(file)} == {("WonderWorld", "1.0"), ("FlexWorld", "1.0")}


def test_from_the_disk_a_reload_goes_on_and_the_answers_are_downloaded(browser, own_study, capsys):
    with opened(browser, file_address(own_study, 3)) as page:
        page.keyboard.press("Enter")
        answered(page, own_study, 3, last=4)
        playwright.expect(page.locator("#where")).to_have_text(re.compile("^5 of"))
        page.reload()
        answered(page, own_study, 3, first=4)
        playwright.expect(page.locator("#told")).to_have_text(re.compile("^Please download your answers"))
        with page.expect_download() as download:
            page.get_by_role("button", name="Download my answers").click()
        file = own_study.folder / "answers" / download.value.suggested_filename
        download.value.save_as(file)
    given = json.loads(file.read_text())
    assert set(given) == {"version", "study", "participant", "slot", "answers"} and given["slot"] == 2
    assert re.fullmatch(r"answers-[0-9a-f]{32}\.json", file.name)
    assert all(set(one) <= {"ratings", "choice", "seconds", "plays"} for one in given["answers"])
    assert main(["analyse", str(own_study.folder), "resamples=100"]) == 0
    assert "participants counted: 1, excluded: 0; files refused: 0" in capsys.readouterr().out


def test_the_next_participant_on_a_device_is_another_one(browser, tmp_path):
    study = small_study(tmp_path, ratings=1, pairs=1)
    with served(study) as address, opened(browser, address) as page:
        page.get_by_role("button", name="I agree, start").click()
        answered(page, study, 1)
        playwright.expect(page.locator("#told")).to_have_text(re.compile("stored"))
        page.get_by_role("button", name="Next participant on this device").click()
        page.get_by_role("button", name="I agree, start").click()
        answered(page, study, 2)
        playwright.expect(page.locator("#told")).to_have_text(re.compile("stored"))
    assert sorted(json.loads(file.read_text())["slot"] for file in (study.folder / "answers").iterdir()) == [0, 1]


def test_a_page_waits_for_all_answers_and_the_end_of_its_video_and_plays_again(browser, own_study):
    with opened(browser, file_address(own_study, 1)) as page:
        page.keyboard.press("Enter")
        page.locator("#next:disabled").wait_for()
        page.keyboard.press("4")
        page.locator("video").evaluate("video => new Promise(done => video.ended ? done() : video.onended = () => done())")
        page.keyboard.press("Enter")
        playwright.expect(page.locator("#where")).to_have_text(re.compile("^1 of"))
        playwright.expect(page.locator("#hint")).to_have_text(re.compile("Please (answer every question|watch to the end)"))
        page.keyboard.press(" ")
        assert page.locator("video").evaluate("video => !video.ended && video.currentTime < 0.4")
        assert page.locator("input:checked").count() == 1


def test_a_number_can_be_changed_by_mouse_and_by_tab(browser, own_study):
    with opened(browser, file_address(own_study, 1)) as page:
        page.get_by_role("button", name="I agree, start").click()
        page.keyboard.press("4")
        page.get_by_role("radio", name="Scene quality: 2 of 5").check()
        assert page.locator('input[name="quality"]:checked').get_attribute("value") == "2"
        page.get_by_role("radio", name="3D structure: 5 of 5, completely").focus()
        page.keyboard.press("3")
        assert page.locator('input[name="structure"]:checked').get_attribute("value") == "3"
        assert page.locator('input[name="objects"]:checked').count() == 0
        assert page.get_by_role("group", name="3D objects").count() == 1


def pair_page(page, study, seat):
    """Brings a page to its first pair."""
    first = next(number for number, trial in enumerate(study.sessions[seat - 1]) if trial.is_pair)
    page.keyboard.press("Enter")
    answered(page, study, seat, last=first)
    playwright.expect(page.locator(".pair video")).to_have_count(2)


def test_the_videos_of_a_pair_run_together(browser, tmp_path):
    study = small_study(tmp_path, ratings=1)
    with opened(browser, file_address(study, 1)) as page:
        pair_page(page, study, 1)
        apart = """() => new Promise(done => {
            const [a, b] = document.querySelectorAll("video"), found = [];
            const look = () => {
                found.push(Math.abs(a.currentTime - b.currentTime));
                a.ended && b.ended ? done(found) : setTimeout(look, 20);
            };
            look(); })"""
        found = page.locator("main").evaluate(apart)
        assert found[-1] < 0.15 and sorted(found)[len(found) // 2] < 0.15


def test_a_video_that_cannot_be_played_holds_nobody_up(browser, own_study, capsys):
    broken = own_study.sessions[0][0].videos[0]
    (own_study.folder / "page" / "videos" / f"{broken}.mp4").write_bytes(b"no video")
    with served(own_study) as address, opened(browser, address) as page:
        page.get_by_role("button", name="I agree, start").click()
        for number, trial in enumerate(own_study.sessions[0]):
            playwright.expect(page.locator("#where")).to_have_text(re.compile(f"^{number + 1} of"))
            if broken in trial.videos:
                playwright.expect(page.get_by_role("alert")).to_have_text(re.compile("cannot be played"))
                page.get_by_role("button", name="Next").click()
            else:
                press(page, own_study, trial)
        playwright.expect(page.locator("#told")).to_have_text(re.compile("stored"))
    assert main(["analyse", str(own_study.folder), "resamples=100"]) == 0
    assert "participants counted: 1, excluded: 0" in capsys.readouterr().out


@pytest.mark.parametrize(("width", "height"), [(1366, 768), (1024, 640), (390, 844), (320, 568)])
def test_nothing_is_wider_than_the_screen_and_the_buttons_are_in_sight(browser, tmp_path, width, height):
    study = small_study(tmp_path, ratings=1)
    with opened(browser, file_address(study, 1)) as page:
        page.set_viewport_size({"width": width, "height": height})
        pair_page(page, study, 1)
        for _ in range(2):
            page.reload()
            page.locator("video").first.wait_for()
            assert page.locator("main").evaluate("() => document.documentElement.scrollWidth") <= width
            box = page.locator("#next").bounding_box()
            assert box["x"] + box["width"] <= width and box["y"] + box["height"] <= height
            press(page, study, study.sessions[0][int(page.locator("#where").text_content().split()[0]) - 1])
