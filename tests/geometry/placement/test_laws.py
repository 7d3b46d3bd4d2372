"""The laws see what breaks them: one broken room each, and one that breaks none."""

import dataclasses

import numpy as np
import pytest
import shapely

from tests.geometry.placement.test_upright_box import rotation
from tests.geometry.things import box
from wm.geometry.placement.laws import broken_laws
from wm.geometry.placement.upright import transformed
from wm.geometry.plan.site import make_site

DOORS = [
    ("door", np.array([[0.0, 0.3], [0.0, 1.2]]), 0.0, 2.1),
    ("door", np.array([[4.0, 0.3], [4.0, 1.2]]), 0.0, 2.1),
]
SITE = make_site(shapely.box(0, 0, 4, 2), 2.5, DOORS)
TABLE = box((1.2, 1.2, 0.002), (2.0, 1.9, 0.7))


def held(thing, support):
    return dataclasses.replace(thing, support=support)


def test_a_sound_room_breaks_none():
    vase = held(box((1.5, 1.4, 0.705), (1.6, 1.5, 0.9)), "object")
    picture = held(box((1.3, 1.96, 1.2), (1.9, 1.995, 1.7)), "wall")
    lamp = held(box((1.8, 0.8, 2.0), (2.2, 1.2, 2.498)), "ceiling")
    assert broken_laws([TABLE, vase, picture, lamp], SITE) == []


@pytest.mark.parametrize(
    ("law", "things"),
    [
        ("interpenetrates", [TABLE, box((1.9, 1.2, 0.0), (2.6, 1.9, 0.6))]),
        ("leaves", [box((1.2, 1.3, 0.0), (2.0, 2.1, 0.7))]),
        ("leaves", [held(box((1.8, 0.8, 2.0), (2.2, 1.2, 2.6)), "ceiling")]),
        ("floats", [box((1.2, 1.2, 0.05), (2.0, 1.9, 0.7))]),
        ("floats", [TABLE, held(box((2.1, 1.4, 0.705), (2.2, 1.5, 0.9)), "object")]),
        ("floats", [held(box((1.3, 1.8, 1.2), (1.9, 1.85, 1.7)), "wall")]),
        ("floats", [held(box((1.8, 0.8, 1.9), (2.2, 1.2, 2.4)), "ceiling")]),
        ("tilts", [transformed(box((1.2, 1.0, 0.0), (1.9, 1.6, 0.5)), rotation((1, 0, 0), 0.03))]),
        ("blocks", [box((1.5, 0.1, 0.0), (2.0, 1.9, 1.0))]),
    ],
)  # fmt: skip
def test_each_law_is_seen_broken(law, things):
    assert law in {broken.law for broken in broken_laws(things, SITE)}


def test_half_a_centimetre_is_let_pass():
    assert broken_laws([TABLE, box((1.995, 1.2, 0.002), (2.6, 1.9, 0.6))], SITE) == []
