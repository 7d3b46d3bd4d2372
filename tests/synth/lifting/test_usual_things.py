"""What is looked for in rooms where nobody names it."""

import pytest

from wm.geometry.placement.support import is_structure
from wm.synth.lifting import usual_things as module
from wm.synth.lifting.usual_things import IN_ALL_ROOMS, searchable, usual_things
from wm.synth.lifting.vocabulary import LARGEST, sort_of
from wm.synth.room_names import SORTS, room_sort


def test_every_sort_that_is_named_is_one_and_the_table_is_not_empty():
    assert set(module._BY_SORT) <= set(SORTS) and len(module._BY_SORT) > 50


@pytest.mark.parametrize("sort", sorted(module._BY_SORT))
def test_what_is_looked_for_is_no_part_of_the_building_and_of_known_size(sort):
    for name in (*module._BY_SORT[sort], *IN_ALL_ROOMS):
        assert not is_structure(name) and sort_of(name) in LARGEST and name == name.lower()


def test_a_room_is_looked_through_for_its_own_things_first():
    bedroom, unknown = usual_things("Guest Bedroom"), usual_things("zyx")
    assert bedroom[:2] == ("bed", "nightstand") and unknown == IN_ALL_ROOMS
    assert len(set(bedroom)) == len(bedroom) and set(IN_ALL_ROOMS) <= set(bedroom)
    assert room_sort("Guest Bedroom") == "bedroom"


def test_names_are_made_searchable():
    names = [" Sofa ", "sofa", "wall", "Wooden door", "- floor lamp.", "", "x" * 61, "a painting of a door", "rug"]
    assert searchable(names, most=10) == ["sofa", "floor lamp", "a painting of a door", "rug"]
    assert searchable(names, most=2) == ["sofa", "floor lamp"]
