"""The laws of furnished rooms, over seeded rooms of every type and several shapes."""

import dataclasses
import functools

import numpy as np
import pytest
import shapely
from scipy import ndimage

from wm.geometry.placement.navigation import cells_inside
from wm.geometry.plan.site import make_site
from wm.offline.arrangement.arrange import furnish_site, lamped, scene_object
from wm.offline.arrangement.inventory import LAMPS
from wm.offline.arrangement.programmes import PROGRAMME
from wm.offline.style.theme import style_of
from wm.schema import NavigationSettings

TYPES = (*PROGRAMME, "utility", "other")
"""Types of the rooms that most houses have; test_rooms_equipped.py is about the others."""
THEMES = ("gothic mansion", "scandinavian flat", "beach house", "roman villa", "surreal dream", "cyberpunk")
ROOMS = 42
BEACH = "airy modern beach house with whitewashed boards, linen and driftwood"
CLOCKWORK = "clockwork garden pavilion of brass and moss"
ONCE_CLOSED_OFF = [("gothic mansion", 21), ("gothic mansion", 13), (BEACH, 6), (BEACH, 33), (BEACH, 37), (CLOCKWORK, 54)]
"""Rooms in which an arrangement that looked at its own grid alone closed off a strip between two pieces, on some grid."""
NAVIGATION = NavigationSettings()


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


def trunk(placed):
    """What a piece really takes up: the hull of its vertices from above, and its height interval."""
    world = scene_object(placed, 0).vertices
    return shapely.convex_hull(shapely.MultiPoint(world[:, :2])), world[:, 2].min(), world[:, 2].max()


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


def check_laws(site, placed):
    solids = [trunk(p) for p in placed]
    roomy = site.polygon.buffer(0.001)
    for p, (hull, low, high) in zip(placed, solids):
        name = p.piece.label
        assert roomy.contains(hull) and low > -1e-9 and high < site.ceiling, f"{name} leaves the room"
        assert abs(low - p.z) < 1e-9
        if p.piece.support in ("floor", "flat"):
            assert low < 0.01, f"{name} floats"
        elif p.piece.support == "ceiling":
            assert site.ceiling - high < 0.01, f"{name} hangs on nothing"
        elif p.piece.support == "wall":
            assert shapely.distance(site.polygon.exterior, hull) < 0.01, f"{name} is off its wall"
        else:
            below = [
                q
                for q, (base, _, _) in zip(placed, solids)
                if q is not p and any(abs(q.z + t.z - low) < 0.01 for t in q.piece.tops) and base.contains(hull.centroid)
            ]
            assert below, f"{name} floats"
        if p.piece.support != "flat" and low < 1.9:
            assert not any(zone.intersects(hull) for zone in site.keep), f"{name} stands before a door"
    for i, (p, (a, a0, a1)) in enumerate(zip(placed, solids)):
        for q, (b, b0, b1) in zip(placed[:i], solids[:i]):
            if "flat" in (p.piece.support, q.piece.support) and (p.piece.support != q.piece.support):
                continue  # feet stand 8 mm deep in rugs
            if min(a1, b1) - max(a0, b0) > 0.0 and a.intersects(b):
                raise AssertionError(f"{p.piece.label} and {q.piece.label} share space")
    check_walkable(site, placed, solids)


def check_walkable(site, placed, solids):
    """On the grid of navigation a body of 0.25 m radius reaches every door from every other, and no part of the floor is closed
    off to it: what it cannot reach is less than half a square metre of places for its middle, and 5 % of them. A house's grid
    starts where it likes: so too on that grid half a cell to either side."""
    walkable = site.polygon.buffer(-NAVIGATION.body_radius)
    in_the_way = [hull for p, (hull, low, _) in zip(placed, solids) if p.piece.support == "floor" and low < 1.8]
    blocked = shapely.union_all(in_the_way).buffer(NAVIGATION.body_radius)
    corner = np.array(site.polygon.bounds[:2])
    for shift in np.ndindex(2, 2):
        check_walkable_on(corner - 0.5 * NAVIGATION.cell * np.array(shift), site, walkable, walkable.difference(blocked))


def check_walkable_on(low, site, walkable, unblocked):
    """The same on the grid that starts at one point."""
    columns, rows = (int(n) for n in np.ceil((np.array(site.polygon.bounds[2:]) - low) / NAVIGATION.cell))
    bare, free = (cells_inside(area, low, NAVIGATION.cell, (rows, columns)) for area in (walkable, unblocked))
    labels, _ = ndimage.label(free)
    sizes = np.bincount(labels.ravel())[1:]
    if not len(sizes) or ndimage.label(bare)[1] > 1:
        return
    main = int(np.argmax(sizes)) + 1
    closed = int(sizes.sum() - sizes.max())
    assert closed <= 0.05 * sizes.sum() and closed * NAVIGATION.cell**2 < 0.5
    centres = low + NAVIGATION.cell * (np.stack(np.meshgrid(np.arange(columns), np.arange(rows)), -1) + 0.5)
    for probe in site.probes:
        near = np.abs(centres - probe).max(axis=-1) < 0.2
        assert not bare[near].any() or (labels[near] == main).any(), "a door is blocked"


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
