"""The laws of furnished rooms, over seeded rooms of every type and several shapes."""

import dataclasses
import functools

import numpy as np
import pytest
import shapely

from tests.offline.arrangement.laws import check_laws
from wm.geometry.plan.site import make_site
from wm.offline.arrangement.arrange import furnish_site, lamped
from wm.offline.arrangement.inventory import LAMPS
from wm.offline.arrangement.programmes import PROGRAMME
from wm.offline.style.theme import style_of

TYPES = (*PROGRAMME, "utility", "other")
"""Types of the rooms that most houses have; test_rooms_equipped.py is about the others."""
THEMES = ("gothic mansion", "scandinavian flat", "beach house", "roman villa", "surreal dream", "cyberpunk")
ROOMS = 42
BEACH = "airy modern beach house with whitewashed boards, linen and driftwood"
CLOCKWORK = "clockwork garden pavilion of brass and moss"
ONCE_CLOSED_OFF = [("gothic mansion", 21), ("gothic mansion", 13), (BEACH, 6), (BEACH, 33), (BEACH, 37), (CLOCKWORK, 54)]
"""Rooms in which an arrangement that looked at its own grid alone closed off a strip between two pieces, on some grid."""


@functools.cache
def room(k: int, theme: str = ""):
    """Room k, in the theme whose turn it is or another: (site, its pieces).

    Rectangles, L-shapes, corridors and closets; one to three doors, up to two windows.
    """
    rng = np.random.default_rng(k)
    kind = TYPES[k % len(TYPES)]
    w, d = {"bathroom": (rng.uniform(1.7, 3), rng.uniform(2, 3)), "corridor": (rng.uniform(4, 8), rng.uniform(1.1, 1.6))}.get(
        kind, (rng.uniform(3, 7.5), rng.uniform(2.6, 5.5))
    )
    polygon = shapely.box(0, 0, w, d)
    if k % 3 == 1 and kind not in ("bathroom", "corridor"):
        polygon = polygon.difference(shapely.box(0.6 * w, 0.55 * d, w + 1, d + 1))
    x = float(rng.uniform(0.1, 0.3)) * w
    openings = [("door", np.array([[x, 0.0], [x + 0.9, 0.0]]), 0.0, 2.1)]
    if k % 2:
        openings.append(("passage", np.array([[0.0, 0.3 * d], [0.0, 0.3 * d + 0.8]]), 0.0, 2.2))
    if k % 5 == 0:
        openings.append(("door", np.array([[w, 0.1], [w, 0.95]]), 0.0, 2.0))
    if kind != "corridor":
        openings.append(("window", np.array([[0.15 * w, d], [0.15 * w + 0.3 * w, d]]), 0.9, 2.1))
    site = make_site(polygon, 2.7 + 0.3 * (k % 2), openings)
    return site, furnish_site(site, kind, style_of(theme or THEMES[k % len(THEMES)]), seed=k, room=k % 7)


@pytest.mark.parametrize("k", range(ROOMS))
def test_laws_of_a_room(k):
    check_laws(*room(k))


@pytest.mark.parametrize("k", range(12))
def test_laws_of_a_room_full_of_clockwork(k):
    """Wheels, orreries, climbers and clocks larger than any other family's keep the laws in rooms of every type."""
    check_laws(*room(k, "clockwork garden"))


@pytest.mark.parametrize(("theme", "k"), ONCE_CLOSED_OFF)
def test_laws_of_a_room_that_once_broke_one(theme, k):
    check_laws(*room(k, theme))


def test_most_rooms_are_furnished():
    counts = [sum(p.piece.support != "object" for p in room(k)[1]) for k in range(ROOMS)]
    assert np.mean(counts) >= 8 and min(counts) >= 2


def test_the_same_seed_gives_the_same_room_and_another_seed_another():
    site, _ = room(3)
    style = style_of("gothic")
    runs = [furnish_site(site, "library", style, seed=seed, room=0) for seed in (5, 5, 6)]
    names = [[(p.piece.label, p.x, p.y, p.yaw) for p in placed] for placed in runs]
    assert names[0] == names[1] and names[0] != names[2]
    assert all(a.piece.vertices.tobytes() == b.piece.vertices.tobytes() for a, b in zip(runs[0], runs[1]))


@pytest.mark.parametrize("family", LAMPS)
def test_a_house_has_lamps_of_several_sorts_and_one_sort_for_each_type_of_room(family):
    style = dataclasses.replace(style_of("gothic"), family=family)
    for seed in range(3):
        sorts = {kind: lamped(style, kind, seed).form.lamp for kind in TYPES}
        assert len(set(sorts.values())) >= 2
        assert sorts == {kind: lamped(style, kind, seed).form.lamp for kind in TYPES}
        assert all(sort in LAMPS[family].get(kind, LAMPS[family][""]) for kind, sort in sorts.items())


def test_density_thins_out():
    site, _ = room(0)
    style = style_of("gothic")
    counts = [
        np.mean([len(furnish_site(site, "living", style, seed=s, room=0, density=share)) for s in range(4)])
        for share in (0.0, 1.0)
    ]
    assert counts[0] < 0.75 * counts[1]


def test_a_room_too_small_to_stand_in_stays_empty():
    site = make_site(shapely.box(0, 0, 0.4, 3), 2.6, [])
    assert furnish_site(site, "living", style_of("gothic"), seed=0, room=0) == []
