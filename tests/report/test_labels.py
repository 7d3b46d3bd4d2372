"""Laws of the plan's labels: no two overlap, none leaves the sheet, the large come first, and names stay text."""

import dataclasses
import html.parser
import itertools

import numpy as np
import pytest

from tests.geometry.plans import two_rooms
from tests.geometry.things import box
from wm.report.floorplan import draw_floorplan
from wm.report.labels import LONGEST, Box, place_label

SHEET = Box(0.0, 0.0, 200.0, 100.0)


class _Texts(html.parser.HTMLParser):
    """The texts of the labels of things in an SVG, one for each, and the classes of all groups."""

    def __init__(self, svg):
        super().__init__()
        self.labels, self.groups, self.titles, self._inside = [], [], [], None
        self.feed(svg)

    def handle_starttag(self, tag, attrs):
        kind = dict(attrs).get("class")
        if tag == "g" and kind:
            self.groups.append(kind)
        if tag == "text" and kind == "name":
            self.labels.append([])
        self._inside = self.labels[-1] if tag == "tspan" and kind != "area" else self.titles if tag == "title" else None

    def handle_data(self, data):
        if self._inside is not None and data.strip():
            self._inside.append(data)
            self._inside = None


def _labels(*things):
    return [" ".join(lines) for lines in _Texts(draw_floorplan(two_rooms(), things, [])).labels]


def test_labels_do_not_overlap_and_stay_on_the_sheet():
    rng = np.random.default_rng(1)
    placed = []
    for k in range(60):
        x, y = rng.uniform(0, 200), rng.uniform(0, 100)
        taken = [one.box for one in placed]
        label = place_label(f"thing number {k}", [(x, y)], size=9.0, taken=taken, sheet=SHEET, turned=k % 2 == 0)
        placed += [] if label is None else [label]
    assert 5 < len(placed) < 60
    assert not any(a.box.overlaps(b.box) for a, b in itertools.combinations(placed, 2))
    assert all(label.box.within(SHEET) for label in placed)


def test_a_label_breaks_or_turns_where_that_makes_it_fit():
    narrow = Box(0.0, 0.0, 60.0, 100.0)
    broken = place_label("coffee table", [(30.0, 50.0)], size=9.0, taken=[], sheet=narrow)
    assert broken is not None and broken.lines == ("coffee", "table")
    slim = Box(0.0, 0.0, 14.0, 100.0)
    label = place_label("wardrobe", [(7.0, 50.0)], size=9.0, taken=[], sheet=slim)
    assert label is not None and label.turned and label.lines == ("wardrobe",)
    moved = place_label("wardrobe", [(2.0, 90.0)], size=9.0, taken=[], sheet=slim)
    assert moved is not None and moved.box.within(slim) and moved.x > 2.0 and moved.y < 90.0
    assert place_label("wardrobe", [(7.0, 5.0)], size=9.0, taken=[], sheet=Box(0.0, 0.0, 14.0, 10.0)) is None


def test_a_long_label_is_cut():
    label = place_label("x" * 500, [(200.0, 50.0)], size=9.0, taken=[], sheet=Box(0.0, 0.0, 400.0, 100.0))
    assert label is not None and len(label.lines[0]) == LONGEST and label.lines[0].endswith("…")


def test_what_stands_on_the_floor_is_labelled_the_largest_first():
    table, stool = box((1, 2.6, 0), (3, 3.8, 0.7), label="dining table"), box((1.9, 3.1, 0), (2.1, 3.3, 0.5), label="stool at it")
    lamp = dataclasses.replace(box((4, 0.4, 2), (4.6, 1.0, 2.4), label="lamp"), support="ceiling")
    assert _labels(stool, table)[0] == "dining table"
    assert _labels(table, stool, lamp) == _labels(table, stool)  # what stands on no floor has no label, but a title


@pytest.mark.parametrize("name", ["<b>bed</b>", "a & b", "</svg>"])
def test_names_are_text(name):
    svg = draw_floorplan(two_rooms(), [box((1, 2.6, 0), (3, 3.8, 0.7), label=name)], [])
    assert name not in svg.removesuffix("</svg>") and _Texts(svg).labels and _Texts(svg).titles == [name]


def test_cameras_are_a_group_that_the_page_hides():
    assert _Texts(draw_floorplan(two_rooms(), [], [])).groups == ["cameras"]
