"""The report is one self-contained page that shows what it was given."""

import dataclasses
import html.parser

import jinja2
import numpy as np
import pytest
from markupsafe import escape

from tests.geometry.plans import two_rooms
from tests.geometry.things import box
from wm.metric_table import METRICS
from wm.report import ReportData, SheetRow, render_page, write_video
from wm.report.paper import PAPER_ROWS, paper_figure
from wm.report.pictures import depth_error_image
from wm.report.plots import plot_error_against_time
from wm.report.templating import fill
from wm.types import Camera, View


class _Tags(html.parser.HTMLParser):
    def __init__(self, page):
        super().__init__()
        self.open, self.links, self.count = [], [], {}
        self.feed(page)

    def handle_starttag(self, tag, attrs):
        self.count[tag] = self.count.get(tag, 0) + 1
        self.links += [value for name, value in attrs if name in ("src", "href") and value]
        if tag not in ("meta", "img", "br", "input", "i", "tr", "td", "th", "p", "use", "path", "circle", "line"):
            self.open.append(tag)

    def handle_endtag(self, tag):
        if self.open and tag == self.open[-1]:
            self.open.pop()


def _data(**changes):
    rng = np.random.default_rng(0)
    image = rng.random((12, 20, 3)).astype(np.float32)
    depth = rng.uniform(1, 3, (12, 20)).astype(np.float32)
    camera = Camera(T_cam_world=np.eye(4), focal=np.array([10.0, 10.0]), principal=np.array([10.0, 6.0]), width=20, height=12)
    row = SheetRow("a/bootstrap0", "recall 0.98", image, image, image, depth + 0.01, depth)
    fields = {
        "scene": "test_house",
        "theme": "a <b>bold</b> theme & more",
        "variant": "full",
        "preset": "draft",
        "seed": 3,
        "plan": two_rooms(),
        "objects": [],
        "views": [View(camera=camera, room=0, kind="bootstrap", name="a/bootstrap0")],
        "sheets": {"Hall": [row, row]},
        "heroes": {"Hall": image},
        "metrics": {"psnr": 31.234, "m_mae": 0.0123, "yield": 1.0, "rooms": 2, "gaussians": 12345, "ssim": None},
        "timings": {"plan": {"seconds": 1.0, "peak_gib": 0.5}, "paint": {"seconds": 3.0, "peak_gib": 0.7}},
        "history": [{"seconds": 1.0, "psnr": 20.0, "m_mae": 0.1}, {"seconds": 2.0, "psnr": 25.0, "m_mae": 0.05}],
        "video": b"\x00\x00",
    }
    return ReportData(**{**fields, **changes})


def test_the_page_loads_nothing_from_anywhere():
    tags = _Tags(render_page(_data()))
    assert tags.links and all(link.startswith("data:") for link in tags.links)
    assert tags.count["video"] == 1
    assert tags.count["img"] == 2 * 4 + 1
    assert not tags.open


def test_the_theme_is_text_and_never_markup():
    page = render_page(_data())
    assert "<b>bold</b>" not in page
    assert "a &lt;b&gt;bold&lt;/b&gt; theme &amp; more" in page


def test_names_of_rooms_views_and_things_are_text_and_never_markup():
    evil = "<script>alert('x')</script>"
    plan = two_rooms()
    plan = dataclasses.replace(plan, rooms=tuple(dataclasses.replace(room, name=evil) for room in plan.rooms))
    rows = _data().sheets["Hall"]
    sheets = {evil: [dataclasses.replace(row, name=evil, note=evil) for row in rows]}
    views = [dataclasses.replace(view, name=evil) for view in _data().views]
    thing = box((0, 0, 0.5), (1, 1, 1), label=evil)
    texts = dict.fromkeys(("scene", "theme", "variant", "preset"), evil)
    data = _data(plan=plan, sheets=sheets, heroes={evil: _data().heroes["Hall"]}, views=views, objects=[thing], **texts)
    page = render_page(data)
    assert "<script" not in page.lower() and "alert('" not in page
    # title, h1, theme, two facts; rooms, camera, title and label of the thing; alt and caption of the hero; sheet
    assert page.lower().count("&lt;script&gt;") == 5 + (2 + 1 + 2) + 2 + (1 + 2 * 2)
    assert not _Tags(page).open


def test_a_value_that_a_template_is_not_given_is_an_error():
    with pytest.raises(jinja2.UndefinedError):
        fill("page.html")


def test_figures_stand_beside_the_papers():
    page = render_page(_data())
    assert "31.23 dB" in page and "0.0123 m" in page and "0.0383 m" in page and "12,345" in page


def test_every_metric_is_shown_with_its_definition():
    page = render_page(_data())
    assert all(f"<dt>{escape(metric.heading)}</dt><dd>{escape(metric.definition)}</dd>" in page for metric in METRICS.values())


@pytest.mark.parametrize("changes", [{"video": None}, {"history": []}, {"sheets": {}, "heroes": {}}, {"metrics": {}}])
def test_what_was_not_made_is_left_out(changes):
    assert not _Tags(render_page(_data(**changes))).open


def test_the_curve_has_a_panel_for_each_error_that_was_measured():
    rows = [{"seconds": float(k), "psnr": 20.0 + k, "m_mae": 0.1 / (k + 1), "n_ang_deg": 30.0 - k} for k in range(3)]
    titles = {"psnr": "held-out PSNR", "m_mae": "M-MAE", "n_ang_deg": "N-Ang"}
    whole = plot_error_against_time(rows)
    for left_out, title in titles.items():
        part = plot_error_against_time([row | {left_out: None} for row in rows])
        assert title in whole and title not in part
        assert all(other in part for name, other in titles.items() if name != left_out)


def test_equal_data_give_equal_pages():
    assert render_page(_data()) == render_page(_data())


def test_depth_error_is_dark_where_exact_and_grey_where_nothing_is_hit():
    scaffold = np.array([[2.0, 2.0, 0.0]])
    image = depth_error_image(np.array([[2.0, 2.5, 1.0]]), scaffold)
    assert image[0, 0].max() < 10
    assert image[0, 1].max() > 200
    assert np.ptp(image[0, 2]) == 0


def test_every_ablation_row_of_the_paper_is_there():
    assert len(PAPER_ROWS) == 8
    assert paper_figure("full", "n_ang_deg") == 39.26
    assert paper_figure("full", "navigability") == 0.967
    assert paper_figure("unheard_of", "m_mae") is None


def test_video_of_odd_size_is_written_whole_and_deterministic(tmp_path):
    frames = [np.full((31, 45, 3), 8 * k, np.uint8) for k in range(10)]
    for name in ("a.mp4", "b.mp4"):
        assert write_video(tmp_path / name, iter(frames), fps=10) == 10
    data = (tmp_path / "a.mp4").read_bytes()
    assert data[4:8] == b"ftyp"
    assert data == (tmp_path / "b.mp4").read_bytes()


def test_no_frames_make_no_file(tmp_path):
    assert write_video(tmp_path / "none.mp4", iter([]), fps=10) == 0
    assert not (tmp_path / "none.mp4").exists()
