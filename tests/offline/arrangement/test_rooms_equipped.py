"""Every sort of room holds what makes it one and nothing that would make it another, in any size, shape, style and seed."""

import functools
import itertools

import numpy as np
import pytest
import shapely

from tests.offline.arrangement.laws import check_laws
from wm.geometry.placement.laws import broken_laws
from wm.geometry.plan.site import make_site
from wm.offline.arrangement.arrange import furnish_site, scene_object
from wm.offline.arrangement.room_type import ROOM_TYPES
from wm.offline.arrangement.rooms_equipped import EQUIPPED
from wm.offline.furniture import EQUIPMENT
from wm.offline.language.programme import room_kind_of
from wm.offline.style.theme import style_of
from wm.synth.room_names import OTHER, SORTS

BEDS = "bed, single bed, four-poster bed, bunk bed, hospital bed, cot"
LOUNGE = "fireplace, sofa, media bench, coffee table"
SEATS = "chair|office chair"
NEVER = dict.fromkeys(SORTS, f"{LOUNGE}, {BEDS}, desk")
"""What stands in no room but those that say so below."""
NEVER |= {
    "hall": BEDS, "great hall": BEDS, "atrium": BEDS, "living": BEDS, "leisure": BEDS, "tea room": BEDS, "library": BEDS,
    "study": f"{BEDS}, sofa", "studio": f"{BEDS}, sofa", "dining": f"{BEDS}, sofa, desk", "bedroom": "sofa, fireplace, bathtub",
    **dict.fromkeys(("office", "control room", "surgery", "observatory"), f"{LOUNGE}, {BEDS}"),
    "nursery": f"{LOUNGE}, desk, bed, bunk bed", "kids": f"{LOUNGE}, four-poster bed, cot", "cell": f"{LOUNGE}, desk, single bed",
    "dormitory": f"{LOUNGE}, desk, four-poster bed", "hospital": f"{LOUNGE}, desk, bed, single bed",
    "wc": "bathtub, shower, sofa, desk",
    OTHER: f"{LOUNGE}, {BEDS}, desk, armchair, {', '.join(EQUIPMENT)}", "room": f"{LOUNGE}, {BEDS}, desk, armchair",
}  # fmt: skip
MUST = {
    "corridor": "rug|console table|plant|bench|wall sconce",
    "hall": "console table|bench|statue|column|plant",
    "great hall": "chair|armchair|bench|statue|column",
    "gallery": "statue|bench|column",
    "atrium": "console table|bench|statue|column|plant",
    "living": "sofa|armchair",
    "leisure": "sofa|armchair",
    "tea room": "sofa|armchair",
    "dining": "dining table|round table, chair",
    "kitchen": "stove, sink counter",
    "library": "bookshelf",
    "studio": "desk",
    "study": "desk",
    "bedroom": "bed|single bed|four-poster bed",
    "bathroom": "toilet",
    "entrance": "coat rack, umbrella stand|shoe rack",
    "throne room": "throne",
    "museum": "display case",
    "garden": "bench, plant|planter",
    "balcony": "railing planter, deck chair",
    "restaurant": f"round table, {SEATS}",
    "bar": "bar counter, bottle shelf, bar stool",
    "pantry": "larder shelf",
    "bakery": "cake counter, stove",
    "conservatory": "armchair, plant",
    "greenhouse": "potting bench, plant",
    "aquarium": "fish tank",
    "music": "piano, music stand|drum kit",
    "games": "arcade machine, tennis table",
    "billiard": "billiard table",
    "cinema": "wall screen, cinema seats",
    "gym": "treadmill, weight bench, dumbbell rack",
    "yoga": "yoga mat",
    "dance": "mirror",
    "ballroom": "piano",
    "chapel": "altar table, pew",
    "crypt": "altar table, column|statue",
    "classroom": "blackboard, pupil desk, chair",
    "workshop": "workbench",
    "forge": "anvil, workbench",
    "garage": "car, workbench|pile of tyres",
    "boiler room": "boiler",
    "atelier": "easel",
    "laboratory": "lab bench",
    "observatory": "telescope",
    "office": f"desk, {SEATS}, filing cabinet",
    "meeting": f"dining table|round table, {SEATS}",
    "control room": f"desk, server rack, {SEATS}",
    "server room": "server rack",
    "reception": "shop counter, chair|bench",
    "shop": "shop shelf, shop counter",
    "barber": "barber chair, mirror",
    "dormitory": "bunk bed",
    "nursery": "cot, changing table",
    "kids": "single bed, toy box",
    "playroom": "toy box, play mat",
    "hospital": "hospital bed, drip stand",
    "surgery": "examination table",
    "cell": "bunk bed, toilet",
    "wc": "toilet, washbasin",
    "sauna": "sauna bench, sauna stove",
    "pool": "pool, deck chair",
    "laundry": "washing machine, ironing board|drying rack",
    "service": "washing machine, storage rack",
    "closet": "clothes rack",
    "cloakroom": "coat rack, shoe rack",
    "changing room": "lockers, bench",
    "storage": "storage rack",
    "cellar": "barrel, bottle shelf",
    "vault": "safe, chest",
    "armoury": "weapon rack",
    "stable": "horse stall, hay bale",
    "room": "bench|chair|console table|plant",
    OTHER: "bench|chair|console table|plant",
}
"""What stands in each sort of room: one of the alternatives between bars, and all that commas part."""
HUNG = (
    "hall",
    "gallery",
    "kitchen",
    "utility",
    "workshop",
    "cinema",
    "classroom",
    "games",
    "boiler room",
    "throne room",
    "closet",
)
"""Types of rooms with large things on their walls."""
THEMES = ("scandinavian flat", "gothic mansion", "clockwork garden", "cyberpunk", "beach house", "roman villa")


def room_site(sort, k):
    """A room of a sort: small, middling and L-shaped, or large, with one door or two and a window."""
    low, high = room_kind_of(sort).area if sort != OTHER else (14.0, 22.0)
    area = (low, 0.5 * (low + high), high)[k]
    w = np.sqrt(area * 1.3 * (1.15 if k == 1 else 1.0))
    d = area * (1.15 if k == 1 else 1.0) / w
    polygon = shapely.box(0, 0, w, d)
    if k == 1 and area > 12:
        polygon = polygon.difference(shapely.box(0.65 * w, 0.6 * d, w + 1, d + 1))
    openings = [("door", np.array([[0.5, 0.0], [1.4, 0.0]]), 0.0, 2.1)]
    if area > 8:
        openings.append(("window", np.array([[0.15 * w, d], [0.15 * w + 1.0, d]]), 0.9, 2.1))
    if k == 2:
        openings.append(("door", np.array([[w, 0.1], [w, 1.0]]), 0.0, 2.1))
    return make_site(polygon, 2.5 + 0.2 * k, openings)


@functools.cache
def furnished(sort, k):
    """Room k of a sort in a style of its own, and what stands there."""
    site, theme = room_site(sort, k), THEMES[(SORTS.index(sort) + k) % len(THEMES)]
    return site, furnish_site(site, ROOM_TYPES[sort], style_of(theme), seed=7 * k + SORTS.index(sort), room=k)


@pytest.mark.parametrize("k", [0, *(pytest.param(k, marks=pytest.mark.slow) for k in (1, 2))])
@pytest.mark.parametrize("sort", SORTS)
def test_a_room_holds_what_makes_it_one_and_nothing_that_makes_it_another(sort, k):
    site, placed = furnished(sort, k)
    labels = {p.piece.label for p in placed}
    for alternatives in MUST[sort].split(", "):
        assert labels & set(alternatives.split("|")), f"a {sort} without {alternatives}: {sorted(labels)}"
    assert not labels & set(NEVER[sort].split(", "))
    check_laws(site, placed)
    assert broken_laws([scene_object(p, 0) for p in placed], site) == []


def test_every_sort_has_a_row():
    assert set(MUST) == set(NEVER) == set(SORTS) and len(SORTS) >= 60


def test_every_equipment_stands_somewhere():
    equipped = [sort for sort in SORTS if ROOM_TYPES[sort] in EQUIPPED]
    missing = set(EQUIPMENT)
    for k, sort in itertools.product(range(3), equipped):
        if missing:  # the small rooms are furnished anyway, and hold most of it
            missing -= {p.piece.label for p in furnished(sort, k)[1]}
    assert not missing


@pytest.mark.parametrize(("theme", "ceiling"), [("clockwork garden", 1.8), ("clockwork garden", 1.9), ("gothic mansion", 2.0)])
def test_nothing_goes_through_the_floor_or_the_ceiling_of_a_low_room(theme, ceiling):
    site = make_site(shapely.box(0, 0, 5, 4), ceiling, [("door", np.array([[0.5, 0.0], [1.4, 0.0]]), 0.0, 1.75)])
    for seed, kind in enumerate(HUNG):
        for p in furnish_site(site, kind, style_of(theme), seed=seed, room=0):
            assert p.z >= -1e-9 and p.top <= ceiling, f"{p.piece.label} in a {kind}"


def test_an_unknown_room_is_sparse():
    site = room_site("room", 2)
    for seed, theme in enumerate(THEMES):
        known, unknown = (furnish_site(site, kind, style_of(theme), seed=seed, room=0) for kind in ("living", "other"))
        counts = [sum(p.piece.support == "floor" for p in placed) for placed in (known, unknown)]
        assert 2 <= counts[1] < counts[0]
