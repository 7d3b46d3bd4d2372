"""What a theme asks of kinds of furniture is done, and nothing else changes."""

import numpy as np
import pytest

from wm.geometry import build_structure, parse_plan
from wm.offline.arrangement.furnishing import furnish_scene
from wm.offline.style.finish import SLOTS
from wm.synth.backends import SceneContext

ROOM = """{"id": "%s", "name": "%s", "floor_polygon": [[%g, 0], [%g, 0], [%g, 4.6], [%g, 4.6]], "ceiling_height": 2.7,
  "openings": [{"type": "door", "wall_segment": [[%g, 4.6], [%g, 0]], "position": 0.4, "width": 0.9, "height": 2.0,
  "sill_height": 0}]}"""


def plan_of(*names):
    """Rooms of one size in a row, each with a door to the one on its left, the first without."""
    rooms = []
    for k, name in enumerate(names):
        a, b = 5.4 * k, 5.4 * (k + 1)
        room = ROOM % (f"r{k}", name, a, b, b, a, a, a)
        rooms.append(room if k else room[: room.index('"openings"')] + '"openings": []}')
    metadata = '{"units": "meters", "wall_thickness": 0.15}'
    return parse_plan(f'{{"metadata": {metadata}, "rooms": [{",".join(rooms)}], "objects": []}}')


def furnished(theme, *names, seed=3, **seeds):
    plan = plan_of(*(names or ("living room", "bedroom")))
    return furnish_scene(SceneContext(theme, seed, plan, build_structure(plan), (), seeds=tuple(seeds.items())))


def test_a_green_sofa_changes_the_sofas_and_nothing_else():
    plain, green = furnished("gothic mansion"), furnished("gothic mansion and a green sofa")
    assert [thing.label for thing in plain] == [thing.label for thing in green]
    changed = set()
    for a, b in zip(plain, green):
        np.testing.assert_array_equal(a.vertices, b.vertices)
        if not np.array_equal(a.slot_colors, b.slot_colors):
            changed.add(a.label)
            r, g, b_ = b.slot_colors[next(k for k, s in enumerate(b.slots) if s in ("fabric", "leather", "velvet"))]
            assert g > r and g > b_
    assert changed == {"sofa"}


@pytest.mark.parametrize(("words", "labels"), [("no pictures", {"picture"}), ("no carpets", {"rug", "round rug", "bath mat"})])
def test_what_is_not_wanted_is_left_out_and_the_rest_stays(words, labels):
    plain, less = furnished("scandinavian flat"), furnished(f"scandinavian flat, {words}")
    assert {thing.label for thing in plain} & labels
    assert [thing.label for thing in plain if thing.label not in labels] == [thing.label for thing in less]


def test_a_submarine_has_no_fireplace_and_nothing_hangs_where_it_was():
    for seed in range(6):
        things = furnished("submarine", seed=seed)
        assert "fireplace" not in {thing.label for thing in things}
        lowest = {thing.label: thing.vertices[:, 2].min() for thing in things if thing.support == "object"}
        tops = [thing.vertices[:, 2].max() for thing in things if thing.support in ("floor", "wall", "object")]
        assert all(any(abs(low - top) < 1.2 for top in tops) for low in lowest.values())


def test_slots_stay_known():
    things = furnished("loft, chrome tables, oak wardrobe, leather chairs")
    assert {slot for thing in things for slot in thing.slots} <= set(SLOTS)


def labels_of(things, room):
    return [(thing.label, thing.slots, thing.size.tolist()) for thing in things if thing.room == room]


def test_a_room_that_is_added_leaves_the_furniture_of_the_others():
    before, after = (furnished("coastal", "study", "bedroom", "hall", *more) for more in ((), ("bedroom",)))
    assert [labels_of(before, room) for room in (0, 1)] == [labels_of(after, room) for room in (0, 1)]
    assert labels_of(after, 1) != labels_of(after, 3)


def test_furniture_has_a_seed_of_its_own():
    plain, same, other = furnished("coastal"), furnished("coastal", seed=9, furnish=3), furnished("coastal", furnish=9)
    assert labels_of(plain, 0) == labels_of(same, 0) != labels_of(other, 0)
